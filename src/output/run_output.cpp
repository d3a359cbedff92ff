#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/csv.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/output.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "bedload/output/writer_thread.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// Writes to a file; if that fails since a file that was `begun` has gone, says so.
template <class F>
void while_there(const fs::path& path, bool begun, const F& write) {
  try {
    write();
  } catch (const FileError&) {
    if (begun) must_be_there(path);
    throw;
  }
}

/// When something is written: at the first step end at or after every multiple of
/// `every`. Everything follows from the times written so far, so a restarted run
/// continues the series where the unbroken one would.
class Schedule {
 public:
  explicit Schedule(double every) : every_(every) {}

  bool due(double time) const { return multiple(time) > last_multiple_; }
  bool begun() const { return last_time_ >= 0; }
  bool written_at(double time) const { return time == last_time_; }
  void written(double time) {
    last_time_ = time;
    last_multiple_ = multiple(time);
  }
  /// Of an earlier run's times, how many stay when going on from a time just below
  /// `cut`: none after it, and not an extra last one with which that run ended off schedule.
  std::size_t resume(const std::vector<double>& times, double cut) {
    std::size_t kept = 0;
    while (kept < times.size() && times[kept] < cut) ++kept;
    for (std::size_t k = 0; k + 1 < kept; ++k) written(times[k]);
    if (kept > 1 && !due(times[kept - 1])) --kept;
    if (kept > 0) written(times[kept - 1]);
    return kept;
  }

 private:
  double multiple(double time) const {
    if (every_ <= 0) return 0;
    return std::floor(time / every_ + 1e-9);  // a hair below a multiple is rounding of the clock
  }
  double every_;
  double last_time_ = -1, last_multiple_ = -1;
};

struct Frames {
  std::string store;
  FrameFile file;
  Schedule schedule;
  std::size_t written = 0, in_xdmf = 0;  ///< frames

  /// The side-car is written anew each time, so ever more rarely: its cost a frame stays the same.
  void refresh_xdmf(bool last) {
    if (in_xdmf == written || (!last && written - in_xdmf < std::max<std::size_t>(1, written / 16))) return;
    file.write_xdmf();
    in_xdmf = written;
  }
};

struct Table {
  std::optional<ProbeConfig> probe;  ///< none: a body, or diagnostics
  std::optional<int> body;           ///< a wall body or rigid group, as Simulation counts them
  CsvTable csv;
  Schedule schedule;
};

nlohmann::ordered_json to_json(const std::vector<Quantity>& quantities) {
  auto object = nlohmann::ordered_json::object();
  for (const auto& q : quantities) object[q.name] = {{"value", q.value}, {"unit", q.unit}};
  return object;
}

double host_peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

/// Oldest first.
std::vector<fs::path> checkpoints_in(const fs::path& dir) {
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(dir / "checkpoints", none))
    if (entry.path().extension() == ".h5" && entry.path().stem().string().starts_with("step_"))
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::string commented(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) out += c == '\n' ? ' ' : c;
  return out + '\n';
}

}  // namespace

struct RunOutput::Impl {
  Impl(const fs::path& folder, const Config& c, const Device& d, std::string v, bool go_on)
      : dir(folder),
        config(c),
        device(d),
        version(std::move(v)),
        continuing(go_on),
        checkpoint_schedule(c.out.checkpoint_every) {
    const bool doubles = c.precision == "double";
    const auto frames_of = [&](const char* store) {
      frames.push_back(
          {store, FrameFile(dir / (std::string(store) + ".vtkhdf"), doubles), Schedule(c.out.every)});
    };
    if (c.fluid.present) frames_of("fluid");
    if (c.grain.present) frames_of("grains");
    const bool wall_particles = c.fluid.present && !(c.wall.bodies.empty() && c.inlets.empty());
    if (c.out.walls && wall_particles) frames_of("walls");
    const auto every = [&](double own) { return Schedule(own > 0 ? own : c.out.every); };
    tables.push_back({{}, {}, CsvTable(dir / "diagnostics.csv"), every(c.out.diagnostics_every)});
    for (const auto& probe : c.out.probes)
      tables.push_back({probe, {}, CsvTable(dir / "probes" / (probe.name + ".csv")), every(probe.every)});
    for (int b = 0; b < int(c.wall.bodies.size()); ++b) {
      const WallBody& body = c.wall.bodies[b];
      if (c.out.bodies == "all" || (c.out.bodies == "moving" && body.moves()))
        tables.push_back(
            {{}, b, CsvTable(dir / "bodies" / (body.name + ".csv")), every(c.out.diagnostics_every)});
    }
    int group = int(c.wall.bodies.size());  // they come behind the bodies
    for (const int fill : c.grain.rigid_fills()) {
      if (c.out.bodies != "none")
        tables.push_back({{},
                          group,
                          CsvTable(dir / "bodies" / fmt::format("grain_fill_{}.csv", fill + 1)),
                          every(c.out.diagnostics_every)});
      ++group;
    }
  }

  void make_folder() {
    try {
      fs::create_directories(dir / "probes");
      fs::create_directories(dir / "checkpoints");
      if (std::any_of(tables.begin(), tables.end(), [](const Table& t) { return t.body.has_value(); }))
        fs::create_directories(dir / "bodies");
      if (!continuing) remove_former_run();
      if (const auto all = checkpoints_in(dir); !all.empty()) newest = all.back();
    } catch (const fs::filesystem_error& e) {
      throw FileError(fmt::format("{}: cannot write results there: {}", dir.string(), e.code().message()));
    }
    write_file(dir / "case.resolved.toml",
               commented("Bedload " + version) +
                   commented(fmt::format("device: {}, {}", device.backend, device.name)) +
                   commented(fmt::format("seed: {}", config.seed)) + '\n' + resolved_toml(config));
  }

  void remove_former_run() const {
    for (const char* store : {"fluid", "grains", "walls"})
      for (const char* ending : {".vtkhdf", ".xdmf"}) fs::remove(dir / (std::string(store) + ending));
    for (const auto& table : tables) fs::remove(table.csv.path());
    fs::remove(dir / "summary.json");
    for (const auto& path : checkpoints_in(dir)) fs::remove(path);
  }

  /// Takes up the series of an earlier run before the step that ends at `time`, once.
  void take_up(double time, double dt) {
    if (taken_up) return;
    taken_up = true;
    if (!continuing) return;
    const double cut =
        dt > 0 ? time - 0.5 * dt : std::nextafter(time, std::numeric_limits<double>::infinity());
    checkpoint_schedule.written(time - dt);
    for (auto& f : frames) {
      f.written = f.schedule.resume(f.file.times(), cut);
      f.file.keep(f.written);
      f.file.write_xdmf();
      f.in_xdmf = f.written;
    }
    for (auto& t : tables) t.csv.keep(t.schedule.resume(t.csv.times(), cut));
  }

  /// Hands over what is due at `time`, or all that is not yet written there.
  void emit(Simulation& simulation, double time, bool everything) {
    const auto wanted = [&](const Schedule& s) { return everything ? !s.written_at(time) : s.due(time); };
    for (auto& f : frames) {
      if (wanted(f.schedule)) {
        const bool again = f.schedule.begun();
        f.schedule.written(time);
        writer.post([&f, store = simulation.snapshot(f.store), time, again] {
          while_there(f.file.path(), again, [&] {
            f.file.append(store, time, again);
            ++f.written;
            f.refresh_xdmf(false);
          });
        });
      }
      if (everything) writer.post([&f] { while_there(f.file.path(), true, [&] { f.refresh_xdmf(true); }); });
    }
    for (auto& t : tables) {
      if (!wanted(t.schedule)) continue;
      const bool again = t.schedule.begun();
      t.schedule.written(time);
      std::vector<Quantity> row = row_of(simulation, t);
      if (row_watcher) {
        fs::path name = t.csv.path().lexically_relative(dir);
        row_watcher(name.replace_extension().generic_string(), time, row);
      }
      writer.post([csv = &t.csv, row = std::move(row), time, again] {
        while_there(csv->path(), again, [&] { csv->append(time, row, again); });
      });
    }
  }

  static std::vector<Quantity> row_of(Simulation& simulation, const Table& t) {
    if (t.probe) return simulation.measure(*t.probe);
    return t.body ? simulation.body_state(*t.body) : simulation.diagnostics();
  }

  fs::path post_checkpoint(Simulation& simulation) {
    auto path = dir / "checkpoints" / fmt::format("step_{:09}.h5", simulation.steps());
    writer.post([this, path, state = simulation.save()] {
      write_state(path, state, config);
      const std::lock_guard lock(mutex);
      newest = path;
    });
    return path;
  }

  fs::path last_checkpoint() const {
    const std::lock_guard lock(mutex);
    return newest;
  }

  void write_summary(Simulation& simulation, const std::string& status, const Effort& effort) const {
    const auto counts = simulation.counts();
    const double rate = effort.wall_seconds > 0 ? double(effort.particle_steps) / effort.wall_seconds : 0;
    auto probes = nlohmann::ordered_json::object();
    for (const auto& t : tables)
      if (t.probe) probes[t.probe->name] = to_json(simulation.measure(*t.probe));
    nlohmann::ordered_json summary{
        {"status", status},
        {"title", config.title},
        {"version", version},
        {"device", {{"backend", device.backend}, {"name", device.name}}},
        {"precision", config.precision},
        {"seed", config.seed},
        {"counts", {{"fluid", counts.fluid}, {"walls", counts.walls}, {"grains", counts.grains}}},
        {"steps", simulation.steps()},
        {"substeps", effort.substeps},
        {"rebuilds", effort.rebuilds},
        {"time", {{"value", simulation.time()}, {"unit", "s"}}},
        {"wall_time", {{"value", effort.wall_seconds}, {"unit", "s"}}},
        {"wall_time_of", to_json(simulation.time_spent())},
        {"numerical_viscosity", to_json(simulation.numerical_viscosity())},
        {"particle_steps", effort.particle_steps},
        {"particle_steps_rate", {{"value", rate}, {"unit", "1/s"}}},
        {"memory",
         {{"solver", {{"value", simulation.bytes()}, {"unit", "B"}}},
          {"host_peak", {{"value", host_peak_bytes()}, {"unit", "B"}}}}},
        {"last_checkpoint", last_checkpoint().lexically_relative(dir).generic_string()},
        {"warnings", warnings},
        {"metrics", to_json(simulation.diagnostics())},
        {"probes", probes}};
    for (const auto& [name, quantities] : added) summary[name] = to_json(quantities);
    write_file(dir / "summary.json",
               summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  }

  fs::path dir;
  Config config;
  Device device;
  std::string version;
  bool continuing;
  bool taken_up = false;
  std::vector<Frames> frames;
  std::vector<Table> tables;
  Schedule checkpoint_schedule;
  RowWatcher row_watcher;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, std::vector<Quantity>>> added;  ///< to the summary
  mutable std::mutex mutex;                                          ///< guards `newest`
  fs::path newest;
  WriterThread writer;  ///< last: its jobs use all of the above
};

RunOutput::RunOutput(const fs::path& dir, const Config& config, const Device& device, std::string version,
                     bool continuing)
    : impl_(std::make_unique<Impl>(dir, config, device, std::move(version), continuing)) {
  impl_->make_folder();
}

RunOutput::~RunOutput() = default;

void RunOutput::write(Simulation& simulation, const StepInfo& info) {
  impl_->take_up(info.time, info.dt);
  impl_->emit(simulation, info.time, false);
  auto& schedule = impl_->checkpoint_schedule;
  if (impl_->config.out.checkpoint_every <= 0 || !schedule.due(info.time)) return;
  schedule.written(info.time);
  if (info.step > 0) impl_->post_checkpoint(simulation);  // t = 0 is the case itself
}

fs::path RunOutput::checkpoint(Simulation& simulation) {
  auto path = impl_->post_checkpoint(simulation);
  impl_->writer.drain();
  return path;
}

void RunOutput::watch_rows(RowWatcher watcher) { impl_->row_watcher = std::move(watcher); }

void RunOutput::warn(std::string message) { impl_->warnings.push_back(std::move(message)); }

void RunOutput::add(std::string name, std::vector<Quantity> quantities) {
  impl_->added.emplace_back(std::move(name), std::move(quantities));
}

void RunOutput::finish(Simulation& simulation, const std::string& status, const Effort& effort) {
  impl_->take_up(simulation.time(), 0);
  impl_->emit(simulation, simulation.time(), true);
  if (status != "failed") impl_->post_checkpoint(simulation);
  impl_->writer.drain();
  impl_->write_summary(simulation, status, effort);
}

fs::path RunOutput::last_checkpoint() const { return impl_->last_checkpoint(); }

fs::path latest_checkpoint(const fs::path& dir) {
  const auto all = checkpoints_in(dir);
  if (all.empty()) throw FileError(dir.string() + ": has no checkpoint to go on from");
  return all.back();
}

}  // namespace bedload
