// Stress by contacts: without walls the sum of F r over pairs is that of force times place over grains.

#include <random>

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

TEST(SmallContactStress, OfPairsIsWhatForcesOnGrainsComeTo) {
  GrainBench b;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 64; ++i) {  // neighbours overlap, by up to a tenth
    const Vec3d place{i % 4 + 0.0, i / 4 % 4 + 0.0, i / 16 + 0.0};
    b.add(0.95 * b.config.grain.d * place + Vec3d{unit(random), unit(random), unit(random)} * 6e-5,
          {unit(random), unit(random), unit(random)}, {50 * unit(random), 50 * unit(random), 0});
  }
  b.start();
  std::array<double, 9> pairs{}, grains{};
  Buffer<PairMoment<>> moments;
  b.solver->contact_moments(*b.grains, moments);
  for (const PairMoment<>& one : moments.to_host())
    for (int k = 0; k < 9; ++k) pairs[k] += double(one.row[k / 3][k % 3]);
  const auto x = b.grains->x.values();
  const auto force = b.grains->force.values();
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 9; ++k) grains[k] += double(force[i][k / 3]) * x[i][k % 3];
  for (const double value : grains) size = std::max(size, std::abs(value));
  ASSERT_GT(size, 1e-3);
  EXPECT_GT(std::abs(grains[1]), 1e-4 * size) << "friction shears";
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(pairs[k], grains[k], 100 * kInvariant * size) << k;
}

}  // namespace
}  // namespace BL_SOLVER
