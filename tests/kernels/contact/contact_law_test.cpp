#include "kernels/contact/registry.hpp"

#include <gtest/gtest.h>

#include <random>

#include "bedload/core/error.hpp"
#include "tests/support/contact_law.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr Real kRadius = Real(1.35e-3);
const Sphere kGrain{kRadius, Real(2500 * 4.0 / 3.0 * 3.14159265358979 * 1.35e-3 * 1.35e-3 * 1.35e-3)};

Config glass() {
  Config c;
  c.grain.d = 2 * kRadius;
  return c;
}

TEST(ContactLaw, HertzForceAndStiffnessByHand) {
  const ContactLaw law = contact_law_of(glass());
  const double overlap = 1e-6, R = 0.5 * kRadius, E = 1e8 / (2 * 0.91);
  const NormalState s = law.normal_state(Real(R), kGrain.m / 2, Real(overlap));
  const double force = 4.0 / 3 * E * std::sqrt(R) * std::pow(overlap, 1.5);
  EXPECT_NEAR(s.elastic / force, 1, tolerance(1e-12, 1e-6, 1e-6));
  EXPECT_NEAR(s.stiffness / (2 * E * std::sqrt(R * overlap)), 1, tolerance(1e-12, 1e-6, 1e-6));
}

template <class Law>
bool composed_as(const std::vector<ContactLaw>& laws) {
  bool found = false;
  with_contact_law(laws,
                   [&]<class Chosen>(std::type_identity<Chosen>) { found = std::is_same_v<Chosen, Law>; });
  return found;
}

TEST(ContactLaw, IsComposedOfWhatActs) {
  Config c = glass();
  c.contact.rolling = "cdt", c.grain.mu_r = 0.1;
  const ContactLaw rolls = contact_law_of(c);
  EXPECT_TRUE((composed_as<ContactLawOf<Hertz, Mindlin, ConstantRolling>>({rolls, rolls})));
  c.grain.mu_r = 0, c.contact.normal = "democritus", c.contact.tangential = "democritus";
  const ContactLaw slides = contact_law_of(c);
  EXPECT_TRUE((composed_as<ContactLawOf<Hertz, Mindlin, NoRolling>>({slides})));
  EXPECT_TRUE((composed_as<ContactLaw>({rolls, slides}))) << "no composition is both";
  c.contact.normal = "linear", c.contact.tangential = "linear", c.contact.k = 1e4;
  EXPECT_TRUE((composed_as<ContactLaw>({contact_law_of(c)})));
}

TEST(ContactLaw, PaperDampingIsRootSixTimesTheRatio) {
  Config c = glass();
  c.contact.clip_tension = false;
  const Real exact = contact_law_of(c).normal.alpha;
  c.contact.he_damping = true;
  EXPECT_NEAR(contact_law_of(c).normal.alpha / exact, std::sqrt(6.0 / 5.0), 1e-6);
}

TEST(ContactLaw, RefusesALinearSpringThatCannotDampEnough) {
  Config c = glass();
  c.contact.normal = "linear";
  c.contact.k = 1000;
  c.grain.e = 0.1;
  EXPECT_THROW(contact_law_of(c), CaseError);
  c.contact.clip_tension = false;
  EXPECT_NO_THROW(contact_law_of(c));
  c.contact.k = 0;
  EXPECT_THROW(contact_law_of(c), CaseError);
}

TEST(ContactLaw, ClippedForceNeverPulls) {
  const ContactLaw law = contact_law_of(glass());
  ContactHistory h;
  const ContactGeometry at =
      sphere_contact(kGrain, kGrain, {2 * kRadius - 1e-7, 0, 0}, 2 * kRadius - 1e-7, 1e-7);
  EXPECT_EQ(law(at, {10, 0, 0}, {}, {}, 0, h).force.x, 0);
  EXPECT_GT(law(at, {-10, 0, 0}, {}, {}, 0, h).force.x, 0);
}

/// A pair loaded along n and sheared by xi (m) in a tangential direction.
TEST(ContactLaw, MindlinDeresiewiczStartsAtMindlinStiffnessAndEndsAtCoulomb) {
  Config c = glass();
  c.contact.rolling = "none";
  c.contact.tangential = "mindlin_deresiewicz";
  const ContactLaw md = contact_law_of(c);
  const double overlap = 1e-6, gap = 2 * double(kRadius) - overlap;
  const ContactGeometry at = sphere_contact(kGrain, kGrain, {gap, 0, 0}, gap, overlap);
  c.contact.tangential = "mindlin";
  const double stiffness = 8 * double(contact_law_of(c).sliding.G_star) * std::sqrt(0.5 * kRadius * overlap);

  const double longest = md.sliding.slipping(overlap), small = longest * 1e-7;
  ContactHistory h{{0, small, 0}, {}, overlap};
  const ContactForce start = md(at, {}, {}, {}, 0, h);
  EXPECT_NEAR(-start.force.y / (stiffness * small), 1, tolerance(1e-6, 1e-5, 1e-4));

  h = {{0, 3 * longest, 0}, {}, overlap};
  const ContactForce limit = md(at, {}, {}, {}, 0, h);
  EXPECT_NEAR(-limit.force.y / (0.3 * limit.force.x), 1, tolerance(1e-6, 1e-5, 1e-4));
  EXPECT_NEAR(h.xi.y / longest, 1, 1e-6) << "stretch is kept at the limit";

  h = {};
  EXPECT_EQ(norm(md(at, {}, {}, {}, 0, h).force - Real3{limit.force.x, 0, 0}), 0) << "no stretch, no force";
}

TEST(ContactLaw, SlidingIsLimitedAndTheSpringFollows) {
  Config c = glass();
  c.contact.rolling = "none";
  for (const char* name : {"mindlin", "linear"}) {
    c.contact.tangential = name;
    const ContactLaw law = contact_law_of(c);
    const double overlap = 1e-6, gap = 2 * double(kRadius) - overlap;
    const ContactGeometry at = sphere_contact(kGrain, kGrain, {0, 0, gap}, gap, overlap);
    ContactHistory h{{1e-3, 0, 0}, {}, overlap};
    const ContactForce slip = law(at, {}, {}, {}, 0, h);
    EXPECT_NEAR(-slip.force.x / (0.3 * slip.force.z), 1, tolerance(1e-12, 1e-6, 1e-6)) << name;
    const ContactForce again = law(at, {}, {}, {}, 0, h);
    EXPECT_NEAR(again.force.x / slip.force.x, 1, tolerance(1e-12, 1e-6, 1e-6))
        << name << ": spring was not cut back";
  }
}

/// Friction cuts the spring back to its own limit, whatever the dashpot does: what slid and stops is held by
/// it.
TEST(ContactLaw, FrictionLeavesTheSpringItsLimit) {
  Config c = glass();
  c.contact.rolling = "none";
  for (const char* name : {"mindlin", "linear"}) {
    c.contact.tangential = name;
    const ContactLaw law = contact_law_of(c);
    const double overlap = 1e-6, gap = 2 * double(kRadius) - overlap;
    const ContactGeometry at = sphere_contact(kGrain, kGrain, {0, 0, gap}, gap, overlap);
    const auto sliding = [&](Real v, ContactHistory& h) { return law(at, {v, 0, 0}, {}, {}, 0, h).force.x; };
    ContactHistory still{{1e-9, 0, 0}, {}, overlap}, moves = still, slips{{1e-3, 0, 0}, {}, overlap};
    const Real slow = Real(1e-4);
    const double damping = (sliding(0, still) - sliding(slow, moves)) / slow;
    const double limit = -sliding(slow, slips);
    ASSERT_GT(damping * slow, 1e-3 * limit);
    EXPECT_NEAR(-sliding(0, slips) / limit, 1, tolerance(1e-12, 1e-5, 1e-5)) << name;
  }
}

/// [ai11] type C: k_r = 2.25 k_n (mu_r R*)^2, damped by eta of twice its critical damping, and their energy.
TEST(ContactLaw, ElasticPlasticCoupleByHand) {
  const double mu_r = 0.1, eta = 0.3, k_n = 1e4, R = 5e-4, dt = 1e-6, inverse = 2e11;
  const ElasticPlasticRolling law{Real(mu_r), Real(eta)};
  const RollingInput in{.omega = {Real(0.5), 0, 0},
                        .normal_force = Real(1),
                        .normal_stiffness = Real(k_n),
                        .stiffness_before = Real(k_n),
                        .R_star = Real(R),
                        .inverse_spin = Real(inverse),
                        .inverse_rolling = Real(inverse),
                        .dt = Real(dt)};
  const double k_r = 2.25 * k_n * mu_r * mu_r * R * R;
  Vec3d couple;
  const Real3 total = law(in, couple);
  EXPECT_NEAR(couple.x / (-k_r * dt * 0.5), 1, 1e-6);
  EXPECT_NEAR(total.x / (couple.x - 2 * eta * std::sqrt(k_r / inverse) * 0.5), 1, 1e-6);
  EXPECT_LT(norm(total), mu_r * R);
  EXPECT_NEAR(law.stored(Real(k_n), Real(R), couple) / (0.5 * k_r * square(dt * 0.5)), 1, 1e-6);
}

TEST(ContactLaw, ElasticPlasticCoupleIsNeverMoreThanItsLimit) {
  const double mu_r = 0.1, R = 5e-4, force = 2, limit = mu_r * R * force, dt = 1e-6;
  const ElasticPlasticRolling law{Real(mu_r), 1};
  RollingInput in{.omega = {0, Real(1e5), 0},
                  .normal_force = Real(force),
                  .normal_stiffness = Real(1e4),
                  .stiffness_before = Real(1e4),
                  .R_star = Real(R),
                  .inverse_spin = Real(2e11),
                  .inverse_rolling = Real(2e11),
                  .dt = Real(dt)};
  Vec3d couple{0, -0.99 * limit, 0};
  EXPECT_NEAR(law(in, couple).y / -limit, 1, 1e-6) << "it slips";
  EXPECT_NEAR(couple.y / -limit, 1, 1e-6) << "its spring keeps the limit";
  in.dt = 0;
  couple = {0, -0.5 * limit, 0};
  EXPECT_NEAR(law(in, couple).y / -limit, 1, 1e-6) << "its damper bears no more than the limit";
  EXPECT_NEAR(couple.y / (-0.5 * limit), 1, 1e-12);
}

/// A spring that softens keeps its angle, one that stiffens its couple.
TEST(ContactLaw, ElasticPlasticSpringGainsNoEnergyFromItsStiffness) {
  const ElasticPlasticRolling law{Real(0.1), 0};
  for (const double before : {4e4, 2.5e3}) {
    const RollingInput in{.omega = {},
                          .normal_force = Real(1),
                          .normal_stiffness = Real(1e4),
                          .stiffness_before = Real(before),
                          .R_star = Real(5e-4),
                          .inverse_spin = Real(2e11),
                          .inverse_rolling = Real(2e11),
                          .dt = 0};
    Vec3d couple{1e-6, 0, 0};
    law(in, couple);
    EXPECT_NEAR(couple.x / 1e-6, before > 1e4 ? 0.25 : 1, 1e-6) << before;
  }
}

/// S_t = 8 G* (R* overlap)^1/2 [mindlin53]; damping of the normal spring times (S_t / S_n)^1/2.
TEST(ContactLaw, MindlinSpringByHand) {
  const double G = 3e7, R = 1e-3, overlap = 1e-6, S_t = 8 * G * std::sqrt(R * overlap), S_n = 2e4, c_n = 0.3;
  const Mindlin law{Real(G)};
  const NormalState n{Real(0.01), Real(S_n), Real(c_n)};
  const SlidingInput in{.normal_force = Real(0.01),
                        .normal = n,
                        .before = n,
                        .root = Real(std::sqrt(R * overlap)),
                        .m_star = Real(1e-6),
                        .overlap = Real(overlap),
                        .overlap_before = Real(overlap)};
  const SlidingState s = law(in, {2e-7, 0, 0});
  EXPECT_NEAR(s.elastic.x / (-S_t * 2e-7), 1, 1e-5);
  EXPECT_NEAR(s.damping / (c_n * std::sqrt(S_t / S_n)), 1, 1e-5);
  EXPECT_NEAR(law.longest(in, Real(0.5)) / (0.5 / S_t), 1, 1e-5);
  EXPECT_NEAR(law.stored(in, {2e-7, 0, 0}) / (0.5 * S_t * 4e-14), 1, 1e-5);
}

/// Damped by beta of twice the critical damping of its tangent stiffness, 3/2 mu F_n (1 - s)^1/2 / most.
TEST(ContactLaw, MindlinDeresiewiczIsDampedByItsTangentStiffness) {
  const double mu = 0.4, slip = 0.3, beta = 0.2, overlap = 1e-6, force = 0.05, m = 2e-6,
               most = slip * overlap;
  const MindlinDeresiewicz law{Real(mu), Real(slip), Real(beta)};
  const NormalState n{Real(force), Real(1e4), 0};
  const SlidingInput in{.normal_force = Real(force),
                        .normal = n,
                        .before = n,
                        .root = 0,
                        .m_star = Real(m),
                        .overlap = Real(overlap),
                        .overlap_before = Real(overlap)};
  for (const double s : {0.1, 0.75}) {
    const SlidingState state = law(in, {Real(s * most), 0, 0});
    EXPECT_NEAR(state.elastic.x / (-mu * force * (1 - std::pow(1 - s, 1.5))), 1, 1e-4) << s;
    const double stiffness = 1.5 * mu * force * std::sqrt(1 - s) / most;
    EXPECT_NEAR(state.damping / (2 * beta * std::sqrt(m * stiffness)), 1, 1e-4) << s;
  }
}

/// A contact begins and ends within a substep: the dashpot of a linear spring acts while they touch, counted
/// from the middle of one substep to that of the next.
TEST(ContactLaw, DashpotActsWhileTheyTouch) {
  const Real v = Real(0.5), dt = Real(0.01), way = v * dt;
  EXPECT_EQ(dashpot_fraction(1e-3, Real(1e-3), -v, dt, false), 1);
  EXPECT_NEAR(dashpot_fraction(0, Real(0.25) * way, -v, dt, false), 0.75, 1e-6);
  EXPECT_NEAR(dashpot_fraction(0, way, -v, dt, false), 1.5, 1e-6);
  EXPECT_EQ(dashpot_fraction(1e-3, Real(0.25) * way, v, dt, false), 1) << "it never pulls";
  EXPECT_NEAR(dashpot_fraction(1e-3, Real(0.25) * way, v, dt, true), 0.75, 1e-6);
  EXPECT_EQ(dashpot_fraction(0, Real(0.1), 0, dt, true), 1);
}

/// Damping acts at the speed at the end of the step, half a change beyond its middle.
TEST(ContactLaw, DampingIsThatOfTheEndOfTheStep) {
  Config c = glass();
  c.contact.rolling = "none", c.contact.clip_tension = false;
  const ContactLaw law = contact_law_of(c);
  const double overlap = 1e-6;
  const ContactGeometry at = sphere_contact(kGrain, kGrain, {2 * double(kRadius) - overlap, 0, 0},
                                            2 * double(kRadius) - overlap, overlap);
  const NormalState n = law.normal_state(at.R_star, at.m_star, Real(overlap));
  const auto force = [&](double before, double dt) {
    ContactHistory h;
    h.overlap = Real(overlap), h.recede = before;
    return double(law(at, {Real(-0.3), 0, 0}, {}, {}, Real(dt), h).force.x);
  };
  EXPECT_NEAR(force(-0.1, 1e-7) / (n.elastic + n.damping * (0.3 + 0.1)), 1, 1e-5);
  EXPECT_NEAR(force(-0.1, 0) / (n.elastic + n.damping * 0.3), 1, 1e-5) << "no time passes";
}

TEST(ContactLaw, RigidRotationDoesNotSlide) {
  // two touching grains that turn as one body: no force but the elastic one
  Config c = glass();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const ContactLaw law = contact_law_of(c);
  for (int k = 0; k < 100; ++k) {
    const Vec3d direction{normal(random), normal(random), normal(random)},
        spin{normal(random), normal(random), normal(random)};
    const Sphere big{Real(1.7) * kRadius, Real(5) * kGrain.m};
    const double overlap = 1e-6, gap = double(kGrain.R) + double(big.R) - overlap;
    const Vec3d r = direction * (gap / norm(direction));
    const ContactGeometry at = sphere_contact(kGrain, big, r, gap, overlap);
    ContactHistory h;
    // the contact divides the line of centres in arm_i : arm_j
    const ContactForce f = law(at, Real3(cross(spin, r)), Real3(spin), Real3(spin), Real(1e-6), h);
    const double slide = norm(h.xi) / (1e-6 * norm(cross(spin, r)));
    EXPECT_LT(slide, tolerance(1e-12, 1e-6, 1e-5));
    EXPECT_NEAR(dot(Vec3d(f.force), Vec3d(at.n)) / norm(Vec3d(f.force)), 1, 1e-5);
  }
}

TEST(ContactLaw, SpringAndCoupleTurnWithTheContact) {
  Config c = glass();
  c.grain.mu = 5;
  c.grain.mu_r = 1;
  c.contact.clip_tension = false;
  const ContactLaw law = contact_law_of(c);
  const double overlap = 1e-5, gap = 2 * double(kRadius) - overlap;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 8; ++trial) {
    Vec3d axis{normal(random), normal(random), normal(random)},
        n0{normal(random), normal(random), normal(random)};
    if (trial == 0) axis = n0;  // pure twist
    axis *= 1 / norm(axis), n0 *= 1 / norm(n0);
    Vec3d t0 = cross(n0, Vec3d{normal(random), normal(random), normal(random)});
    t0 *= 1 / norm(t0);
    ContactHistory h{t0 * 2e-6, cross(n0, t0) * 1e-9, overlap};
    const ContactHistory initial = h;
    const int steps = 10000;  // projecting n away is first order: 0.05 degrees at this step
    const double dt = 1.0 / steps, rate = 2 * M_PI;
    Vec3d n = n0;
    for (int s = 1; s <= steps; ++s) {
      n = Quat<double>::from_rotation(axis * (rate * s * dt)).rotate(n0);
      const ContactGeometry at = sphere_contact(kGrain, kGrain, n * gap, gap, overlap);
      const Vec3d v = cross(axis * rate, n * gap);
      law(at, Real3(v), Real3(axis * rate), Real3(axis * rate), Real(dt), h);
    }
    const double degree = M_PI / 180;
    EXPECT_LT(norm(h.xi - initial.xi) / norm(initial.xi), 0.1 * degree) << "trial " << trial;
    EXPECT_LT(norm(h.couple - initial.couple) / norm(initial.couple), 0.1 * degree) << "trial " << trial;
  }
}

/// What a spring changes by is found as a small difference, so it does not drift: here while a pair turns as
/// one body, every substep by another angle. That of a pair is also rounded each time.
TEST(ContactLaw, ASpringKeepsItsLengthThroughAMillionTurns) {
  const Vec3d axis{0.48, 0.6, 0.64};
  Vec3d n{0, 0, 1}, spring = 3e-9 * Vec3d{0.8, 0.6, 0};
  Real3 of_pair = Real3(spring);
  const double length = norm(spring), angle = 1e-5;
  for (int s = 0; s < 1000000; ++s) {
    const double more = angle * (1 + 0.5 * std::sin(s));
    const auto turned = [&](double by) { return Quat<double>::from_rotation(by * axis).rotate(n); };
    const Vec3d n_mid = turned(more / 2), n_end = turned(more);
    const ContactTurn turn(Real3(n_mid), Real3(n_end), Real(more * dot(axis, n_mid)));
    spring += Vec3d(turn.change(Real3(spring)));
    of_pair += turn.change(of_pair);
    n = n_end;
  }
  EXPECT_NEAR(norm(spring) / length, 1, tolerance(1e-8, 1e-6, 1e-6));
  EXPECT_NEAR(norm(Vec3d(of_pair)) / length, 1, tolerance(1e-8, 3e-4, 3e-4));
  EXPECT_LT(std::abs(dot(spring, n)) / length, tolerance(1e-9, 1e-6, 1e-6));
}

/// For a million substeps, 2 s, on a slope, held by friction and rolling friction. In fp32 what is lost of
/// springs lets it slide by 2 nm/s.
TEST(ContactLaw, AGrainOnASlopeDoesNotCreep) {
  Config c = glass();
  c.grain.mu = 0.6, c.grain.mu_r = 0.4;
  c.contact.rolling = "epsd";
  const ContactLaw law = contact_law_of(c);
  const double R = kRadius, m = kGrain.m, dt = 2e-6;
  const Vec3d n{0, 0, 1}, gravity{9.81 * std::sin(0.25), 0, -9.81 * std::cos(0.25)};
  Vec3d x{0, 0, R}, v, omega;
  PairHistory h;
  double rested = 0;
  for (int s = 0; s < 1100000; ++s) {
    if (s == 100000) rested = x.x;
    x += dt * v;
    const double overlap = R - x.z;
    ContactForce f{};
    if (overlap > 0) {
      f = law(wall_contact(kGrain, n, n, Real(overlap)), Real3(v), Real3(omega), {}, Real(dt), h);
    } else {
      h = {};
    }
    v += dt * (Vec3d(f.force) * (1 / m) + gravity);
    omega += Vec3d(f.torque_i) * (dt / (0.4 * m * R * R));
  }
  EXPECT_GT(norm(h.xi), 0);
  EXPECT_NEAR(norm(v), 0, 1e-5);
  EXPECT_NEAR((x.x - rested) / R, 0, tolerance(1e-6, 1e-5, 1e-5));
}

/// Far from the origin and for overlaps far below the radius.
TEST(ContactLaw, OverlapsHaveAllDigits) {
  const double R_i = 1e-3, R_j = 3e-3;
  for (const double overlap : {1e-10, 1e-8, 1e-5}) {
    const Real a = Real(R_i), b = Real(R_j);
    const double apart = double(a) + double(b) - overlap;
    const SphereGap gap(apart * Vec3d{0.48, 0.6, 0.64}, a, b);
    EXPECT_TRUE(gap.overlaps());
    EXPECT_NEAR(gap.overlap() / overlap, 1, 1e-6) << overlap;
    EXPECT_FALSE(SphereGap((apart + 2 * overlap) * Vec3d{0.48, 0.6, 0.64}, a, b).overlaps());
  }
}

TEST(ContactLaw, CapKeepsTheConstantCoupleFromTurningTheSpinRound) {
  ConstantRolling law{Real(0.05), true};
  const double dt = 1e-5, inverse = 1 / double(kGrain.inertia());
  RollingInput in{.omega = {Real(1e-6), 0, 0},
                  .normal_force = Real(1),
                  .normal_stiffness = Real(1e4),
                  .stiffness_before = Real(1e4),
                  .R_star = kRadius,
                  .inverse_spin = Real(inverse),
                  .inverse_rolling = Real(inverse),
                  .dt = Real(dt)};
  const double change = double(law(in).x) * inverse * dt;
  EXPECT_NEAR(change / 1e-6, -1, 1e-5) << "just stopped";
  in.omega.x = 1e6;
  EXPECT_NEAR(law(in).x / (-0.05 * kRadius), 1, 1e-5) << "full couple when fast";
  in.omega = {};
  EXPECT_EQ(norm(law(in)), 0);
}

TEST(ContactLaw, WallIsTheLimitOfAHugePartner) {
  const double size = 1e6, near = 2 / size;  // R* and 1/I fall short by 1/size, to which Real rounds
  const Sphere huge{Real(size) * kRadius, Real(size * size * size) * kGrain.m};
  const auto pair = [&](double overlap) {
    const double gap = double(kRadius) + double(huge.R) - overlap;
    return sphere_contact(kGrain, huge, {0, 0, gap}, gap, overlap);
  };
  const double deep = 1e-2 * kRadius;
  ContactGeometry at = pair(deep), wall = wall_contact(kGrain, {0, 0, 1}, {0, 0, 1}, deep);
  EXPECT_EQ(at.n, wall.n);
  EXPECT_EQ(at.overlap, wall.overlap);
  EXPECT_NEAR(at.R_star / wall.R_star, 1, near);
  EXPECT_NEAR(at.m_star / wall.m_star, 1, near);
  EXPECT_NEAR(at.inverse_spin / wall.inverse_spin, 1, near);
  EXPECT_NEAR(at.inverse_rolling / wall.inverse_rolling, 1, near);
  // a flat wall takes the whole overlap; the pair shares it
  EXPECT_NEAR((kRadius - wall.arm_i) / deep, 1, 1e-4);
  EXPECT_NEAR((kRadius - at.arm_i) / deep, 0.5, 1e-4);
  // that is of no account where the overlap is as small against the grain as the grain is against its partner
  Config c = glass();
  c.grain.mu_r = 0.1;
  for (const char* rolling : {"none", "cdt", "epsd"}) {
    c.contact.rolling = rolling;
    const ContactLaw law = contact_law_of(c);
    at = pair(kRadius / size), wall = wall_contact(kGrain, {0, 0, 1}, {0, 0, 1}, kRadius / size);
    ContactHistory h, w;
    const Real3 v{Real(0.01), 0, Real(-0.02)}, spin{0, Real(3), 0};
    const ContactForce a = law(at, v, spin, {}, Real(1e-6), h), b = law(wall, v, spin, {}, Real(1e-6), w);
    EXPECT_LT(norm(a.force - b.force), 2 * near * norm(b.force)) << rolling;
    EXPECT_LT(norm(a.torque_i - b.torque_i), 2 * near * norm(b.torque_i)) << rolling;
  }
}

/// A spring that pulls, too, up to a gap of a fifth of R*.
struct HoldingSpring : LinearSpring {
  Real range = Real(0.2);
};
using Holding = ContactLawOf<HoldingSpring, NoSliding, NoRolling>;

TEST(ContactLaw, ReachesAsFarAsItsRange) {
  static_assert(!ContactLawOf<Hertz, Mindlin, ElasticPlasticRolling>::kApart && Holding::kApart);
  Holding law;
  law.normal.k = 1000, law.normal.beta = Real(0.1);
  const double range = 0.2 * kRadius / 2;
  const auto acts = [&](double gap, bool touched) {
    return law.acts(SphereGap({0, 0, 2 * double(kRadius) + gap}, kRadius, kRadius), kRadius, kRadius,
                    touched);
  };
  EXPECT_TRUE(acts(-1e-6, false));
  EXPECT_TRUE(acts(0.99 * range, true));
  EXPECT_FALSE(acts(1.01 * range, true));
  EXPECT_FALSE(acts(0.5 * range, false)) << "they have not touched";

  const auto pull = [&](double gap, double speed, PairHistory& h) {
    const double distance = 2 * double(kRadius) + gap;
    const ContactGeometry at = sphere_contact(kGrain, kGrain, {0, 0, distance}, Real(distance), Real(-gap));
    return law(at, {0, 0, Real(speed)}, {}, {}, Real(1e-7), h).force.z;
  };
  PairHistory h;
  pull(-1e-6, 0, h);
  EXPECT_NEAR(pull(1e-6, 0, h), -1e-3, 1e-8);
  EXPECT_NEAR(law.stored(kRadius / 2, kGrain.m / 2, h), 0.5 * 1000 * 1e-12, 1e-16);
  EXPECT_GT(pull(1e-6, -0.01, h), -1e-3) << "the dashpot slows what comes back";
  EXPECT_NEAR(pull(1e-6, 0.01, h), -1e-3, 1e-8) << "it does not pull by itself";
  pull(0, 0, h);
  EXPECT_NE(h.overlap, 0) << "0 stands for pairs that have not touched";
}

}  // namespace
}  // namespace BL_SOLVER
