#include "src/viscometer/layers.hpp"

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

double value(const HostArray& a, std::size_t k) {
  return a.type == Scalar::f64 ? a.as<double>()[k] : double(a.as<float>()[k]);
}
Vec3d vector(const HostArray& a, std::size_t i) {
  return {value(a, 3 * i), value(a, 3 * i + 1), value(a, 3 * i + 2)};
}

/// The arrays of a store used for a sample.
struct Particles {
  explicit Particles(const HostStore& store)
      : count(store.count),
        position(store.find("position")),
        velocity(store.find("velocity")),
        mass(store.find("mass")),
        volume(store.find("volume")),
        drive(store.find("drive")) {
    for (const HostArray& a : store.arrays)
      if (a.name.starts_with("stress_")) parts.emplace_back(a.name.substr(7), &a);
  }
  std::size_t count;
  const HostArray *position, *velocity, *mass, *volume, *drive;
  std::vector<std::pair<std::string, const HostArray*>> parts;
};

/// Mean velocity of all fluid and grains, m/s.
Vec3d mean_velocity(const Particles& fluid, const Particles& grains) {
  Vec3d momentum;
  double mass = 0;
  for (const Particles* all : {&fluid, &grains})
    for (std::size_t i = 0; i < all->count; ++i) {
      const double m = value(*all->mass, i);
      momentum += m * vector(*all->velocity, i), mass += m;
    }
  return mass > 0 ? momentum / mass : Vec3d{};
}

}  // namespace

void MotionSums::add(double m, const Vec3d& v) {
  mass += m, momentum += m * v;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) flow[3 * i + j] += m * v[i] * v[j];
}

void MotionSums::add(const MotionSums& o) {
  mass += o.mass, momentum += o.momentum;
  for (int k = 0; k < 9; ++k) flow[k] += o.flow[k];
}

Tensor MotionSums::fluctuation() const {
  Tensor out = flow;
  if (mass > 0)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out[3 * i + j] -= momentum[i] * momentum[j] / mass;
  return out;
}

void LayerSums::add(const LayerSums& o) {
  fluid.add(o.fluid), grains.add(o.grains);
  volume += o.volume, grain_volume += o.grain_volume, place += o.place, place2 += o.place2, drive += o.drive;
  for (const auto& [name, tensor] : o.parts) {
    Tensor& sum = parts.try_emplace(name, Tensor{}).first->second;
    for (int k = 0; k < 9; ++k) sum[k] += tensor[k];
  }
}

Layers::Layers(const PlaneFlow& flow, double h, int layers, int blocks)
    : flow_(flow), h_(flow.kind == PlaneFlowKind::lees_edwards ? 0 : h), layers_(layers), blocks_(blocks) {
  for (Block& block : blocks_) block.layers.resize(layers);
}

bool Layers::inside(int layer, double distance) const {
  const double gap = flow_.gap(), z = std::fmod(middle(layer) - flow_.low, gap);
  return z > distance && z < gap - distance;
}

void Layers::add(int number, const HostStore& fluid_store, const HostStore& grain_store, double wall_stress) {
  Block& block = blocks_[number];
  const Particles fluid(fluid_store), grains(grain_store);
  const Vec3d drift = flow_.walled() ? Vec3d{} : mean_velocity(fluid, grains);
  const double length = flow_.high - flow_.low, gap = flow_.gap();
  const auto add = [&](const Particles& all, bool is_fluid) {
    for (std::size_t i = 0; i < all.count; ++i) {
      double z = value(*all.position, 3 * i + flow_.gradient) - flow_.low;
      if (!flow_.walled()) z -= length * std::floor(z / length);
      LayerSums& layer = block.layers[std::clamp(int(z / length * layers_), 0, layers_ - 1)];
      const double m = value(*all.mass, i);
      const Vec3d v = vector(*all.velocity, i) - drift;
      (is_fluid ? layer.fluid : layer.grains).add(m, v);
      for (const auto& [name, a] : all.parts) {
        Tensor& sum = layer.parts.try_emplace(name, Tensor{}).first->second;
        for (int k = 0; k < 9; ++k) sum[k] += value(*a, 9 * i + k);
      }
      const bool turned = flow_.reversed() && z >= gap;
      const double s = (turned ? z - gap : z) / gap;
      layer.drive += value(*all.drive, 3 * i + flow_.along);
      (is_fluid ? layer.volume : layer.grain_volume) += value(*all.volume, i);
      if (!is_fluid) continue;
      layer.place += m * s, layer.place2 += m * s * s;
      if (s * gap < h_ || (1 - s) * gap < h_) continue;
      const double u = turned ? -v[flow_.along] : v[flow_.along];
      double power = m;
      for (int k = 0; k < 5; ++k, power *= s) {
        block.s[k] += power;
        if (k < 3) block.u[k] += power * u;
      }
    }
  };
  add(fluid, true);
  add(grains, false);
  block.stress += wall_stress;
  ++block.samples;
}

}  // namespace bedload
