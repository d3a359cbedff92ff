// The two visitors that write: a resolved case, and the table of parameters.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

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
  std::string operator()(const std::vector<MotionRow>* rows) const {
    std::string out;
    for (const MotionRow& row : *rows)
      out += fmt::format("{}[{}]", out.empty() ? "" : ", ", fmt::join(row, ", "));
    return "[" + out + "]";
  }
};

bool is_absent(const Slot& value) {
  struct Test {
    bool operator()(const double* x) const { return *x == 0 || std::isinf(*x); }
    bool operator()(const std::int64_t* i) const { return *i == 0; }
    bool operator()(const std::string* s) const { return s->empty(); }
    bool operator()(const std::vector<Vec3d>* list) const { return list->empty(); }
    bool operator()(const std::vector<double>* list) const { return list->empty(); }
    bool operator()(const std::vector<std::string>* list) const { return list->empty(); }
    bool operator()(const std::vector<MotionRow>* rows) const { return rows->empty(); }
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

class Lister final : public Parameters {
 public:
  void operator()(std::string_view key, Slot value, const About& about) override {
    ParameterRow row;
    row.key = prefix_ + std::string(key);
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
    rows_.push_back(std::move(row));
  }
  bool everything() const override { return true; }
  bool table(std::string_view, bool) override { return true; }
  std::vector<ParameterRow> take() { return std::move(rows_); }

 private:
  std::size_t open_list(std::string_view, std::size_t) override { return 1; }
  void open_item(std::string_view key, std::size_t) override {
    outer_.push_back(prefix_);
    prefix_ += std::string(key) + ".";
  }
  void close_item() override {
    prefix_ = outer_.back();
    outer_.pop_back();
  }

  std::string prefix_;
  std::vector<std::string> outer_;
  std::vector<ParameterRow> rows_;
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

}  // namespace bedload
