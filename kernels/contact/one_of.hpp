#pragma once
// A law chosen at run time from a list of types.

#include <cstdint>
#include <type_traits>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// One of several laws; holds the parameters of each.
template <class... Laws>
struct OneOf : Laws... {
  std::uint32_t place = 0;  ///< index of the active law in the list

  template <class Law>
  static constexpr std::uint32_t place_of() {
    std::uint32_t place = 0;
    (void)((std::is_same_v<Law, Laws> || (++place, false)) || ...);
    return place;
  }
  template <class Law>
  BL_HD bool is() const {
    return place == place_of<Law>();
  }
  /// Makes this law the active one.
  template <class Law>
  void take(const Law& law) {
    static_cast<Law&>(*this) = law;
    place = place_of<Law>();
  }
};

namespace detail {
template <class First, class... Rest, class Any, class F>
BL_HD auto with_acting(const Any& any, F& f) {
  if constexpr (sizeof...(Rest) == 0)
    return f(static_cast<const First&>(any));
  else
    return any.template is<First>() ? f(static_cast<const First&>(any)) : with_acting<Rest...>(any, f);
}
}  // namespace detail

/// f(law), with the active one of several.
template <class Law, class F>
BL_HD auto with_law(const Law& law, F&& f) {
  return f(law);
}
template <class... Laws, class F>
BL_HD auto with_law(const OneOf<Laws...>& any, F&& f) {
  return detail::with_acting<Laws...>(any, f);
}

/// Whether the active law of `any` is a Law.
template <class Law, class Any>
bool acts_as(const Any& any) {
  if constexpr (std::is_same_v<Law, Any>)
    return true;
  else
    return any.template is<Law>();
}

}  // namespace BL_SOLVER
