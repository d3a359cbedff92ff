#include "series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace bedload {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStores[] = {"fluid", "grains", "clumps", "walls", "contacts"};
constexpr const char* kSpectra[] = {"spectra.csv", "spectra_peaks.csv"};
constexpr const char* kTableFolders[] = {"probes", "bodies"};

FrameFile frame_file(const fs::path& folder, const std::string& store, bool doubles = false) {
  return FrameFile(folder / (store + ".vtkhdf"), doubles);
}

bool is_table(const fs::path& path) {
  const std::string begin = "time [s],";
  std::string found(begin.size(), ' ');
  return path.extension() == ".csv" && fs::is_regular_file(path) &&
         std::ifstream(path).read(found.data(), std::streamsize(found.size())) && found == begin;
}

}  // namespace

void Schedule::written(double time) {
  last_time_ = time;
  last_multiple_ = multiple(time);
}

std::size_t Schedule::resume(const std::vector<double>& times, double now, bool steps_follow) {
  std::size_t kept = 0;
  while (kept < times.size() && times[kept] <= now) ++kept;
  for (std::size_t k = 0; k + 1 < kept; ++k) written(times[k]);
  if (steps_follow && kept > 1 && !due(times[kept - 1])) --kept;
  if (kept > 0) written(times[kept - 1]);
  return kept;
}

double Schedule::multiple(double time) const {
  if (every_ <= 0) return 0;
  return std::floor(time / every_ + 1e-9);  // tolerance for rounding of the clock
}

void Frames::refresh_xdmf(bool last) {
  if (in_xdmf == written || (!last && written - in_xdmf < std::max<std::size_t>(1, written / 16))) return;
  file.write_xdmf();
  in_xdmf = written;
}

Series series_of(const Config& c, const fs::path& folder) {
  Series s;
  const auto frames_of = [&](const std::string& store) {
    s.frames.push_back(
        {store, frame_file(folder, store, c.precision == Precision::fp64), Schedule(c.out.every)});
  };
  if (c.fluid.present) frames_of("fluid");
  if (c.grain.present) frames_of("grains");
  if (c.grain.has_clumps()) frames_of("clumps");
  for (const WallBody& body : c.wall.bodies)
    if (body.wear != WearLaw::none) frames_of("wear/" + body.name);
  if (c.out.contacts != ContactFrames::none) frames_of("contacts");
  const bool wall_particles =
      c.fluid.present && !c.fluid.lattice() && !(c.wall.bodies.empty() && c.inlets.empty());
  if (c.out.walls && wall_particles) frames_of("walls");

  const auto every = [&](double own) { return Schedule(own > 0 ? own : c.out.every); };
  s.tables.push_back({{}, {}, CsvTable(folder / "diagnostics.csv"), every(c.out.diagnostics_every)});
  if (c.out.spectra) {
    s.tables.push_back({{}, {}, CsvTable(folder / kSpectra[0]), every(0), &Simulation::spectra});
    s.tables.push_back({{}, {}, CsvTable(folder / kSpectra[1]), every(0), &Simulation::spectra_peaks});
  }
  for (const auto& probe : c.out.probes)
    s.tables.push_back({probe, {}, CsvTable(folder / "probes" / (probe.name + ".csv")), every(probe.every)});
  const auto add_body = [&](int body, const std::string& name) {
    s.tables.push_back(
        {{}, body, CsvTable(folder / "bodies" / (name + ".csv")), every(c.out.diagnostics_every)});
  };
  for (int b = 0; b < int(c.wall.bodies.size()); ++b) {
    const WallBody& body = c.wall.bodies[b];
    if (c.out.bodies == BodyTables::all || (c.out.bodies == BodyTables::moving && body.moves()))
      add_body(b, body.name);
  }
  int group = int(c.wall.bodies.size());  // rigid groups follow the bodies
  for (const int fill : c.grain.rigid_fills()) {
    if (c.out.bodies != BodyTables::none) add_body(group, fmt::format("grain_fill_{}", fill + 1));
    ++group;
  }
  return s;
}

Leftovers leftovers(const Series& series, const fs::path& folder) {
  Leftovers left;
  for (const char* store : kStores)
    if (std::none_of(series.frames.begin(), series.frames.end(),
                     [&](const Frames& f) { return f.store == store; }))
      left.frames.push_back(frame_file(folder, store));
  std::error_code no_wear;
  for (const auto& entry : fs::directory_iterator(folder / "wear", no_wear))
    if (entry.path().extension() == ".vtkhdf" &&
        std::none_of(series.frames.begin(), series.frames.end(),
                     [&](const Frames& f) { return f.file.path() == entry.path(); }))
      left.frames.emplace_back(entry.path());
  const auto look = [&](const fs::path& path) {
    if (is_table(path) && std::none_of(series.tables.begin(), series.tables.end(),
                                       [&](const Table& t) { return t.csv.path() == path; }))
      left.tables.emplace_back(path);
  };
  for (const char* name : kSpectra) look(folder / name);
  for (const char* name : kTableFolders) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder / name, none)) look(entry.path());
  }
  return left;
}

std::vector<std::string> gaps(const Series& series, const Config& former, const fs::path& folder,
                              double now) {
  std::vector<std::string> clauses;
  const auto look = [&](const fs::path& path, const std::vector<double>& times, Schedule schedule) {
    const std::size_t kept = schedule.resume(times, now, true);
    if (!schedule.due(now)) return;
    clauses.push_back(!fs::exists(path) ? path.string() + " is missing"
                      : kept == 0       ? path.string() + " is empty"
                                        : fmt::format("{} ends at t = {} s", path.string(), times[kept - 1]));
  };
  Series then = series_of(former, folder);
  for (const Frames& f : then.frames)
    if (std::any_of(series.frames.begin(), series.frames.end(),
                    [&](const Frames& g) { return g.store == f.store; }))
      look(f.file.path(), f.file.times(), f.schedule);
  for (const Table& t : then.tables)
    if (std::any_of(series.tables.begin(), series.tables.end(),
                    [&](const Table& u) { return u.csv.path() == t.csv.path(); }))
      look(t.csv.path(), t.csv.times(), t.schedule);
  return clauses;
}

}  // namespace bedload
