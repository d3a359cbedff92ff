// Each stage of a step does the same on every device. Two runs of one case go stage by stage; before each
// stage the second takes all fields from the first, so that what a stage makes of one state is compared, not
// what differences before it have grown to.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "bedload/core/error.hpp"
#include "tests/support/stage_cases.hpp"
#include "tests/support/staged_run.hpp"

// One factory a build; CMake lists those that there are.
#define BL_USE(which, where)                                           \
  namespace bedload::which##_##where {                                 \
    std::unique_ptr<test::StagedRun> staged_run(const Config& config); \
  }
BL_STAGED_RUNS
#undef BL_USE

namespace bedload {
namespace {

using test::StagedRun, test::StageField, test::StageFields;
using MakeRun = std::function<std::unique_ptr<StagedRun>(const Config&)>;

constexpr int kSteps = 6;

struct Build {
  std::string precision, backend;
  MakeRun make;
};
std::vector<Build> builds() {
  std::vector<Build> all;
#define BL_USE(which, where) all.push_back({#which, #where, which##_##where::staged_run});
  BL_STAGED_RUNS
#undef BL_USE
  return all;
}

/// Where two runs differ most after a stage.
struct Difference {
  int step;
  std::string stage, field;
  double relative;  ///< to the largest value of that quantity
  std::string text() const {
    char line[200];
    std::snprintf(line, sizeof line, "step %d, stage %s, field %s: %.2g of its largest value", step,
                  stage.c_str(), field.c_str(), relative);
    return line;
  }
};

/// Of one field, over the largest value of each quantity in it; no number at all where the other has one, and
/// fields that are not equally long, differ infinitely.
double difference(const StageField& a, const StageField& b) {
  if (a.raw.bytes == b.raw.bytes) return 0;
  if (a.values.size() != b.values.size()) return INFINITY;
  const int components = a.components();
  std::vector<double> largest(components, 0.0), apart(components, 0.0);
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    const double x = a.values[k], y = b.values[k];
    const int group = a.group[k % components];
    if (std::isnan(x) && std::isnan(y)) continue;
    if (!std::isfinite(x - y)) return INFINITY;
    largest[group] = std::max({largest[group], std::abs(x), std::abs(y)});
    apart[group] = std::max(apart[group], std::abs(x - y));
  }
  double most = 0;
  for (int c = 0; c < components; ++c)
    if (apart[c] > 0) most = std::max(most, apart[c] / largest[c]);
  return most;
}

/// Fields of a run before its first stage and after each, over some steps.
class Record {
 public:
  Record(StagedRun& run, int steps) {
    for (int n = 0; n < steps; ++n)
      run.step([&](const std::string& ended) { moments_.push_back({ended, run.fields()}); });
  }
  /// All differences of another run that takes each stage from the state of this one, in their order.
  std::vector<Difference> against(StagedRun& other) const {
    std::vector<Difference> found;
    std::size_t at = 0;
    for (int n = 0; at < moments_.size(); ++n)
      other.step([&](const std::string& ended) {
        if (at == moments_.size() || moments_[at].ended != ended)
          return found.push_back({n + 1, ended, "the order of stages", INFINITY});
        const StageFields &mine = moments_[at++].fields, theirs = other.fields();
        // before the first stage, only what outlives a step has a value
        for (std::size_t k = 0; !ended.empty() && k < mine.size(); ++k)
          if (const double apart = difference(mine[k], theirs[k]); apart > 0)
            found.push_back({n + 1, ended, mine[k].name, apart});
        other.take(mine);
      });
    return found;
  }

 private:
  struct Moment {
    std::string ended;
    StageFields fields;
  };
  std::vector<Moment> moments_;
};

/// The first that is larger than allowed, or nothing.
std::string first_beyond(const std::vector<Difference>& all, double allowed) {
  for (const Difference& d : all)
    if (!(d.relative <= allowed)) return d.text();
  return "";
}

class Threads {
 public:
  explicit Threads(int n) : before_(omp_get_max_threads()) { omp_set_num_threads(n); }
  ~Threads() { omp_set_num_threads(before_); }

 private:
  int before_;
};

/// No sum depends on how the work is divided.
TEST(StagesOnTheCpu, AreTheSameOnAnyNumberOfThreads) {
  for (const Build& build : builds()) {
    if (build.backend == "cuda") continue;
    for (const auto& c : test::stage_cases()) {
      SCOPED_TRACE(build.precision + " " + build.backend + ": " + c.name);
      const auto run_on = [&](int threads) {
        const Threads of(threads);
        return build.make(c.config());
      };
      const auto one = run_on(1), three = run_on(3);
      const Record record = [&] {
        const Threads of(1);
        return Record(*one, kSteps);
      }();
      const Threads of(3);
      EXPECT_EQ(first_beyond(record.against(*three), 0), "");
    }
  }
}

/// A run that is wrong in one number after one stage.
class Spoilt final : public StagedRun {
 public:
  explicit Spoilt(std::unique_ptr<StagedRun> run) : run_(std::move(run)) {}
  void take(const StageFields& fields) override { run_->take(fields); }
  StageFields fields() const override { return run_->fields(); }
  void step(const Observer& f) override {
    run_->step([&](const std::string& ended) {
      if (ended == "fluid_state") {
        StageFields all = run_->fields();
        for (StageField& field : all)
          if (field.name == "fluid/eos_state") field.raw.as<float>()[4 * 17 + 2] *= 1.0001f;  // density
        run_->take(all);
      }
      f(ended);
    });
  }

 private:
  std::unique_ptr<StagedRun> run_;
};

TEST(StagesOnTheCpu, ThatDifferAreNamed) {
  for (const Build& build : builds()) {
    if (build.precision != "mixed" || build.backend != "cpu") continue;
    const Config config = test::stage_cases().front().config();
    const auto right = build.make(config);
    Spoilt wrong(build.make(config));
    const auto found = Record(*right, 1).against(wrong);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].stage, "fluid_state");
    EXPECT_EQ(found[0].field, "fluid/eos_state");
    EXPECT_NEAR(found[0].relative, 1e-4, 1e-6);
    EXPECT_NE(first_beyond(found, 5e-5), "");
    EXPECT_EQ(first_beyond(found, 2e-4), "");
  }
}

/// Sums go in another order, and products are rounded once or twice: pairs cancel in forces to about 1/100.
double allowed(const std::string& precision) { return precision == "double" ? 1e-11 : 1e-4; }

/// What moves. Other fields may hold rounding alone (the flow around grains at rest), which is as large as
/// they are.
std::vector<Difference> of_motion(std::vector<Difference> all) {
  static const std::set<std::string> moves{"fluid/x", "fluid/v_rho", "grains/x", "grains/v"};
  std::erase_if(all, [&](const Difference& d) { return !moves.contains(d.field); });
  return all;
}

/// What one backend makes of each state, against the CPU without AVX2.
void compare_with_the_cpu(const std::string& backend) {
  int compared = 0;
  const auto all = builds();
  for (const Build& other : all) {
    if (other.backend != backend) continue;
    const auto cpu = std::find_if(all.begin(), all.end(), [&](const Build& b) {
      return b.precision == other.precision && b.backend == "cpu";
    });
    ASSERT_NE(cpu, all.end());
    for (const auto& c : test::stage_cases()) {
      SCOPED_TRACE(other.precision + " " + other.backend + ": " + c.name);
      std::unique_ptr<StagedRun> there;
      try {
        there = other.make(c.config());
      } catch (const DeviceError& error) {
        GTEST_SKIP() << error.what();
      }
      const auto here = cpu->make(c.config());
      const auto found = of_motion(Record(*here, kSteps).against(*there));
      EXPECT_EQ(first_beyond(found, allowed(other.precision)), "");
      const auto worst = std::max_element(
          found.begin(), found.end(), [](const auto& a, const auto& b) { return a.relative < b.relative; });
      std::printf("%s %s, %s: %s\n", other.precision.c_str(), backend.c_str(), c.name,
                  worst == found.end() ? "the same bits" : worst->text().c_str());
      ++compared;
    }
  }
  if (compared == 0) GTEST_SKIP() << "this build has no " << backend;
}

TEST(StagesOnTheGpu, DoAsOnTheCpu) { compare_with_the_cpu("cuda"); }
TEST(StagesInAvx2, DoAsWithout) { compare_with_the_cpu("cpu_avx2"); }

}  // namespace
}  // namespace bedload
