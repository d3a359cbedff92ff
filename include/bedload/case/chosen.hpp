#pragma once
// Keys of a case that take one of several names, each an enumerator with its row in kNames: name, meaning,
// and what code asks about it (traits).

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bedload/core/error.hpp"

namespace bedload {

/// A row of kNames. An enumeration with traits has its own, in which they follow.
template <class E>
struct Named {
  E value;
  std::string_view name, meaning;
};

/// A value in a row. It has no default: a row that leaves one out does not compile.
template <class T>
class Stated {
 public:
  constexpr Stated(T value) : value_(value) {}
  constexpr operator T() const { return value_; }

 private:
  T value_;
};
using Trait = Stated<bool>;

/// All that a key of type E may be, in the order of the enumerators.
template <class E>
inline constexpr std::array<Named<E>, 0> kNames{};

/// "hertz, linear, none".
template <class E>
std::string names_of() {
  std::string all;
  for (const auto& row : kNames<E>) all += (all.empty() ? "" : ", ") + std::string(row.name);
  return all;
}

/// "hertz, linear or none": those of which the trait holds.
template <class E>
std::string names_with(Trait Named<E>::*trait) {
  std::string all;
  for (auto row = kNames<E>.rbegin(); row != kNames<E>.rend(); ++row)
    if ((*row).*trait) {
      const bool second = !all.empty() && all.find(' ') == all.npos;
      all = std::string(row->name) + (all.empty() ? "" : second ? " or " : ", ") + all;
    }
  return all;
}

/// One of the names of E. Throws CaseError for any other text.
template <class E>
class Chosen {
 public:
  constexpr Chosen(E value) : value_(value) {}
  template <std::convertible_to<std::string_view> Text>
  Chosen(const Text& name) : value_(value_of(name)) {}

  constexpr operator E() const { return value_; }
  std::string name() const { return std::string((*this)->name); }
  /// Its row: `model->spins`.
  constexpr const Named<E>* operator->() const { return &kNames<E>[std::size_t(value_)]; }
  constexpr bool operator==(const Chosen&) const = default;
  constexpr bool operator==(E value) const { return value_ == value; }

 private:
  static E value_of(std::string_view name) {
    for (const auto& row : kNames<E>)
      if (row.name == name) return row.value;
    throw CaseError("\"" + std::string(name) + "\" must be one of " + names_of<E>());
  }

  E value_;
};

/// One of the names of E, or a name that the case gives itself, as that of a [[shape]].
template <class E>
class ChosenOrNamed {
 public:
  ChosenOrNamed(E value) : choice_(value), name_(Chosen<E>(value).name()) {}
  template <std::convertible_to<std::string_view> Text>
  ChosenOrNamed(const Text& text) : name_(std::string_view(text)) {
    for (const auto& row : kNames<E>)
      if (row.name == name_) choice_ = row.value;
  }

  /// Nothing where the name is the case's own.
  const std::optional<E>& choice() const { return choice_; }
  const std::string& name() const { return name_; }
  /// The enumerator. Throws CaseError for a name of the case's own.
  E value() const { return choice_ ? *choice_ : E(Chosen<E>(name_)); }
  bool operator==(const ChosenOrNamed&) const = default;
  bool operator==(E value) const { return choice_ == value; }

 private:
  std::optional<E> choice_;
  std::string name_;
};

}  // namespace bedload
