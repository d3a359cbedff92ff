// drive.factor where particles are: kernels come to what the host does.
#include <gtest/gtest.h>

#include "src/fluid/drive_field.hpp"
#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

struct FactorOf {
  DriveField drive;
  Span<double> out;
  BL_HD void operator()(Index i) const { out[i] = drive.at(i, {}).x; }
};

TEST(DriveFactorSmall, IsTheFormulaOfTheHost) {
  const Frame frame{{-1, -1, -1}, {1, 1, 1}, true, true, true};
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec3d> x(300);
  for (Vec3d& at : x) at = {u(rng), u(rng), u(rng)};
  std::vector<Vec3d> images = x;  // a step may take particles beyond the domain's edge
  for (std::size_t a = 0; a < x.size(); ++a) images[a].x += a % 2 ? 2 : -2;
  Buffer<Vec3d> places;
  places.assign(images);
  Buffer<double> out(x.size());

  for (const std::string text :
       {"x", "-y + 2*z - x/4", "x^2 + abs(y)^1.5 - 2^z", "sin(3*x)*cos(2*y) + tan(z)",
        "asin(x) + acos(y) - atan(3*z)", "sinh(x)*cosh(y) + tanh(z)",
        "asinh(x) + acosh(2 + y) + atanh(0.9*z)", "exp(x)*ln(2 + y) + log2(2 + z) - log10(3 + x)",
        "sqrt(abs(x)) + sign(y) + rint(5*z)",
        "atan2(x, y) + min(x, y, z) - max(x, 0) + sum(x, y) * avg(y, z)",
        "x < y ? (x <= 0) + (y >= 0.5) : z > 0 && x != y || x == 0.25", "sin(2*pi*(x - 3*t))",
        "x < -0.5 ? 1 : x < 0 ? 2 - t : x < 0.5 ? 3*t : 4"}) {
    DriveConfig drive;
    drive.f = {1, 0, 0}, drive.factor = text;
    const Formula formula(text, "xyzt");
    DriveFactor factor(drive);
    for (const double t : {0.0, 0.37}) {
      for_each({0, Index(x.size())}, FactorOf{factor.field<Vec3d>(drive, frame, places, t), out});
      const auto found = out.to_host();
      for (std::size_t a = 0; a < x.size(); ++a)
        ASSERT_NEAR(found[a], formula(x[a], t), 1e-6 * (1 + std::abs(found[a]))) << text;
    }
  }
}

}  // namespace
}  // namespace BL_SOLVER
