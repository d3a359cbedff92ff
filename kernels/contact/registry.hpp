#pragma once
// Contact laws that a case may name, and compositions of them. A new law needs an include and an entry in a
// list.

#include <algorithm>
#include <vector>

#include "kernels/contact/constant_rolling.hpp"
#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/elastic_plastic_rolling.hpp"
#include "kernels/contact/hertz.hpp"
#include "kernels/contact/linear_sliding.hpp"
#include "kernels/contact/linear_spring.hpp"
#include "kernels/contact/mindlin.hpp"
#include "kernels/contact/mindlin_deresiewicz.hpp"

namespace BL_SOLVER {

template <class... Laws>
struct LawList {
  using Any = OneOf<Laws...>;
  template <class Name>
  static constexpr bool holds(Name name) {
    return (Laws::is(name) || ...);
  }
  /// f(std::type_identity<Law>) with each.
  template <class F>
  static void each(F&& f) {
    (f(std::type_identity<Laws>{}), ...);
  }
  /// The same with the law of that name, if there is one.
  template <class Name, class F>
  static void with(Name name, F&& f) {
    (void)((Laws::is(name) && (f(std::type_identity<Laws>{}), true)) || ...);
  }
  /// The law of that name between two materials; the first one, without parameters, where a name has none.
  template <class Name>
  static Any of(Name name, const ContactMaterials& between) {
    Any any;
    (void)((Laws::is(name) && (any.take(Laws::of(between)), true)) || ...);
    return any;
  }
};

using NormalLaws = LawList<Hertz, LinearSpring>;
using SlidingLaws = LawList<Mindlin, MindlinDeresiewicz, LinearSliding, NoSliding>;
using RollingLaws = LawList<ElasticPlasticRolling, ConstantRolling, NoRolling>;

static_assert(std::all_of(kNames<NormalLaw>.begin(), kNames<NormalLaw>.end(),
                          [](const auto& row) {
                            return NormalLaws::holds(row.value) || row.value == NormalLaw::none;
                          }),
              "a normal law that a case may name is missing in NormalLaws");
static_assert(std::all_of(kNames<SlidingLaw>.begin(), kNames<SlidingLaw>.end(),
                          [](const auto& row) { return SlidingLaws::holds(row.value); }),
              "a tangential law that a case may name is missing in SlidingLaws");
static_assert(std::all_of(kNames<RollingLaw>.begin(), kNames<RollingLaw>.end(),
                          [](const auto& row) { return RollingLaws::holds(row.value); }),
              "a rolling law that a case may name is missing in RollingLaws");

/// Any laws that a case may name; the active ones are chosen pair by pair.
using ContactLaw = ContactLawOf<NormalLaws::Any, SlidingLaws::Any, RollingLaws::Any>;

/// Compositions for which the substep passes are compiled separately; all others run with ContactLaw and give
/// the same results.
template <class... Laws>
struct LawCompositions {
  template <class F>
  static void with(const std::vector<ContactLaw>& laws, F& f) {
    const auto is = [&](const auto& composed) {
      using Law = typename std::decay_t<decltype(composed)>::type;
      return std::all_of(laws.begin(), laws.end(), [](const ContactLaw& law) { return Law::is(law); });
    };
    (void)((is(std::type_identity<Laws>{}) && (f(std::type_identity<Laws>{}), true)) || ...);
  }
};
using ContactLaws = LawCompositions<ContactLawOf<Hertz, Mindlin, NoRolling>,              //
                                    ContactLawOf<Hertz, Mindlin, ElasticPlasticRolling>,  //
                                    ContactLawOf<Hertz, Mindlin, ConstantRolling>,        //
                                    ContactLawOf<Hertz, MindlinDeresiewicz, ConstantRolling>, ContactLaw>;

/// f(std::type_identity<Law>) with the first composition that all of `laws` have; chosen on the host.
template <class F>
void with_contact_law(const std::vector<ContactLaw>& laws, F&& f) {
  ContactLaws::with(laws, f);
}
/// The law of type Law that is equal to a general one.
template <class Law>
BL_HD decltype(auto) composed(const ContactLaw& law) {
  if constexpr (std::is_same_v<Law, ContactLaw>)
    return (law);
  else
    return Law::of(law);
}

/// The laws between two materials. Throws CaseError if the restitution cannot be reached.
inline ContactLaw make_contact_law(const ContactMaterials& m) {
  const ContactConfig& c = m.contact;
  return {.normal = NormalLaws::of(NormalLaw(c.normal), m),
          .sliding = SlidingLaws::of(SlidingLaw(c.tangential), m),
          .rolling = RollingLaws::of(m.mu_r == 0 ? RollingLaw::none : RollingLaw(c.rolling), m),
          .clip_tension = c.clip_tension,
          .mu = Real(m.mu),
          .sliding_damping = Real(c.tangential_damping)};
}

}  // namespace BL_SOLVER
