#include "units.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "bedload/core/error.hpp"
#include "shortened.hpp"

namespace bedload {
namespace {

/// factor 10^ten m^a kg^b s^c rad^d; an angle counts as a dimension, so that no turn is taken for a radian.
struct Unit {
  double factor = 1;
  int ten = 0;
  std::array<int, 4> powers{};  ///< of m, kg, s, rad
};

struct Named {
  std::string_view name;
  bool prefixed;  ///< may follow n, u, m, c, d, k, M, G
  Unit unit;
};

constexpr double kTurn = 2 * std::numbers::pi;
constexpr Named kUnits[]{
    {"m", true, {1, 0, {1}}},
    {"g", true, {1, -3, {0, 1}}},
    {"s", true, {1, 0, {0, 0, 1}}},
    {"l", true, {1, -3, {3}}},
    {"L", true, {1, -3, {3}}},
    {"N", true, {1, 0, {1, 1, -2}}},
    {"Pa", true, {1, 0, {-1, 1, -2}}},
    {"bar", true, {1, 5, {-1, 1, -2}}},
    {"P", true, {1, -1, {-1, 1, -1}}},
    {"J", true, {1, 0, {2, 1, -2}}},
    {"Hz", true, {1, 0, {0, 0, -1}}},
    {"t", false, {1, 3, {0, 1}}},
    {"min", false, {60, 0, {0, 0, 1}}},
    {"h", false, {3600, 0, {0, 0, 1}}},
    {"in", false, {2.54, -2, {1}}},
    {"ft", false, {0.3048, 0, {1}}},
    {"lb", false, {0.45359237, 0, {0, 1}}},
    {"rad", true, {1, 0, {0, 0, 0, 1}}},
    {"deg", false, {kTurn / 360, 0, {0, 0, 0, 1}}},
    {"rev", false, {kTurn, 0, {0, 0, 0, 1}}},
    {"rpm", false, {kTurn / 60, 0, {0, 0, -1, 1}}},
    {"rps", false, {kTurn, 0, {0, 0, -1, 1}}},
};

struct Prefix {
  std::string_view name;
  int ten;
};
constexpr Prefix kPrefixes[]{{"n", -9}, {"u", -6}, {"\u00b5", -6}, {"m", -3}, {"c", -2},
                             {"d", -1}, {"k", 3},  {"M", 6},       {"G", 9}};

std::optional<Unit> named(std::string_view name) {
  for (const Named& n : kUnits)
    if (n.name == name) return n.unit;
  for (const Prefix& p : kPrefixes)
    for (const Named& n : kUnits)
      if (n.prefixed && name.starts_with(p.name) && name.substr(p.name.size()) == n.name) {
        Unit unit = n.unit;
        unit.ten += p.ten;
        return unit;
      }
  return {};
}

bool is_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalpha(byte) || byte >= 0x80;  // of a micro sign
}

/// Reads units such as "kg/m3"; `whole` is what messages quote.
Unit parse(std::string_view text, std::string_view whole) {
  const auto fail = [&] { throw CaseError(fmt::format("\"{}\" is no unit", whole)); };
  Unit out;
  int sign = 1;
  bool first = true;
  while (!text.empty()) {
    const auto skip = [&](std::string_view marks) {
      while (!text.empty() && marks.find(text[0]) != marks.npos) text.remove_prefix(1);
    };
    skip(" *");
    if (!text.empty() && text[0] == '/') {
      sign = -1;
      text.remove_prefix(1);
      skip(" ");
    }
    if (first && text.starts_with("1")) {  // "1/s"
      text.remove_prefix(1);
      first = false;
      continue;
    }
    first = false;
    std::size_t letters = 0;
    while (letters < text.size() && is_letter(text[letters])) ++letters;
    const auto unit = named(text.substr(0, letters));
    if (!unit) fail();
    text.remove_prefix(letters);
    if (!text.empty() && text[0] == '^') text.remove_prefix(1);
    int power = 1;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), power);
    if (read.ptr != text.data() && (read.ec != std::errc() || power == 0 || std::abs(power) > 9)) fail();
    text.remove_prefix(std::size_t(read.ptr - text.data()));
    power *= sign;
    sign = 1;
    out.factor *= std::pow(unit->factor, power);
    out.ten += unit->ten * power;
    for (std::size_t k = 0; k < out.powers.size(); ++k) out.powers[k] += unit->powers[k] * power;
  }
  return out;
}

}  // namespace

bool takes_units(std::string_view unit) { return unit != "-" && unit.find_first_of(",._*") == unit.npos; }

double quantity(std::string_view text, std::string_view unit) {
  const auto trim = [](std::string_view t) {
    while (!t.empty() && t.front() == ' ') t.remove_prefix(1);
    while (!t.empty() && t.back() == ' ') t.remove_suffix(1);
    return t;
  };
  text = trim(text);
  const bool plus = text.starts_with("+");
  if (plus) text.remove_prefix(1);
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || !std::isfinite(number)) throw CaseError("it does not begin with a number");
  const std::string digits(text.data(), read.ptr);
  const std::string_view name = trim(text.substr(digits.size()));
  if (name.empty()) throw CaseError("it has no unit; a bare number stands without quotes");
  const Unit from = parse(name, name), to = parse(unit, unit);
  if (from.powers != to.powers)
    throw CaseError(fmt::format("{} is no unit of that kind", shortened(std::string(name), 60)));
  // The exponent goes into the digits, so that rounding happens once.
  const auto e = digits.find_first_of("eE");
  std::int64_t ten = from.ten - to.ten;
  if (e != digits.npos) {
    const std::size_t sign = digits[e + 1] == '+' ? 1 : 0;
    std::int64_t given = 0;
    std::from_chars(digits.data() + e + 1 + sign, digits.data() + digits.size(), given);
    ten += given;
  }
  const std::string scaled = fmt::format("{}e{}", digits.substr(0, e), ten);
  std::from_chars(scaled.data(), scaled.data() + scaled.size(), number);
  return number * (from.factor / to.factor);
}

}  // namespace bedload
