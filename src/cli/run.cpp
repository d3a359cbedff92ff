#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/folder_lock.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "progress.hpp"
#include "run.hpp"
#include "session.hpp"
#include "src/device.hpp"
#include "src/team/process_team.hpp"
#include "src/viewer/live/server.hpp"
#include "stop.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// "fluid 61 %, grains 20 %, ..., output 3 %" of `all`, a wall time above 0 s.
std::string fractions_text(const std::vector<Quantity>& parts, double all) {
  std::string text;
  double rest = all;
  for (const Quantity& part : parts) {
    text += fmt::format("{} {:.0f} %, ", part.name, 100 * part.value / all);
    rest -= part.value;
  }
  return text + fmt::format("output {:.0f} %", 100 * std::max(rest, 0.0) / all);
}

/// "cfl (time.cfl) 98 %, growth 2 %": the limits that set the steps.
std::string limits_text(const std::array<std::int64_t, kLimits.size()>& steps) {
  const auto all = double(std::accumulate(steps.begin(), steps.end(), std::int64_t{0}));
  std::string text;
  for (const auto& row : kLimits)
    if (const std::int64_t n = steps[std::size_t(row.limit)]; n > 0)
      text +=
          fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", with_key(row.limit), 100 * double(n) / all);
  return text;
}

class Run {
 public:
  Run(const Options& options, Prepared prepared, RunWatcher* watcher, LiveView* live)
      : options_(options),
        p_(std::move(prepared)),
        watcher_(watcher),
        live_(live),
        end_(options.until.value_or(p_.config.time.end)) {
    if (end_ < p_.begin - (1 + 1e-9) * p_.last_dt)  // within it the run has reached its end
      throw CaseError(fmt::format("{}: {} = {} s is before the time of the checkpoint, {} s",
                                  options.restart.string(), options.until ? "--until" : "time.end", end_,
                                  p_.begin));
    if (watcher_) watcher_->begin(p_.config, end_);
  }

  int go() {
    print(summary_text(p_) + notes_text(p_));
    if (const Processes* const all = Processes::joined(); all && !all->gpu_data().empty())
      print(fmt::format("exchange   by {}\n", all->gpu_data()));
    session_.emplace(options_, std::move(p_), [this](const std::string& text) { print(text); });
    print_warnings();
    print(fmt::format("results    {}\n", options_.out.string()));
    return steps();
  }

 private:
  void print(const std::string& text) const {
    if (!options_.quiet) fmt::print("{}", text);
    std::fflush(stdout);
  }

  /// New warnings only.
  void print_warnings(Progress* progress = nullptr) {
    const std::vector<std::string>& all = session_->prepared().warnings;
    if (progress && warnings_printed_ < all.size()) progress->close();
    for (; warnings_printed_ < all.size(); ++warnings_printed_)
      fmt::print(stderr, "warning: {}\n", all[warnings_printed_]);
  }

  int steps() {
    Simulation& simulation = session_->simulation();
    Progress progress(options_.quiet, simulation.time(), end_, simulation.steps());
    if (live_) {
      live_->begin(session_->prepared().config, session_->prepared().device, simulation, end_);
      session_->output()->watch_rows([this](const std::string& table, double time, const auto& row) {
        live_->add_row(table, time, row);
      });
    }
    try {
      session_->begin();
      while (simulation.time() < end_ && !stop_requested()) {
        const StepInfo info = session_->step();
        print_warnings(&progress);
        if (watcher_) watcher_->after_step(simulation, info);
        progress.update(info, session_->totals().particle_steps);
        if (live_) live_->after_step(simulation, info, session_->totals().particle_steps);
      }
      progress.close();
      if (watcher_ && simulation.time() >= end_) take(watcher_->findings());
      session_->finish(simulation.time() < end_ ? "stopped" : "completed");
    } catch (const FileError& error) {
      progress.close();
      throw FileError(error.what() + checkpoint_hint());
    } catch (const DeviceError& error) {  // device lost or out of memory
      progress.close();
      throw DeviceError(error.what() + checkpoint_hint());
    } catch (const fs::filesystem_error& error) {
      progress.close();
      throw FileError(fmt::format("{}: cannot write: {}{}", error.path1().string(), error.code().message(),
                                  checkpoint_hint()));
    } catch (const SimulationFault& fault) {
      progress.close();
      throw SimulationFault(fault.what() + after_fault());
    } catch (const KeyError& error) {  // a fixed step now exceeds its limit
      progress.close();
      throw KeyError(error.key, error.what() + after_fault());
    }
    const bool stopped = simulation.time() < end_;
    if (stopped && watcher_ && !watcher_->may_restart()) {
      fmt::print("stopped at t = {:.6g} s; a viscometer cannot restart: run it again with --overwrite\n",
                 simulation.time());
    } else if (stopped) {
      fmt::print("stopped at t = {:.6g} s; restart with: {} --restart {}\n", simulation.time(),
                 options_.repeat, last_checkpoint().string());
    } else {
      const RunTotals totals = session_->totals();
      print(fmt::format("completed  t = {:.6g} s, {} steps in {}, {:.3g} particle-steps/s\n",
                        simulation.time(), grouped(simulation.steps()), duration_text(totals.wall_seconds),
                        totals.wall_seconds > 0 ? double(totals.particle_steps) / totals.wall_seconds : 0));
      if (const std::string text = limits_text(totals.steps_by); !text.empty())
        print("step       limited by " + text + "\n");
      if (const std::string text = limits_text(totals.substeps_by); !text.empty())
        print("substep    limited by " + text + "\n");
      print(fmt::format("time       by part: {}\n",
                        fractions_text(simulation.time_spent(), totals.wall_seconds)));
    }
    const bool lost = losses();
    if (live_)
      live_->end(stopped ? "stopped" : "completed",
                 lost ? "Losses through the sides of the domain exceed run.max_lost." : "", &simulation);
    return stopped ? kExitStopped : lost ? kExitLost : 0;
  }

  void take(const RunFindings& found) {
    if (found.name.empty()) return;
    for (const std::string& warning : found.warnings) {
      fmt::print(stderr, "warning: {}\n", warning);
      session_->output()->warn(warning);
    }
    session_->output()->add(found.name, found.quantities, found.note);
  }

  /// Reports losses through sides of the domain that are no outlets; whether they exceed run.max_lost.
  bool losses() {
    const auto d = session_->simulation().diagnostics();
    const std::vector<Loss> by_side = session_->simulation().losses();
    const auto sides = [&](const char* phase) {
      std::string text;
      for (const Loss& loss : by_side)
        if (loss.phase == phase)
          text += fmt::format("{} {:.0f}{} through {} from t = {:.4g} s", text.empty() ? ":" : ",",
                              loss.count, loss.phase == "fluid" ? " particles" : "", loss.side, loss.first);
      return text;
    };
    const auto read = [&](const char* name) {
      const auto q =
          std::find_if(d.begin(), d.end(), [&](const Quantity& each) { return each.name == name; });
      return q == d.end() ? 0 : q->value;
    };
    bool too_many = false;
    const auto report = [&](const std::string& what, double lost, double left,
                            const std::string& where = "") {
      if (!(lost > 0)) return;
      const double fraction = lost / (lost + left), allowed = session_->prepared().config.max_lost;
      too_many = too_many || fraction > allowed;
      const std::string text = fmt::format("{}, {:.3g} %, left the domain where there is no outlet{}", what,
                                           100 * fraction, where);
      if (fraction > allowed)
        fmt::print(stderr, "{}; run.max_lost = {} allows {:.3g} %\n", text, allowed, 100 * allowed);
      else
        print("lost       " + text + "\n");
    };
    const double fluid = read("lost_fluid_mass"), grains = read("grains_outside"), all = read("grain_count");
    report(fmt::format("{:.4g} kg of fluid", fluid), fluid, read("fluid_mass"), sides("fluid"));
    report(fmt::format("{:.0f} of {:.0f} grains", grains, all), grains, all - grains, sides("grains"));
    const auto& walls = session_->prepared().config.wall.bodies;
    const auto bodies = double(std::ranges::count_if(walls, [](auto& body) { return body.free.present; }));
    const double gone = read("bodies_outside");
    report(fmt::format("{:.0f} of {:.0f} free bodies", gone, bodies), gone, bodies - gone);
    return too_many;
  }

  fs::path last_checkpoint() {
    const fs::path last = session_->output()->last_checkpoint();
    return last.empty() ? options_.restart : last;
  }

  /// After a write error: names the checkpoint to restart from, as the rest of the sentence.
  std::string checkpoint_hint() {
    const fs::path last = session_->output()->last_checkpoint();
    std::error_code unknown;
    return fs::exists(last, unknown) ? "; the last good checkpoint is " + last.string() : "";
  }

  /// Writes the broken state as a last frame; returns the rest of the error's sentence.
  std::string after_fault() {
    const fs::path good = session_->output()->last_checkpoint();
    try {
      session_->finish("failed");
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "warning: the last frame was not written: {}\n", error.what());
    }
    return good.empty() ? "; there is no checkpoint (set checkpoint.every)"
                        : "; the last good checkpoint is " + good.string();
  }

  const Options& options_;
  Prepared p_;
  RunWatcher* watcher_;  ///< or null
  LiveView* live_;       ///< or null
  double end_;
  std::optional<Session> session_;
  std::size_t warnings_printed_ = 0;
};

}  // namespace

int run_prepared(const Options& options, Prepared prepared, RunWatcher* watcher, LiveView* live) {
  const Places places = prepared.config.places;
  return placed(places, [&] {
    Run run(options, std::move(prepared), watcher, live);
    const FolderLock lock(options.out);  // before grains settle, which may take hours
    refuse_other_run(options);           // again: one may have finished since
    return run.go();
  });
}

namespace {

void find_restart(Options& options) {
  if (options.restart == "latest") options.restart = latest_checkpoint(options.out);
}

/// The first process says what to do, and prints what went wrong here.
int run_as_other(const Options& given, Processes& all) {
  Options options = given;
  options.quiet = true;
  const auto read = [&] {
    find_restart(options);
    Prepared p = prepare(options);
    return OwnCase{std::move(p.config), std::move(p.setup), p.device, code_of(p.device), own_gpu(p.device)};
  };
  serve(all, read, make_own_part);
  return 0;
}

/// Among several processes once all have read it.
Prepared prepare_all(const Options& options) {
  Prepared p = prepare(options);
  if (Processes* const all = Processes::joined()) {
    all->hear(nullptr, 0);
    connect(*all, own_gpu(p.device),
            options.mpi_data == "nccl"   ? GpuData::nccl
            : options.mpi_data == "host" ? GpuData::host
                                         : GpuData::automatic);
  }
  return p;
}

}  // namespace

int run_case(const Options& given) {
  watch_signals();
  Options options = given;
  if (options.mpi) Processes::join();
  if (options.mpi && Processes::joined()->rank() > 0) return run_as_other(options, *Processes::joined());
  find_restart(options);
  refuse_other_run(options);  // before particles are placed, which takes time
  if (!options.live) return run_prepared(options, prepare_all(options));

  LiveServer server(*options.live, case_name(options.file));
  if (!options.quiet) fmt::print("live       {}\n", server.address());
  std::fflush(stdout);
  try {
    return run_prepared(options, prepare_all(options), nullptr, &server.view());
  } catch (const std::exception& error) {
    server.view().end("failed", error.what());
    throw;
  } catch (const Stopped&) {
    server.view().end("stopped", "Before t = 0.");
    throw;
  }
}

}  // namespace bedload
