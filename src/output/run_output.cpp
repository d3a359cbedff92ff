#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/output.hpp"
#include "bedload/output/writer_thread.hpp"
#include "series.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// Calls write(); if it fails because a file that was `begun` is gone, the error states so.
template <class F>
void write_existing(const fs::path& path, bool begun, const F& write) {
  try {
    write();
  } catch (const FileError&) {
    if (begun) must_be_there(path);
    throw;
  }
}

nlohmann::ordered_json to_json(const std::vector<Quantity>& quantities) {
  auto object = nlohmann::ordered_json::object();
  for (const auto& q : quantities) object[q.name] = {{"value", q.value}, {"unit", q.unit}};
  return object;
}

/// {"fluid": {"z+": {...}}, "grains": {}}
nlohmann::ordered_json to_json(const std::vector<Loss>& losses) {
  auto object = nlohmann::ordered_json::object();
  for (const char* phase : {"fluid", "grains"}) object[phase] = nlohmann::ordered_json::object();
  for (const Loss& loss : losses)
    object[loss.phase][loss.side] = {{"count", loss.count},
                                     {"mass", {{"value", loss.mass}, {"unit", "kg"}}},
                                     {"first", {{"value", loss.first}, {"unit", "s"}}}};
  return object;
}

/// {"cfl": 120, "growth": 3}: steps by active limit.
nlohmann::ordered_json by_limit(const std::array<std::int64_t, kLimits.size()>& steps) {
  auto object = nlohmann::ordered_json::object();
  for (const auto& row : kLimits)
    if (const std::int64_t n = steps[std::size_t(row.limit)]; n > 0) object[std::string(row.name)] = n;
  return object;
}

double host_peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

/// The step number in the name of a checkpoint; none for other files.
std::optional<std::int64_t> step_of(const fs::path& path) {
  const std::string name = path.filename().string(), before = "step_", after = ".h5";
  std::int64_t step = 0;
  if (!name.starts_with(before)) return {};
  const char* const digits = name.data() + before.size();
  const auto [end, error] = std::from_chars(digits, name.data() + name.size(), step);
  if (error != std::errc() || end == digits || end != name.data() + name.size() - after.size() ||
      !name.ends_with(after))
    return {};
  return step;
}

/// Checkpoints by step.
std::map<std::int64_t, fs::path> checkpoints_in(const fs::path& dir) {
  std::map<std::int64_t, fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(dir / "checkpoints", none))
    if (const auto step = step_of(entry.path())) found[*step] = entry.path();
  return found;
}

std::string commented(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) out += c == '\n' ? ' ' : c;
  return out + '\n';
}

constexpr const char* kStores[] = {"fluid", "grains", "clumps", "walls"};

/// The arrays of a store that `fields` (out.fields) names; all if it is empty. Position, id, radius and body
/// are always among them.
HostStore chosen(HostStore store, const std::vector<std::string>& fields) {
  if (fields.empty()) return store;
  std::size_t n = 0;
  std::erase_if(store.arrays, [&](const HostArray& a) {
    const bool needed = n++ == 0 || a.name == "id" || a.name == "radius" || a.name == "body";
    return !needed && std::find(fields.begin(), fields.end(), a.name) == fields.end();
  });
  return store;
}

}  // namespace

void check_fields(Simulation& simulation, const Config& config) {
  if (config.out.fields.empty()) return;
  std::vector<std::string> known;
  for (const char* name : kStores)
    for (const HostArray& a : simulation.snapshot(name).arrays)
      if (std::find(known.begin(), known.end(), a.name) == known.end()) known.push_back(a.name);
  for (const std::string& field : config.out.fields)
    if (std::find(known.begin(), known.end(), field) == known.end())
      throw KeyError("out.fields", fmt::format("out.fields = \"{}\" must name a field of this case: {}",
                                               field, fmt::join(known, ", ")));
}

struct RunOutput::Impl {
  Impl(const fs::path& folder, const Config& c, const Device& d, std::string v, Simulation* restarted)
      : dir(folder),
        config(c),
        device(d),
        version(std::move(v)),
        series(series_of(c, folder)),
        checkpoint_schedule(c.out.checkpoint_every) {
    if (restarted) {
      begin = Begin{restarted->time(), restarted->steps()};
      examine(*restarted);
      for (const auto& [step, path] : checkpoints_in(dir))
        if (step <= begin->step) newest = path;
    } else {
      for (const fs::path& path : files()) must_be_no_folder(path);
      start_new();
    }
  }

  /// All files of this run except checkpoints.
  std::vector<fs::path> files() const {
    std::vector<fs::path> all{dir / "case.resolved.toml", dir / "summary.json"};
    for (const auto& f : series.frames)
      for (const auto& path : {f.file.path(), f.file.xdmf_path()}) all.push_back(path);
    for (const auto& t : series.tables) all.push_back(t.csv.path());
    return all;
  }

  void make_folders() const {
    try {
      fs::create_directories(dir / "probes");
      fs::create_directories(dir / "checkpoints");
      if (std::any_of(series.tables.begin(), series.tables.end(),
                      [](const Table& t) { return t.body.has_value(); }))
        fs::create_directories(dir / "bodies");
      if (config.wall.wears()) fs::create_directories(dir / "wear");
    } catch (const fs::filesystem_error& e) {
      throw FileError(fmt::format("{}: cannot write results there: {}", dir.string(), e.code().message()));
    }
  }

  void write_case() const {
    write_file(dir / "case.resolved.toml",
               commented("Bedload " + version) +
                   commented(fmt::format("device: {}, {}", device.backend, device.name)) +
                   commented(fmt::format("seed: {}", config.seed)) + '\n' + resolved_toml(config));
  }

  void start_new() const {
    make_folders();
    const Leftovers others = leftovers(series, dir);
    for (const auto& [step, path] : checkpoints_in(dir)) remove_file(path);
    for (const fs::path& path : files()) remove_file(path);
    for (const FrameFile& f : others.frames) f.keep(0);
    for (const CsvTable& t : others.tables) t.keep(0);
    for (const char* name : {"result.csv", "profile.csv", "profile.png", "stress.csv"})
      remove_file(dir / "viscometer" / name);
    write_case();
  }

  /// Throws FileError, before anything is changed, if the run cannot continue the files in the folder.
  void examine(Simulation& simulation) const {
    for (const fs::path& path : {dir, dir / "probes", dir / "bodies", dir / "wear", dir / "checkpoints"})
      must_be_usable(path, fs::file_type::directory);
    for (const fs::path& path : files()) must_be_usable(path, fs::file_type::regular);
    const Leftovers others = leftovers(series, dir);
    for (const auto& f : series.frames) {
      must_increase(f.file.path(), f.file.times());
      f.file.expect(frame_later(simulation, f.store)());
    }
    for (const auto& t : series.tables) {
      must_increase(t.csv.path(), t.csv.times());
      t.csv.expect(rows_of(simulation, t).at(0));
    }
    for (const FrameFile& f : others.frames) must_increase(f.path(), f.times());
    for (const CsvTable& t : others.tables) must_increase(t.path(), t.times());
  }

  static void must_increase(const fs::path& path, const std::vector<double>& times) {
    const auto at = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
    if (at != times.end())
      throw FileError(fmt::format("{}: cannot be continued: t = {} s comes before t = {} s", path.string(),
                                  *at, *(at + 1)));
  }

  /// Truncates the series of an earlier run to the checkpoint, once. Later checkpoints go first, the newest
  /// before others, so that an interruption leaves a folder whose newest checkpoint is valid.
  void truncate(bool steps_follow) {
    if (!begin || truncated) return;
    truncated = true;
    make_folders();
    remove_file(dir / "summary.json");
    const auto all = checkpoints_in(dir);
    for (auto it = all.rbegin(); it != all.rend() && it->first > begin->step; ++it) remove_file(it->second);
    const Leftovers others = leftovers(series, dir);
    checkpoint_schedule.written(begin->time);
    for (auto& f : series.frames) {
      f.written = f.schedule.resume(f.file.times(), begin->time, steps_follow);
      f.file.keep(f.written);
      f.file.write_xdmf();
      f.in_xdmf = f.written;
    }
    for (auto& t : series.tables) t.csv.keep(t.schedule.resume(t.csv.times(), begin->time, steps_follow));
    const auto kept = [&](const std::vector<double>& times) {
      return Schedule(0).resume(times, begin->time, false);
    };
    for (const FrameFile& f : others.frames) {
      f.keep(kept(f.times()));
      f.write_xdmf();
    }
    for (const CsvTable& t : others.tables) t.keep(kept(t.times()));
    write_case();
  }

  /// Posts the output that is due at `time`, or everything not yet written at that time.
  void emit(Simulation& simulation, double time, bool everything) {
    const auto wanted = [&](const Schedule& s) { return everything ? !s.written_at(time) : s.due(time); };
    const bool frame = std::any_of(series.frames.begin(), series.frames.end(),
                                   [&](const Frames& f) { return wanted(f.schedule); });
    if (frame) wait_for_writer();
    for (auto& f : series.frames) {
      if (wanted(f.schedule)) {
        const bool again = f.schedule.begun();
        f.schedule.written(time);
        writer.post(
            [&f, store = frame_later(simulation, f.store), time, again] {
              write_existing(f.file.path(), again, [&] {
                f.file.append(store(), time, again);
                ++f.written;
                f.refresh_xdmf(false);
              });
            },
            WriterThread::Size::large);
      }
      if (everything)
        writer.post([&f] { write_existing(f.file.path(), true, [&] { f.refresh_xdmf(true); }); });
    }
    for (auto& t : series.tables) {
      if (!wanted(t.schedule)) continue;
      const bool again = t.schedule.begun(), due = t.schedule.due(time);
      t.schedule.written(time);
      std::vector<std::vector<Quantity>> rows = rows_of(simulation, t);
      // an extra last row is removed by a restart, whose next mean includes its interval
      if (t.probe && due) simulation.begin_interval(*t.probe);
      if (row_watcher && !t.spectra) {
        fs::path name = t.csv.path().lexically_relative(dir);
        for (const auto& row : rows) row_watcher(name.replace_extension().generic_string(), time, row);
      }
      writer.post([csv = &t.csv, rows = std::move(rows), time, again] {
        write_existing(csv->path(), again, [&] { csv->append_rows(time, rows, again); });
      });
    }
  }

  Later<HostStore> frame_later(Simulation& simulation, const std::string& store) const {
    Later<HostStore> all = simulation.snapshot_later(store);
    if (std::find(std::begin(kStores), std::end(kStores), store) == std::end(kStores)) return all;
    return [all = std::move(all), this] { return chosen(all(), config.out.fields); };
  }

  /// Before what takes as much memory as a frame: one frame may wait beside that which is written.
  void wait_for_writer() {
    const auto from = std::chrono::steady_clock::now();
    writer.wait_for_large(series.frames.size());
    waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  }

  static std::vector<std::vector<Quantity>> rows_of(Simulation& simulation, const Table& t) {
    if (t.spectra) return (simulation.*t.spectra)();
    if (t.probe) return {simulation.measure(*t.probe)};
    return {t.body ? simulation.body_state(*t.body) : simulation.diagnostics()};
  }

  fs::path post_checkpoint(Simulation& simulation) {
    auto path = dir / "checkpoints" / fmt::format("step_{:09}.h5", simulation.steps());
    wait_for_writer();
    writer.post(
        [this, path, state = simulation.save()] {
          write_state(path, state, config);
          const std::lock_guard lock(mutex);
          newest = path;
        },
        WriterThread::Size::large);
    return path;
  }

  fs::path last_checkpoint() const {
    const std::lock_guard lock(mutex);
    return newest;
  }

  /// Whether a restart has nothing to add: it was stopped before its first step, or it starts at the end of a
  /// completed run.
  bool nothing_to_add(const Simulation& simulation, const std::string& status) const {
    if (!begin || truncated) return false;
    if (status == "stopped") return true;
    const fs::path path = dir / "summary.json";
    if (status != "completed" || !fs::exists(path)) return false;
    const auto former = nlohmann::json::parse(read_file(path), nullptr, false);
    const auto value = [&](const char* key) {
      return former.is_object() && former.contains(key) ? former[key] : nlohmann::json();
    };
    return value("status") == status && value("steps") == simulation.steps();
  }

  /// Metrics are the last rows in the tables: a restarted simulation may report its last step differently.
  void write_summary(Simulation& simulation, const std::string& status, const RunTotals& totals) const {
    const auto counts = simulation.counts();
    const double rate = totals.wall_seconds > 0 ? double(totals.particle_steps) / totals.wall_seconds : 0;
    auto probes = nlohmann::ordered_json::object();
    for (const auto& t : series.tables)
      if (t.probe) probes[t.probe->name] = to_json(t.csv.last_row());
    nlohmann::ordered_json summary{
        {"status", status},
        {"title", config.title},
        {"version", version},
        {"device", {{"backend", device.backend}, {"name", device.name}}},
        {"precision", config.precision.name()},
        {"seed", config.seed},
        {"counts", {{"fluid", counts.fluid}, {"walls", counts.walls}, {"grains", counts.grains}}},
        {"steps", simulation.steps()},
        {"substeps", totals.substeps},
        {"steps_by_limit", by_limit(totals.steps_by)},
        {"substeps_by_limit", by_limit(totals.substeps_by)},
        {"rebuilds", totals.rebuilds},
        {"time", {{"value", simulation.time()}, {"unit", "s"}}},
        {"wall_time", {{"value", totals.wall_seconds}, {"unit", "s"}}},
        {"wall_time_of", to_json(simulation.time_spent())},
        {"numerical_viscosity", to_json(simulation.numerical_viscosity())},
        {"particle_steps", totals.particle_steps},
        {"particle_steps_rate", {{"value", rate}, {"unit", "1/s"}}},
        {"memory",
         {{"solver", {{"value", simulation.bytes()}, {"unit", "B"}}},
          {"host_peak", {{"value", host_peak_bytes()}, {"unit", "B"}}}}},
        {"lost", to_json(simulation.losses())},
        {"last_checkpoint", last_checkpoint().lexically_relative(dir).generic_string()},
        {"warnings", warnings},
        {"metrics", to_json(CsvTable(dir / "diagnostics.csv").last_row())},
        {"probes", probes}};
    for (const auto& [name, quantities, note] : added) {
      summary[name] = to_json(quantities);
      if (!note.empty()) summary[name]["note"] = note;
    }
    write_file(dir / "summary.json",
               summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  }

  fs::path dir;
  Config config;
  Device device;
  std::string version;
  struct Begin {
    double time = 0;
    std::int64_t step = 0;
  };
  std::optional<Begin> begin;  ///< where a restart continues an earlier run
  bool truncated = false;
  Series series;
  Schedule checkpoint_schedule;
  RowWatcher row_watcher;
  std::vector<std::string> warnings;
  struct Section {
    std::string name;
    std::vector<Quantity> quantities;
    std::string note;
  };
  std::vector<Section> added;  ///< to the summary
  mutable std::mutex mutex;    ///< guards `newest`
  fs::path newest;
  double waited = 0;          ///< for the writer, s
  WriterThread writer{1024};  ///< last: its jobs use all of the above
};

RunOutput::RunOutput(const fs::path& dir, const Config& config, const Device& device, std::string version,
                     Simulation* restarted)
    : impl_(std::make_unique<Impl>(dir, config, device, std::move(version), restarted)) {}

RunOutput::~RunOutput() = default;

void RunOutput::write(Simulation& simulation, const StepInfo& info) {
  impl_->truncate(true);
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

std::vector<std::string> RunOutput::gaps(const Config& former) const {
  return bedload::gaps(impl_->series, former, impl_->dir, impl_->begin->time);
}

void RunOutput::watch_rows(RowWatcher watcher) { impl_->row_watcher = std::move(watcher); }

void RunOutput::warn(std::string message) { impl_->warnings.push_back(std::move(message)); }

void RunOutput::add(std::string name, std::vector<Quantity> quantities, std::string note) {
  impl_->added.push_back({std::move(name), std::move(quantities), std::move(note)});
}

void RunOutput::finish(Simulation& simulation, const std::string& status, const RunTotals& totals) {
  if (impl_->nothing_to_add(simulation, status)) return;
  impl_->truncate(false);
  impl_->emit(simulation, simulation.time(), true);
  if (status != "failed") impl_->post_checkpoint(simulation);
  impl_->writer.drain();
  impl_->write_summary(simulation, status, totals);
}

OutputTimes RunOutput::times() const { return {impl_->waited, impl_->writer.busy()}; }

fs::path RunOutput::last_checkpoint() const { return impl_->last_checkpoint(); }

fs::path latest_checkpoint(const fs::path& dir) {
  const auto all = checkpoints_in(dir);
  if (all.empty()) throw FileError(dir.string() + ": has no checkpoint to restart from");
  return all.rbegin()->second;
}

}  // namespace bedload
