// Coarse-grained fields of the grains.

#include <algorithm>
#include <cmath>
#include <utility>

#include "bedload/parallel/reductions.hpp"
#include "kernels/stress/coarse_fields.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

constexpr const char* kVector[] = {"x", "y", "z"};
constexpr const char* kSymmetric[] = {"xx", "xy", "xz", "yy", "yz", "zz"};
constexpr const char* kTensor[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};

/// Unit vectors across the spans stand for those that are missing.
FieldPoints points_of_field(const ProbeConfig& p, const Frame& frame) {
  FieldPoints points{.frame = frame, .at = p.at, .step = {}, .dual = {}, .count = {1, 1, 1}};
  Vec3d* const e = points.step;
  for (std::size_t k = 0; k < p.span.size(); ++k) {
    points.count[k] = int(p.count[k]);
    e[k] = (1 / (p.count[k] - 1)) * p.span[k];
  }
  if (p.span.empty()) e[0] = {1, 0, 0};
  if (p.span.size() < 2) {
    const Vec3d axis = std::abs(e[0].x) < 0.9 * norm(e[0]) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    e[1] = cross(e[0], axis), e[1] *= 1 / norm(e[1]);
  }
  if (p.span.size() < 3) e[2] = cross(e[0], e[1]), e[2] *= 1 / norm(e[2]);
  const double volume = dot(cross(e[0], e[1]), e[2]);
  for (int k = 0; k < 3; ++k) points.dual[k] = (1 / volume) * cross(e[(k + 1) % 3], e[(k + 2) % 3]);
  return points;
}

void add_up(WideSum& into, const WideSum& more) {
  const std::uint64_t before = into.low;
  into.low += more.low;
  into.high += more.high + (into.low < before ? 1 : 0);
}

/// What the sums at a point say, their values by kernel.
void report(const double* sum, const std::string& suffix, std::vector<Quantity>& out) {
  using T = CoarseTerms;
  const double density = sum[T::kMass], none = std::nan("");
  const auto add = [&](const std::string& name, const char* unit, double value) {
    out.push_back({name + suffix, unit, value});
  };
  double v[3], kinetic[6];
  for (int k = 0; k < 3; ++k) v[k] = density > 0 ? sum[T::kMomentum + k] / density : none;
  for (int a = 0, k = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++k) kinetic[k] = density > 0 ? density * v[a] * v[b] - sum[T::kFlow + k] : 0;
  add("solid_fraction", "-", sum[T::kVolume]);
  add("density", "kg/m3", density);
  for (int k = 0; k < 3; ++k) add(std::string("velocity_") + kVector[k], "m/s", v[k]);
  add("granular_temperature", "m2/s2",
      density > 0 ? -(kinetic[0] + kinetic[3] + kinetic[5]) / (3 * density) : none);
  for (int k = 0; k < 9; ++k) add(std::string("contact_stress_") + kTensor[k], "Pa", sum[T::kStress + k]);
  for (int k = 0; k < 6; ++k) add(std::string("kinetic_stress_") + kSymmetric[k], "Pa", kinetic[k]);
  for (int k = 0; k < 6; ++k) add(std::string("fabric_") + kSymmetric[k], "-", sum[T::kFabric + k]);
}

}  // namespace

std::vector<double> CoupledSimulation::field_sums(const ProbeConfig& p) {
  constexpr int kSums = CoarseTerms::kSums;
  const GrainStore& g = state_.grains;
  const FieldPoints points = points_of_field(p, state_.frame);
  const CoarseKernel kernel(p.radius);
  const Clumps& clumps = std::as_const(stepper_).solids().clumps();
  const CoarseTerms terms{std::as_const(stepper_).solids().actions(g, state_.poses_now()),
                          state_.matter.of(g), state_.matter.volume_of(g),
                          clumps.any() ? clumps.view() : ClumpView{}};
  const LargestTerms largest{terms};
  const auto most = all_reduce(reduce(g.owned(), largest),
                               [&](auto& into, const auto& of_rank) { largest.combine(into, of_rank); });
  SpreadPass spread{.terms = terms, .kernel = kernel, .points = points, .scale = {}, .sums = nullptr};
  double unit[kSums];
  for (int k = 0; k < kSums; ++k) {  // of less than 2^31 units, here of 2^61
    const detail::SumUnit of(most.v[k] < 1e300 ? most.v[k] * kernel.most : most.v[k]);
    spread.scale[k] = std::ldexp(of.scale, 30), unit[k] = std::ldexp(of.unit, -30);
  }
  const std::size_t n = std::size_t(points.count[0]) * points.count[1] * points.count[2];
  Buffer<WideSum> sums(n * kSums);
  sums.zero();
  spread.sums = sums.data();
  for_each(g.owned(), spread);
  std::vector<WideSum> found = sums.to_host();
  all_reduce(found, add_up);
  std::vector<double> out;
  for (std::size_t k = 0; k < n * kSums; ++k) out.push_back(found[k].value() * unit[k % kSums]);
  return out;
}

std::vector<Quantity> CoupledSimulation::field(const ProbeConfig& p) {
  std::vector<double> sums = field_means_.mean(p.name);
  if (sums.empty()) sums = field_sums(p);
  std::vector<Quantity> out;
  for (std::size_t i = 0; i * CoarseTerms::kSums < sums.size(); ++i)
    report(&sums[i * CoarseTerms::kSums], p.span.empty() ? "" : "_" + std::to_string(i), out);
  return out;
}

void CoupledSimulation::sample_fields() {
  field_means_.sample(state_.clock.time, [&](const std::string& name) {
    stepper_.share_all();
    const auto probe = std::find_if(config_.out.probes.begin(), config_.out.probes.end(),
                                    [&](const ProbeConfig& p) { return p.name == name; });
    return field_sums(*probe);
  });
}

}  // namespace BL_SOLVER
