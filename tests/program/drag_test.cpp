// `bedload drag` from outside.

#include "bedload/case/read.hpp"
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

  const Outcome again = bedload(command);
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err, "table.toml: exists; give --overwrite to replace it\n");
}

TEST_F(Drag, SaysWhatTheLatticeCannotDo) {
  const Outcome o = bedload("drag --backend cpu --array simple --fractions 0.2 --reynolds 900 --nodes 8");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("fluid.dx"), o.err.npos) << o.err;
  EXPECT_NE(o.err.find("relaxation time"), o.err.npos) << o.err;
}

}  // namespace
}  // namespace bedload::test
