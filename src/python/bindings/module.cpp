// The extension module of the Python package: cases, runs in this process, the command line.

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>
#include <optional>

#include "arrays.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/folder_lock.hpp"
#include "cli/commands.hpp"
#include "cli/first_step.hpp"
#include "cli/session.hpp"
#include "tree.hpp"

namespace nb = nanobind;

namespace bedload {
namespace {

/// All simulations of a build share scratch memory, so only one thread computes at a time.
std::mutex& computing() {
  static std::mutex one;
  return one;
}

/// f() without the lock of the interpreter, one call at a time.
template <class F>
auto computed(F&& f) {
  const nb::gil_scoped_release release;
  const std::lock_guard lock(computing());
  return f();
}

/// name -> (value, unit)
nb::dict to_dict(const std::vector<Quantity>& quantities) {
  nb::dict out;
  for (const Quantity& q : quantities) out[q.name.c_str()] = nb::make_tuple(q.value, q.unit);
  return out;
}

/// name -> (seconds, whether it is the active limit)
nb::dict to_dict(const std::vector<StepLimit>& limits) {
  nb::dict out;
  for (const StepLimit& limit : limits)
    out[std::string(name_of(limit.limit)).c_str()] = nb::make_tuple(limit.seconds, limit.binds);
  return out;
}

/// A dictionary each.
nb::list to_list(const std::vector<RankReport>& ranks) {
  nb::list out;
  for (const RankReport& r : ranks) {
    nb::dict one;
    one["fluid"] = r.own.fluid, one["walls"] = r.own.walls, one["grains"] = r.own.grains;
    one["ghosts"] = r.ghosts, one["bytes"] = r.bytes, one["exchanges"] = r.exchanges;
    one["migrated"] = r.migrated, one["sent"] = r.sent, one["waited"] = r.waited;
    out.append(one);
  }
  return out;
}

/// A session for Python.
class Run {
 public:
  Run(const ReadCase& given, const std::filesystem::path& out, const std::filesystem::path& restart,
      const std::string& backend, int threads, bool overwrite, bool allow_changes, const std::string& devices,
      int ranks) {
    Options options;
    options.command = "run";
    options.devices = devices;
    options.ranks = ranks;
    options.out = out;
    options.restart = restart;
    options.backend = backend;
    options.threads = threads;
    options.overwrite = overwrite;
    options.allow_changes = allow_changes;
    options.quiet = true;
    computed([&] {
      if (!out.empty()) {
        lock_.emplace(out);
        refuse_other_run(options);
      }
      placed(given.config.places, [&] {
        Prepared prepared;
        prepared.config = given.config;
        prepared.warnings = given.warnings;
        initialise(options, prepared);
        session_.emplace(options, std::move(prepared), [](const std::string&) {});
      });
    });
  }

  Simulation& simulation() { return session_->simulation(); }
  const Config& config() const { return session_->prepared().config; }
  Session& session() { return *session_; }
  bool cuda() const { return session_->prepared().device.cuda(); }

  StepInfo step() {
    return computed([&] { return placed(config().places, [&] { return session_->step(); }); });
  }
  void begin() {
    computed([&] { session_->begin(); });
  }
  void finish(const std::string& status) {
    computed([&] { session_->finish(status); });
    lock_.reset();
  }

  nb::dict fields(const std::string& store) {
    const auto views = computed([&] { return simulation().fields(store); });
    nb::dict out;
    for (const FieldView& v : views)
      out[v.name.c_str()] =
          nb::make_tuple(cuda() ? nb::cast(DeviceField{v, session_->prepared().device}) : view_of(v), v.unit);
    return out;
  }
  nb::dict snapshot(const std::string& store) {
    HostStore all = computed([&] { return simulation().snapshot(store); });
    nb::dict out;
    for (HostArray& a : all.arrays) {
      const std::string name = a.name, unit = a.unit;
      out[name.c_str()] = nb::make_tuple(array_of(std::move(a)), unit);
    }
    return out;
  }
  nb::dict measure(const std::string& name) {
    for (const ProbeConfig& probe : config().out.probes)
      if (probe.name == name) return to_dict(computed([&] { return simulation().measure(probe); }));
    throw CaseError("there is no probe \"" + name + "\" in this case");
  }
  nb::dict body(const std::string& name) {
    const auto& bodies = config().wall.bodies;
    for (int k = 0; k < int(bodies.size()); ++k)
      if (bodies[k].name == name) return to_dict(computed([&] { return simulation().body_state(k); }));
    throw CaseError("there is no wall body \"" + name + "\" in this case");
  }
  std::filesystem::path checkpoint() {
    if (!session_->output()) throw FileError("a run without a results folder has no checkpoints; set out");
    return computed([&] { return session_->output()->checkpoint(simulation()); });
  }

 private:
  std::optional<FolderLock> lock_;
  std::optional<Session> session_;
};

/// The results of `bedload check`, as numbers.
nb::dict checked(const ReadCase& given, const std::string& backend, int threads, const std::string& devices,
                 int ranks) {
  Prepared p;
  p.config = given.config;
  p.warnings = given.warnings;
  Options options;
  options.backend = backend;
  options.threads = threads;
  options.devices = devices;
  options.ranks = ranks;
  std::optional<FirstStep> first;
  std::vector<RankReport> parts;
  computed([&] {
    placed(given.config.places, [&] {
      initialise(options, p);
      first.emplace(p, false);
      first->take();
      if (first->trial) parts = first->trial->simulation().ranks();
      first->trial.reset();  // the lock is held
    });
  });
  nb::dict out;
  out["counts"] = nb::make_tuple(p.counts.fluid, p.counts.walls, p.counts.grains);
  out["device"] = p.device.backend + ", " + p.device.text();
  out["memory"] = first->memory.all > 0 ? first->memory.all : p.memory.of(p.counts);
  out["step_limits"] = to_dict(first->steps);
  out["substep_limits"] = to_dict(first->substeps);
  out["numerical_viscosity"] = to_dict(first->numerical_viscosity);
  out["ranks"] = to_list(parts);
  out["warnings"] = p.warnings;
  out["notes"] = first->notes();
  return out;
}

/// The program's four errors become those of bedload.errors.
void translate(const std::exception_ptr& error, void*) {
  const auto raise = [](const char* name, const char* text) {
    const nb::object kind = nb::module_::import_("bedload.errors").attr(name);
    PyErr_SetString(kind.ptr(), text);
  };
  try {
    std::rethrow_exception(error);
  } catch (const CaseError& e) {
    raise("CaseError", e.what());
  } catch (const FileError& e) {
    raise("FileError", e.what());
  } catch (const DeviceError& e) {
    raise("DeviceError", e.what());
  } catch (const SimulationFault& e) {
    raise("SimulationFault", e.what());
  }
}

void bind_runs(nb::module_& m) {
  nb::class_<StepInfo>(m, "Step", "What one step did.")
      .def_ro("step", &StepInfo::step, "Steps done.")
      .def_ro("time", &StepInfo::time, "At the end of the step, s.")
      .def_ro("dt", &StepInfo::dt, "s.")
      .def_ro("substeps", &StepInfo::substeps, "DEM substeps in it.")
      .def_prop_ro(
          "limit", [](const StepInfo& i) { return std::string(name_of(i.limit)); },
          "Active limit of dt: cfl, viscous, ...")
      .def_ro("vmax", &StepInfo::vmax, "Of the fastest fluid particle, m/s.")
      .def_ro("rebuilt", &StepInfo::rebuilt,
              "Neighbour lists were rebuilt: the order of particles has changed.")
      .def("__repr__", [](const StepInfo& i) {
        return "Step(step=" + std::to_string(i.step) + ", time=" + std::to_string(i.time) + ")";
      });
  nb::class_<Run>(m, "Run", "A simulation and its results folder, if it has one.")
      .def(nb::init<const ReadCase&, std::filesystem::path, std::filesystem::path, std::string, int, bool,
                    bool, std::string, int>(),
           nb::arg("case"), nb::arg("out"), nb::arg("restart"), nb::arg("backend"), nb::arg("threads"),
           nb::arg("overwrite"), nb::arg("allow_changes"), nb::arg("devices"), nb::arg("ranks"))
      .def("begin", &Run::begin, "Writes the first frames.")
      .def("step", &Run::step, "One step and the output that is due.")
      .def("finish", &Run::finish, nb::arg("status"), "Writes the last results.")
      .def_prop_ro("time", [](Run& r) { return r.simulation().time(); })
      .def_prop_ro("end", [](Run& r) { return r.config().time.end; })
      .def_prop_ro("steps", [](Run& r) { return r.simulation().steps(); })
      .def_prop_ro("counts",
                   [](Run& r) {
                     const Counts n = r.simulation().counts();
                     return nb::make_tuple(n.fluid, n.walls, n.grains);
                   })
      .def_prop_ro("bytes", [](Run& r) { return r.simulation().bytes(); })
      .def_prop_ro("cuda", &Run::cuda)
      .def_prop_ro("warnings", [](Run& r) { return r.session().prepared().warnings; })
      .def("ranks", [](Run& r) { return to_list(computed([&] { return r.simulation().ranks(); })); })
      .def("limits", [](Run& r) { return to_dict(computed([&] { return r.simulation().limits(); })); })
      .def("time_spent", [](Run& r) { return to_dict(r.simulation().time_spent()); })
      .def("diagnostics",
           [](Run& r) { return to_dict(computed([&] { return r.simulation().diagnostics(); })); })
      .def("measure", &Run::measure, nb::arg("probe"))
      .def("body", &Run::body, nb::arg("name"))
      .def("fields", &Run::fields, nb::arg("store"))
      .def("snapshot", &Run::snapshot, nb::arg("store"))
      .def("checkpoint", &Run::checkpoint);
  m.def("latest_checkpoint", &latest_checkpoint, nb::arg("folder"),
        "The newest checkpoint of a results folder.");
  m.def("check", &checked, nb::arg("case"), nb::arg("backend"), nb::arg("threads"), nb::arg("devices"),
        nb::arg("ranks"), "Places the particles, evaluates the step limits, does one step.");
}

}  // namespace

NB_MODULE(_bedload, m) {
  nb::register_exception_translator(translate);
  bind_arrays(m);
  bind_cases(m);
  bind_runs(m);
  m.def("version", [] { return version(); });
  m.def("commit", [] { return commit(); });
  m.def(
      "main",
      [](const std::vector<std::string>& arguments) {
        std::vector<const char*> words;
        for (const std::string& word : arguments) words.push_back(word.c_str());
        const nb::gil_scoped_release release;
        return run_program(int(words.size()), words.data());
      },
      nb::arg("arguments"), "The program `bedload`: prints, and returns its exit code.");
}

}  // namespace bedload
