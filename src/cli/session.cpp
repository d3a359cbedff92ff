#include "session.hpp"

#include <fmt/format.h>

#include "bedload/core/error.hpp"
#include "progress.hpp"
#include "settle.hpp"

namespace bedload {

namespace fs = std::filesystem;

void refuse_other_run(const Options& o) {
  if (!o.restart.empty() || o.overwrite || !fs::exists(o.out / "case.resolved.toml")) return;
  throw FileError(fmt::format("{}: holds a run already; use {}--overwrite to replace it, or another --out",
                              o.out.string(), o.command == "run" ? "--restart to go on from it, " : ""));
}

Session::Session(const Options& options, Prepared prepared, const Say& say)
    : p_(std::move(prepared)),
      intervals_(p_.config.out),
      speed_watch_(p_.config),
      continues_(!options.restart.empty()) {
  build(options, say);
  check_fixed_steps(p_, *simulation_);
  if (options.out.empty()) return;
  output_.emplace(options.out, p_.config, p_.device, version(), continues_ ? &*simulation_ : nullptr);
  if (p_.former) tell_gaps(options);
  for (const std::string& warning : p_.warnings) output_->warn(warning);
}

void Session::tell_gaps(const Options& options) {
  for (const std::string& gap : output_->gaps(*p_.former)) {
    const std::string text = fmt::format("{}, but its run went on until the checkpoint's time, t = {:.6g} s",
                                         gap, simulation_->time());
    if (!options.allow_changes)
      throw FileError(text + "; restore what is missing, or continue without it by --allow-changes");
    p_.warnings.push_back(text);
  }
}

void Session::build(const Options& options, const Say& say) {
  const bool settle = !continues_ && p_.config.grain.present && p_.config.grain.settle;
  SavedState state;
  if (settle) state = settled(options, say);
  if (estimate_bytes(p_.config, p_.counts, p_.device.cuda()) > p_.device.memory)
    p_.warnings.push_back("the case may need more memory than the device has free");
  simulation_ = make_simulation(p_.config, p_.setup, p_.device);
  p_.setup = {};  // as large as the simulation itself
  if (continues_) {
    simulation_->load(p_.restart);
    p_.restart = {};
    say(fmt::format("restart    {} at t = {:.6g} s\n", options.restart.string(), simulation_->time()));
  } else {
    if (settle) simulation_->load_grains(state);
    simulation_->start();
  }
}

SavedState Session::settled(const Options& options, const Say& say) {
  Progress progress(options.quiet, 0, p_.config.grain.settle_time);
  const auto from = std::chrono::steady_clock::now();
  const SettledGrains bed = settled_grains(p_.config, p_.setup, p_.device, progress, p_.warnings);
  progress.close();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  say(bed.kept.empty() ? fmt::format("settled    in {}\n", duration_text(took.count()))
                       : fmt::format("settled    as kept in {}\n", bed.kept.string()));
  return bed.state;
}

void Session::begin() {
  from_ = std::chrono::steady_clock::now();
  if (output_ && !continues_) output_->write(*simulation_, StepInfo{});
}

StepInfo Session::step() {
  const StepInfo info = simulation_->step();
  const Counts n = simulation_->counts();
  effort_.particle_steps += n.fluid > 0 ? n.fluid : n.grains * info.substeps;
  effort_.substeps += info.substeps;
  ++effort_.steps_by[std::size_t(info.limit)];
  if (info.substeps > 1) effort_.substeps_by[std::size_t(info.substep_limit)] += info.substeps;
  effort_.rebuilds += info.rebuilt;
  if (const auto warning = speed_watch_.look(*simulation_, info)) warn(*warning);
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
  if (output_) output_->finish(*simulation_, status, effort());
}

Effort Session::effort() const {
  Effort so_far = effort_;
  so_far.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from_).count();
  return so_far;
}

}  // namespace bedload
