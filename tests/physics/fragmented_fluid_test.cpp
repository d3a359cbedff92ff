// Fluid that has been fragmented and joins again.

#include <fstream>

#include "tests/boundaries/support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace BL_SOLVER {
namespace {

/// Height of water that begins `apart` spacings apart, over the height that its mass asks for, after `end` s.
double level(const std::string& density, double end, double apart = 1.1,
             const std::string& integrator = "kdk") {
  constexpr int n = 8, layers = 12;
  constexpr double dx = 0.01;
  const double gap = apart * dx, width = n * gap;
  const test::TemporaryFolder folder;
  std::ofstream table(folder / "fragments.csv");
  table << "x,y,z\n";
  for (int k = 0; k < n * n * layers; ++k)
    table << gap * (k % n + 0.5) << ',' << gap * (k / n % n + 0.5) << ',' << gap * (k / (n * n) + 0.5)
          << '\n';
  table.close();
  std::ostringstream text;
  text << "[domain]\nmin = [0, 0, -0.04]\nmax = [" << width << ", " << width
       << ", 0.25]\nperiodic = [true, true, false]\n[fluid]\ndx = " << dx
       << "\nvmax = 1.6\n[[fluid.fill]]\nfile = \"" << (folder / "fragments.csv").string()
       << "\"\n[visc]\nalpha = 0.02\n"
       << "[[wall.body]]\nname = \"floor\"\nshape = \"tank\"\nmin = [0, 0, 0]\nmax = [" << width << ", "
       << width << ", 0.18]\nfaces = [\"z-\"]\n[time]\nend = 1\nintegrator = \"" << integrator
       << "\"\n[out]\nevery = 1\n[density]\n"
       << density;
  auto s = started(text.str());
  run_until(*s, end);
  double sum = 0;
  for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) sum += x.z;
  return 2 * sum / (n * n * layers) / (n * n * layers * dx * dx * dx / (width * width));
}

TEST(FragmentedFluid, FillsItsVolumeAgain) {
  EXPECT_NEAR(level("", 0.6), 1, 0.03);
  EXPECT_GT(level("void_relaxation = 0", 0.6), 1.2) << "continuity alone keeps it apart";
}

TEST(FragmentedFluid, FallsTogetherFromAfarInOnePassAsInTwo) {
  const double two = level("", 0.5, 1.4), one = level("", 0.5, 1.4, "ab3");
  EXPECT_LT(two, 1.3);
  EXPECT_NEAR(one, two, 0.05);
}

}  // namespace
}  // namespace BL_SOLVER
