// A host file that includes kernels: compiled as a separate build, in double, it passes on to the contact
// laws what the host asks of them.

#include "bedload/case/contact_laws.hpp"

#include "describe.hpp"
#include "kernels/contact/registry.hpp"

namespace bedload {
namespace {

using enum Presence;

void contact_pair(Parameters& p, ContactPair& pair, const ContactConfig& contact) {
  p("of", &pair.of,
    {.meaning = "two names of materials of grains (\"grain\": that of grain.*; also those of walls), or of "
                "one and a wall.body",
     .presence = required});
  p("mu", &pair.mu,
    {.meaning = "sliding friction of these two",
     .range = within(0, 5),
     .fallback = "the wall's, else the mean of both",
     .presence = unbounded});
  p("mu_r", &pair.mu_r,
    {.meaning = "their rolling friction",
     .range = within(0, 1),
     .fallback = "the wall's, else the mean of both",
     .presence = unbounded});
  p("e", &pair.e,
    {.meaning = "their restitution",
     .range = within(least_restitution(contact), 1),
     .hint = "give a fraction, not percent?",
     .fallback = "the wall's, else the mean of both",
     .presence = optional});
}

/// The keys of each law that has some.
template <class Laws>
void describe_laws(Parameters& p, ContactConfig& c) {
  Laws::each([&]<class Law>(std::type_identity<Law>) {
    if constexpr (requires { Law::describe(p, c); }) Law::describe(p, c);
  });
}

}  // namespace

void describe_contact(Parameters& p, ContactConfig& c) {
  p("contact.normal", &c.normal, {.meaning = "normal contact law", .family = "laws"});
  p("contact.tangential", &c.tangential, {.meaning = "tangential contact law (friction)", .family = "laws"});
  p("contact.rolling", &c.rolling, {.meaning = "law of rolling resistance", .family = "laws"});
  describe_laws<NormalLaws>(p, c);
  describe_laws<SlidingLaws>(p, c);
  p("contact.tangential_damping", &c.tangential_damping,
    {.meaning = "damping of the tangential spring, as a fraction of c_n sqrt(S_t/S_n); 0: none, so that "
                "sticking spheres rebound sideways whatever e",
     .range = within(0, 1)});
  describe_laws<RollingLaws>(p, c);
  p("contact.clip_tension", &c.clip_tension,
    {.meaning =
         "no attractive force while grains separate; the damping is adjusted so that the restitution is e"});
  p.list("contact.pair", c.pairs, ContactPair{},
         [&](Parameters& q, ContactPair& pair) { contact_pair(q, pair, c); });
}

double least_restitution(const ContactConfig& contact) {
  if (!contact.clip_tension) return 0.01;
  double least = 0.05;
  NormalLaws::with(NormalLaw(contact.normal),
                   [&]<class Law>(std::type_identity<Law>) { least = Law::kLeastRestitution; });
  return least;
}

bool takes_moduli(NormalLaw law) {
  bool takes = false;
  NormalLaws::with(law, [&]<class Law>(std::type_identity<Law>) { takes = Law::kTakesModuli; });
  return takes;
}

Impact impact(const ContactConfig& contact, double m, double R, double E, double v, double e) {
  Impact hit;
  NormalLaws::with(NormalLaw(contact.normal),
                   [&]<class Law>(std::type_identity<Law>) { hit = Law::impact(contact, m, R, E, v, e); });
  return hit;
}

double overlap_under(const ContactConfig& contact, double force, double R, double E) {
  double overlap = 0;
  NormalLaws::with(NormalLaw(contact.normal), [&]<class Law>(std::type_identity<Law>) {
    overlap = Law::overlap_under(contact, force, R, E);
  });
  return overlap;
}

double rolling_limit(const ContactConfig& contact, double stiffness, double mu_r, double R_star,
                     double inertia) {
  double step = std::numeric_limits<double>::infinity();
  RollingLaws::with(RollingLaw(contact.rolling), [&]<class Law>(std::type_identity<Law>) {
    if constexpr (requires { Law::longest_step(stiffness, mu_r, R_star, inertia); })
      step = Law::longest_step(stiffness, mu_r, R_star, inertia);
  });
  return step;
}

}  // namespace bedload
