#include "bedload/motion/law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bedload/case/config.hpp"
#include "bedload/case/formula.hpp"
#include "src/motion/formula_breaks.hpp"
#include "src/motion/spline.hpp"
#include "src/motion/survey.hpp"
#include "src/motion/wave_maker.hpp"

namespace bedload::test {
namespace {

using std::numbers::pi;

MotionPart oscillation(const Vec3d& amplitude, double frequency) {
  MotionPart m;
  m.kind = "oscillation";
  m.amplitude = amplitude;
  m.frequency = frequency;
  return m;
}

MotionPart rotation(const Vec3d& axis, const Vec3d& centre, double rate) {
  MotionPart m;
  m.kind = "rotation";
  m.axis = axis * (1 / norm(axis));
  m.centre = centre;
  m.rate = rate;
  return m;
}

MotionPart formula(const std::array<std::string, 3>& displacement,
                   const std::array<std::string, 3>& rotation = {"0", "0", "0"}, const Vec3d& centre = {}) {
  MotionPart m;
  m.kind = "formula";
  m.displacement = displacement;
  m.rotation = rotation;
  m.centre = centre;
  return m;
}

/// Rows of f(t), t = 0, step, ..
template <class F>
MotionPart table(int rows, double step, const F& f) {
  MotionPart m;
  m.kind = "table";
  for (int i = 0; i < rows; ++i) m.rows.push_back(f(i * step));
  return m;
}

MotionConfig motion_of(const std::vector<MotionPart>& parts) {
  MotionConfig m;
  static_cast<MotionPart&>(m) = parts[0];
  m.add.assign(parts.begin() + 1, parts.end());
  return m;
}

/// Speeds and accelerations of moved points are the differences of their places in time, of fourth order,
/// to 1e-6 of `speed` (m/s) and `acceleration` (m/s2).
void expect_rates_of_the_pose(const MotionLaw& law, double from, double to, double speed,
                              double acceleration) {
  const double h = 2e-4;
  for (const Vec3d& x0 : {Vec3d{0, 0, 0}, Vec3d{0.3, -0.2, 0.1}, Vec3d{-0.1, 0.4, 0.25}})
    for (int i = 0; i <= 20; ++i) {
      const double t = from + (to - from) * i / 20;
      const auto at = [&](int k) { return law.at(t + k * h).place(x0); };
      const Vec3d v = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) * (1 / (12 * h));
      const Vec3d a = (16.0 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30.0 * at(0)) * (1 / (12 * h * h));
      const RigidMotion now = law.at(t);
      EXPECT_LT(norm(now.velocity(at(0)) - v), 1e-6 * speed) << "t = " << t;
      EXPECT_LT(norm(now.acceleration(at(0)) - a), 1e-6 * acceleration) << "t = " << t;
    }
}

TEST(MotionLaw, VelocitiesAreTheDifferencesOfThePose) {
  const auto swing = oscillation({0.1, 0, 0.02}, 2);
  const auto spin = rotation({1, 2, -1}, {0.05, 0.1, 0}, 7);
  const auto rocking =
      formula({"0.05*sin(9*t)", "0.1*t^2", "0"}, {"40*sin(9*t)", "90*t^2", "-10*cos(4*t)"}, {0.2, 0, -0.1});
  for (const auto& parts : std::vector<std::vector<MotionPart>>{{swing}, {spin}, {rocking}})
    expect_rates_of_the_pose(MotionLaw(motion_of(parts), 2), 0.1, 1.9, 1, 10);
}

TEST(MotionLaw, SumsMoveAsTheirPoseDoes) {
  const auto swing = oscillation({0.1, 0, 0.02}, 2);
  const auto spin = rotation({0, 0, 1}, {0.1, 0, 0}, 9);
  const auto carousel = rotation({1, 0, 1}, {-0.2, 0, 0.3}, 3);
  const auto rocking = formula({"0", "0.1*t", "0"}, {"20*sin(5*t)", "0", "30*cos(3*t)"}, {0, 0.1, 0});
  for (const auto& parts : std::vector<std::vector<MotionPart>>{
           {swing, spin}, {spin, carousel}, {spin, rocking, carousel, swing}, {carousel, spin, rocking}})
    expect_rates_of_the_pose(MotionLaw(motion_of(parts), 2), 0.1, 1.9, 2, 50);
}

TEST(MotionLaw, TranslationsAddAndLaterTurnsCarryEarlierCentres) {
  // A quarter turn about z at (1, 0, 0), then one about x at the origin; the shift is not turned.
  const auto first = rotation({0, 0, 1}, {1, 0, 0}, pi / 2), second = rotation({1, 0, 0}, {}, pi / 2);
  MotionPart shift;
  shift.kind = "velocity";
  shift.velocity = {0, 0, 5};
  const RigidMotion m = MotionLaw(motion_of({shift, first, second}), 2).at(1);
  const Vec3d x = m.place({2, 0, 0});  // (1, 1, 0), then (1, 0, 1), then up by 5
  EXPECT_NEAR(norm(x - Vec3d{1, 0, 6}), 0, 1e-14);
  // omega: pi/2 about x, and pi/2 about what was z and is now -y
  EXPECT_NEAR(norm(m.omega - Vec3d{pi / 2, -pi / 2, 0}), 0, 1e-14);
}

TEST(MotionLaw, TurnsSmoothlyThroughNoRotationAtAll) {
  const MotionLaw law(motion_of({formula({"0", "0", "0"}, {"50*(t-1)", "20*(t-1)^2", "30*(t-1)"})}), 2);
  for (const double t : {1.0, 1 + 1e-9, 1 + 1e-4, 1.05, 1.08})
    for (const double aside : {-1e-5, 1e-5})
      EXPECT_LT(norm(law.at(t).alpha - law.at(t + aside).alpha), 1e-4) << t;
  expect_rates_of_the_pose(law, 0.9, 1.1, 1, 10);
}

TEST(MotionLaw, RestsBeforeItsStartAndAfterItsStop) {
  MotionPart m = oscillation({0.1, 0, 0}, 1);
  m.start = 0.5;
  m.stop = 0.75;
  const MotionLaw law(motion_of({m}), 2);
  EXPECT_EQ(norm(law.at(0.4).v), 0);
  EXPECT_EQ(norm(law.at(0.4).translation), 0);
  EXPECT_NEAR(law.at(0.5).v.x, 0.2 * pi, 1e-12);
  EXPECT_NEAR(law.at(0.6).translation.x, 0.1 * std::sin(0.2 * pi), 1e-12);
  EXPECT_NEAR(law.at(0.9).translation.x, 0.1, 1e-12);
  EXPECT_EQ(norm(law.at(0.9).v), 0);
  EXPECT_EQ(norm(law.at(0.9).a), 0);
  EXPECT_EQ(law.events(), (std::vector<double>{0.5, 0.75}));
}

TEST(MotionLaw, AgitatorPeaks) {  // T-43
  const double A = 7.1e-3, f = 4.06, end = 3 / f;
  const MotionPart rows = table(
      151, end / 150, [&](double t) { return MotionRow{t, A * std::sin(2 * pi * f * t), 0, 0, 0, 0, 0}; });
  const auto text = formula({"7.1e-3*sin(2*pi*4.06*t)", "0", "0"});
  for (const auto& [part, exact] :
       {std::pair{oscillation({A, 0, 0}, f), 1e-4}, {text, 1e-4}, {rows, 1e-2}}) {  // rows: (w dt)^2 / 12
    Config c;
    c.gravity = {};
    c.time.end = end;
    c.frame.motion = motion_of({part});
    const EffectiveGravity effective(c.gravity, c.frame.motion, c.time.end);
    const MotionLaw law(c.frame.motion, end);
    double v = 0, a = 0;
    for (int i = 200; i < 2800; ++i) {
      v = std::max(v, norm(law.at(end * i / 3000).v));
      a = std::max(a, norm(effective.at(end * i / 3000)));
    }
    EXPECT_NEAR(v, 0.1811, exact) << part.kind.name();
    EXPECT_NEAR(a, 4.6203, exact * (part.kind == "table" ? 4.62 : 1)) << part.kind.name();
    const double t = 0.3;  // minus the frame's acceleration
    EXPECT_NEAR(effective.at(t).x, 4.6203 * std::sin(2 * pi * f * t), 4.62 * exact) << part.kind.name();
  }
}

TEST(FormulaMotion, DerivativesAreGoodFromSlowToFast) {
  for (const double w : {0.1, 3.0, 1e3, 1e5}) {  // rad/s, over ten seconds
    const MotionLaw law(motion_of({formula({"2*sin(" + std::to_string(w) + "*t)", "0", "0"})}), 10);
    for (int i = 0; i <= 50; ++i) {
      const double t = 9.7 * i / 50;
      EXPECT_NEAR(law.at(t).v.x / (2 * w), std::cos(w * t), 1e-7) << w << ' ' << t;
      EXPECT_NEAR(law.at(t).a.x / (2 * w * w), -std::sin(w * t), 2e-6) << w << ' ' << t;
    }
  }
}

TEST(FormulaMotion, AsksForNoValueBeforeItsStart) {
  const MotionLaw law(motion_of({formula({"t^2.5", "sqrt(t)", "0"})}), 4);
  EXPECT_NEAR(law.at(0).v.x, 0, 1e-4);
  EXPECT_NEAR(law.at(1).v.x, 2.5, 1e-8);
  EXPECT_NEAR(law.at(1).a.x, 3.75, 1e-6);
  EXPECT_NEAR(law.at(1).v.y, 0.5, 1e-8);
  EXPECT_EQ(first_gap(motion_of({formula({"t^2.5", "sqrt(t)", "0"})}), 4), INFINITY);
  EXPECT_NEAR(first_gap(motion_of({formula({"sqrt(1-t)", "0", "0"})}), 4), 1, 0.01);
}

MotionPart scaled(MotionPart part, const std::string& factor) {
  part.factor = factor;
  return part;
}

TEST(ScaledMotion, GoesAsFarAsTheIntegralOfItsFactor) {
  const auto turn = rotation({0, 0, 1}, {}, 2);
  const MotionLaw ramp(motion_of({scaled(turn, "min(1, t/0.5)")}), 3);
  for (const double t : {0.0, 0.1, 0.25, 0.499, 0.51, 1.0, 1.5}) {
    const double angle = t < 0.5 ? 2 * t * t : 0.5 + 2 * (t - 0.5);
    const Vec3d x = ramp.at(t).place({1, 0, 0});
    EXPECT_NEAR(std::atan2(x.y, x.x), angle, 1e-12) << t;
    EXPECT_NEAR(ramp.at(t).omega.z, std::min(2.0, 4 * t), 1e-14) << t;
    EXPECT_NEAR(ramp.at(t).alpha.z, t < 0.5 ? 4 : 0, 1e-6) << t;
  }
  MotionPart lift;
  lift.kind = "velocity";
  lift.velocity = {0, 0, 3};
  for (const double w : {0.1, 3.0, 1e3, 1e4}) {  // rad/s, over ten seconds
    const MotionLaw law(motion_of({scaled(lift, "cos(" + std::to_string(w) + "*t)")}), 10);
    for (int i = 0; i <= 50; ++i) {
      const double t = 9.7 * i / 50;
      EXPECT_NEAR(law.at(t).translation.z, 3 * std::sin(w * t) / w, 3e-12) << w << ' ' << t;
      EXPECT_NEAR(law.at(t).v.z, 3 * std::cos(w * t), 1e-14) << w << ' ' << t;
      EXPECT_NEAR(law.at(t).a.z / (3 * w), -std::sin(w * t), 1e-6) << w << ' ' << t;
    }
  }
}

TEST(ScaledMotion, VelocitiesAreTheDifferencesOfThePose) {
  const auto spin = scaled(rotation({1, 2, -1}, {0.05, 0.1, 0}, 7), "1-exp(-3*t)+0.2*sin(20*t)");
  const auto carousel = rotation({1, 0, 1}, {-0.2, 0, 0.3}, 3);
  for (const auto& parts : std::vector<std::vector<MotionPart>>{{spin}, {spin, carousel}})
    expect_rates_of_the_pose(MotionLaw(motion_of(parts), 2), 0.1, 1.9, 2, 50);
}

TEST(ScaledMotion, MayStopAtOnceAndKnowsWhen) {
  auto turn = scaled(rotation({0, 1, 0}, {}, 4), "t < 1 ? 1 : 0");
  turn.start = 0.5;
  const MotionLaw law(motion_of({turn}), 3);
  ASSERT_EQ(law.events().size(), 2u);
  EXPECT_NEAR(law.events()[1], 1.5, 1e-8);
  EXPECT_EQ(law.at(2).omega, (Vec3d{}));
  const Vec3d x = law.at(2).place({1, 0, 0});
  EXPECT_NEAR(std::atan2(-x.z, x.x), 4 - 2 * pi, 1e-7) << "4 rad";
  const auto jumps = velocity_jumps(motion_of({turn}), {{1, 0, 0}}, 3);
  ASSERT_EQ(jumps.size(), 2u);
  EXPECT_NEAR(jumps[1].size, 4, 1e-6);
}

TEST(ScaledMotion, FactorsWithoutEndOfDetailAreTakenAsTheyCome) {
  const MotionLaw law(motion_of({scaled(rotation({0, 1, 0}, {}, 1), "sin(1e12*t*t)")}), 10);
  EXPECT_TRUE(std::isfinite(law.at(7).omega.y));
  const RigidMotion once = law.at(3.7), again = law.at(3.7);
  EXPECT_EQ(once.rotation.w, again.rotation.w);
}

TEST(TableMotion, IsSmoothThroughRowsAndRestsOutsideThem) {
  const auto rows = table(21, 0.1, [](double t) {
    return MotionRow{t + 0.5, t * t * (3 - t), 0, 0.1 * t, 0, 0, 20 * std::sin(3 * t)};
  });
  const MotionLaw law(motion_of({rows}), 3);
  for (const double t : {0.5, 0.7, 1.23, 1.5, 2.4}) {
    const double s = t - 0.5;
    EXPECT_NEAR(law.at(t).translation.x, s * s * (3 - s), 1e-12);  // a cubic is met exactly
    EXPECT_NEAR(law.at(t).v.x, 6 * s - 3 * s * s, 1e-10);
    EXPECT_NEAR(law.at(t).a.x, 6 - 6 * s, 1e-9);
    EXPECT_NEAR(law.at(t).omega.z, pi / 3 * std::cos(3 * s), 2e-3);
  }
  for (const double t : {0.0, 0.4, 2.6, 5.0}) {
    EXPECT_EQ(norm(law.at(t).v) + norm(law.at(t).omega) + norm(law.at(t).a), 0);
    EXPECT_NEAR(law.at(t).translation.x, t < 1 ? 0 : 4, 1e-12);
  }
  expect_rates_of_the_pose(law, 0.533, 2.433, 2, 1e3);  // the third derivative jumps at rows
}

TEST(TableMotion, RowsBeforeItsStartAreSkipped) {
  auto rows = table(5, 0.25, [](double t) { return MotionRow{t - 0.5, t}; });
  rows.start = 1;
  const MotionLaw law(motion_of({rows}), 3);
  EXPECT_EQ(norm(law.at(0.9).v), 0);
  EXPECT_NEAR(law.at(0.9).translation.x, 0.5, 1e-12);
  EXPECT_NEAR(law.at(1.25).v.x, 1, 1e-12);
  EXPECT_EQ(law.events(), (std::vector<double>{1, 1.5}));
}

TEST(Spline, MonotoneNeitherOvershootsNorBreaksItsSlope) {
  const Spline s({0, 1, 1.5, 3, 4}, {0, 0, 2, 2, 5}, true);
  double before = 0;
  for (int i = 0; i <= 4000; ++i) {
    const auto v = s.at(i * 1e-3);
    EXPECT_GE(v.y, before - 1e-12);
    before = v.y;
  }
  EXPECT_EQ(s.at(0.5).y, 0);
  EXPECT_EQ(s.at(2.2).y, 2);
  for (const double knot : {1.0, 1.5, 3.0}) EXPECT_NEAR(s.at(knot - 1e-9).rate, s.at(knot + 1e-9).rate, 1e-6);
}

TEST(Spline, SmoothKeepsItsCurvatureAcrossPoints) {
  const std::vector<double> t{0, 0.3, 1, 1.1, 2, 3.5}, y{1, 2, -1, 0, 4, 2};
  const Spline s(t, y, false);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(s.at(t[i]).y, y[i], 1e-12);
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    EXPECT_NEAR(s.at(t[i] - 1e-9).rate, s.at(t[i] + 1e-9).rate, 1e-5);
    EXPECT_NEAR(s.at(t[i] - 1e-9).rate2, s.at(t[i] + 1e-9).rate2, 1e-3);
  }
  EXPECT_NEAR(Spline({0, 1, 3}, {0, 1, 9}, false).at(2).y, 4, 1e-14);  // a parabola
  EXPECT_NEAR(Spline({0, 2}, {0, 4}, false).at(0.5).rate, 2, 1e-14);
}

/// Four points and more: the third derivative is continuous next to the ends, so a cubic is one.
TEST(Spline, SmoothIsExactForACubic) {
  const auto y = [](double t) { return 1 - 2 * t + 0.5 * t * t + 0.3 * t * t * t; };
  for (const std::vector<double>& t :
       {std::vector<double>{0, 0.3, 1, 1.1, 2, 3.5}, std::vector<double>{-1, 0.5, 0.75, 2}}) {
    std::vector<double> at;
    for (const double time : t) at.push_back(y(time));
    const Spline s(t, at, false);
    for (int i = 0; i <= 20; ++i) {
      const double now = t.front() + (t.back() - t.front()) * i / 20;
      EXPECT_NEAR(s.at(now).y, y(now), 1e-12) << now;
      EXPECT_NEAR(s.at(now).rate, -2 + now + 0.9 * now * now, 1e-11) << now;
      EXPECT_NEAR(s.at(now).rate2, 1 + 1.8 * now, 1e-10) << now;
    }
  }
}

/// [fritsch84]: harmonic means within; at the ends three points, not against the chord nor three times as
/// steep.
TEST(Spline, MonotoneHasTheSlopesOfItsChords) {
  const Spline s({0, 1, 3}, {0, 1, 5}, true);  // chords 1 and 2
  EXPECT_NEAR(s.at(0).rate, (4 * 1 - 1 * 2) / 3.0, 1e-14);
  EXPECT_NEAR(s.at(1).rate, 9 / (5 / 1.0 + 4 / 2.0), 1e-14);
  EXPECT_NEAR(s.at(3).rate, (5 * 2 - 2 * 1) / 3.0, 1e-14);
  EXPECT_EQ(Spline({0, 1, 2}, {0, 1, 6}, true).at(0).rate, 0) << "-1 by three points";
  const Spline peak({0, 1, 2}, {0, 1, -4}, true);
  EXPECT_NEAR(peak.at(0).rate, 3, 1e-14) << "4 by three points";
  EXPECT_EQ(peak.at(1).rate, 0);
}

TEST(Formula, BreaksAreFoundWhereTheyAre) {
  const auto found = [](const char* text, double span) { return breaks_of(Formula(text, "t"), span); };
  const auto at = found("t < 1.2345678 ? 0 : 0.3*(t - 1.2345678)", 4);
  ASSERT_EQ(at.size(), 1u);
  EXPECT_NEAR(at[0].time, 1.2345678, 1e-8);
  EXPECT_NEAR(at[0].rate_jump, 0.3, 1e-6);
  EXPECT_EQ(at[0].jump, 0);
  const auto jump =
      found("100 + 0.01*sin(t) + (t < 3 ? 0 : 1e-4)", 4);  // far from zero, small against the rest
  ASSERT_EQ(jump.size(), 1u);
  EXPECT_NEAR(jump[0].time, 3, 1e-6);
  EXPECT_NEAR(jump[0].jump, 1e-4, 1e-8);
  const auto teeth = found("abs(sin(50*t))", 1);
  ASSERT_EQ(teeth.size(), 15u);
  for (std::size_t k = 0; k < teeth.size(); ++k) {
    EXPECT_NEAR(teeth[k].time, double(k + 1) * pi / 50, 1e-8);
    EXPECT_NEAR(teeth[k].rate_jump, 100, 0.01);
  }
  EXPECT_EQ(found("0.01*rint(10*t)", 1).size(), 10u);
  const auto both = found("max(0, t - 0.1) - 2*max(0, t - 0.1004)", 1);  // nearer than two samples
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both[0].rate_jump, 1, 1e-4);
  EXPECT_NEAR(both[1].rate_jump, -2, 1e-4);
}

TEST(Formula, SmoothOnesDoNotBreak) {
  for (const char* text :
       {"0.3", "t", "1000 + 1e-3*sin(7*t)", "sin(4e4*t)", "sin(6e5*t)", "t^2.5", "sqrt(t)", "sqrt(t + 1e-4)",
        "exp(-100*t)*sin(2000*t)", "tanh(200*(t - 0.5))", "t < 0.5 ? t^2 : t - 0.25", "1e20*t"})
    EXPECT_TRUE(breaks_of(Formula(text, "t"), 1).empty()) << text;
}

TEST(Formula, RatesBesideABreakAreThoseOfEitherSide) {
  const MotionLaw law(motion_of({formula({"t < 0.5 ? 0.1*t : 0.05 + 2*(t - 0.5)", "0", "0"})}), 1);
  for (const double aside : {1e-8, 1e-5, 1e-3, 0.1}) {
    EXPECT_NEAR(law.at(0.5 - aside).v.x, 0.1, 1e-7) << aside;
    EXPECT_NEAR(law.at(0.5 + aside).v.x, 2, 1e-7) << aside;
    EXPECT_NEAR(law.at(0.5 + aside).a.x, 0, 2e-3) << aside;
  }
}

TEST(Survey, FindsJumpsWithinFormulas) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}};
  auto part = formula({"t < 0.5 ? 0 : 2*(t - 0.5)", "0", "t < 0.5 ? 0 : t - 0.5"},
                      {"0", "0", "max(0, t - 0.8)*180/pi"});
  part.start = 0.1;
  const auto jumps = velocity_jumps(motion_of({part}), points, 2);
  ASSERT_EQ(jumps.size(), 2u);
  EXPECT_NEAR(jumps[0].time, 0.6, 1e-7);
  EXPECT_NEAR(jumps[0].size, std::sqrt(5), 1e-6);
  EXPECT_NEAR(jumps[1].time, 0.9, 1e-7);
  EXPECT_NEAR(jumps[1].size, 1, 1e-6);
  part.stop = 0.3;
  EXPECT_TRUE(velocity_jumps(motion_of({part}), points, 2).empty()) << "it has stopped by then";
  EXPECT_TRUE(velocity_jumps(motion_of({formula({"0.001*(1-cos(6e4*t))", "0", "0"})}), points, 2).empty());
}

TEST(Survey, FindsTopSpeedAndJumps) {
  MotionPart gate;
  gate.kind = "velocity";
  gate.velocity = {0, 0, 0.68};
  gate.stop = 0.25;
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}};
  const auto jumps = velocity_jumps(motion_of({gate}), points, 1);
  ASSERT_EQ(jumps.size(), 2u);
  EXPECT_EQ(jumps[0].time, 0);
  EXPECT_DOUBLE_EQ(jumps[0].size, 0.68);
  EXPECT_EQ(jumps[1].time, 0.25);
  EXPECT_DOUBLE_EQ(jumps[1].size, 0.68);
  EXPECT_EQ(velocity_jumps(motion_of({gate}), points, 0.2).size(), 1u) << "the run ends before the stop";

  const auto drum = motion_of({rotation({0, 0, 1}, {}, 3)});
  EXPECT_DOUBLE_EQ(velocity_jumps(drum, points, 1).at(0).size, 3);
  EXPECT_NEAR(top_speed(drum, points, 1), 3, 1e-12);
  // from rest to rest without a jump, 1 m in 1 s
  const auto swing = table(101, 0.01, [](double t) { return MotionRow{t, (1 - std::cos(pi * t)) / 2}; });
  EXPECT_TRUE(velocity_jumps(motion_of({swing}), points, 2).empty());
  EXPECT_NEAR(top_speed(motion_of({swing}), points, 2), pi / 2, 1e-4);
  EXPECT_TRUE(velocity_jumps(motion_of({formula({"0.1*(1-cos(7*t))", "0", "0"})}), points, 2).empty());
}

/// Water waves of 1.2 s over 0.4 m: k d from the dispersion relation, strokes from the limits of shallow and
/// deep water.
TEST(WaveMaker, StrokeFollowsFromTheWave) {
  const WaterWave wave{.height = 0.05, .period = 1.2, .depth = 0.4, .gravity = 9.81};
  const double k = wave.number(), w = 2 * pi / 1.2;
  EXPECT_NEAR(9.81 * k * std::tanh(0.4 * k), w * w, 1e-10);
  const auto amplitude = [](const WaterWave& of) {  // at the first quarter of a period
    return Formula(piston_stroke(of, 1, 0), "t")(of.period / 4);
  };
  // shallow: H/S = k d; deep: H/S = 2
  const WaterWave shallow{.height = 0.001, .period = 60, .depth = 0.1, .gravity = 9.81};
  EXPECT_NEAR(amplitude(shallow) / (0.5 * 0.001 / (shallow.number() * 0.1)), 1, 1e-3);
  const WaterWave deep{.height = 0.01, .period = 0.4, .depth = 2, .gravity = 9.81};
  EXPECT_NEAR(amplitude(deep), 0.5 * 0.01 / 2, 1e-9);
  // in shallow water a flap needs twice the stroke of a piston at the surface
  const double angle = Formula(flap_angle(shallow, 1, 0), "t")(15.0) * pi / 180;
  EXPECT_NEAR(std::tan(angle) * 0.1 / amplitude(shallow), 2, 1e-3);
}

TEST(WaveMaker, SecondOrderAddsItsHarmonic) {
  const WaterWave wave{.height = 0.05, .period = 1.2, .depth = 0.4, .gravity = 9.81};
  const Stroke stroke = stroke_of(wave, Paddle::flap);
  const Formula first(piston_stroke(wave, 1, 0), "t"), second(piston_stroke(wave, 2, 0), "t");
  const Stroke piston = stroke_of(wave, Paddle::piston);
  const Formula angle(flap_angle(wave, 2, 0), "t");
  for (const double t : {0.0, 0.1, 0.15, 0.7}) {
    const double wt = 2 * pi * t / 1.2;
    EXPECT_NEAR(second(t) - first(t), piston.sine * std::sin(2 * wt) + piston.cosine * (1 - std::cos(2 * wt)),
                1e-12);
    EXPECT_NEAR(
        0.4 * std::tan(angle(t) * pi / 180),
        stroke.first * std::sin(wt) + stroke.sine * std::sin(2 * wt) + stroke.cosine * (1 - std::cos(2 * wt)),
        1e-12);
  }
}

/// In shallow water the second order of a piston is that of Madsen (1971), as Hughes (1993) gives it; a flap,
/// whose displacement at the surface is twice as large, moves it on average as much.
TEST(WaveMaker, SecondOrderTendsToThatOfShallowWater) {
  for (const double period : {6.0, 12.0}) {
    const WaterWave wave{.height = 0.01, .period = period, .depth = 1, .gravity = 9.81};
    const double kd = wave.number(), sinh = std::sinh(kd), cosh = std::cosh(kd);
    const double m1 = 2 * sinh * sinh / (sinh * cosh + kd);
    const double madsen = 0.01 * 0.01 / 32 * (3 * cosh / (sinh * sinh * sinh) - 2 / m1);
    const Stroke piston = stroke_of(wave, Paddle::piston), flap = stroke_of(wave, Paddle::flap);
    EXPECT_NEAR(piston.sine / madsen, 1, kd * kd / 4)
        << "kd = " << kd;  // what it leaves out is of that order
    EXPECT_NEAR(piston.cosine, 0, 1e-3 * madsen);
    EXPECT_NEAR(flap.sine / madsen, 2, 5 * kd * kd);
  }
}

/// k d = 1: the shares of the paddle's motion and of the modes that decay are as large as Madsen's term.
/// Numbers of an independent evaluation with 200 modes, whose forcing of the free surface was compared with
/// finite differences of the first-order potential in time.
TEST(WaveMaker, SecondOrderOfDeeperWater) {
  const double w2 = 9.81 * std::tanh(1.0);
  const WaterWave wave{.height = 0.05, .period = 2 * pi / std::sqrt(w2), .depth = 1, .gravity = 9.81};
  const Stroke piston = stroke_of(wave, Paddle::piston), flap = stroke_of(wave, Paddle::flap);
  EXPECT_NEAR(piston.sine, 2.2697e-4, 1.5e-6);
  EXPECT_NEAR(piston.cosine, -2.2165e-5, 3e-7);
  EXPECT_NEAR(flap.sine, -4.5659e-4, 1.5e-6);
  EXPECT_NEAR(flap.cosine, 2.1620e-4, 3e-7);
}

}  // namespace
}  // namespace bedload::test
