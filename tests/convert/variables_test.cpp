#include "src/convert/variables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bedload/core/error.hpp"

namespace bedload::test {
namespace {

TEST(Variables, AreReplacedInExpressions) {
  Variables v;
  v.set("Dp", 0.02), v.set("SizeX", -1.5), v.set("e", 3);
  const auto is = [&](const char* text, double expected) {
    EXPECT_NEAR(v.value(text), expected, 1e-14) << text;
  };
  is("0.1", 0.1);
  is(" 1e-3*2", 2e-3);
  is("Dp*2", 0.04);
  is("2-SizeX", 3.5);
  is("SizeX^2", 2.25);
  is("max(Dp, abs(SizeX), 1)", 1.5);
  is("pow(2, 10)/2", 512);
  is("cosdg(60) + sindg(30)", 1);
  is("2*pi()", 2 * std::numbers::pi);
  is("eval(Dp<0.1, floor(2.7), ceil(2.2))", 2);
  is("e", 3);
  is("round(sqrt(Dp*5000))", 10);
}

TEST(Variables, SayWhatIsWrong) {
  const Variables v;
  const auto why = [&](const std::string& text) {
    try {
      v.value(text);
    } catch (const CaseError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(why("2*Width"), "names Width, which has no value");
  EXPECT_EQ(why("max(1, 2"), "has a bracket that does not close");
  EXPECT_EQ(why("pow(2)"), "calls pow with 1 values");
  EXPECT_EQ(why("1/0"), "has no finite value");
  EXPECT_EQ(why(""), "is empty");
  EXPECT_EQ(why(std::string(100, '(') + std::string(100, ')')).find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace bedload::test
