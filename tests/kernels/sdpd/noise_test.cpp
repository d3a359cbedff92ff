// Random numbers of pairs.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "kernels/sdpd/pair_law.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

void expect_words(const Words& w, std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t u) {
  EXPECT_EQ(w.x, x);
  EXPECT_EQ(w.y, y);
  EXPECT_EQ(w.z, z);
  EXPECT_EQ(w.w, u);
}

TEST(Noise, PhiloxGivesThePublishedWords) {  // known answers of Salmon et al.
  expect_words(philox({0, 0, 0, 0}, 0, 0), 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8);
  expect_words(philox({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u), 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd);
  expect_words(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0), 0xd16cfe09,
               0x94fdcceb, 0x5001e420, 0x24126ea1);
}

TEST(Noise, DeviatesAreThoseOfTheFormula) {
  for (std::uint32_t k = 0; k < 100000; ++k) {
    const std::uint32_t r = k * 2654435761u + 1, a = k * 2246822519u + 3;
    const double radius = std::sqrt(-2 * std::log((r + 0.5) * 0x1p-32)), angle = 2 * M_PI * a * 0x1p-32;
    const Normals n = normals(r, a);
    ASSERT_NEAR(n.a, radius * std::cos(angle), 3e-6);
    ASSERT_NEAR(n.b, radius * std::sin(angle), 3e-6);
  }
  EXPECT_LT(std::abs(normals(0, 0).a), 6.8);
  EXPECT_EQ(normals(~0u, 0).a, 0);
}

struct DrawPass {
  Span<Vec3f> out;
  BL_HD void operator()(Index a) const { out[a] = odd_normals({17, a * 40503ull}, a, a * 7 + 1); }
};

/// The bits of some deviates, as every build and device must have them.
TEST(Noise, BitsAreTheSameInEveryBuild) {
  Buffer<Vec3f> drawn(1000);
  for_each({0, 1000}, DrawPass{drawn});
  std::uint32_t sum = 0;
  for (const Vec3f& x : drawn.to_host())
    for (int k = 0; k < 3; ++k) sum = sum * 31 + std::bit_cast<std::uint32_t>(x[k]);
  EXPECT_EQ(sum, 3691539163u);
}

TEST(Noise, IsOddOrEvenInThePair) {  // T-13
  const NoiseKey key{5, 1234567890123ull};
  for (Id a : {0u, 3u, 70000u, 4000000000u})
    for (Id b : {1u, 65536u, 80000u}) {
      const Vec3f ab = odd_normals(key, a, b), ba = odd_normals(key, b, a);
      EXPECT_EQ(ab, -ba);
      const auto s = even_normals(key, a, b), t = even_normals(key, b, a);
      EXPECT_EQ(s.xy, t.xy);
      EXPECT_EQ(s.zz, t.zz);
      EXPECT_EQ(as_id(row_id(a)), a);
      if (a < 0x7f800000u) {
        EXPECT_EQ(as_id(as_label(a)), a);
      }
    }
}

#if !BL_CUDA
TEST(Noise, PacksHaveTheDeviatesOfTheirPairs) {  // T-13
  const NoiseKey key{5, 77};
  const Id row = 123457;
  Pack label;
  std::vector<Id> ids;
  for (int l = 0; l < kLanes; ++l) {
    ids.push_back(Id(l % 2 ? 90 + l : 2000000 + l));
    const Real one = as_label(ids.back());
    std::memcpy(reinterpret_cast<char*>(&label) + l * sizeof(Real), &one, sizeof one);
  }
  const RowId<Real> id = row_id(row);
  const auto x = odd_normals(key, RowId<Pack>{Pack(id.low), Pack(id.high)}, label);
  const auto s = even_normals(key, RowId<Pack>{Pack(id.low), Pack(id.high)}, label);
  for (int l = 0; l < kLanes; ++l) {
    const Vec3f one = odd_normals(key, row, ids[l]);
    EXPECT_EQ(x.x.v[l], one.x);
    EXPECT_EQ(x.y.v[l], one.y);
    EXPECT_EQ(x.z.v[l], one.z);
    EXPECT_EQ(s.yz.v[l], even_normals(key, row, ids[l]).yz);
  }
}
#endif

TEST(Noise, MomentsAndCorrelations) {  // T-14, five standard errors
  constexpr int n = 1000000;
  double sum[5] = {}, axes = 0, steps = 0, pairs = 0, seeds = 0;
  for (int k = 0; k < n; ++k) {
    const Id a = Id(k % 1000), b = Id(1000 + k / 1000);
    const Vec3f x = odd_normals({1, 10}, a, b);
    const double v = x.x;
    for (int p = 1; p <= 4; ++p) sum[p] += std::pow(v, p) / n;
    axes += v * x.z / n;
    steps += v * odd_normals({1, 11}, a, b).x / n;
    pairs += v * odd_normals({1, 10}, a, b + 1).x / n;
    seeds += v * odd_normals({2, 10}, a, b).x / n;
  }
  const double sigma = 1 / std::sqrt(double(n));
  EXPECT_NEAR(sum[1], 0, 5 * sigma);
  EXPECT_NEAR(sum[2], 1, 5 * sigma * std::sqrt(2));
  EXPECT_NEAR(sum[3], 0, 5 * sigma * std::sqrt(15));
  EXPECT_NEAR(sum[4], 3, 5 * sigma * std::sqrt(96));
  for (double correlation : {axes, steps, pairs, seeds}) EXPECT_NEAR(correlation, 0, 5 * sigma);
}

/// Covariance of the noise of one pair against 2 kT / dt (c1 P + c2 e e), by vector and by tensor.
TEST(Noise, BalancesFriction) {
  for (const bool tensor : {false, true}) {
    PairLaw law;
    law.across = 3, law.along = 5, law.tensor = tensor;
    const double kT = 0.7, dt = 0.01;
    law.thermal = Real(2 * kT / dt);
    const Real3 r{Real(0.3), Real(-0.5), Real(0.2)};
    const Real g = Real(0.25);
    double covariance[3][3] = {};
    constexpr int n = 400000;
    for (int k = 0; k < n; ++k) {
      law.key = {3, std::uint64_t(k)};
      const Real3 F = law.noise(g, row_id(8), as_label(4), r, norm2(r));
      const Real3 back = law.noise(g, row_id(4), as_label(8), -r, norm2(r));
      ASSERT_EQ(F, -back);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) covariance[i][j] += double(F[i]) * F[j] / n;
    }
    for (int j = 0; j < 3; ++j) {
      Real3 v{};
      v[j] = 1;
      const Real3 stopped = -law.friction(g, v, Real3{}, r, norm2(r));
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(covariance[i][j], 2 * kT / dt * stopped[i], 5 * 2 * kT / dt * 1.25 * std::sqrt(2.0 / n))
            << i << j << tensor;
    }
  }
}

TEST(Noise, FrictionOfAPairByHand) {
  PairLaw law;
  law.across = 3, law.along = 5;
  const Real3 r{2, 0, 0}, F = law.friction(Real(0.5), Real3{1, 4, 0}, Real3{0, -1, 2}, r, Real(4));
  EXPECT_NEAR(F.x, -0.5 * 5 * 1, 1e-6);
  EXPECT_NEAR(F.y, -0.5 * 3 * 3, 1e-6);
  EXPECT_NEAR(F.z, -0.5 * 3 * 2, 1e-6);
}

}  // namespace
}  // namespace BL_SOLVER
