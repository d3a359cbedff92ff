#pragma once
// Whole simulations of this build, from a Config made in code.

#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <bit>

#include "bedload/geometry/setup.hpp"
#include "bedload/parallel/link.hpp"
#include "bedload/simulation.hpp"
#include "tests/support/fluid_box.hpp"

namespace BL_SOLVER {

std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup, Link* link = nullptr);

inline std::unique_ptr<Simulation> started(const Config& config, const Setup& setup) {
  auto simulation = make_coupled(config, setup);
  simulation->start();
  return simulation;
}
inline std::unique_ptr<Simulation> started(const Config& config) {
  std::vector<std::string> warnings;
  return started(config, build_setup(config, warnings));
}

inline void run_until(Simulation& s, double t) {
  while (s.time() < t) s.step();
}

inline double reading(const std::vector<Quantity>& rows, const std::string& name) {
  for (const auto& q : rows)
    if (q.name == name) return q.value;
  ADD_FAILURE() << "no quantity " << name;
  return 0;
}

/// A snapshot's array as vectors of three, in the order of ids.
inline std::vector<Vec3d> vectors(const HostStore& store, const std::string& name) {
  const HostArray& a = *store.find(name);
  const auto* id = store.find("id")->as<std::uint32_t>();
  std::vector<Vec3d> out(store.count);
  for (std::size_t i = 0; i < store.count; ++i)
    for (int k = 0; k < 3; ++k)
      out[id[i]][k] = a.type == Scalar::f64 ? a.as<double>()[3 * i + k] : a.as<float>()[3 * i + k];
  return out;
}
inline std::vector<double> scalars(const HostStore& store, const std::string& name) {
  const HostArray& a = *store.find(name);
  const auto* id = store.find("id")->as<std::uint32_t>();
  std::vector<double> out(store.count);
  for (std::size_t i = 0; i < store.count; ++i)
    out[id[i]] = a.type == Scalar::f64 ? a.as<double>()[i] : a.as<float>()[i];
  return out;
}

/// The straight line through points by least squares.
class LineFit {
 public:
  void add(double x, double y) { n_ += 1, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y; }
  double slope() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }
  double at_zero() const { return (y_ - slope() * x_) / n_; }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

/// Through the pressure (Pa) over the height z of fluid particles between two heights (m).
inline LineFit pressure_line(Simulation& s, double from, double to) {
  LineFit line;
  const auto store = s.snapshot("fluid");
  const auto x = vectors(store, "position");
  const auto p = scalars(store, "pressure");
  for (std::size_t a = 0; a < x.size(); ++a)
    if (x[a].z >= from && x[a].z <= to) line.add(x[a].z, p[a]);
  return line;
}

/// Every bit of the kept state, numbers included.
inline std::vector<std::byte> bits(Simulation& s) {
  std::vector<std::byte> out;
  const SavedState state = s.save();
  for (const auto& store : state.stores)
    for (const auto& a : store.arrays) out.insert(out.end(), a.bytes.begin(), a.bytes.end());
  for (const Quantity& q : state.scalars) {
    const auto raw = std::bit_cast<std::array<std::byte, sizeof q.value>>(q.value);
    out.insert(out.end(), raw.begin(), raw.end());
  }
  return out;
}

/// Of two runs of so many steps, one with a thread and one with three.
inline void expect_same_on_any_number_of_threads(const Config& config, int steps) {
  std::vector<std::byte> all[2];
  const int most = omp_get_max_threads();
  for (const int threads : {1, 3}) {
    omp_set_num_threads(threads);
    auto s = started(config);
    for (int k = 0; k < steps; ++k) s->step();
    all[threads / 2] = bits(*s);
  }
  omp_set_num_threads(most);
  EXPECT_EQ(all[0], all[1]);
}

}  // namespace BL_SOLVER
