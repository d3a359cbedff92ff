#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "bedload/geometry/body.hpp"
#include "src/viewer/image.hpp"

namespace bedload {
namespace {

constexpr std::size_t kMost = 30000;  // particles of a kind in a frame

double number(const HostArray& array, std::size_t k) {
  switch (array.type) {
    case Scalar::f32:
      return array.as<float>()[k];
    case Scalar::f64:
      return array.as<double>()[k];
    case Scalar::u32:
      return array.as<std::uint32_t>()[k];
    case Scalar::u64:
      return double(array.as<std::uint64_t>()[k]);
  }
  return 0;
}

Vec3d vector(const HostArray& array, std::size_t k) {
  return {number(array, 3 * k), number(array, 3 * k + 1), number(array, 3 * k + 2)};
}

/// A uniform number in 0..1 that is the same for a particle in every frame.
double hash_fraction(std::uint64_t id) {
  id = (id + 1) * 0x9e3779b97f4a7c15u;
  id = (id ^ (id >> 29)) * 0xbf58476d1ce4e5b9u;
  return double((id ^ (id >> 32)) & 0xffffffffu) / 4294967296.0;
}

LiveParticles particles_of(const HostStore& store, int dimensions) {
  LiveParticles out;
  const HostArray *x = store.find("position"), *v = store.find("velocity"), *id = store.find("id"),
                  *radius = store.find("radius");
  if (store.count == 0 || !x) return out;
  const double fraction = std::min(1.0, double(kMost) / double(store.count));
  out.enlarged = std::pow(fraction, -1.0 / dimensions);
  for (std::size_t k = 0; k < store.count; ++k) {
    if (fraction < 1 && hash_fraction(id ? std::uint64_t(number(*id, k)) : k) >= fraction) continue;
    const Vec3d at = vector(*x, k);
    const double speed = v ? norm(vector(*v, k)) : 0;
    if (!std::isfinite(norm(at)) || !std::isfinite(speed)) continue;  // the run has failed
    out.x.push_back(at);
    out.speed.push_back(speed);
    if (radius) out.radius.push_back(out.enlarged * number(*radius, k));
  }
  return out;
}

double top_speed(const LiveFrame& frame) {
  std::vector<double> all = frame.fluid.speed;
  all.insert(all.end(), frame.grains.speed.begin(), frame.grains.speed.end());
  if (all.empty()) return 0;
  const auto at = all.begin() + std::ptrdiff_t(0.99 * double(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  return rounded_up(*at);
}

double value_of(const std::vector<Quantity>& all, const std::string& name, double otherwise) {
  const auto q =
      std::find_if(all.begin(), all.end(), [&](const Quantity& each) { return each.name == name; });
  return q == all.end() ? otherwise : q->value;
}

}  // namespace

FrameTaker::FrameTaker(const Config& config) : config_(config) {
  for (const WallBody& body : config_.wall.bodies) laws_.emplace_back(body.motion, config_.time.end);
}

LiveFrame FrameTaker::take(Simulation& simulation) const {
  const int dimensions = config_.domain.two_d ? 2 : 3;
  LiveFrame out;
  out.time = simulation.time();
  if (config_.fluid.present) out.fluid = particles_of(simulation.snapshot("fluid"), dimensions);
  if (config_.grain.present) out.grains = particles_of(simulation.snapshot("grains"), dimensions);
  for (int b = 0; b < int(laws_.size()); ++b) {
    auto& motion = out.bodies.emplace_back();
    if (config_.wall.bodies[b].moves()) motion = motion_of(simulation, b);
    out.removed.push_back(removed(simulation, b));
  }
  out.top_speed = top_speed(out);
  return out;
}

bool FrameTaker::removed(Simulation& simulation, int body) const {
  return config_.wall.bodies[body].motion.remove_when_clear &&
         value_of(simulation.body_state(body), "present", 1) == 0;
}

RigidMotion FrameTaker::motion_of(Simulation& simulation, int body) const {
  const FreeConfig& free = config_.wall.bodies[body].free;
  if (!free.present) return laws_[body].at(simulation.time());
  const std::vector<Quantity> state = simulation.body_state(body);
  const auto read = [&](const std::string& name) { return value_of(state, name, 0); };
  RigidMotion out;
  out.centre = turning_centre(free);
  out.translation = Vec3d{read("centre_x"), read("centre_y"), read("centre_z")} - out.centre;
  out.rotation = {read("rotation_w"), read("rotation_x"), read("rotation_y"), read("rotation_z")};
  return out;
}

}  // namespace bedload
