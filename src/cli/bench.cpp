#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/output.hpp"
#include "benchmarks.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "progress.hpp"
#include "scaling.hpp"
#include "settle.hpp"
#include "tiled_bed.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Table = std::vector<std::vector<std::string>>;

/// One case in one precision, on so many ranks.
struct Job {
  std::string name;
  Prepared p;  ///< only its config before measure()
  int ranks = 1;
  std::string scaling = {};  ///< as ScalingRow::kind
  Prepared tile = {};        ///< its bed is of copies of this, if there are any
  int tiles = 0;             ///< along x and y
};

/// A value of the table and of the JSON file, null where it does not apply.
struct Cell {
  std::string head, text, key;
  Json value;
};

struct Result {
  std::string name, precision;
  double ms = 0;  ///< per step
  std::vector<Cell> cells;
  std::vector<Quantity> stages;  ///< per step, ms; the last is the rest
  ScalingRow scaling = {};
};

/// One repeat: some steps in a row.
struct Repeat {
  double seconds = 0;
  std::int64_t substeps = 0, rebuilds = 0;
  std::vector<Quantity> stages;  ///< s
};

/// Numbers of ranks, ascending.
std::vector<int> counts_of(const Options& o) {
  if (!o.bench.devices.empty() && !o.bench.ranks.empty())
    throw CaseError("command line: --devices divides among GPUs, --ranks among parts of the CPU; give one");
  std::vector<int> counts = o.bench.devices.empty() ? o.bench.ranks : o.bench.devices;
  if (counts.empty()) counts = {1};
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

/// As for a run on that many ranks; one rank is a run that is not divided.
Options on_ranks(const Options& o, int ranks) {
  Options of_run = o;
  if (ranks > 1 && o.bench.devices.empty()) of_run.ranks = ranks;
  if (ranks > 1 && !o.bench.devices.empty()) of_run.devices = fmt::format("{}", ranks);
  return of_run;
}

/// Those that a bed without fluid has a use for.
std::vector<std::string> dry_settings(std::vector<std::string> settings) {
  std::erase_if(settings, [](const std::string& s) {
    return !s.starts_with("grain.") && !s.starts_with("contact.") && !s.starts_with("run.");
  });
  return settings;
}

std::vector<Job> jobs_of(const Options& o) {
  const std::vector<Benchmark> built_in = benchmarks();
  std::vector<Job> jobs;
  int ranks = 1;
  std::string scaling;
  const auto add = [&](const std::string& name, const fs::path& file, const std::string& text,
                       std::vector<std::string> overrides, const std::string& tile = {}, int tiles = 0) {
    overrides.insert(overrides.end(), o.overrides.begin(), o.overrides.end());
    for (std::size_t k = 0; k < std::max<std::size_t>(1, o.bench.precisions.size()); ++k) {
      Job job{.name = name, .p = {}, .ranks = ranks, .scaling = scaling};
      std::vector<std::string> settings = overrides;
      if (!o.bench.precisions.empty()) settings.push_back("run.precision=" + o.bench.precisions[k]);
      job.p.config = file.empty() ? read_case_text(text, name, settings, job.p.warnings)
                                  : read_case(file, settings, job.p.warnings);
      job.tiles = tiles;
      if (tiles > 0) job.tile.config = read_case_text(tile, name, dry_settings(settings), job.tile.warnings);
      jobs.push_back(std::move(job));
    }
  };
  const auto add_benchmark = [&](const Benchmark& b) {
    add(b.name, {}, b.text, b.settings, b.tile, b.tiles);
    if (o.bench.default_settings && !b.settings.empty())
      add(b.name + ", default settings", {}, b.text, {}, b.tile, b.tiles);
  };
  const std::vector<int> counts = counts_of(o);
  const auto add_scaled = [&](const Benchmark& b) {
    for (const int count : counts) {
      ranks = count;
      if (counts.size() > 1) scaling = "strong";
      add_benchmark(b);
    }
    for (std::size_t k = 0; k < counts.size() && counts.size() > 1 && b.widened; ++k) {
      ranks = counts[k], scaling = "weak";
      add_benchmark(b.widened(double(counts[k]) / counts[0]));
    }
  };

  std::vector<std::string> wanted = o.bench.cases;
  if (wanted.empty() && o.bench.widths.empty()) {
    wanted = {"0.1M"};
    if (find_device(o.backend, o.threads).backend == "cuda") wanted = {"1M", "5M", "8M", "14M"};
  }
  for (const std::string& name : wanted) {
    const auto found =
        std::find_if(built_in.begin(), built_in.end(), [&](const Benchmark& b) { return b.name == name; });
    if (found != built_in.end()) {
      add_scaled(*found);
    } else if (name.ends_with(".toml") || fs::exists(name)) {
      for (const int count : counts) {
        ranks = count;
        if (counts.size() > 1) scaling = "strong";
        add(case_name(name), name, "", {});
      }
    } else {
      std::string names;
      for (const Benchmark& b : built_in) names += b.name + ", ";
      throw CaseError(
          fmt::format("command line: unknown benchmark {}; it must be one of {}or a case file", name, names));
    }
  }
  for (const double width : o.bench.widths)
    add_scaled(widened_dam_break(fmt::format("{} m wide", width), width));
  return jobs;
}

/// Frames and a row of diagnostics, in a folder that is removed in the end.
class Frames {
 public:
  Frames(Config config, const Device& device)
      : folder_(fs::temp_directory_path() / fmt::format("bedload_bench_{}", getpid())),
        output_(std::make_unique<RunOutput>(folder_, each_time(std::move(config)), device, version())) {}
  ~Frames() {
    output_.reset();
    std::error_code none;
    fs::remove_all(folder_, none);
  }
  void write(Simulation& simulation, const StepInfo& info) { output_->write(simulation, info); }
  OutputTimes times() const { return output_->times(); }

 private:
  static Config each_time(Config config) {
    config.out.every = 1e-12;
    config.out.diagnostics_every = 1e9;  // frames alone
    config.out.checkpoint_every = 0;
    return config;
  }
  fs::path folder_;
  std::unique_ptr<RunOutput> output_;
};

/// frames: null, or written to every so many steps.
Repeat time_steps(Simulation& simulation, int steps, Frames* frames = nullptr, int every = 1) {
  Repeat repeat;
  const std::vector<Quantity> before = simulation.time_spent();
  const auto from = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) {
    const StepInfo info = simulation.step();
    repeat.substeps += info.substeps;
    repeat.rebuilds += info.rebuilt;
    if (frames && (k + 1) % every == 0) frames->write(simulation, info);
  }
  repeat.stages = simulation.time_spent();  // waits for the last step
  repeat.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  for (std::size_t k = 0; k < before.size(); ++k) repeat.stages[k].value -= before[k].value;
  return repeat;
}

/// A value that applies to some cases only.
Cell optional_cell(bool applies, const std::string& head, const std::string& format, const std::string& key,
                   double value) {
  return applies ? Cell{head, fmt::format(fmt::runtime(format), value), key, value}
                 : Cell{head, "-", key, nullptr};
}

const Repeat& median_of(std::vector<Repeat>& repeats) {
  std::sort(repeats.begin(), repeats.end(),
            [](const Repeat& a, const Repeat& b) { return a.seconds < b.seconds; });
  return repeats[repeats.size() / 2];
}

/// Values of the median repeat; spread and rebuilds over all.
Result result_of(const Job& job, const Simulation& simulation, int steps, std::vector<Repeat> repeats) {
  const Repeat& median = median_of(repeats);
  std::int64_t rebuilds = 0;
  for (const Repeat& repeat : repeats) rebuilds += repeat.rebuilds;
  const std::int64_t all = std::int64_t(steps) * std::int64_t(repeats.size());
  const Counts n = simulation.counts();
  const double ms = 1e3 * median.seconds / steps, substeps = double(median.substeps);
  const double spread = 100 * (repeats.back().seconds - repeats.front().seconds) / median.seconds;
  const double bytes = double(simulation.bytes()) / double(n.fluid + n.walls + n.grains);
  const bool fluid = n.fluid > 0, grains = n.grains > 0 && substeps > 0;

  Cell rebuilt = optional_cell(rebuilds > 0, "steps per rebuild", "{:.1f}", "steps_per_rebuild",
                               double(all) / double(rebuilds));
  if (rebuilds == 0) rebuilt.text = fmt::format("> {}", all);
  Result result{
      job.name,
      job.p.config.precision.name(),
      ms,
      {{"benchmark", job.name, "row", job.name},
       {"N fluid", grouped(n.fluid), "fluid_particles", n.fluid},
       {"N wall", grouped(n.walls), "wall_particles", n.walls},
       {"N grains", grouped(n.grains), "grains", n.grains},
       {"precision", job.p.config.precision.name(), "precision", job.p.config.precision.name()},
       optional_cell(fluid, "h/dx", "{:g}", "h_over_dx", job.p.config.fluid.h_over_dx),
       rebuilt,
       {"ms/step", fmt::format("{:.3f}", ms), "step_ms", ms},
       {"spread", fmt::format("{:.1f} %", spread), "spread_percent", spread},
       optional_cell(fluid, "fluid particle-steps/s", "{:.3g}", "fluid_particle_steps_per_s",
                     1e3 * double(n.fluid) / ms),
       optional_cell(substeps > 0, "us/substep", "{:.2f}", "substep_us", 1e6 * median.seconds / substeps),
       optional_cell(grains, "sphere-substeps/s", "{:.3g}", "sphere_substeps_per_s",
                     double(n.grains) * substeps / median.seconds),
       {"bytes/particle", fmt::format("{:.0f}", bytes), "bytes_per_particle", bytes}},
      median.stages};
  double rest = ms;
  for (Quantity& stage : result.stages) rest -= stage.value *= 1e3 / steps;
  result.stages.push_back({"rest", "ms", std::max(0.0, rest)});
  return result;
}

SavedState settled(Prepared& p) {
  Progress progress(false, 0, p.config.grain.settle_time);
  SavedState bed = settled_grains(p.config, p.setup, p.device, progress, p.warnings).state;
  progress.close();
  return bed;
}

/// Grains at rest: how much they move, and how many others each touches.
void add_rest(Simulation& simulation, Result& result) {
  double contacts = 0, kinetic = 0, mass = 0;
  for (const Quantity& q : simulation.diagnostics()) {
    if (q.name == "coordination_number") contacts = q.value;
    if (q.name == "grain_kinetic_energy") kinetic = q.value;
    if (q.name == "grain_mass") mass = q.value;
  }
  const bool any = mass > 0;
  result.cells.push_back(optional_cell(any, "contacts/grain", "{:.2f}", "coordination_number", contacts));
  result.cells.push_back(optional_cell(any, "grains, J", "{:.2g}", "grain_kinetic_energy_j", kinetic));
  result.cells.push_back(
      optional_cell(any, "rms m/s", "{:.2g}", "grain_rms_speed", std::sqrt(2 * kinetic / mass)));
}

Result measure(Job job, const Options& o) {
  Prepared& p = job.p;
  const auto from = std::chrono::steady_clock::now();
  initialise(on_ranks(o, job.ranks), p);
  SavedState bed;
  const bool settle = p.config.grain.present && p.config.grain.settle;
  if (job.tiles > 0) {
    initialise(on_ranks(o, 1), job.tile);
    const SavedState tile = settled(job.tile);
    p.setup.grains =
        tiled_bed(job.tile.config, job.tile.setup.grains, tile, p.config, p.setup.grains, job.tiles);
    job.tile.setup = {};
  }
  if (settle) bed = settled(p);
  for (const std::string& warning : p.warnings) fmt::print(stderr, "warning: {}\n", warning);
  const auto simulation = make_simulation(p.config, p.setup, p.device);
  p.setup = {};
  if (settle) simulation->load_grains(bed);
  simulation->start();
  const std::chrono::duration<double> set_up = std::chrono::steady_clock::now() - from;
  while (simulation->time() < o.bench.at) simulation->step();
  time_steps(*simulation, o.bench.warm_up);
  std::vector<Repeat> repeats;
  const std::vector<RankReport> before = simulation->ranks();
  for (int k = 0; k < o.bench.repeats; ++k) repeats.push_back(time_steps(*simulation, o.bench.steps));
  double seconds = 0;
  for (const Repeat& repeat : repeats) seconds += repeat.seconds;
  Result result = result_of(job, *simulation, o.bench.steps, std::move(repeats));
  add_rest(*simulation, result);
  result.cells.push_back({"set-up", fmt::format("{:.3g} s", set_up.count()), "set_up_s", set_up.count()});
  const Counts n = simulation->counts();
  result.scaling = {.name = result.name,
                    .precision = result.precision,
                    .kind = job.scaling,
                    .ranks = job.ranks,
                    .rate = 1e3 * double(n.fluid > 0 ? n.fluid : n.grains) / result.ms,
                    .ms = result.ms};
  result.scaling.share(before, simulation->ranks(), o.bench.steps * o.bench.repeats, seconds);
  if (o.bench.frame_every > 0) {
    struct Span {
      double with, beside;  ///< s; beside: mean of the spans without frames before and after
      double part() const { return 100 * (1 - beside / with); }
    };
    std::vector<Span> spans;
    Frames frames(p.config, p.device);
    // the first two fetch the memory that all others use again
    time_steps(*simulation, 2 * o.bench.frame_every, &frames, o.bench.frame_every);
    const OutputTimes from = frames.times();
    double last = time_steps(*simulation, o.bench.steps).seconds;
    for (int k = 0; k < o.bench.repeats; ++k) {
      const double with = time_steps(*simulation, o.bench.steps, &frames, o.bench.frame_every).seconds,
                   next = time_steps(*simulation, o.bench.steps).seconds;
      spans.push_back({with, 0.5 * (last + next)});
      last = next;
    }
    const OutputTimes to = frames.times();
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.part() < b.part(); });
    const Span& span = spans[spans.size() / 2];
    const double ms = 1e3 * span.with / o.bench.steps, beside = 1e3 * span.beside / o.bench.steps;
    result.cells.push_back({"ms/step with frames", fmt::format("{:.3f}", ms), "step_with_frames_ms", ms});
    result.cells.push_back({"beside", fmt::format("{:.3f}", beside), "step_beside_frames_ms", beside});
    result.cells.push_back({"frames", fmt::format("{:.1f} %", span.part()), "frames_percent", span.part()});
    const int written = std::max(1, o.bench.repeats * (o.bench.steps / o.bench.frame_every));
    const double wait = 1e3 * (to.waited - from.waited) / written,
                 write = 1e3 * (to.writing - from.writing) / written;
    result.cells.push_back({"wait, ms/frame", fmt::format("{:.1f}", wait), "frame_wait_ms", wait});
    result.cells.push_back({"writing, ms/frame", fmt::format("{:.1f}", write), "frame_writing_ms", write});
  }
  return result;
}

std::vector<ScalingRow> scaling_of(const std::vector<Result>& results) {
  std::vector<ScalingRow> rows;
  for (const Result& result : results) rows.push_back(result.scaling);
  return rows;
}

Table numbers_table(const std::vector<Result>& results) {
  Table table(1);
  for (const Cell& cell : results.front().cells) table.front().push_back(cell.head);
  for (const Result& result : results) {
    table.emplace_back();
    for (const Cell& cell : result.cells) table.back().push_back(cell.text);
  }
  return table;
}

/// Milliseconds and percent per step.
Table stages_table(const std::vector<Result>& results) {
  std::vector<std::string> stages;
  for (const Result& result : results)
    for (const Quantity& stage : result.stages)
      if (std::find(stages.begin(), stages.end(), stage.name) == stages.end()) stages.push_back(stage.name);
  Table table{{"benchmark", "precision"}};
  table[0].insert(table[0].end(), stages.begin(), stages.end());
  for (const Result& result : results) {
    std::vector<std::string> line{result.name, result.precision};
    for (const std::string& name : stages) {
      const auto stage = std::find_if(result.stages.begin(), result.stages.end(),
                                      [&](const Quantity& each) { return each.name == name; });
      line.push_back(stage == result.stages.end()
                         ? "-"
                         : fmt::format("{:.3f} ({:.0f} %)", stage->value, 100 * stage->value / result.ms));
    }
    table.push_back(line);
  }
  return table;
}

/// As Markdown; the first line is the header.
void print_table(const Table& table) {
  std::vector<std::size_t> widths(table.front().size());
  for (const auto& line : table)
    for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  std::string rule = "|";
  for (const std::size_t width : widths) rule += std::string(width + 1, '-') + ":|";
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::string text = "|";
    for (std::size_t k = 0; k < widths.size(); ++k) text += fmt::format(" {:>{}} |", table[i][k], widths[k]);
    fmt::print("{}\n", i == 0 ? text + "\n" + rule : text);
  }
}

Json json_of(const Options& o, const Device& device, const std::vector<Result>& results) {
  const bool divided = counts_of(o).back() > 1;
  auto rows = Json::array();
  for (const Result& result : results) {
    auto row = Json::object(), stages = Json::object();
    for (const Cell& cell : result.cells) row[cell.key] = cell.value;
    for (const Quantity& stage : result.stages) stages[stage.name] = stage.value;
    row["stages_ms"] = stages;
    if (divided) add_scaling(result.scaling, scaling_of(results), row);
    rows.push_back(row);
  }
  return {{"version", version()},
          {"commit", commit()},
          {"backend", device.backend},
          {"device", device.text()},
          {"from_s", o.bench.at},
          {"warm_steps", o.bench.warm_up},
          {"span_steps", o.bench.steps},
          {"spans", o.bench.repeats},
          {"frame_every", o.bench.frame_every},
          {"rows", rows}};
}

/// The least wide of weak scaling is the first of strong scaling.
std::vector<Result> measured_before(const Job& job, int fewest, const std::vector<Result>& results) {
  std::vector<Result> same;
  if (job.scaling != "weak" || job.ranks != fewest) return same;
  for (const Result& result : results)
    if (result.scaling.kind == "strong" && result.scaling.ranks == fewest && result.name == job.name &&
        result.precision == job.p.config.precision.name()) {
      same.push_back(result);
      same.back().scaling.kind = "weak";
    }
  return same;
}

/// The same with each number of threads that is asked for.
std::vector<Result> measure_with_threads(const Job& job, const Options& o) {
  if (o.bench.thread_counts.empty()) return {measure(job, o)};
  std::vector<Result> results;
  Options with = o;
  for (const int threads : o.bench.thread_counts) {
    with.threads = threads;
    results.push_back(measure(job, with));
    results.back().cells.push_back({"threads", std::to_string(threads), "threads", threads});
  }
  return results;
}

}  // namespace

int bench(const Options& o) {
  const std::vector<Job> jobs = jobs_of(o);
  const Config& first = jobs.front().p.config;
  Device device = placed(first.places, [&] { return find_device(o.backend, o.threads, first.simd); });
  const std::vector<int> counts = counts_of(o);
  const Options most = on_ranks(o, counts.back());
  divide_among(device, most.ranks, most.devices);  // fails now where there are not as many
  if (counts.size() > 1) device = device.undivided();
  std::vector<Result> results;
  const auto save = [&] {
    if (o.bench.json.empty()) return;
    write_file(o.bench.json,
               json_of(o, device, results).dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
  };
  save();  // a path that cannot be written fails now, not after minutes
  std::exception_ptr failure;
  for (std::size_t k = 0; k < jobs.size() && !failure; ++k) {
    try {
      const std::string on = counts.back() > 1 ? fmt::format(", {} ranks", jobs[k].ranks) : "";
      std::vector<Result> found = measured_before(jobs[k], counts[0], results);
      if (found.empty())
        found = placed(jobs[k].p.config.places, [&] { return measure_with_threads(jobs[k], o); });
      for (const Result& each : found) {
        fmt::print(stderr, "{} {}{}: {:.3f} ms/step\n", each.name, each.precision, on, each.ms);
        results.push_back(each);
      }
      save();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  if (!results.empty()) {
    fmt::print("bedload {}, commit {}, {}: {}. From t = {:g} s, median of {} repeats of {} steps.\n\n",
               version(), commit(), device.backend, device.text(), o.bench.at, o.bench.repeats,
               o.bench.steps);
    print_table(numbers_table(results));
    fmt::print("\nTime per step by stage, ms:\n\n");
    print_table(stages_table(results));
    const std::pair<std::string, std::string> kinds[] = {{"", "Ranks"},
                                                         {"strong", "Strong scaling, of one case"},
                                                         {"weak", "Weak scaling, of one that grows"}};
    for (const auto& [kind, title] : kinds) {
      const Table table = scaling_table(kind, scaling_of(results));
      if (counts.back() == 1 || table.size() == 1) continue;
      fmt::print("\n{}:\n\n", title);
      print_table(table);
    }
  }
  if (failure) std::rethrow_exception(failure);
  return 0;
}

}  // namespace bedload
