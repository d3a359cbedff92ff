#include "bedload/case/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "bedload/core/error.hpp"
#include "shortened.hpp"

namespace bedload {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + "\"";
}

/// Edits (insert, delete, replace, swap of neighbours) that turn a into b, over the longer length.
double difference(std::string_view a, std::string_view b) {
  if (a.empty() && b.empty()) return 0;
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = int(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return double(d[a.size()][b.size()]) / double(std::max(a.size(), b.size()));
}

std::pair<std::string_view, std::string_view> split(std::string_view key) {
  const auto dot = key.rfind('.');
  if (dot == key.npos) return {"", key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

bool is_place(std::string_view part) {
  return !part.empty() && part.find_first_not_of("0123456789") == part.npos;
}

/// What a key may be called by who does not know it.
std::vector<std::string_view> names_of(std::string_view name) {
  struct Synonym {
    std::string_view word, key;
  };
  static constexpr Synonym synonyms[]{
      {"diameter", "d"},    {"friction", "mu"},    {"rolling_friction", "mu_r"},
      {"viscosity", "mu"},  {"density", "rho"},    {"density", "rho0"},
      {"restitution", "e"}, {"young", "E"},        {"youngs_modulus", "E"},
      {"poisson", "nu"},    {"nu", "mu"},          {"rpm", "rate"},
      {"spacing", "dx"},    {"dp", "dx"},          {"vicosity", "mu"},
      {"c0", "c_factor"},   {"sound", "c_factor"}, {"coefsound", "c_factor"}};
  std::vector<std::string_view> names{name};
  for (const Synonym& s : synonyms)
    if (s.word == name) names.push_back(s.key);
  return names;
}

template <class F>
void for_parts(std::string_view path, F f) {
  while (!path.empty()) {
    const auto dot = path.find('.');
    f(path.substr(0, dot));
    path = dot == path.npos ? std::string_view() : path.substr(dot + 1);
  }
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto* table = get<Table>();
  if (!table) return nullptr;
  const auto it = table->find(key);
  return it == table->end() ? nullptr : &it->second;
}

std::string Value::place() const { return line ? fmt::format("{}:{}", source, line) : source; }

std::string Value::text() const {
  struct Print {
    std::string operator()(std::monostate) const { return "a date"; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double x) const { return fmt::format("{}", x); }
    std::string operator()(const std::string& s) const { return quoted(s); }
    std::string operator()(const Array& a) const {
      std::string out;
      for (const Value& v : a) out += (out.empty() ? "" : ", ") + v.text();
      return "[" + out + "]";
    }
    std::string operator()(const Table&) const { return "{...}"; }
  };
  return std::visit(Print{}, data);
}

std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  const auto whole = [&](std::size_t at) {  // no cut through a character
    while (at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
    return at;
  };
  const std::size_t head = whole(most / 2), tail = whole(text.size() - most / 4);
  return text.substr(0, head) + fmt::format(" ... ({} characters) ... ", text.size()) + text.substr(tail);
}

const Value& nearest_value(const Value& root, std::string_view path) {
  const Value* at = &root;
  for_parts(path, [&, lost = false](std::string_view part) mutable {
    const Value* next = at->find(part);
    if (const auto* array = at->get<Value::Array>(); array && is_place(part)) {
      std::size_t i = 0;
      std::from_chars(part.data(), part.data() + part.size(), i);
      if (i < array->size()) next = &(*array)[i];
    }
    lost = lost || !next;
    if (!lost) at = next;
  });
  return *at;
}

void reject(const Value& root, std::string_view path, const std::string& value, const std::string& rest) {
  throw CaseError(
      fmt::format("{}: {} = {} {}", nearest_value(root, path).place(), key_of(path), shortened(value), rest));
}

std::string key_of(std::string_view path) {
  std::string key;
  for_parts(path, [&](std::string_view part) {
    if (is_place(part)) return;
    if (!key.empty()) key += '.';
    key += part;
  });
  return key;
}

std::string nearest_key(const std::string& key, const std::vector<std::string>& known) {
  // A wrong name counts more than a wrong table: contact.e is rather grain.e than contact.k.
  constexpr double table_weight = 0.6;
  const auto [table, name] = split(key);
  std::string best;
  double least = 1e9;
  for (const std::string& k : known) {
    const auto [t, n] = split(k);
    for (const std::string_view called : names_of(name)) {
      const double d = difference(called, n) + table_weight * difference(table, t);
      if (d < least) least = d, best = k;
    }
  }
  return best;
}

}  // namespace bedload
