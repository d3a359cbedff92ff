// `bedload drag` from outside.

#include "bedload/case/drag_table.hpp"
#include "bedload/case/read.hpp"
#include "cli/random_spheres.hpp"
#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

using Drag = ProgramTest;

/// A simple cubic array at a solid fraction of 0.216, where the drag with the mean pressure gradient is 7.442
/// times that of a sphere alone [zick82]: the table has it without, over the slip between the spheres.
TEST_F(Drag, WritesATableThatCasesRead) {
  const std::string command =
      "drag --backend cpu --array simple --fractions 0.216 --reynolds 0.05 --nodes 8 --out table.toml";
  const Outcome o = bedload(command);
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("K / (3 pi mu d)"), o.out.npos) << o.out;

  std::vector<std::string> warnings;
  const Config config =
      read_case_text(small_dam() + "[time]\nend = 1\n[out]\nevery = 1\n" + content_of(dir_ / "table.toml"),
                     "dam.toml", {}, warnings);
  const DragTable& table = config.couple.table;
  EXPECT_EQ(config.couple.drag, DragLaw::table);
  EXPECT_EQ(table.reynolds, (std::vector<double>{0, 0.05}));
  ASSERT_EQ(table.porosity.size(), 2u);
  EXPECT_NEAR(table.porosity[0], 0.784, 1e-9);
  ASSERT_EQ(table.factor.size(), 4u);
  EXPECT_NEAR(table.factor[0] / (7.442 * 0.784 * 0.784), 1, 0.03);
  EXPECT_EQ(table.factor[0], table.factor[1]);
  EXPECT_NEAR(table.factor[3], 1 + 0.15 * std::pow(0.05, 0.687), 1e-4);

  // the same beside the laws
  std::istringstream points(content_of(dir_ / "table.csv"));
  std::string line, names;
  while (std::getline(points, names) && names.starts_with("#")) {
  }
  ASSERT_TRUE(names.ends_with(",stokes")) << names;
  ASSERT_TRUE(std::getline(points, line));
  double fraction = 0, reynolds = 0, measured = 0, stokes = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &fraction, &reynolds, &measured), 3) << line;
  stokes = std::stod(line.substr(line.rfind(',') + 1));
  EXPECT_EQ(fraction, 0.216);
  EXPECT_NEAR(reynolds, 0.05, 0.02);
  EXPECT_NEAR(measured / table.factor[0], 1, 1e-4);
  EXPECT_EQ(stokes, 1);
  EXPECT_NEAR(drag_factor(DragLaw::wen_yu, 0.8, 10), (1 + 0.15 * std::pow(10, 0.687)) * std::pow(0.8, -2.65),
              1e-12);

  const Outcome again = bedload(command);
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err, "table.toml: exists; give --overwrite to replace it\n");
}

/// Hard spheres, also where places drawn one by one run out.
TEST(RandomSpheres, DoNotOverlapAndForgetTheirStart) {
  const int count = 54;
  const double side = std::cbrt(count * M_PI / 6 / 0.5);
  const std::vector<Vec3d> x = random_spheres(count, side, 1);
  EXPECT_NE(x[0].x, random_spheres(count, side, 2)[0].x);
  int near = 0;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j) {
      Vec3d d = x[i] - x[j];
      for (int k = 0; k < 3; ++k) d[k] -= side * std::rint(d[k] / side);
      EXPECT_GT(norm(d), 1);
      near += norm(d) < 1.05;
    }
  // 27 pairs of a sphere times density, volume of the shell and the pair distribution at contact, 6 by
  // Carnahan and Starling: 97, a little less as that falls off
  EXPECT_NEAR(near, 95, 35);
}

TEST_F(Drag, SaysWhatTheLatticeCannotDo) {
  const Outcome o = bedload("drag --backend cpu --array simple --fractions 0.2 --reynolds 900 --nodes 8");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("fluid.dx"), o.err.npos) << o.err;
  EXPECT_NE(o.err.find("relaxation time"), o.err.npos) << o.err;
  const Outcome late =
      bedload("drag --backend cpu --array simple --fractions 0.2 --reynolds 0.01,900 --nodes 8");
  EXPECT_EQ(late.out, "") << "before anything is measured";
  const Outcome same = bedload("drag --backend cpu --out table.csv");
  EXPECT_EQ(same.code, 2);
  EXPECT_EQ(same.err,
            "command line: --out table.csv must not end in .csv: points and laws go to that file\n");
}

}  // namespace
}  // namespace bedload::test
