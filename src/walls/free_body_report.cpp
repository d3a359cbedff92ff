// Free bodies as seen by the host: speeds, step limits, forces, sums, saved state.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bedload/case/contact_laws.hpp"
#include "kernels/boundaries/sinks.hpp"
#include "src/walls/free_bodies.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LoadSum load_of(int k, const Field<Vec3d>& force, const Field<Vec3d>& torque) {
  LoadSum sum = LoadSum::zero();
  sum.add(force.values()[k], torque.values()[k]);
  return sum;
}

bool finite(const Vec3d& v) { return std::isfinite(v.x + v.y + v.z); }

}  // namespace

int FreeBodies::broken() const {
  for (int k = 0; k < size(); ++k)
    if (!finite(now_[k].translation) || !finite(now_[k].v) || !finite(now_[k].omega)) return k;
  return -1;
}

double FreeBodies::top_speed(double dt) const {
  double top = 0;
  for (int k = 0; k < size(); ++k) {
    const RigidMotion& m = now_[k];
    top = std::max(
        top, norm(m.v) + dt * norm(m.a) + parameters_.bodies[k].reach * (norm(m.omega) + dt * norm(m.alpha)));
  }
  return top;
}

std::vector<StepLimit> FreeBodies::limits(double wall_speed) const {
  if (!any()) return {};
  const FreeBodyParameters& p = parameters_;
  StepLimit contact{Limit::body_contact}, roll{Limit::body_rolling}, turn{Limit::body_turn};
  double hardest = kInfinity;
  for (const ElasticCompliance& compliance : p.compliances) hardest = std::min(hardest, compliance.normal);
  for (int k = 0; k < size(); ++k) {
    const FreeBody& body = p.bodies[k];
    const auto lower = [&](StepLimit& limit, double seconds) {
      if (seconds < limit.seconds) limit.seconds = seconds, limit.body = int(body.rigid.body);
    };
    const double size = 2 * body.size;
    const double speed = std::max(norm(now_[k].v) + body.size * norm(now_[k].omega) + wall_speed,
                                  std::sqrt(p.acceleration * size));
    lower(turn, 0.02 * size / std::max(speed, 1e-300));
    if (speed == 0) continue;
    if (balls_.size() > 0) {
      const double E_star = 1 / (p.compliances[body.rigid.body].normal + hardest);
      const Impact hit = Hertz::impact({}, 1 / (2 * body.inverse_mass), contact_radius_, E_star, speed, 1);
      lower(contact, p.contact_fraction * hit.duration);
      const Vec3d& I = body.rigid.moments;
      lower(roll, rolling_limit(p.contact, hit.stiffness, body.mu_r, largest_radius_,
                                0.5 * std::min({I.x, I.y, I.z})));
    }
    if (p.grain_mass > 0) {
      const double m = 1 / (1 / p.grain_mass + body.inverse_mass);
      lower(contact, p.contact_fraction *
                         impact(p.contact, m, p.grain_radius, 1 / body.grain_compliance, speed).duration);
    }
  }
  std::vector<StepLimit> all{contact, roll, turn};
  std::erase_if(all, [](const StepLimit& limit) { return !std::isfinite(limit.seconds); });
  return all;
}

LoadSum FreeBodies::correction(int k) const {
  return load_of(k, store_.corrected_force, store_.corrected_torque);
}

BodyForces FreeBodies::forces(int k) const {
  return {load_of(k, store_.fluid_force, store_.fluid_torque),
          load_of(k, store_.grain_force, store_.grain_torque),
          load_of(k, store_.contact_force, store_.contact_torque)};
}

LoadSum FreeBodies::contact_load(int body) const {
  if (ball_loads_.size == 0) return LoadSum::zero();
  return reduce({0, ball_loads_.size}, ContactLoadReduction{ball_loads_, std::uint32_t(body)});
}

BodyTotals FreeBodies::totals(double time) const {
  BodyTotals t;
  if (!any()) return t;
  const auto x = store_.x.values(), v = store_.v.values(),
             angular_momentum = store_.angular_momentum.values();
  const auto q = store_.rotation.values();
  for (int k = 0; k < size(); ++k) {
    const RigidBody& b = rigid(k);
    const Quat<double> turn = to_quat(q[k]);
    const Vec3d centre = x[k] + turn.rotate(b.arm);
    // a body that only rotates has `angular_momentum` about its pivot, and no v
    const Vec3d u =
        b.move == BodyMove::none ? cross(b.omega(turn, angular_momentum[k]), centre - x[k]) : v[k];
    const double moving = 0.5 * b.mass * norm2(u);
    t.mass += b.mass;
    t.outside += outside(frame_, centre);
    t.potential -= b.mass * dot(parameters_.gravity, centre);
    if (time < b.release) continue;
    t.momentum += b.mass * u;
    t.angular += cross(x[k], b.mass * u) + angular_momentum[k];
    t.kinetic += moving;
    t.rotational += b.turning_energy(turn, angular_momentum[k]) - (b.move == BodyMove::none ? moving : 0);
  }
  return t;
}

void FreeBodies::save(std::vector<HostStore>& stores) const {
  if (!any()) return;
  stores.push_back(store_.save());
  if (balls_.size() > 0) stores.push_back(memory_.save());
}

}  // namespace BL_SOLVER
