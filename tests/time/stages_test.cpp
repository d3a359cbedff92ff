// What the stages of a step say that they read and write is what they do.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "src/time/coupled_simulation.hpp"
#include "tests/support/run.hpp"
#include "tests/support/stage_cases.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

using test::kFluid, test::kGate, test::kGrains, test::kTank;
using Case = test::StageCase;

constexpr int kSteps = 6;

struct AuditedRun {
  Config config;
  CoupledSimulation simulation;
  explicit AuditedRun(const Case& of) : AuditedRun(of.config()) {}
  explicit AuditedRun(const Config& c) : config(c), simulation(c, setup_of(c)) { simulation.start(); }
  static Setup setup_of(const Config& c) {
    std::vector<std::string> warnings;
    return build_setup(c, warnings);
  }

  Stepper& stepper() { return simulation.stepper(); }
  template <class F>
  void each_field(const F& f) {
    for (const Store* store : stepper().stores())
      for (FieldBase* field : store->fields())
        if (field->used()) f(store->name + "/" + field->name, *field);
  }
  std::string name_of(const FieldBase* field) {
    std::string out = field->name;
    each_field([&](const std::string& name, FieldBase& f) { out = &f == field ? name : out; });
    return out;
  }
};

using Names = std::set<std::string>;

/// What each stage changed.
std::map<std::string, Names> changes(AuditedRun& run) {
  std::map<std::string, Names> out;
  std::map<std::string, std::vector<std::byte>> before;
  for (int n = 0; n < kSteps; ++n)
    run.stepper().step([&](std::size_t done) {
      run.each_field([&](const std::string& name, FieldBase& field) {
        std::vector<std::byte> now = field.to_host().bytes;
        if (done > 0 && now != before[name])
          out[std::string(run.stepper().stages()[done - 1].name)].insert(name);
        before[name] = std::move(now);
      });
    });
  return out;
}

template <class Fields>
bool holds(const Fields& fields, const FieldBase& field) {
  return std::find(fields.begin(), fields.end(), &field) != fields.end();
}

/// By what stages say, no value that the field has after `done` of them is read, in this step or the next.
bool spent(const std::vector<Stage>& stages, std::size_t done, const FieldBase& field) {
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const Stage& stage = stages[(done + k) % stages.size()];
    if (holds(stage.reads, field)) return false;
    if (holds(stage.writes, field)) return true;
  }
  return false;
}

/// The state after some steps in which values that are spent were spoilt where `which(stage to come, field)`.
template <class Which>
std::vector<std::byte> outcome(const Case& of, const Which& which) {
  AuditedRun run(of);
  const auto& stages = run.stepper().stages();
  for (int n = 0; n < kSteps; ++n)
    run.stepper().step([&](std::size_t done) {
      if (done == stages.size()) return;
      run.each_field([&](const std::string& name, FieldBase& field) {
        if (!spent(stages, done, field) || !which(std::string(stages[done].name), name)) return;
        HostArray spoilt = field.to_host();
        std::fill(spoilt.bytes.begin(), spoilt.bytes.end(), std::byte{0xff});  // not a number
        field.from_host(spoilt);
      });
    });
  return bits(run.simulation);
}

TEST(Stages, WriteWhatTheyNameAndNothingElse) {
  std::map<std::string, Names> named, changed;
  for (const Case& c : test::stage_cases()) {
    SCOPED_TRACE(c.name);
    AuditedRun run(c);
    const auto seen = changes(run);
    for (const Stage& stage : run.stepper().stages()) {
      const std::string name(stage.name);
      Names writes;
      for (const FieldBase* field : stage.writes) writes.insert(run.name_of(field));
      if (seen.contains(name))
        for (const std::string& field : seen.at(name)) {
          EXPECT_TRUE(writes.contains(field)) << name << " changed " << field;
          changed[name].insert(field);
        }
      named[name].merge(writes);
    }
  }
  named.erase("renew_lists");
  // rare: least density and porosity, walls that turn drift away; stores of bodies and groups are named as a
  // whole
  const Names rare{"fluid_state fluid/s", "porosity fluid/solid_factor", "repel fluid/drift"};
  for (const auto& [stage, fields] : named)
    for (const std::string& field : fields)
      if (field.find("bod") != 0 && field.find("groups/") != 0 && field.find("grains/wall_memory") != 0 &&
          !rare.contains(stage + " " + field)) {
        EXPECT_TRUE(changed[stage].contains(field)) << stage << " never changed " << field;
      }
}

TEST(Stages, ReadAllThatTheyTakeFromBefore) {
  for (const Case& c : test::stage_cases()) {
    SCOPED_TRACE(c.name);
    const auto expected = outcome(c, [](const auto&...) { return false; });
    std::set<std::pair<std::string, std::string>> spoilt;
    const auto all = [&](const std::string& stage, const std::string& field) {
      spoilt.emplace(stage, field);
      return true;
    };
    try {
      if (outcome(c, all) == expected) continue;
    } catch (const SimulationFault&) {
    }
    for (const auto& [stage, field] : spoilt) {
      const auto one = [&](const std::string& s, const std::string& f) { return s == stage && f == field; };
      try {
        if (outcome(c, one) == expected) continue;
      } catch (const SimulationFault&) {
      }
      ADD_FAILURE() << field << " from before " << stage << " is read, which no stage says";
    }
    ADD_FAILURE() << "values are read that no stage reads by what it says";
  }
}

/// As docs/architecture.md lists them: store by store; what grains remember of walls, which is as many fields
/// as they may touch, as one.
std::string list_of(AuditedRun& run, const Fields& fields) {
  std::string out;
  for (const Store* store : run.stepper().stores()) {
    std::string names;
    for (const FieldBase* field : fields) {
      if (!holds(store->fields(), *field)) continue;
      const bool one_of_many = field->name.starts_with("wall_memory_");
      if (!one_of_many || field->name == "wall_memory_0")
        names += " " + (one_of_many ? "wall_memory" : field->name);
    }
    if (!names.empty()) out += (out.empty() ? "" : "; ") + store->name + ":" + names;
  }
  return out;
}

std::string row_of(AuditedRun& run, const Stage& stage) {
  std::string out = "| `" + std::string(stage.name) + "` | " + std::string(name_of(stage.part)) + " | ";
  if (stage.name == "renew_lists") return out + "all that outlives a step | the same, in a new order; xp |";
  return out + list_of(run, stage.reads) + " | " + list_of(run, stage.writes) + " |";
}

TEST(Stages, StandInTheDocuments) {
  std::ifstream file(BL_SOURCE_DIR "/docs/architecture.md");
  if (!file) GTEST_SKIP() << "the documents are not here";
  const std::string page(std::istreambuf_iterator<char>(file), {});
  std::string table = "| stage | time of | reads | writes |\n|---|---|---|---|\n";
  AuditedRun run(Case{"", kTank + kFluid + kGate + kGrains, {"couple.slip=local"}});
  for (const Stage& stage : run.stepper().stages()) table += row_of(run, stage) + "\n";
  EXPECT_NE(page.find(table), std::string::npos) << "docs/architecture.md lacks this table:\n" << table;
}

}  // namespace
}  // namespace bedload::inline BL_VARIANT
