#include "src/cli/progress.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bedload/core/error.hpp"
#include "src/cli/options.hpp"

namespace bedload::test {
namespace {

TEST(DurationText, PicksItsUnits) {
  EXPECT_EQ(duration_text(8.4), "8 s");
  EXPECT_EQ(duration_text(250), "4 min 10 s");
  EXPECT_EQ(duration_text(2 * 3600 + 5 * 60 + 10), "2 h 05 min");
  EXPECT_EQ(duration_text(3 * 86400 + 4 * 3600), "3 d 04 h");
  EXPECT_EQ(duration_text(-1), "?");
}

TEST(ProgressLine, TellsTimeRatesStepAndWhatLimitsIt) {
  const ProgressLine line{.time = 0.123,
                          .end = 0.3,
                          .fraction = 0.41,
                          .steps_per_second = 812,
                          .particle_steps_per_second = 3.2e7,
                          .dt = 1.2e-5,
                          .limit = "cfl",
                          .seconds_left = 250};
  EXPECT_EQ(line.text(),
            "t = 0.123 of 0.3 s   41 %  812 steps/s  3.2e+07 particle-steps/s  dt 1.2e-05 s (cfl)  4 min 10 "
            "s left");
}

Options parse(std::vector<const char*> words) { return parse_options(int(words.size()), words.data()); }

TEST(Options, ShorthandsBecomeOverrides) {
  const Options o =
      parse({"bedload", "run", "cases/dam/case.toml", "--set", "grain.e=0.5", "--set", "run.precision=single",
             "--precision", "double", "--force-dt", "--until", "0.5", "--threads", "2"});
  EXPECT_EQ(o.command, "run");
  EXPECT_EQ(o.overrides, (std::vector<std::string>{"grain.e=0.5", "run.precision=single",
                                                   "run.precision=double", "time.force_dt=true"}));
  EXPECT_EQ(o.until, 0.5);
  EXPECT_EQ(o.threads, 2);
  EXPECT_EQ(o.out, "results/dam");
}

TEST(Options, TheRepeatedCommandDropsWhatBeginsARun) {
  EXPECT_EQ(
      parse({"bedload", "run", "my dam.toml", "--overwrite", "--set", "title=\"it's\"", "--restart", "a.h5"})
          .repeat,
      "bedload run 'my dam.toml' --set 'title=\"it'\\''s\"'");
  EXPECT_EQ(parse({"bedload", "run", "dam.toml", "--restart=a.h5"}).repeat, "bedload run dam.toml");
  EXPECT_EQ(parse({"bedload", "run", "dam.toml"}).out, "results/dam");
}

TEST(Options, WrongOnesAreCaseErrors) {
  EXPECT_THROW(parse({"bedload", "run", "dam.toml", "--threads", "0"}), CaseError);
  EXPECT_THROW(parse({"bedload", "run", "dam.toml", "--until", "soon"}), CaseError);
  EXPECT_THROW(parse({"bedload", "fly"}), CaseError);
}

}  // namespace
}  // namespace bedload::test
