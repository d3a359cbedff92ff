#include "session.hpp"

#include <fmt/format.h>

#include <utility>

#include "bedload/core/error.hpp"
#include "progress.hpp"
#include "room.hpp"
#include "settle.hpp"

namespace bedload {

namespace fs = std::filesystem;

void refuse_other_run(const Options& o) {
  if (!o.restart.empty() || o.overwrite || !fs::exists(o.out / "case.resolved.toml")) return;
  throw FileError(fmt::format("{}: already holds a run; use {}--overwrite to replace it, or another --out",
                              o.out.string(), o.command == "run" ? "--restart to continue it, " : ""));
}

Session::Session(const Options& options, Prepared prepared, const Print& print)
    : p_(std::move(prepared)),
      intervals_(p_.config.out),
      speed_watch_(p_.config),
      restarted_(!options.restart.empty()) {
  build(options, print);
  check_fixed_steps(p_, *simulation_);
  check_fields(*simulation_, p_.config);
  if (options.out.empty()) return;
  output_.emplace(options.out, p_.config, p_.device, version(), restarted_ ? &*simulation_ : nullptr);
  if (p_.former) report_gaps(options);
  for (const std::string& warning : p_.warnings) output_->warn(warning);
}

void Session::report_gaps(const Options& options) {
  for (const std::string& gap : output_->gaps(*p_.former)) {
    const std::string text =
        fmt::format("{}, but the checkpoint is at t = {:.6g} s", gap, simulation_->time());
    if (!options.allow_changes)
      throw FileError(text + "; restore the file, or restart without its data by --allow-changes");
    p_.warnings.push_back(text);
  }
}

void Session::build(const Options& options, const Print& print) {
  const bool settle = !restarted_ && p_.config.grain.present && p_.config.grain.settle;
  SavedState state;
  if (settle) state = settled(options, print);
  if (p_.memory.of(p_.counts) > p_.device.memory)
    p_.warnings.push_back("the case may need more memory than there is: " + lack_of_memory_text(p_));
  simulation_ = make_simulation(p_.config, p_.setup, p_.device);
  p_.setup = {};  // frees as much memory as the simulation takes
  if (restarted_) {
    simulation_->load(p_.restart);
    p_.restart = {};
    print(fmt::format("restart    {} at t = {:.6g} s\n", options.restart.string(), simulation_->time()));
  } else {
    if (settle) simulation_->load_grains(state);
    simulation_->start();
  }
  if (std::string idle = idle_ranks_text(simulation_->ranks(), p_.config); !idle.empty())
    p_.warnings.push_back(std::move(idle));
}

SavedState Session::settled(const Options& options, const Print& print) {
  Progress progress(options.quiet, 0, p_.config.grain.settle_time);
  const auto from = std::chrono::steady_clock::now();
  const SettledGrains bed = settled_grains(p_.config, p_.setup, p_.device, progress, p_.warnings);
  progress.close();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  print(bed.cached.empty() ? fmt::format("settled    in {}\n", duration_text(took.count()))
                           : fmt::format("settled    from cache, {}\n", bed.cached.string()));
  return bed.state;
}

void Session::begin() {
  started_ = std::chrono::steady_clock::now();
  if (output_ && !restarted_) output_->write(*simulation_, StepInfo{});
}

StepInfo Session::step() {
  const StepInfo info = simulation_->step();
  const Counts n = simulation_->counts();
  totals_.particle_steps += n.fluid > 0 ? n.fluid : n.grains * info.substeps;
  totals_.substeps += info.substeps;
  ++totals_.steps_by[std::size_t(info.limit)];
  if (info.substeps > 1) totals_.substeps_by[std::size_t(info.substep_limit)] += info.substeps;
  totals_.rebuilds += info.rebuilt;
  if (const auto warning = speed_watch_.check(*simulation_, info)) warn(*warning);
  if (!output_) return info;
  output_->write(*simulation_, info);
  for (const std::string& warning : intervals_.newly_below(info.dt)) warn(warning);
  return info;
}

void Session::warn(const std::string& text) {
  p_.warnings.push_back(text);
  if (output_) output_->warn(text);
}

void Session::finish(const std::string& status) {
  if (output_) output_->finish(*simulation_, status, totals());
}

RunTotals Session::totals() const {
  RunTotals so_far = totals_;
  so_far.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  return so_far;
}

}  // namespace bedload
