// The visitors that write: a resolved case, and the table of parameters.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "bedload/case/parameters.hpp"
#include "bedload/case/read.hpp"
#include "bedload/case/section.hpp"

namespace bedload {
namespace {

/// A member of Config as TOML; shortest text that reads back to the same number.
struct ToText {
  template <class T>
  static std::string scalar(T value) {
    return Value{.data = value}.text();
  }
  std::string operator()(const bool* b) const { return scalar(*b); }
  std::string operator()(const std::int64_t* i) const { return scalar(*i); }
  std::string operator()(const std::uint64_t* i) const { return scalar(std::int64_t(*i)); }
  std::string operator()(const double* x) const { return scalar(*x); }
  std::string operator()(const std::string* s) const { return scalar(*s); }
  std::string operator()(const Vec3d* v) const { return fmt::format("[{}, {}, {}]", v->x, v->y, v->z); }
  std::string operator()(const Formulas* f) const {
    return fmt::format("[{}, {}, {}]", scalar((*f)[0]), scalar((*f)[1]), scalar((*f)[2]));
  }
  std::string operator()(const std::array<bool, 3>* b) const {
    return fmt::format("[{}, {}, {}]", (*b)[0], (*b)[1], (*b)[2]);
  }
  std::string operator()(const Faces* faces) const {
    std::string out;
    for (std::size_t i = 0; i < kFaces.size(); ++i)
      if ((*faces)[i]) out += fmt::format("{}\"{}\"", out.empty() ? "" : ", ", kFaces[i]);
    return "[" + out + "]";
  }
  std::string operator()(const std::vector<std::string>* list) const {
    std::string out;
    for (const std::string& s : *list) out += (out.empty() ? "" : ", ") + scalar(s);
    return "[" + out + "]";
  }
  template <class T>
  std::string operator()(const std::vector<T>* list) const {
    std::string out;
    for (const T& v : *list) out += (out.empty() ? "" : ", ") + (*this)(&v);
    return "[" + out + "]";
  }
  template <std::size_t n>
  std::string operator()(const std::vector<std::array<double, n>>* rows) const {
    std::string out;
    for (const auto& row : *rows) out += fmt::format("{}[{}]", out.empty() ? "" : ", ", fmt::join(row, ", "));
    return "[" + out + "]";
  }
};

bool is_absent(const Slot& value) {
  struct Test {
    bool operator()(const double* x) const { return *x == 0 || std::isinf(*x); }
    bool operator()(const std::int64_t* i) const { return *i == 0; }
    bool operator()(const std::string* s) const { return s->empty(); }
    bool operator()(const Faces* faces) const { return *faces == Faces{}; }
    bool operator()(const std::vector<Vec3d>* list) const { return list->empty(); }
    bool operator()(const std::vector<double>* list) const { return list->empty(); }
    bool operator()(const std::vector<std::string>* list) const { return list->empty(); }
    bool operator()(const std::vector<MotionRow>* rows) const { return rows->empty(); }
    bool operator()(const std::vector<ClumpSphere>* spheres) const { return spheres->empty(); }
    bool operator()(const void*) const { return false; }
  };
  return std::visit(Test{}, value);
}

class Writer final : public Parameters {
 public:
  void operator()(std::string_view key, Slot value, const About& about) override {
    if (about.presence == Presence::optional && is_absent(value)) return;
    if (about.presence == Presence::unbounded && std::isinf(*std::get<double*>(value))) return;
    const auto dot = key.rfind('.');
    const std::string table = prefix_ + std::string(dot == key.npos ? "" : key.substr(0, dot));
    if (dot != key.npos && table != table_) text_ += fmt::format("\n[{}]\n", table_ = table);
    text_ +=
        fmt::format("{} = {}\n", dot == key.npos ? key : key.substr(dot + 1), std::visit(ToText{}, value));
  }
  bool table(std::string_view, bool present) override { return present; }
  const std::string& text() const { return text_; }

 private:
  std::size_t open_list(std::string_view, std::size_t have) override { return have; }
  void open_item(std::string_view key, std::size_t) override {
    outer_.push_back(prefix_);
    text_ += fmt::format("\n[[{}{}]]\n", prefix_, key);
    prefix_ += std::string(key) + ".";
    table_.clear();
  }
  void close_item() override {
    prefix_ = outer_.back();
    outer_.pop_back();
    table_.clear();
  }

  std::string text_, table_, prefix_;
  std::vector<std::string> outer_;
};

/// A visitor that enters every table, and each list once; keeps the full keys.
class Tour : public Parameters {
 public:
  bool table(std::string_view, bool) override { return true; }
  /// Those that were entered, "wall.body.".
  const std::set<std::string>& lists() const { return lists_; }

 protected:
  std::string key_of(std::string_view key) const { return prefix_ + std::string(key); }
  std::string path_of(std::string_view key) const { return path_ + std::string(key); }

 private:
  std::size_t open_list(std::string_view, std::size_t) override { return 1; }
  void open_item(std::string_view key, std::size_t) override {
    outer_.emplace_back(prefix_, path_);
    prefix_ += std::string(key) + ".";
    path_ += std::string(key) + "[].";
    lists_.insert(prefix_);
  }
  void close_item() override {
    std::tie(prefix_, path_) = outer_.back();
    outer_.pop_back();
  }

  std::string prefix_, path_;
  std::set<std::string> lists_;
  std::vector<std::pair<std::string, std::string>> outer_;
};

/// What is required of tables that hold every name and list that they may, and the n-th of each choice.
class RequiredKeys final : public Tour {
 public:
  explicit RequiredKeys(std::size_t n) : n_(n) {}
  void operator()(std::string_view key, Slot value, const About& about) override {
    if (about.presence == Presence::required) keys_.insert(key_of(key));
    most_ = std::max(most_, about.choices.size());
    std::visit(Give{about, n_}, value);
  }
  const std::set<std::string>& keys() const { return keys_; }
  std::size_t most_choices() const { return most_; }

 private:
  struct Give {
    const About& about;
    std::size_t n;
    void operator()(std::string* text) const {
      *text = about.choices.empty() ? "?" : about.choices[n % about.choices.size()].name;
    }
    template <class T>
    void operator()(std::vector<T>* list) const {
      list->resize(1);
    }
    void operator()(const void*) const {}
  };
  std::size_t n_, most_ = 1;
  std::set<std::string> keys_;
};

/// Whatever the choices. `present`: of a case with fluid and grains.
std::set<std::string> keys_required(bool present) {
  std::set<std::string> keys, lists;
  std::size_t most = 1;
  for (std::size_t n = 0; n < most; ++n) {
    Config config;
    config.fluid.present = config.grain.present = present;
    RequiredKeys visitor(n);
    describe(visitor, config);
    most = std::max(most, visitor.most_choices());
    if (n == 0) keys = visitor.keys(), lists = visitor.lists();
    const auto in_it = [&](const std::string& key) {  // not in a list that these choices leave out
      return std::ranges::none_of(lists, [&](const std::string& list) {
        return key.starts_with(list) && !visitor.lists().contains(list);
      });
    };
    std::erase_if(keys, [&](const std::string& key) { return !visitor.keys().contains(key) && in_it(key); });
  }
  return keys;
}

/// The ranges of a case in which all values are others than by default.
class OtherRanges final : public Tour {
 public:
  void operator()(std::string_view key, Slot value, const About& about) override {
    ranges_[key_of(key)] = about.range;
    std::visit(Change{about}, value);
  }
  bool everything() const override { return true; }
  const std::map<std::string, Interval>& ranges() const { return ranges_; }

 private:
  struct Change {
    const About& about;
    void operator()(bool* flag) const { *flag = !*flag; }
    void operator()(double* number) const { *number = 1.5 * *number + 1e-3; }
    void operator()(std::string* text) const {
      if (!about.choices.empty()) *text = about.choices.back().name;
    }
    void operator()(const void*) const {}
  };
  std::map<std::string, Interval> ranges_;
};

std::map<std::string, Interval> other_ranges() {
  Config config;
  config.fluid.present = config.grain.present = true;
  OtherRanges visitor;
  describe(visitor, config);
  return visitor.ranges();
}

ValueKind kind_of(const Slot& value) {
  using enum ValueKind;
  struct Kind {
    ValueKind operator()(const bool*) const { return boolean; }
    ValueKind operator()(const std::int64_t*) const { return integer; }
    ValueKind operator()(const std::uint64_t*) const { return integer; }
    ValueKind operator()(const double*) const { return number; }
    ValueKind operator()(const std::string*) const { return text; }
    ValueKind operator()(const Vec3d*) const { return vector; }
    ValueKind operator()(const Formulas*) const { return formulas; }
    ValueKind operator()(const std::array<bool, 3>*) const { return booleans; }
    ValueKind operator()(const Faces*) const { return faces; }
    ValueKind operator()(const std::vector<double>*) const { return numbers; }
    ValueKind operator()(const std::vector<Vec3d>*) const { return vectors; }
    ValueKind operator()(const std::vector<std::string>*) const { return texts; }
    ValueKind operator()(const std::vector<MotionRow>*) const { return rows; }
    ValueKind operator()(const std::vector<ClumpSphere>*) const { return spheres; }
  };
  return std::visit(Kind{}, value);
}

class Lister final : public Tour {
 public:
  void operator()(std::string_view key, Slot value, const About& about) override {
    ParameterRow row;
    row.key = key_of(key);
    row.path = path_of(key);
    row.kind = kind_of(value);
    row.unit = about.unit;
    if (about.presence == Presence::required)
      row.fallback = "required";
    else
      row.fallback = about.fallback.empty() ? std::visit(ToText{}, value) : std::string(about.fallback);
    row.allowed = about.range.text();
    for (const Choice& choice : about.choices) row.allowed += (row.allowed.empty() ? "" : ", ") + choice.name;
    if (!about.or_else.empty()) row.allowed += fmt::format(" or {}", about.or_else);
    row.meaning = about.meaning;
    row.family = about.family;
    row.choices = about.choices;
    if (!about.formerly.empty())
      row.formerly = row.key.substr(0, row.key.rfind('.') + 1) + std::string(about.formerly);
    if (others_.at(row.key) == about.range) row.range = about.range;
    row.or_else = about.or_else;
    row.fixed_default = about.presence == Presence::defaulted && about.fallback.empty();
    row.required = required_.contains(row.key);
    rows_.push_back(std::move(row));
  }
  bool everything() const override { return true; }
  std::vector<ParameterRow> take() { return std::move(rows_); }

 private:
  std::vector<ParameterRow> rows_;
  const std::set<std::string> required_ = keys_required(true);
  const std::map<std::string, Interval> others_ = other_ranges();
};

}  // namespace

std::string resolved_toml(const Config& config) {
  Config copy = config;  // describe() takes a Config that it may change
  Writer writer;
  describe(writer, copy);
  return writer.text();
}

std::vector<ParameterRow> parameter_table() {
  Config config;
  config.fluid.present = config.grain.present = true;
  Lister lister;
  describe(lister, config);
  return lister.take();
}

std::vector<std::string> required_keys() {
  const std::set<std::string> required = keys_required(false);
  std::vector<std::string> keys;
  for (const ParameterRow& row : parameter_table())
    if (row.path == row.key && required.contains(row.key)) keys.push_back(row.key);
  return keys;
}

}  // namespace bedload
