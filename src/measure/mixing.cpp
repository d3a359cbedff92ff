// How well two kinds of grains are mixed.

#include <cmath>
#include <limits>

#include "bedload/case/materials.hpp"
#include "bedload/parallel/reductions.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kLeast = 5;  ///< grains of a cell that counts

/// A cell as a sample.
struct Sample {
  double grains = 0, of_kind = 0;
};

/// What a grain is for the probe, and sums over both kinds: number and place.
struct Kinds {
  enum Kind { outside, others, of_kind };
  Vec3d lo, hi;
  Span<const Vec3d> x;
  Span<const Real> radius;
  Span<const std::uint32_t> material;  ///< empty: all of the first
  std::uint32_t wanted;                ///< material; kNone: by diameter
  double larger_than;                  ///< m

  BL_HD Kind kind(Index i) const {
    for (int k = 0; k < 3; ++k)
      if (!(x[i][k] >= lo[k] && x[i][k] < hi[k])) return outside;
    if (wanted == kNone) return 2 * double(radius[i]) > larger_than ? of_kind : others;
    return (material ? material[i] : 0) == wanted ? of_kind : others;
  }
  BL_HD void operator()(Index i, double* out) const {
    const Kind is = kind(i);
    if (is == outside) return;
    double* const own = out + (is == of_kind ? 4 : 0);
    own[0] = 1;
    for (int k = 0; k < 3; ++k) own[1 + k] = x[i][k];
  }
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
  const GrainStore& grains = state_.grains;
  const std::vector<GrainMaterial> materials = config_.grain.all_materials();
  Kinds kinds{p.min, p.max,        grains.x.span(), grains.radius.span(), grains.material.span(),
              kNone, p.larger_than};
  for (std::uint32_t m = 0; !p.of.empty() && m < materials.size(); ++m)
    if (name_in_pairs(materials[m]) == p.of) kinds.wanted = m;
  const auto sum = sum_over<8>(grains.owned(), kinds);

  const std::vector<Vec3d> x = grains.x.values();
  const std::vector<Real> radius = grains.radius.values();
  const std::vector<std::uint32_t> material = grains.material.values();
  kinds.x = {x.data(), Index(x.size())};
  kinds.radius = {radius.data(), Index(radius.size())};
  kinds.material = {material.data(), Index(material.size())};
  std::array<std::size_t, 3> count;
  for (int k = 0; k < 3; ++k) count[k] = std::size_t(std::ceil((p.max[k] - p.min[k]) / p.cell));
  std::vector<Sample> samples(count[0] * count[1] * count[2]);
  for (Index i = 0; i < grains.owned().size(); ++i) {
    const Kinds::Kind kind = kinds.kind(i);
    if (kind == Kinds::outside) continue;
    std::array<std::size_t, 3> at;
    for (int k = 0; k < 3; ++k) at[k] = std::min(std::size_t((x[i][k] - p.min[k]) / p.cell), count[k] - 1);
    Sample& sample = samples[(at[2] * count[1] + at[1]) * count[0] + at[0]];
    sample.grains += 1, sample.of_kind += kind == Kinds::of_kind;
  }
  all_reduce(samples, [](Sample& into, const Sample& more) {
    into.grains += more.grains, into.of_kind += more.of_kind;
  });
  double used = 0;
  for (const Sample& s : samples) used += s.grains >= kLeast;
  const double *const others = sum.v, *const of_kind = sum.v + 4;
  std::vector<Quantity> out{{"lacey", "-", lacey_index(samples)},
                            {"cells", "-", used},
                            {"count", "-", of_kind[0]},
                            {"count_others", "-", others[0]}};
  for (const double* const kind : {of_kind, others})
    for (int k = 0; k < 3; ++k)
      out.push_back({std::string(kind == of_kind ? "centre_" : "centre_others_") + "xyz"[k], "m",
                     kind[0] > 0 ? kind[1 + k] / kind[0] : std::nan("")});
  return out;
}

}  // namespace BL_SOLVER
