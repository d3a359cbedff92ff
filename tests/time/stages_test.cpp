// What the stages of a step say that they read and write is what they do.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "src/time/coupled_simulation.hpp"
#include "tests/support/run.hpp"
#include "tests/support/stage_cases.hpp"

namespace BL_SOLVER {
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
  std::map<std::string, HostBytes> before;
  for (int n = 0; n < kSteps; ++n) {
    std::string ended;
    run.stepper().step([&](const Stage* next) {
      run.each_field([&](const std::string& name, FieldBase& field) {
        HostBytes now = field.to_host().bytes;
        if (!ended.empty() && now != before[name]) out[ended].insert(name);
        before[name] = std::move(now);
      });
      if (next) ended = next->name;
    });
  }
  return out;
}

template <class Fields>
bool holds(const Fields& fields, const FieldBase& field) {
  return std::find(fields.begin(), fields.end(), &field) != fields.end();
}

/// What stages say, by the names of the fields.
struct Declared {
  std::string name;
  Names near, reads, writes;
};
std::vector<Declared> declared(const Case& c) {
  AuditedRun run(c);
  std::vector<Declared> out;
  run.stepper().step([&](const Stage* next) {
    if (!next) return;
    Declared d{std::string(next->name), {}, {}, {}};
    for (const FieldBase* f : next->fields.near) d.near.insert(run.name_of(f));
    for (const FieldBase* f : next->fields.reads) d.reads.insert(run.name_of(f));
    for (const FieldBase* f : next->fields.writes) d.writes.insert(run.name_of(f));
    out.push_back(d);
  });
  return out;
}

/// By what stages say, no value that the field has after `done` of them is read, in this step or the next.
bool spent(const std::vector<Declared>& stages, std::size_t done, const std::string& field) {
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const Declared& stage = stages[(done + k) % stages.size()];
    if (stage.near.contains(field) || stage.reads.contains(field)) return false;
    if (stage.writes.contains(field)) return true;
  }
  return false;
}

/// The state after some steps in which values that are spent were spoilt where `which(stage to come, field)`.
template <class Which>
std::vector<std::byte> outcome(const Case& of, const Which& which) {
  const auto stages = declared(of);
  AuditedRun run(of);
  for (int n = 0; n < kSteps; ++n) {
    std::size_t done = 0;
    run.stepper().step([&](const Stage* next) {
      if (!next) return;
      run.each_field([&](const std::string& name, FieldBase& field) {
        if (!spent(stages, done, name) || !which(stages[done].name, name)) return;
        HostArray spoilt = field.to_host();
        std::fill(spoilt.bytes.begin(), spoilt.bytes.end(), std::byte{0xff});  // not a number
        field.from_host(spoilt);
      });
      ++done;
    });
  }
  return bits(run.simulation);
}

/// Spoils the values of one particle in what a stage reads of the particle itself alone.
void spoil_own(const Stage& stage, std::size_t particle) {
  for (const FieldBase* read : stage.fields.reads) {
    HostArray values = read->to_host();
    if (values.count() <= particle + 1) continue;
    const std::size_t row = values.components * size_of(values.type);
    std::byte* const at = values.bytes.data() + particle * row;
    if (values.type == Scalar::f32 || values.type == Scalar::f64)
      std::fill(at, at + row, std::byte{0xff});  // not a number
    else
      std::copy_n(at + row, row, at);  // those of the next
    const_cast<FieldBase*>(read)->from_host(values);
  }
}

/// The first particle but one whose rows differ, or kNone.
Index first_other(const HostArray& a, const HostArray& b, std::size_t but) {
  const std::size_t row = a.components * size_of(a.type);
  for (std::size_t i = 0; i < a.count(); ++i)
    if (i != but &&
        !std::equal(a.bytes.begin() + i * row, a.bytes.begin() + (i + 1) * row, b.bytes.begin() + i * row))
      return Index(i);
  return kNone;
}

TEST(Stages, WriteWhatTheyNameAndNothingElse) {
  std::map<std::string, Names> named, changed;
  for (const Case& c : test::stage_cases()) {
    SCOPED_TRACE(c.name);
    AuditedRun run(c);
    const auto seen = changes(run);
    for (const Declared& stage : declared(c)) {
      const std::string& name = stage.name;
      Names writes = stage.writes;
      if (seen.contains(name))
        for (const std::string& field : seen.at(name)) {
          EXPECT_TRUE(writes.contains(field)) << name << " changed " << field;
          changed[name].insert(field);
        }
      named[name].merge(writes);
    }
  }
  named.erase("renew_lists");
  // rare: least density and porosity, walls that turn drift away, drag that may be stiff; stores of bodies
  // and clumps are named as a whole
  const Names rare{"fluid_state fluid/compression", "porosity fluid/solid_factor", "repel fluid/drift",
                   "interpolate fluid/drag_rate", "move_solids grains/wall_row"};
  for (const auto& [stage, fields] : named)
    for (const std::string& field : fields)
      if (field.find("bod") != 0 && field.find("clumps/") != 0 && !rare.contains(stage + " " + field)) {
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

struct Enough {};

/// What a stage reads of the particle itself alone makes no difference to any other: with several GPUs, only
/// what it reads near has to be exchanged before it.
TEST(Stages, ReadOfOtherParticlesOnlyWhatTheyNameAsNear) {
  constexpr std::size_t kSpoilt = 3;
  for (const Case& c : test::stage_cases()) {
    SCOPED_TRACE(c.name);
    AuditedRun right(c);
    right.stepper().step();
    std::vector<std::map<std::string, HostArray>> expected;  // before each stage
    right.stepper().step([&](const Stage*) {
      expected.emplace_back();
      right.each_field(
          [&](const std::string& name, FieldBase& field) { expected.back()[name] = field.to_host(); });
    });
    // by itself what fills buffers that are no fields, which later stages read
    for (const bool interpolation : {false, true}) {
      AuditedRun spoilt(c);
      spoilt.stepper().step();
      std::size_t done = 0;
      Declared last;
      const auto compare = [&](const Stage* next) {
        spoilt.each_field([&](const std::string& name, FieldBase& field) {
          const HostArray& right_value = expected[done].at(name);
          if (last.writes.contains(name))
            if (const Index other = first_other(right_value, field.to_host(), kSpoilt); other != kNone)
              ADD_FAILURE() << last.name << ": " << name << " of particle " << other
                            << " depends on particle " << kSpoilt;
          field.from_host(right_value);
        });
        ++done;
        if (next->name == "finish" || last.name == "interpolate") throw Enough{};
        last = {};
        if (next->name == "renew_lists" || (next->name == "interpolate") != interpolation) return;
        last.name = next->name;
        for (const FieldBase* field : next->fields.writes) last.writes.insert(spoilt.name_of(field));
        spoil_own(*next, kSpoilt);
      };
      EXPECT_THROW(spoilt.stepper().step(compare), Enough);
    }
  }
}

/// As docs/architecture.md lists them: store by store.
std::string list_of(AuditedRun& run, const Fields& fields) {
  std::string out;
  for (const Store* store : run.stepper().stores()) {
    std::string names;
    for (const FieldBase* field : fields) {
      if (!holds(store->fields(), *field)) continue;
      names += " " + field->name;
    }
    if (!names.empty()) out += (out.empty() ? "" : "; ") + store->name + ":" + names;
  }
  return out;
}

std::string row_of(AuditedRun& run, const Stage& stage) {
  std::string out = "| `" + std::string(stage.name) + "` | " + std::string(name_of(stage.part)) + " | ";
  if (stage.name == "renew_lists")
    return out + "positions | all that outlives a step | the same, in a new order; xp |";
  return out + list_of(run, stage.fields.near) + " | " + list_of(run, stage.fields.reads) + " | " +
         list_of(run, stage.fields.writes) + " |";
}

TEST(Stages, StandInTheDocuments) {
  std::ifstream file(BL_SOURCE_DIR "/docs/architecture.md");
  if (!file) GTEST_SKIP() << "the documents are not here";
  const std::string page(std::istreambuf_iterator<char>(file), {});
  std::string table = "| stage | time of | reads near | reads | writes |\n|---|---|---|---|---|\n";
  AuditedRun run(Case{"", kTank + kFluid + kGate + kGrains, {"couple.slip=local"}});
  run.stepper().step([&](const Stage* next) {
    if (next) table += row_of(run, *next) + "\n";
  });
  EXPECT_NE(page.find(table), std::string::npos) << "docs/architecture.md lacks this table:\n" << table;
}

}  // namespace
}  // namespace BL_SOLVER
