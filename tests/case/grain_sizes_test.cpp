#include "bedload/case/grain_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support.hpp"

namespace bedload::test {
namespace {

SizeClass uniform(double d_min, double d_max) {
  SizeClass s;
  s.kind = "uniform", s.d_min = d_min, s.d_max = d_max;
  return s;
}

SizeClass log_normal(double median, double sigma, double d_min, double d_max) {
  SizeClass s;
  s.kind = "log_normal", s.median = median, s.sigma = sigma, s.d_min = d_min, s.d_max = d_max;
  return s;
}

SizeClass sieve(std::vector<double> openings, std::vector<double> passing) {
  SizeClass s;
  s.kind = "sieve", s.openings = std::move(openings), s.passing = std::move(passing);
  return s;
}

double mean_cube(const std::vector<double>& d) {
  double sum = 0;
  for (const double x : d) sum += x * x * x;
  return sum / double(d.size());
}

/// Fraction of the mass of `d` in grains finer than `opening`.
double finer(const std::vector<double>& d, double opening) {
  double fine = 0, all = 0;
  for (const double x : d) (x < opening ? fine : all) += x * x * x;
  return fine / (fine + all);
}

TEST(GrainSizes, UniformQuantilesLieAtTheMiddlesOfEqualParts) {
  const auto d = quantiles(uniform(0.001, 0.003), 4);
  ASSERT_EQ(d.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(d[k], 0.00125 + 0.0005 * k, 1e-15);
  // the mean of d^3 between a and b is (b^4 - a^4) / (4 (b - a)); the middles miss a millionth of it
  EXPECT_NEAR(mean_cube(quantiles(uniform(0.001, 0.003), 1000)) / 1e-8, 1, 1e-6);
}

TEST(GrainSizes, LogNormalHasItsMedianAndMoments) {
  const double sigma = 0.3;
  const auto d = quantiles(log_normal(0.002, sigma, 1e-4, 0.1), 100001);
  EXPECT_NEAR(d[50000], 0.002, 1e-15);
  double mean = 0, square = 0;
  for (const double x : d)
    mean += std::log(x / 0.002) / 100001, square += std::pow(std::log(x / 0.002), 2) / 100001;
  EXPECT_NEAR(mean, 0, 1e-12);
  EXPECT_NEAR(std::sqrt(square), sigma, 1e-5);
  EXPECT_NEAR(mean_cube(d) / (8e-9 * std::exp(4.5 * sigma * sigma)), 1, 1e-4);
  EXPECT_TRUE(std::is_sorted(d.begin(), d.end()));
}

TEST(GrainSizes, LogNormalIsCutAtItsEnds) {
  const auto d = quantiles(log_normal(0.002, 0.5, 0.0015, 0.003), 10000);
  EXPECT_GT(d.front(), 0.0015);
  EXPECT_LT(d.front(), 0.001501);
  EXPECT_LT(d.back(), 0.003);
  EXPECT_GT(d.back(), 0.002999);
}

TEST(GrainSizes, ASieveCurveIsMetByMass) {
  const SizeClass s = sieve({0.001, 0.0014, 0.002, 0.0028}, {0, 0.25, 0.25, 1});
  const auto d = quantiles(s, 20000);
  EXPECT_NEAR(finer(d, 0.0014), 0.25, 1e-3);
  EXPECT_NEAR(finer(d, 0.002), 0.25, 1e-3);
  EXPECT_NEAR(finer(d, std::sqrt(0.002 * 0.0028)), 0.625, 1e-3);  // log-linear in between
  EXPECT_NEAR(finer(d, 0.0028), 1, 1e-12);
  for (const double x : d) EXPECT_TRUE(x < 0.0014 || x > 0.002) << x;
  EXPECT_TRUE(std::is_sorted(d.begin(), d.end()));
}

/// One grain has the median by number, which falls as d^-3 where mass is even over ln d.
TEST(GrainSizes, OneGrainOfASieveHasItsMedian) {
  const double median = 1 / std::cbrt(0.5 * (1 + 1.0 / 8));
  EXPECT_NEAR(quantiles(sieve({1, 2}, {0, 1}), 1)[0], median, 1e-12);
}

TEST(GrainSizes, RangeLeavesOutEmptyMeshes) {
  EXPECT_EQ(size_range(sieve({1, 2, 4, 8}, {0, 0, 1, 1})), (std::pair{2.0, 4.0}));
  EXPECT_EQ(size_range(uniform(1, 3)), (std::pair{1.0, 3.0}));
  EXPECT_EQ(size_range({0.5, 1}), (std::pair{0.5, 0.5}));
}

TEST(GrainSizes, EntriesMixByTheirNumberFractions) {
  SizeClass fine = uniform(0.001, 0.002);
  fine.number_fraction = 3;
  const auto d = diameters({{0.004, 1}, fine}, 1000);
  ASSERT_EQ(d.size(), 1000u);
  EXPECT_EQ(std::count(d.begin(), d.end(), 0.004), 250);
  EXPECT_NEAR(d.back(), 0.002, 1e-6);
  EXPECT_EQ(diameters({{0.004, 1}, fine}, 0).size(), 0u);
  EXPECT_EQ(diameters({{0.004, 1}, fine}, 1).size(), 1u);
}

TEST(GrainSizes, CountsReachTheVolumeWithTheGrainsDrawn) {
  const SizeClass s = log_normal(0.002, 0.4, 0.002 * std::exp(-1.2), 0.002 * std::exp(1.2));
  for (const double volume : {2e-6, 1e-4}) {
    const auto n = std::size_t(std::round(count_for_volume({s}, volume)));
    double total = 0;
    for (const double d : diameters({s}, n)) total += M_PI / 6 * d * d * d;
    EXPECT_NEAR(total, volume, M_PI / 6 * 8e-9 * 2.1) << n;  // within a mean grain
  }
}

TEST(GrainSizes, ResolveTheDiametersOfTheCase) {
  const auto with = [](const std::string& sizes) {
    return read(kCase, {"grain.fill.0.sizes=[" + sizes + "]"});
  };
  const Config c =
      with("{kind = \"log_normal\", median = 0.002, sigma = 0.2}, {d = 0.005, number_fraction = 0.1}");
  EXPECT_DOUBLE_EQ(c.grain.d_min, 0.002 * std::exp(-0.6));
  EXPECT_DOUBLE_EQ(c.grain.d_max, 0.005);
  EXPECT_DOUBLE_EQ(c.grain.fills[0].sizes[0].d_max, 0.002 * std::exp(0.6));
  EXPECT_TRUE(read(resolved_toml(c)) == c) << resolved_toml(c);
  const Config s = with("{kind = \"sieve\", openings = [0.001, 0.002, 0.003], passing = [0, 0.5, 1]}");
  EXPECT_DOUBLE_EQ(s.grain.d_min, 0.001);
  EXPECT_DOUBLE_EQ(s.grain.d_max, 0.003);
  EXPECT_TRUE(read(resolved_toml(s)) == s) << resolved_toml(s);
}

/// Of the grains of an entry, relative to others.
double mass(const std::vector<SizeClass>& sizes, std::size_t k) {
  double volume = 0;
  const auto d = quantiles(sizes[k], 10000);
  for (const double x : d) volume += x * x * x / double(d.size());
  return sizes[k].number_fraction * volume;
}

TEST(GrainSizes, MixByTheirMassFractions) {
  const std::string three =
      "grain.fill.0.sizes=[{d = 0.001, mass_fraction = 1}, {d = 0.004, mass_fraction = 2}, {kind = "
      "\"uniform\", "
      "d_min = 0.001, d_max = 0.002, mass_fraction = 3}]";
  const Config c = read(kCase, {three});
  const auto& sizes = c.grain.fills[0].sizes;
  EXPECT_NEAR(mass(sizes, 1) / mass(sizes, 0), 2, 1e-9);
  EXPECT_NEAR(mass(sizes, 2) / mass(sizes, 0), 3, 1e-4);
  EXPECT_TRUE(read(resolved_toml(c)) == c) << resolved_toml(c);
}

TEST(GrainSizes, HaveFractionsOfOneKind) {
  EXPECT_EQ(
      error_of(changed("count = 500", "count = 500\nsizes = [{d = 0.001, mass_fraction = 1}, {d = 0.004}]")),
      "dam.toml:21: grain.fill.sizes.mass_fraction must be given (mass of its grains relative to the "
      "other "
      "entries, as those have one)");
  EXPECT_EQ(error_of(changed("count = 500",
                             "count = 500\nsizes = [{d = 0.001, mass_fraction = 1, number_fraction = 1}]")),
            "dam.toml:21: grain.fill.sizes.number_fraction = 1 is not used by the chosen options; remove it");
}

TEST(GrainSizes, MaySpanAFactorOfAThousand) {
  const auto with = [](const std::string& largest) {
    return changed("count = 500",
                   "count = 5\n[[grain.fill.sizes]]\nkind = \"uniform\"\nd_min = 1e-6\nd_max = " + largest);
  };
  EXPECT_EQ(read(with("0.001")).grain.d_max, 0.001);
  EXPECT_NE(error_of(with("0.00101"))
                .find("1e-06..0.00101 m must span at most a factor of 1000 in diameter, not 1010"),
            std::string::npos);
}

TEST(GrainSizes, ErrorsNameTheEntryAtFault) {
  const auto error = [](const std::string& size) {
    return error_of(changed("count = 500", "count = 500\n[[grain.fill.sizes]]\n" + size));
  };
  EXPECT_EQ(
      error("kind = \"normal\""),
      "dam.toml:22: grain.fill.sizes.kind = \"normal\" must be one of class, uniform, log_normal, sieve");
  EXPECT_EQ(error("kind = \"uniform\"\nd_min = 0.002"),
            "dam.toml:21: grain.fill.sizes.d_max must be given (uniform, log_normal: largest diameter, m)");
  EXPECT_EQ(error("kind = \"uniform\"\nd_min = 0.002\nd_max = 0.001"),
            "dam.toml:24: grain.fill.sizes.d_max = 0.001 must be > 0.002");
  EXPECT_EQ(error("kind = \"uniform\"\nd_min = 0.002\nd_max = 0.003\nmedian = 0.002"),
            "dam.toml:25: grain.fill.sizes.median = 0.002 is not used by the chosen options; remove it");
  EXPECT_EQ(error("kind = \"log_normal\"\nmedian = 0.002\nsigma = 0.2\nd_min = 0.003"),
            "dam.toml:25: grain.fill.sizes.d_min = 0.003 must be > 0 and < 0.002");
  EXPECT_EQ(
      error("kind = \"sieve\"\nopenings = [0.001, 0.002]\npassing = [0, 100]"),
      "dam.toml:24: grain.fill.sizes.passing = [0, 100] must hold numbers within 0..1; give fractions, not "
      "percent?");
  EXPECT_EQ(error("kind = \"sieve\"\nopenings = [0.001, 0.002]\npassing = [0.1, 1]"),
            "dam.toml:24: grain.fill.sizes.passing = [0.1, 1] must begin with 0 and end with 1; add the "
            "meshes that "
            "stop and pass everything");
  EXPECT_EQ(error("kind = \"sieve\"\nopenings = [0.002, 0.001]\npassing = [0, 1]"),
            "dam.toml:23: grain.fill.sizes.openings = [0.002, 0.001] must rise from each to the next");
  EXPECT_EQ(
      error("kind = \"sieve\"\nopenings = [0.001, 0.002]\npassing = [0, 0.5, 1]"),
      "dam.toml:24: grain.fill.sizes.passing = [0, 0.5, 1] must hold a fraction for each of the 2 openings");
  EXPECT_EQ(
      error("kind = \"sieve\"\nopenings = [0.001, 0.002, 0.003]\npassing = [0, 1, 0.5]"),
      "dam.toml:24: grain.fill.sizes.passing = [0, 1, 0.5] must not fall from the finer mesh to the coarser");
  EXPECT_EQ(
      error("kind = \"log_normal\"\nmedian = 0.002\nsigma = 1.2"),
      "dam.toml:17: grain.fill = 5.465e-05..0.0732 m must span at most a factor of 1000 in diameter, not "
      "1339");
}

/// Two sizes of `ratio`, of which the fine ones have this fraction of the mass.
double densest_of_two(double ratio, double fine) {
  SizeClass large, small;
  large.d = 0.01, small.d = 0.01 / ratio;
  large.number_fraction = 1 - fine, small.number_fraction = fine * ratio * ratio * ratio;
  return densest_packing({large, small});
}

TEST(GrainSizes, UnlikeSizesPackDenser) {
  SizeClass one;
  one.d = 0.003;
  EXPECT_NEAR(densest_packing({one}), 0.64, 1e-12);
  // the fine ones fill the 36 % between the coarse ones by 64 %: 0.2304 / 0.8704 of the volume
  EXPECT_NEAR(densest_of_two(1e6, 0.2304 / 0.8704), 1 - 0.36 * 0.36, 1e-3);
  EXPECT_NEAR(densest_of_two(1e6, 0.1), 0.64 / 0.9, 1e-3) << "few fine ones between coarse ones that touch";
  EXPECT_NEAR(densest_of_two(1e6, 0.6), 0.64 / (1 - 0.36 * 0.4), 1e-3) << "coarse ones among fine ones";
  EXPECT_GT(densest_of_two(5, 0.3), densest_of_two(2, 0.3) + 0.03);
  EXPECT_GT(densest_of_two(2, 0.3), 0.64);
  const double wide = densest_packing({log_normal(0.002, 0.4, 0.0008, 0.005)});
  EXPECT_GT(wide, 0.65);
  EXPECT_LT(wide, 0.75);
}

}  // namespace
}  // namespace bedload::test
