#include "variables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>
#include <numbers>

#include "bedload/case/formula.hpp"
#include "bedload/core/error.hpp"

namespace bedload {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kDeepest = 50;  ///< brackets within brackets

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool continues_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)); }

/// The end of the bracket that opens at `from`.
std::size_t closing(std::string_view text, std::size_t from) {
  int depth = 0;
  for (std::size_t k = from; k < text.size(); ++k) {
    depth += text[k] == '(' ? 1 : text[k] == ')' ? -1 : 0;
    if (depth > kDeepest) throw CaseError("has too many brackets");
    if (depth == 0) return k;
  }
  throw CaseError("has a bracket that does not close");
}

/// "a, max(b, c)" to "a" and "max(b, c)".
std::vector<std::string_view> arguments_of(std::string_view text) {
  std::vector<std::string_view> out;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    if (k < text.size()) depth += text[k] == '(' ? 1 : text[k] == ')' ? -1 : 0;
    if (k < text.size() && (text[k] != ',' || depth > 0)) continue;
    out.push_back(text.substr(begin, k - begin));
    begin = k + 1;
  }
  if (out.size() == 1 && out[0].find_first_not_of(" \t") == out[0].npos) out.clear();
  return out;
}

/// As an operand: with a sign only within brackets.
std::string operand(double value) { return fmt::format("({:.17g})", value); }

}  // namespace

std::optional<double> Variables::find(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::nullopt : std::optional(found->second);
}

double Variables::value(std::string_view expression) const {
  std::string plain;  // without names
  for (std::size_t k = 0; k < expression.size();) {
    const char c = expression[k];
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {  // with its exponent
      std::size_t end = k;
      while (
          end < expression.size() &&
          (std::isalnum(static_cast<unsigned char>(expression[end])) || expression[end] == '.' ||
           ((expression[end] == '-' || expression[end] == '+') && std::tolower(expression[end - 1]) == 'e')))
        ++end;
      plain += expression.substr(k, end - k);
      k = end;
      continue;
    }
    if (!begins_name(c)) {
      plain += c, ++k;
      continue;
    }
    std::size_t end = k;
    while (end < expression.size() && continues_name(expression[end])) ++end;
    const std::string name(expression.substr(k, end - k));
    if (end < expression.size() && expression[end] == '(') {
      const std::size_t close = closing(expression, end);
      std::vector<double> values;
      for (const std::string_view argument : arguments_of(expression.substr(end + 1, close - end - 1)))
        values.push_back(value(argument));
      plain += operand(call(name, values));
      k = close + 1;
      continue;
    }
    const std::optional<double> known = find(name);
    if (!known) throw CaseError(fmt::format("names {}, which has no value", name));
    plain += operand(*known);
    k = end;
  }
  if (plain.find_first_not_of(" \t\r\n") == plain.npos) throw CaseError("is empty");
  const double result = Formula(plain)(0.0);
  if (!std::isfinite(result)) throw CaseError("has no finite value");
  return result;
}

double Variables::call(const std::string& name, const std::vector<double>& a) const {
  const auto needs = [&](std::size_t count) {
    if (a.size() != count) throw CaseError(fmt::format("calls {} with {} values", name, a.size()));
  };
  if (name == "pi" || name == "e") return needs(0), name == "pi" ? std::numbers::pi : std::numbers::e;
  if (name == "pow" || name == "fmod")
    return needs(2), name == "pow" ? std::pow(a[0], a[1]) : std::fmod(a[0], a[1]);
  if (name == "eval") return needs(3), a[0] != 0 ? a[1] : a[2];
  if (name == "sindg") return needs(1), std::sin(a[0] * kDegree);
  if (name == "cosdg") return needs(1), std::cos(a[0] * kDegree);
  if (name == "tandg") return needs(1), std::tan(a[0] * kDegree);
  if (name == "floor") return needs(1), std::floor(a[0]);
  if (name == "ceil") return needs(1), std::ceil(a[0]);
  if (name == "round") return needs(1), std::round(a[0]);
  if (name == "int") return needs(1), std::trunc(a[0]);
  if (name == "float") return needs(1), a[0];
  std::vector<std::string> words;
  for (const double value : a) words.push_back(operand(value));
  return Formula(fmt::format("{}({})", name, fmt::join(words, ", ")))(0.0);
}

}  // namespace bedload
