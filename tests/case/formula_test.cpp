// Formulas of case files: what they come to, what is none.
#include "bedload/case/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bedload/core/error.hpp"

namespace bedload {
namespace {

constexpr Vec3d kAt{0.7, -1.3, 2.5};
constexpr double kTime = 0.4;

double value(const std::string& text) { return Formula(text, "xyzt")(kAt, kTime); }

std::string reason(const std::string& text) {
  try {
    (void)Formula(text, "xyzt");
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

TEST(Formula, BindsAsItIsWritten) {
  const auto [x, y, z] = kAt;
  const struct {
    std::string text;
    double value;
  } all[] = {{"1+2*3^2", 19},
             {"-2^2", -4},
             {"2^3^2", 512},
             {"2^-1*3", 1.5},
             {"8/4/2-1-1", -1},
             {"-(x - y)*z", -(x - y) * z},
             {" 1.5e1 * .5 ", 7.5},
             {"x < z == 1", 1},
             {"x > z || y < 0 && t > 1", 0},
             {"x <= 0.7 && y != 0", 1},
             {"x > 1 ? 10 : y >= 0 ? 20 : 30", 30},
             {"(x > 0.5 ? 2 : 1)*cos(3*t)", 2 * std::cos(3 * kTime)},
             {"x > 0 ? sqrt(x) : sqrt(-x)", std::sqrt(x)},
             {"2*pi + e", 2 * std::numbers::pi + std::numbers::e}};
  for (const auto& f : all) EXPECT_NEAR(value(f.text), f.value, 1e-14 * (1 + std::abs(f.value))) << f.text;
}

TEST(Formula, HasTheFunctionsThatAreListed) {
  const double x = kAt.x, y = kAt.y, t = kTime;
  const struct {
    std::string text;
    double value;
  } all[] = {{"sin(x)", std::sin(x)},
             {"cos(x)", std::cos(x)},
             {"tan(x)", std::tan(x)},
             {"asin(x)", std::asin(x)},
             {"acos(x)", std::acos(x)},
             {"atan(y)", std::atan(y)},
             {"sinh(y)", std::sinh(y)},
             {"cosh(y)", std::cosh(y)},
             {"tanh(y)", std::tanh(y)},
             {"asinh(y)", std::asinh(y)},
             {"acosh(z)", std::acosh(2.5)},
             {"atanh(t)", std::atanh(t)},
             {"exp(y)", std::exp(y)},
             {"ln(x)", std::log(x)},
             {"log(x)", std::log(x)},
             {"log2(x)", std::log2(x)},
             {"log10(x)", std::log10(x)},
             {"sqrt(z)", std::sqrt(2.5)},
             {"abs(y)", 1.3},
             {"sign(y)", -1},
             {"sign(0*x)", 0},
             {"rint(z)", 3},
             {"rint(y)", -1},
             {"atan2(x, y)", std::atan2(x, y)},
             {"min(x, y, z)", y},
             {"max(x, y, z)", 2.5},
             {"sum(x, y, z, t)", 2.3},
             {"avg(x, y, z, t)", 2.3 / 4},
             {"max(y)", y},
             {"avg(z)", 2.5}};
  for (const auto& f : all) EXPECT_NEAR(value(f.text), f.value, 1e-14) << f.text;
}

TEST(Formula, KnowsItsVariables) {
  const Formula f("t*sin(y)", "xyzt");
  EXPECT_TRUE(f.uses('y') && f.uses('t'));
  EXPECT_FALSE(f.uses('x') || f.uses('z'));
  EXPECT_EQ(Formula("2*t", "t")(3.0), 6);
  EXPECT_EQ(Formula("2*sin(pi/6)^2 + 1").steps().size(), 1u) << "numbers are worked out once";
}

TEST(Formula, SaysWhatIsWrong) {
  const struct {
    std::string text, reason;
  } all[] = {{"2*q", "Unexpected token \"q\" found at position 2"},
             {"2x", "Unexpected token \"x\" found at position 1"},
             {"sine(x)", "Unexpected token \"sine\" found at position 0"},
             {"x*(1+y))", "Unexpected token \")\" found at position 7"},
             {"x # y", "Unexpected token \"#\" found at position 2"},
             {"1e999", "Unexpected token \"1e999\" found at position 0"},
             {"", "it ends too soon"},
             {"3*", "it ends too soon"},
             {"sin(x", "it ends too soon"},
             {"sin x", "Unexpected token \"x\" found at position 4"},
             {"sin(x, y)", "sin is of 1, not of 2"},
             {"atan2(x)", "atan2 is of 2, not of 1"},
             {"0,05*x", "it makes 2 values; is a decimal comma meant as a point?"},
             {"x = 3", "= assigns; == compares"},
             {std::string(100000, '(') + "x", "it is nested too deeply"},
             {std::string(100000, '-') + "x", "it is nested too deeply"}};
  for (const auto& f : all) EXPECT_EQ(reason(f.text), f.reason) << f.text.substr(0, 20);
  std::string pieces = "0";
  for (int k = 0; k < 70; ++k)
    pieces = "x > " + std::to_string(k) + " ? " + std::to_string(k) + " : " + pieces;
  EXPECT_EQ(reason(pieces), "it is nested too deeply") << "more than the stack holds";
}

}  // namespace
}  // namespace bedload
