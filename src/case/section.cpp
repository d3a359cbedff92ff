#include "bedload/case/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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

/// Edits (insert, delete, replace, swap of neighbours) that turn a into b.
int edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = int(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// Over the longer length.
double difference(std::string_view a, std::string_view b) {
  return a.empty() && b.empty() ? 0 : double(edits(a, b)) / double(std::max(a.size(), b.size()));
}

/// One letter in three may be wrong, and one in two.
bool alike(std::string_view a, std::string_view b) {
  const std::size_t longer = std::max(a.size(), b.size());
  return edits(a, b) <= std::max(int(longer) / 3, longer == 2 ? 1 : 0);
}

/// Letters and digits alone, in lower case: time_end is time.end.
std::string run_together(std::string_view key) {
  std::string out;
  for (const unsigned char c : key)
    if (std::isalnum(c)) out += char(std::tolower(c));
  return out;
}

std::pair<std::string_view, std::string_view> split(std::string_view key) {
  const auto dot = key.rfind('.');
  if (dot == key.npos) return {"", key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

bool is_place(std::string_view part) {
  return !part.empty() && part.find_first_not_of("0123456789") == part.npos;
}

/// A key that may have been meant: the same name in another table, a name alike in the same table or one
/// alike, or a long name with few wrong letters wherever it is.
bool is_near(std::string_view key, std::string_view known) {
  if (run_together(key) == run_together(known)) return true;
  const auto [table, name] = split(key);
  const auto [t, n] = split(known);
  const std::string mine = run_together(name), its = run_together(n);
  if (mine == its) return true;
  if (table == t) return alike(mine, its);
  if (!table.empty() && mine.size() > 2 && alike(table, t)) return alike(mine, its);
  return mine.size() > 5 && difference(mine, its) <= 0.2;
}

/// Whether so many tables have a key of that name that it does not identify the table: min, start, stop.
bool is_common(std::string_view name, const std::vector<std::string>& known) {
  return std::count_if(known.begin(), known.end(),
                       [&](const std::string& k) { return split(k).second == name; }) > 3;
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
  const bool common = is_common(name, known);
  std::string best;
  double least = 1e9;
  for (const std::string& k : known) {
    if (!is_near(key, k)) continue;
    const auto [t, n] = split(k);
    if (common && !t.ends_with(table) && !alike(table, t)) continue;
    const double d = difference(name, n) + table_weight * difference(table, t);
    if (d < least) least = d, best = k;
  }
  return best;
}

}  // namespace bedload
