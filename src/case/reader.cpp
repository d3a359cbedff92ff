#include "reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "bedload/case/formula.hpp"
#include "bedload/case/words.hpp"
#include "bedload/core/error.hpp"
#include "shortened.hpp"
#include "units.hpp"

namespace bedload {
namespace {

/// What is asked of one value; turns it into a member of Config or throws the reason.
class Conversion {
 public:
  Conversion(const Value& value, std::string key, const About& about)
      : value_(value), key_(std::move(key)), about_(about) {}

  void operator()(bool* out) const {
    const auto* number = value_.get<std::int64_t>();
    if (const auto* flag = value_.get<bool>())
      *out = *flag;
    else if (number && (*number == 0 || *number == 1))
      *out = *number == 1;
    else
      reject("must be true or false");
  }
  void operator()(std::int64_t* out) const { *out = whole(); }
  void operator()(std::uint64_t* out) const { *out = std::uint64_t(whole()); }
  void operator()(double* out) const {
    *out = number(
        value_, about_.unit == "-" ? "must be a number" : fmt::format("must be a number in {}", about_.unit));
    if (!about_.range.holds(*out)) reject("must be " + about_.range.text());
  }
  void operator()(std::string* out) const {
    const auto* text = value_.get<std::string>();
    if (!about_.choices.empty()) {
      std::string names;
      for (const Choice& choice : about_.choices) {
        if (text && *text == choice.name) return void(*out = *text);
        names += (names.empty() ? "" : ", ") + choice.name;
      }
      if (about_.or_else.empty()) reject("must be one of " + names);
      if (!text || text->empty()) reject(fmt::format("must be {} or {}", names, about_.or_else));
    }
    if (!text || (text->empty() && about_.presence == Presence::required)) reject("must be a text in quotes");
    const auto controls = [](unsigned char c) { return (c < 0x20 && !std::isspace(c)) || c == 0x7f; };
    if (std::any_of(text->begin(), text->end(), controls)) reject("must hold no control characters");
    *out = *text;
  }
  void operator()(Vec3d* out) const { *out = vector(value_, "must be three numbers [x, y, z]"); }
  void operator()(std::vector<Vec3d>* out) const {
    const char* shape = "must be a list of places [[x, y, z], ...]";
    const auto* list = value_.get<Value::Array>();
    if (!list) reject(shape);
    out->clear();
    for (const Value& item : *list) out->push_back(vector(item, shape));
  }
  void operator()(std::vector<std::string>* out) const {
    const auto* list = value_.get<Value::Array>();
    if (!list || list->empty()) reject("must be a list of names");
    out->clear();
    for (const Value& item : *list) {
      const auto* name = item.get<std::string>();
      if (!name || name->empty()) reject("must be a list of names");
      out->push_back(*name);
    }
  }
  void operator()(std::vector<double>* out) const {
    const char* shape = "must be a list of numbers [a, b, ...]";
    const auto* list = value_.get<Value::Array>();
    if (!list) reject(shape);
    out->clear();
    for (const Value& item : *list) {
      out->push_back(number(item, shape));
      if (!about_.range.holds(out->back())) reject("must hold numbers " + about_.range.text());
    }
  }
  void operator()(std::vector<MotionRow>* out) const {
    const char* shape = "must be a list of rows [[t, x, y, z], ...] or [[t, x, y, z, rx, ry, rz], ...]";
    const auto* list = value_.get<Value::Array>();
    if (!list) reject(shape);
    out->clear();
    for (const Value& item : *list) {
      const auto* row = item.get<Value::Array>();
      if (!row || (row->size() != 4 && row->size() != 7)) reject(shape);
      out->emplace_back();
      for (std::size_t k = 0; k < row->size(); ++k) out->back()[k] = number((*row)[k], shape);
    }
  }
  void operator()(std::vector<ClumpSphere>* out) const {
    const char* shape = "must be a list of spheres [[x, y, z, r], ...], r > 0";
    const auto* list = value_.get<Value::Array>();
    if (!list) reject(shape);
    out->clear();
    for (const Value& item : *list) {
      const auto* row = item.get<Value::Array>();
      if (!row || row->size() != 4) reject(shape);
      out->emplace_back();
      for (std::size_t k = 0; k < 4; ++k) out->back()[k] = number((*row)[k], shape);
    }
  }
  void operator()(Formulas* out) const {
    for (int k = 0; k < 3; ++k)
      (*out)[k] = formula(triple("must be three numbers or formulas in " + variables())[k]);
  }
  void operator()(std::array<bool, 3>* out) const {
    const char* shape = "must be three of true or false";
    for (int k = 0; k < 3; ++k) {
      const auto* flag = triple(shape)[k].get<bool>();
      if (!flag) reject(shape);
      (*out)[k] = *flag;
    }
  }
  void operator()(Faces* out) const {
    const char* shape = "must be a list of some of \"x-\", \"x+\", \"y-\", \"y+\", \"z-\", \"z+\"";
    const auto* list = value_.get<Value::Array>();
    if (!list || list->empty()) reject(shape);
    out->fill(false);
    for (const Value& item : *list) {
      const auto* name = item.get<std::string>();
      const auto face = name ? std::find(kFaces.begin(), kFaces.end(), *name) : kFaces.end();
      if (face == kFaces.end()) reject(shape);
      (*out)[face - kFaces.begin()] = true;
    }
  }

 private:
  [[noreturn]] void reject(const std::string& must) const {
    const std::string hint = about_.hint.empty() ? "" : fmt::format("; {}", about_.hint);
    throw CaseError(
        fmt::format("{}: {} = {} {}{}", value_.place(), key_, shortened(value_.text()), must, hint));
  }
  std::int64_t whole() const {
    const auto* number = value_.get<std::int64_t>();
    if (!number) reject("must be a whole number");
    if (!about_.range.holds(double(*number))) reject("must be " + about_.range.text());
    return *number;
  }
  double number(const Value& v, const std::string& must) const {
    if (const auto* i = v.get<std::int64_t>()) return double(*i);
    const auto* text = v.get<std::string>();
    const bool with_unit = text && takes_units(about_.unit);
    const auto* given = v.get<double>();
    if (!given && !with_unit) reject(must);
    const double x = given ? *given : in_own_unit(*text, must);
    if (!std::isfinite(x)) reject("must be finite");
    if (std::abs(x) > 1e30) reject("must be below 1e30 in size");
    return x;
  }
  double in_own_unit(const std::string& text, const std::string& must) const {
    try {
      return quantity(text, about_.unit);
    } catch (const CaseError& error) {
      reject(fmt::format("{}, or in quotes with another unit; {}", must, error.what()));
    }
  }
  std::string variables() const { return fmt::format("{}", fmt::join(about_.variables, ", ")); }
  const Value::Array& triple(const std::string& shape) const {
    const auto* list = value_.get<Value::Array>();
    if (!list || list->size() != 3) reject(shape);
    return *list;
  }
  Vec3d vector(const Value& v, const char* shape) const {
    const auto* list = v.get<Value::Array>();
    if (!list || list->size() != 3) reject(shape);
    return {number((*list)[0], shape), number((*list)[1], shape), number((*list)[2], shape)};
  }
  std::string formula(const Value& v) const {
    const auto* text = v.get<std::string>();
    if (!text) return fmt::format("{}", number(v, "must be three numbers or formulas in " + variables()));
    try {
      (void)Formula(*text, about_.variables);
    } catch (const CaseError& error) {
      reject(fmt::format("must hold formulas in {}: {}", variables(), error.what()));
    }
    return *text;
  }

  const Value& value_;
  std::string key_;
  const About& about_;
};

/// Calls f(value, key) for every value below `at` that is no table.
template <class F>
void for_leaves(const Value& at, const std::string& key, const F& f) {
  const auto* table = at.get<Value::Table>();
  const auto* list = at.get<Value::Array>();
  if (table && (!table->empty() || key.empty())) {
    for (const auto& [name, value] : *table) for_leaves(value, key.empty() ? name : key + "." + name, f);
  } else if (list && !list->empty() && list->front().get<Value::Table>()) {
    for (const Value& item : *list) for_leaves(item, key, f);
  } else {
    f(at, key);
  }
}

/// What to write instead of an unknown key, as the end of a sentence.
std::string instead_of(const std::string& key, const std::vector<std::string>& known) {
  if (const std::string meaning = meaning_of(key); !meaning.empty()) return meaning;
  if (const std::string near = nearest_key(key, known); !near.empty())
    return fmt::format("did you mean {}?", near);
  for (std::string table = key; table.find('.') != table.npos;) {
    table.resize(table.rfind('.'));
    if (std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.starts_with(table + "."); }))
      return fmt::format("`bedload list {}` shows what there is", table);
  }
  return "`bedload list parameters` shows all there are";
}

}  // namespace

void Reader::operator()(std::string_view key, Slot value, const About& about) {
  const Scope& scope = scopes_.back();
  const std::string full = scope.prefix + std::string(key);
  const Value* found = find(key);
  if (!found) {
    if (about.presence != Presence::required) return;
    const std::string unit = about.unit == "-" ? "" : fmt::format(", {}", about.unit);
    throw CaseError(fmt::format("{}: {} must be given ({}{})", nearest_value(*scope.table, key).place(), full,
                                about.meaning, unit));
  }
  read_.insert(found);
  std::visit(Conversion(*found, full, about), value);
}

const Value* Reader::find(std::string_view key) const {
  const Value* at = scopes_.back().table;
  std::string table = scopes_.back().prefix;
  for (;;) {
    const auto dot = key.find('.');
    at = at->find(key.substr(0, dot));
    if (!at || dot == key.npos) return at;
    table += key.substr(0, dot);
    if (!at->get<Value::Table>())
      throw CaseError(fmt::format("{}: {} must be a single table; write [{}]", at->place(), table, table));
    table += '.';
    key.remove_prefix(dot + 1);
  }
}

std::size_t Reader::open_list(std::string_view key, std::size_t) {
  const Value* found = find(key);
  if (!found) return 0;
  const auto* list = found->get<Value::Array>();
  const auto is_table = [](const Value& item) { return item.get<Value::Table>() != nullptr; };
  if (!list || !std::all_of(list->begin(), list->end(), is_table)) {
    const std::string full = scopes_.back().prefix + std::string(key);
    throw CaseError(fmt::format("{}: {} must be a list of tables; write [[{}]]", found->place(), full, full));
  }
  read_.insert(found);
  return list->size();
}

void Reader::open_item(std::string_view key, std::size_t i) {
  scopes_.push_back({&(*find(key)->get<Value::Array>())[i], scopes_.back().prefix + std::string(key) + "."});
}

void Reader::reject_unread(const std::string& options) const {
  for_leaves(*scopes_.front().table, "", [&](const Value& value, const std::string& key) {
    if (read_.count(&value) || value.get<Value::Table>()) return;
    throw CaseError(fmt::format("{}: {} = {} is not used {}; remove it", value.place(), key,
                                shortened(value.text()), options));
  });
}

namespace {

/// A second [[fluid]] or [fluid.2], as of programs in which each fluid has a table.
void reject_fluids(const Value& root) {
  const Value* const fluid = root.find("fluid");
  if (!fluid) return;
  const auto reject = [](const Value& value, std::string_view what) {
    throw CaseError(fmt::format("{}: {} must be one table, [fluid]; {}", value.place(), what,
                                meaning_of("fluid.fill.rho0")));
  };
  if (const auto* list = fluid->get<Value::Array>();
      list && !list->empty() && list->front().get<Value::Table>())
    reject(list->front(), "[[fluid]]");
  if (const auto* table = fluid->get<Value::Table>())
    for (const auto& [name, member] : *table)
      if (member.get<Value::Table>() && name.find_first_not_of("0123456789") == name.npos)
        reject(member, fmt::format("[fluid.{}]", name));
}

}  // namespace

void reject_unknown(const Value& root) {
  reject_fluids(root);
  std::vector<std::string> known;
  for (const ParameterRow& row : parameter_table()) known.push_back(row.key);
  const auto is_table = [&](const std::string& key) {
    return std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.starts_with(key + "."); });
  };
  const Value* first = nullptr;
  std::string key;
  for_leaves(root, "", [&](const Value& value, const std::string& k) {
    if (value.get<Value::Table>() ? is_table(k) : std::count(known.begin(), known.end(), k) > 0) return;
    if (!first || value.line < first->line) first = &value, key = k;
  });
  if (!first) return;
  if (is_table(key)) {
    const bool list = first->get<Value::Array>() != nullptr;
    if (list && first->get<Value::Array>()->empty()) return;
    throw CaseError(fmt::format("{}: {} = {} must be a table; write [{}]", first->place(), shortened(key),
                                shortened(first->text()), shortened(key)));
  }
  // A key below a parameter ("fluid.dx.a") is that parameter's wrong value, which its reader reports.
  for (const std::string& k : known)
    if (key.starts_with(k + ".")) return;
  throw CaseError(
      fmt::format("{}: {} is not a parameter; {}", first->place(), shortened(key), instead_of(key, known)));
}

}  // namespace bedload
