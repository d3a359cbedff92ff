#include "bedload/case/formula.hpp"

#include <algorithm>
#include <charconv>
#include <numbers>

#include "bedload/core/error.hpp"
#include "shortened.hpp"

namespace bedload {
namespace {

struct Function {
  std::string_view name;
  FormulaOp op;
  bool any_number = false;  ///< of arguments, of which op takes two at a time
};
constexpr std::string_view kMean = "avg";
constexpr Function kFunctions[] = {
    {"sin", FormulaOp::sin},       {"cos", FormulaOp::cos},       {"tan", FormulaOp::tan},
    {"asin", FormulaOp::asin},     {"acos", FormulaOp::acos},     {"atan", FormulaOp::atan},
    {"sinh", FormulaOp::sinh},     {"cosh", FormulaOp::cosh},     {"tanh", FormulaOp::tanh},
    {"asinh", FormulaOp::asinh},   {"acosh", FormulaOp::acosh},   {"atanh", FormulaOp::atanh},
    {"exp", FormulaOp::exp},       {"ln", FormulaOp::ln},         {"log", FormulaOp::ln},
    {"log2", FormulaOp::log2},     {"log10", FormulaOp::log10},   {"sqrt", FormulaOp::sqrt},
    {"abs", FormulaOp::abs},       {"sign", FormulaOp::sign},     {"rint", FormulaOp::rint},
    {"atan2", FormulaOp::atan2},   {"min", FormulaOp::min, true}, {"max", FormulaOp::max, true},
    {"sum", FormulaOp::add, true}, {kMean, FormulaOp::add, true}};

/// Between two operands, from the left; what binds more closely has the higher level.
struct Operator {
  std::string_view text;
  FormulaOp op;
  int level;
};
constexpr Operator kOperators[] = {
    {"||", FormulaOp::either, 1},   {"&&", FormulaOp::both, 2},    {"<=", FormulaOp::at_most, 3},
    {">=", FormulaOp::at_least, 3}, {"==", FormulaOp::equal, 3},   {"!=", FormulaOp::unequal, 3},
    {"<", FormulaOp::less, 3},      {">", FormulaOp::more, 3},     {"+", FormulaOp::add, 4},
    {"-", FormulaOp::subtract, 4},  {"*", FormulaOp::multiply, 5}, {"/", FormulaOp::divide, 5}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool in_name(char c) { return is_digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// By recursive descent; operands before their operator.
class Parser {
 public:
  Parser(std::string_view text, std::string_view variables) : text_(text), variables_(variables) {}

  std::vector<FormulaStep> parse() {
    const int values = list();
    if (at_ < text_.size()) unexpected();
    if (values != 1)
      throw CaseError("it makes " + std::to_string(values) + " values; is a decimal comma meant as a point?");
    return std::move(steps_);
  }

 private:
  static constexpr int kNesting = 200;

  /// One choice after the other; how many.
  int list() {
    int values = 1;
    for (choice(); take(","); ++values) choice();
    return values;
  }
  void choice() {
    const Level level(*this);
    operations(1);
    if (!take("?")) return;
    choice();
    if (!take(":")) unexpected();
    choice();
    emit(FormulaOp::choose);
  }
  void operations(int least) {
    sign();
    while (const Operator* o = next_operator(least)) {
      at_ += o->text.size();
      operations(o->level + 1);
      emit(o->op);
    }
  }
  const Operator* next_operator(int least) {
    skip_space();
    for (const Operator& o : kOperators)
      if (text_.substr(at_).starts_with(o.text)) return o.level >= least ? &o : nullptr;
    return nullptr;
  }
  void sign() {
    const Level level(*this);
    const bool minus = take("-");
    if (minus || take("+"))
      sign();
    else
      power();
    if (minus) emit(FormulaOp::negative);
  }
  void power() {
    operand();
    if (!take("^")) return;
    sign();
    emit(FormulaOp::power);
  }
  void operand() {
    if (take("(")) {
      choice();
      if (!take(")")) unexpected();
      return;
    }
    skip_space();
    const std::size_t begin = at_;
    double number;
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) {
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
      if (error != std::errc()) unexpected();
      at_ = std::size_t(end - text_.data());
      return put({.number = number});
    }
    const std::string_view name = name_here();
    at_ += name.size();
    const std::size_t variable = name.size() == 1 ? variables_.find(name[0]) : name.npos;
    const auto function = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                       [&](const Function& f) { return f.name == name; });
    if (variable != name.npos)
      put({.op = FormulaOp::variable, .variable = std::int32_t(variable)});
    else if (name == "pi")
      put({.number = std::numbers::pi});
    else if (name == "e")
      put({.number = std::numbers::e});
    else if (function != std::end(kFunctions))
      call(*function);
    else
      at_ = begin, unexpected();
  }
  void call(const Function& f) {
    if (!take("(")) unexpected();
    const int given = list();
    if (!take(")")) unexpected();
    if (!f.any_number && given != operands(f.op))
      throw CaseError(std::string(f.name) + " is of " + std::to_string(operands(f.op)) + ", not of " +
                      std::to_string(given));
    for (int k = 1; k < given; ++k) emit(f.op);
    if (!f.any_number && given == 1) emit(f.op);
    if (f.name == kMean) put({.number = double(given)}), emit(FormulaOp::divide);
  }

  void put(const FormulaStep& step) {
    steps_.push_back(step);
    if (++depth_ > FormulaCode::kDepth) nested_too_deeply();
  }
  /// Numbers alone are worked out at once.
  void emit(FormulaOp op) {
    const std::size_t first = steps_.size() - std::size_t(operands(op));
    const bool known = std::all_of(steps_.begin() + std::ptrdiff_t(first), steps_.end(),
                                   [](const FormulaStep& s) { return s.op == FormulaOp::number; });
    steps_.push_back({.op = op});
    depth_ += 1 - operands(op);
    if (!known) return;
    const double value = FormulaCode{&steps_[first], operands(op) + 1}({}, 0);
    steps_.resize(first);
    steps_.push_back({.number = value});
  }

  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != text_.npos) ++at_;
  }
  bool take(std::string_view token) {
    skip_space();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  std::string_view name_here() const {
    std::size_t end = at_;
    while (end < text_.size() && in_name(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  [[noreturn]] void unexpected() {
    skip_space();
    if (at_ == text_.size()) throw CaseError("it ends too soon");
    if (text_[at_] == '=') throw CaseError("= assigns; == compares");
    std::string_view name = name_here();
    if (name.empty()) {  // all bytes of a character
      std::size_t end = at_ + 1;
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xc0) == 0x80) ++end;
      name = text_.substr(at_, end - at_);
    }
    throw CaseError("Unexpected token \"" + shortened(std::string(name), 60) + "\" found at position " +
                    std::to_string(at_));
  }
  [[noreturn]] static void nested_too_deeply() { throw CaseError("it is nested too deeply"); }

  struct Level {
    Parser& parser;
    explicit Level(Parser& p) : parser(p) {
      if (++p.level_ > kNesting) nested_too_deeply();
    }
    ~Level() { --parser.level_; }
  };

  std::string_view text_, variables_;
  std::size_t at_ = 0;
  int level_ = 0, depth_ = 0;
  std::vector<FormulaStep> steps_;
};

}  // namespace

Formula::Formula(const std::string& text, std::string_view variables)
    : variables_(variables), steps_(Parser(text, variables).parse()) {}

bool Formula::uses(char variable) const {
  const auto index = std::int32_t(variables_.find(variable));
  return std::any_of(steps_.begin(), steps_.end(), [&](const FormulaStep& s) {
    return s.op == FormulaOp::variable && s.variable == index;
  });
}

}  // namespace bedload
