#pragma once
// Every parameter of a case, declared once: key, unit, range, default, meaning and
// the member of Config that holds it. Reader, writer and `bedload list` all walk
// this one description.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bedload/case/chosen.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/config/motion.hpp"

namespace bedload {

struct Config;

/// Allowed numbers.
struct Interval {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool lo_open = true, hi_open = true;

  bool holds(double x) const { return (lo_open ? x > lo : x >= lo) && (hi_open ? x < hi : x <= hi); }
  /// "within 0..1", "> 0", ">= 0", "> -1 and < 0.5"; empty if everything is allowed.
  std::string text() const;
  bool operator==(const Interval&) const = default;
};
inline Interval above(double lo) { return {.lo = lo}; }
inline Interval at_least(double lo) { return {.lo = lo, .lo_open = false}; }
inline Interval within(double lo, double hi) { return {lo, hi, false, false}; }
inline Interval above_to(double lo, double hi) { return {lo, hi, true, false}; }

/// A named choice: a law, a model, a shape.
struct Choice {
  std::string name, meaning;
};

enum class Presence {
  defaulted,  ///< the Config's own value stands if the key is absent
  required,
  optional,   ///< absent has a meaning, held as 0, infinity or nothing
  unbounded,  ///< absent means no bound, held as infinity
};

/// What is known about a parameter besides its key and place.
struct About {
  std::string_view unit = "-";
  std::string_view meaning;
  Interval range = {};
  std::string_view hint = {};      ///< added to the error after a semicolon
  std::string_view fallback = {};  ///< default in words, where it is not a plain value
  Presence presence = Presence::defaulted;
  std::string_view family = {};  ///< under which `bedload list` shows the choices
  std::vector<Choice> choices = {};
  std::string_view or_else = {};       ///< what else is allowed besides the choices: "the name of a shape"
  std::string_view variables = "xyz";  ///< of formulas, a letter each
  std::string_view formerly = {};  ///< last part of the key in the version before; still read, with a warning
};

using Formulas = std::array<std::string, 3>;
using Faces = std::array<bool, 6>;
using Slot = std::variant<bool*, std::int64_t*, std::uint64_t*, double*, std::string*, Vec3d*, Formulas*,
                          std::array<bool, 3>*, Faces*, std::vector<double>*, std::vector<Vec3d>*,
                          std::vector<std::string>*, std::vector<MotionRow>*, std::vector<ClumpSphere>*>;

/// Names of the six sides, in the order of WallBody::faces.
inline constexpr std::array<std::string_view, 6> kFaces{"x-", "x+", "y-", "y+", "z-", "z+"};

/// Visitor of parameters.
class Parameters {
 public:
  virtual ~Parameters() = default;
  virtual void operator()(std::string_view key, Slot value, const About& about) = 0;

  /// A key that takes one of the names of E, with kNames<E> as its choices.
  template <class E>
  void operator()(std::string_view key, Chosen<E>* value, About about) {
    add_choices<E>(about);
    std::string name = value->name();
    (*this)(key, Slot(&name), about);
    *value = name;
  }
  /// The same, or a name that the case defines: about.or_else states of what.
  template <class E>
  void operator()(std::string_view key, ChosenOrNamed<E>* value, About about) {
    add_choices<E>(about);
    std::string name = value->name();
    (*this)(key, Slot(&name), about);
    *value = name;
  }
  /// A list of tables, [[key]]: `describe` is called for each.
  template <class T, class F>
  void list(std::string_view key, std::vector<T>& items, const T& prototype, F describe) {
    const std::size_t n = open_list(key, items.size());
    items.resize(n, prototype);
    for (std::size_t i = 0; i < n; ++i) {
      open_item(key, i);
      describe(*this, items[i]);
      close_item();
    }
  }
  /// Whether the table `key` is there, which alone has a meaning; the writer and `bedload list` know by
  /// `present` and always.
  virtual bool table(std::string_view key, bool present) = 0;
  /// True if all that could be given is wanted, whatever the other values.
  virtual bool everything() const { return false; }

 protected:
  virtual std::size_t open_list(std::string_view key, std::size_t have) = 0;
  virtual void open_item(std::string_view key, std::size_t i) = 0;
  virtual void close_item() = 0;

 private:
  template <class E>
  static void add_choices(About& about) {
    for (const auto& row : kNames<E>)
      about.choices.push_back(Choice{std::string(row.name), std::string(row.meaning)});
  }
};

/// Walks all parameters of a case, in the order in which they are written.
void describe(Parameters& p, Config& config);

/// What a value is made of.
enum class ValueKind {
  boolean,
  integer,
  number,
  text,
  vector,
  formulas,
  booleans,
  faces,
  numbers,
  vectors,
  texts,
  rows,
  spheres
};

/// A row of `bedload list parameters`.
struct ParameterRow {
  std::string key, unit, fallback, allowed, meaning, family;
  std::vector<Choice> choices;
  std::string formerly = {};  ///< key in the version before, where it was another
  std::string path = {};      ///< the key with [] behind lists: "wall.body[].motion.add[].kind"
  ValueKind kind = ValueKind::text;
  Interval range =
      {};  ///< all numbers where it depends on other keys; `allowed` is that of a case of defaults
  std::string or_else = {};
  bool fixed_default = false;  ///< `fallback` is a value, not words
  bool required = false;       ///< wherever its table is, whatever else that holds
};
/// All of them, in the order in which they are written.
std::vector<ParameterRow> parameter_table();
/// Those that a case must have which has neither fluid nor grains nor any list.
std::vector<std::string> required_keys();

}  // namespace bedload
