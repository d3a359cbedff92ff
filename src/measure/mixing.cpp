// How well two kinds of grains are mixed.

#include <cmath>
#include <limits>

#include "bedload/case/materials.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kLeast = 5;  ///< grains of a cell that counts

/// A cell as a sample.
struct Sample {
  double grains = 0, of_kind = 0;
};

/// Lacey's index [lacey54]: (S0^2 - S^2) / (S0^2 - Sr^2), S^2 the variance of the fraction of one kind over
/// samples by their number of grains, S0^2 = p (1 - p) apart, Sr^2 = S0^2 / n at random. NaN without samples
/// of both kinds.
double lacey_index(const std::vector<Sample>& samples) {
  double number = 0, of_kind = 0, used = 0;
  for (const Sample& s : samples)
    if (s.grains >= kLeast) number += s.grains, of_kind += s.of_kind, used += 1;
  const double p = of_kind / number, apart = p * (1 - p);
  if (number == 0 || apart == 0) return std::numeric_limits<double>::quiet_NaN();
  double variance = 0;
  for (const Sample& s : samples)
    if (s.grains >= kLeast) variance += s.grains * square(s.of_kind / s.grains - p);
  return (apart - variance / number) / (apart - apart * used / number);
}

}  // namespace

std::vector<Quantity> CoupledSimulation::mixing(const ProbeConfig& p) {
  const std::vector<Vec3d> x = state_.grains.x.values();
  const std::vector<Real> radius = state_.grains.radius.values();
  const std::vector<GrainMaterial> materials = config_.grain.all_materials();
  const std::vector<std::uint32_t> material =
      materials.size() > 1 ? state_.grains.material.values() : std::vector<std::uint32_t>(x.size(), 0);
  std::array<std::size_t, 3> count;
  for (int k = 0; k < 3; ++k) count[k] = std::size_t(std::ceil((p.max[k] - p.min[k]) / p.cell));
  std::vector<Sample> samples(count[0] * count[1] * count[2]);
  Vec3d centre[2];
  double number[2] = {};
  for (std::size_t i = 0; i < x.size(); ++i) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside = inside && x[i][k] >= p.min[k] && x[i][k] < p.max[k];
    if (!inside) continue;
    const bool of_kind =
        p.of.empty() ? 2 * double(radius[i]) > p.larger_than : name_in_pairs(materials[material[i]]) == p.of;
    std::array<std::size_t, 3> at;
    for (int k = 0; k < 3; ++k) at[k] = std::min(std::size_t((x[i][k] - p.min[k]) / p.cell), count[k] - 1);
    Sample& sample = samples[(at[2] * count[1] + at[1]) * count[0] + at[0]];
    sample.grains += 1, sample.of_kind += of_kind;
    centre[of_kind] += x[i], number[of_kind] += 1;
  }
  double used = 0;
  for (const Sample& s : samples) used += s.grains >= kLeast;
  std::vector<Quantity> out{{"lacey", "-", lacey_index(samples)},
                            {"cells", "-", used},
                            {"count", "-", number[1]},
                            {"count_others", "-", number[0]}};
  for (const int kind : {1, 0})
    for (int k = 0; k < 3; ++k)
      out.push_back({std::string(kind ? "centre_" : "centre_others_") + "xyz"[k], "m",
                     number[kind] > 0 ? centre[kind][k] / number[kind] : std::nan("")});
  return out;
}

}  // namespace BL_SOLVER
