// What the host asks of free bodies: speeds, step limits, forces, sums, what is kept.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bedload/case/limits.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/case/normal_laws.hpp"
#include "src/walls/free_bodies.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
    top = std::max(top, norm(m.v) + dt * norm(m.a) + reaches_[k] * (norm(m.omega) + dt * norm(m.alpha)));
  }
  return top;
}

std::vector<StepLimit> FreeBodies::limits(double wall_speed) const {
  if (!any()) return {};
  const double g = norm(config_.gravity) + config_.frame.acceleration;
  double contact = kInfinity, roll = kInfinity, turn = kInfinity;
  const auto compliance_of = [&](const WallBody& body) {
    return body.free.present ? ElasticCompliance(body.free.E, body.free.nu).normal
                             : wall_compliance(config_, body).normal;
  };
  double hardest = kInfinity;
  for (const WallBody& body : config_.wall.bodies) hardest = std::min(hardest, compliance_of(body));
  for (int k = 0; k < size(); ++k) {
    const double size = 2 * sizes_[k];
    const double speed =
        std::max(norm(now_[k].v) + sizes_[k] * norm(now_[k].omega) + wall_speed, std::sqrt(g * size));
    turn = std::min(turn, 0.02 * size / std::max(speed, 1e-300));
    if (speed == 0) continue;
    const WallBody& body = config_.wall.bodies[bodies_[k].body];
    if (balls_.size() > 0) {
      const Impact hit = hertz_impact(1 / (2 * inverse_masses_[k]), contact_radius_,
                                      1 / (compliance_of(body) + hardest), speed);
      contact = std::min(contact, hit.duration);
      const Vec3d& I = bodies_[k].moments;
      const double mu_r = body.free.mu_r;
      if (config_.contact.rolling == RollingLaw::epsd)
        roll = std::min(roll,
                        rolling_limit(hit.stiffness, mu_r, largest_radius_, 0.5 * std::min({I.x, I.y, I.z})));
    }
    if (config_.grain.present) {
      const double R = 0.5 * config_.grain.d_min;
      const double m = 1 / (1 / (4.0 / 3.0 * M_PI * R * R * R * config_.grain.rho) + inverse_masses_[k]);
      const double compliance =
          ElasticCompliance(config_.grain.E, config_.grain.nu).normal + wall_compliance(config_, body).normal;
      contact = std::min(contact, impact(config_.contact, m, R, 1 / compliance, speed).duration);
    }
  }
  std::vector<StepLimit> all;
  if (std::isfinite(contact)) all.push_back({"body contact", config_.time.contact * contact});
  if (std::isfinite(roll)) all.push_back({"body rolling", roll});
  all.push_back({"body turn", turn});
  return all;
}

double FreeBodies::stable_dt(double wall_speed) const {
  double least = kInfinity;
  for (const StepLimit& limit : limits(wall_speed)) least = std::min(least, limit.seconds);
  return least;
}

BodyForces FreeBodies::forces(int k) const {
  const auto load = [&](const Field<Vec3d>& force, const Field<Vec3d>& torque) {
    LoadSum sum = LoadSum::zero();
    sum.add(force.values()[k], torque.values()[k]);
    return sum;
  };
  return {load(store_.fluid_force, store_.fluid_torque), load(store_.grain_force, store_.grain_torque),
          load(store_.contact_force, store_.contact_torque)};
}

LoadSum FreeBodies::contact_load(int body) const {
  if (ball_loads_.size == 0) return LoadSum::zero();
  return reduce({0, ball_loads_.size}, TouchReduction{ball_loads_, std::uint32_t(body)});
}

BodyTotals FreeBodies::totals(double time) const {
  BodyTotals t;
  if (!any()) return t;
  const auto x = store_.x.values(), v = store_.v.values(), spin = store_.spin.values();
  const auto q = store_.rotation.values();
  for (int k = 0; k < size(); ++k) {
    const RigidBody& b = bodies_[k];
    const Quat<double> turn = to_quat(q[k]);
    const Vec3d centre = x[k] + turn.rotate(b.arm);
    // of a body that only turns, `spin` is all there is, about its pivot
    const Vec3d u = b.move == BodyMove::none ? cross(b.omega(turn, spin[k]), centre - x[k]) : v[k];
    const double moving = 0.5 * b.mass * norm2(u);
    t.mass += b.mass;
    t.potential -= b.mass * dot(config_.gravity, centre);
    if (time < b.release) continue;
    t.momentum += b.mass * u;
    t.angular += cross(x[k], b.mass * u) + spin[k];
    t.kinetic += moving;
    t.rotational += b.turning_energy(turn, spin[k]) - (b.move == BodyMove::none ? moving : 0);
  }
  return t;
}

void FreeBodies::save(std::vector<HostStore>& stores) const {
  if (!any()) return;
  stores.push_back(store_.save());
  if (balls_.size() > 0) stores.push_back(memory_.save());
}

}  // namespace bedload::inline BL_VARIANT
