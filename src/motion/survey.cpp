#include "src/motion/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bedload {
namespace {

double speed(const RigidMotion& m, const std::vector<Vec3d>& points) {
  double top = 0;
  for (const Vec3d& x : points) top = std::max(top, norm(m.velocity(m.place(x))));
  return top;
}

void add_rows(std::vector<double>& times, const MotionPart& part, double until) {
  for (std::size_t i = 0; i < part.rows.size(); ++i) {
    const double t = part.start + part.rows[i][0];
    times.push_back(t);
    if (i > 0) times.push_back(0.5 * (t + part.start + part.rows[i - 1][0]));
  }
  std::erase_if(times, [&](double t) { return t < 0 || t > until; });
}

}  // namespace

std::vector<double> survey_times(const MotionConfig& motion, double until) {
  constexpr int samples = 2000;
  std::vector<double> times;
  for (int i = 0; i <= samples; ++i) times.push_back(until * i / samples);
  add_rows(times, motion, until);
  for (const MotionPart& part : motion.add) add_rows(times, part, until);
  return times;
}

double first_gap(const MotionConfig& motion, double until) {
  const MotionLaw law(motion, until);
  double first = std::numeric_limits<double>::infinity();
  for (const double t : survey_times(motion, until)) {
    const RigidMotion m = law.at(t);
    const double all =
        norm(m.translation) + norm(m.v) + norm(m.omega) + norm(m.a) + norm(m.alpha) + m.rotation.w;
    if (!std::isfinite(all)) first = std::min(first, t);
  }
  return first;
}

double top_speed(const MotionConfig& motion, const std::vector<Vec3d>& points, double until) {
  const MotionLaw law(motion, until);
  if (!law.moves()) return 0;
  double top = 0;
  for (const double t : survey_times(motion, until)) top = std::max(top, speed(law.at(t), points));
  return top;
}

double initial_shift(const MotionConfig& motion, const std::vector<Vec3d>& points) {
  const RigidMotion start = MotionLaw(motion, 0).at(0);
  double largest = 0;
  for (const Vec3d& x : points) largest = std::max(largest, norm(start.place(x) - x));
  return largest;
}

std::vector<VelocityJump> velocity_jumps(const MotionConfig& motion, const std::vector<Vec3d>& points,
                                         double until) {
  const MotionLaw law(motion, until);
  std::vector<VelocityJump> jumps;
  const double least = 0.01 * top_speed(motion, points, until);
  const double aside = 1e-8 * until;  // s; more than the error of the times at which formulas break
  double last = -1;
  for (const double t : law.events()) {
    if (t < 0 || t >= until || t < last + aside) continue;
    last = t;
    const RigidMotion now = law.at(t), before = law.at(t - aside), after = law.at(t + aside);
    double size = 0;
    for (const Vec3d& x0 : points) {
      const Vec3d x = now.place(x0);
      size = std::max(size, norm(after.velocity(x) - (t > 0 ? before.velocity(x) : Vec3d{})));
    }
    if (size > least) jumps.push_back({t, size});
  }
  return jumps;
}

}  // namespace bedload
