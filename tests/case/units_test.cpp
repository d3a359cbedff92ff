// Values with units of their own.

#include <gtest/gtest.h>

#include <numbers>

#include "bedload/case/parameters.hpp"
#include "bedload/core/error.hpp"
#include "src/case/units.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

TEST(Units, DecimalOnesGiveTheNumberThatTheDigitsWould) {
  for (const char* text :
       {"2.7 mm", "2.7mm", " 0.27 cm", "2700 um", "2700 \u00b5m", "0.0027 m", "2.7e-3 m", "27e-1 mm"})
    EXPECT_EQ(quantity(text, "m"), 0.0027) << text;
  EXPECT_EQ(quantity("-7 kPa", "Pa"), -7000);
  EXPECT_EQ(quantity("+1.1 bar", "Pa"), 1.1e5);
  EXPECT_EQ(quantity("70 GPa", "Pa"), 70e9);
  EXPECT_EQ(quantity("2.65 g/cm3", "kg/m3"), 2650);
  EXPECT_EQ(quantity("2.65 t/m^3", "kg/m3"), 2650);
  EXPECT_EQ(quantity("0.89 mPa s", "Pa s"), 0.89e-3);
  EXPECT_EQ(quantity("0.89 cP", "Pa s"), 0.89e-3);
  EXPECT_EQ(quantity("0.89e-3 N s m-2", "Pa s"), 0.89e-3);
  EXPECT_EQ(quantity("981 cm/s/s", "m/s2"), 9.81);
  EXPECT_EQ(quantity("0e2147483647 km", "m"), 0);
  EXPECT_EQ(quantity("1 kHz", "Hz"), 1000);
  EXPECT_EQ(quantity("20 1/ms", "1/s"), 20000);
  EXPECT_EQ(quantity("3 kg*mm^2", "kg m2"), 3e-6);
}

TEST(Units, OthersAreConverted) {
  EXPECT_DOUBLE_EQ(quantity("90 rpm", "rad/s"), 3 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("180 deg/s", "rad/s"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("0.5 rev", "deg"), 180);
  EXPECT_DOUBLE_EQ(quantity("100 ml/min", "m3/s"), 1e-4 / 60);
  EXPECT_DOUBLE_EQ(quantity("3.6 t/h", "kg/s"), 1);
  EXPECT_DOUBLE_EQ(quantity("1 in", "m"), 0.0254);
}

std::string why(const char* text, const char* unit) {
  try {
    (void)quantity(text, unit);
  } catch (const CaseError& error) {
    return error.what();
  }
  return "taken";
}

TEST(Units, WhatDoesNotFitIsRefused) {
  EXPECT_EQ(why("3 kg", "m"), "kg is no unit of that kind");
  EXPECT_EQ(why("90 rpm", "Hz"), "rpm is no unit of that kind");
  EXPECT_EQ(why("1.5 Hz", "rad/s"), "Hz is no unit of that kind");
  EXPECT_EQ(why("3 furlong", "m"), "\"furlong\" is no unit");
  EXPECT_EQ(why("3 mmm", "m"), "\"mmm\" is no unit");
  EXPECT_EQ(why("3 kmin", "s"), "\"kmin\" is no unit");
  EXPECT_EQ(why("3 m/", "m"), "\"m/\" is no unit");
  EXPECT_EQ(why("3 m0", "m"), "\"m0\" is no unit");
  EXPECT_EQ(why("3 m99", "m"), "\"m99\" is no unit");
  EXPECT_EQ(why("mm", "m"), "it does not begin with a number");
  EXPECT_EQ(why("", "m"), "it does not begin with a number");
  EXPECT_EQ(why("nan mm", "m"), "it does not begin with a number");
  EXPECT_EQ(why("0,3 mm", "m"), "\",3 mm\" is no unit");
  EXPECT_EQ(why("3", "m"), "it has no unit; a bare number stands without quotes");
}

TEST(Units, EveryUnitOfTheParametersIsKnown) {
  int with_units = 0;
  for (const ParameterRow& row : parameter_table()) {
    if (!takes_units(row.unit)) continue;
    ++with_units;
    EXPECT_EQ(quantity("3 " + row.unit, row.unit), 3) << row.key;
  }
  EXPECT_GT(with_units, 80);
}

TEST(Units, StandInCasesListsAndOverrides) {
  EXPECT_EQ(read(changed("dx = 0.004", "dx = \"4 mm\"")).fluid.dx, 0.004);
  EXPECT_EQ(read(changed("max = [0.2, 0.1, 0.2]\n[fluid]", "max = [\"20 cm\", 0.1, \"200mm\"]\n[fluid]"))
                .domain.max,
            (Vec3d{0.2, 0.1, 0.2}));
  EXPECT_EQ(read(kCase, {"fluid.dx=4mm"}).fluid.dx, 0.004);
  EXPECT_EQ(read(kCase, {"fluid.dx=\"4 mm\""}).fluid.dx, 0.004);
  EXPECT_EQ(read(kCase, {"time.end=300 ms"}).time.end, 0.3);
  EXPECT_EQ(error_of(kCase, {"grain.mu=50mm"}), "--set grain.mu=50mm: grain.mu = \"50mm\" must be a number");
  EXPECT_EQ(error_of(kCase, {"time.end=300 mm"}),
            "--set time.end=300 mm: time.end = \"300 mm\" must be a number in s, or in quotes with another "
            "unit; mm "
            "is no unit of that kind");
}

}  // namespace
}  // namespace bedload::test
