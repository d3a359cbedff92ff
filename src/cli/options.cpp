#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "bedload/core/error.hpp"
#include "benchmarks.hpp"
#include "commit.hpp"
#include "list.hpp"
#include "shell.hpp"
#include "src/viewer/live/server.hpp"
#include "templates.hpp"

namespace bedload {
namespace {

std::string shell_word(const std::string& word) {
  const auto safe = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-./=:,+").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), safe)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The command line without --restart and --overwrite, to which a message appends --restart.
std::string repeatable(int argc, const char* const* argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--restart") ++i;
    if (word.starts_with("--restart") || word == "--overwrite") continue;
    text += (text.empty() ? "" : " ") + shell_word(word);
  }
  return text;
}

/// The command that continues the run of a demonstration, to which a message appends --restart.
std::string run_of_demo(const Options& o, const std::string& program) {
  std::vector<std::string> words{program, "run", o.file.string(), "--out", o.out.string()};
  for (const std::string& assignment : o.overrides) words.insert(words.end(), {"--set", assignment});
  if (o.backend != "auto") words.insert(words.end(), {"--backend", o.backend});
  if (o.until) words.insert(words.end(), {"--until", fmt::format("{}", *o.until)});
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

/// Refuses an empty name, such as that of an unset shell variable: CLI11 would take it for no option.
const CLI::Validator kNamed([](const std::string& name) { return name.empty() ? "is empty" : ""; }, "",
                            "named");

/// Options of all commands that compute.
void add_common_options(CLI::App& app, Options& o) {
  app.add_option("--backend", o.backend, "Device: auto uses a GPU if there is one")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--set", o.overrides, "Override a case key, e.g. grain.e=0.5; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--threads", o.threads, "CPU threads; default: all")->check(CLI::Range(1, 1024));
}

/// Among what the particles are divided.
void add_division(CLI::App& app, Options& o) {
  app.add_option("--devices", o.devices, "Divide the particles among GPUs: so many, a list as 0,2,3, or all")
      ->type_name("N | LIST | all")
      ->check(kNamed);
  app.add_option("--ranks", o.ranks, "Divide the particles among so many parts of the CPU; default: 1")
      ->check(CLI::Range(1, 256));
}

const CLI::IsMember kPrecisions({"single", "mixed", "double"});

void add_case_options(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  app.add_option("case", o.file, "Case file")->required()->type_name("CASE.toml")->check(kNamed);
  add_common_options(app, o);
  app.add_option("--precision", precision, "single, mixed or double; overrides run.precision")
      ->check(kPrecisions);
  app.add_flag("--force-dt", force_dt, "Warn instead of fail if a fixed time.dt or time.dt_dem is unstable");
}

void add_bench_options(CLI::App& app, Options& o) {
  BenchOptions& b = o.bench;
  std::string names;
  for (const Benchmark& each : benchmarks()) names += " " + each.name;
  app.add_option(
         "name", b.cases,
         "Case files or built-in benchmarks:" + names + "; default: 0.1M on a CPU, 1M 5M 8M 14M on a GPU")
      ->type_name("NAME | CASE.toml");
  app.add_option("--widths", b.widths, "Also dam breaks of these widths in m, e.g. 0.2,0.4")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.01, 1e4));
  add_common_options(app, o);
  const std::string tables = "; several numbers, as 1,2,4, give tables of strong and weak scaling";
  app.add_option("--devices", b.devices, "Divide the particles among so many GPUs" + tables)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 256));
  app.add_option("--ranks", b.ranks, "Divide the particles among so many parts of the CPU" + tables)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 256));
  app.add_option("--precision", b.precisions, "single, mixed or double; repeatable")
      ->check(kPrecisions)
      ->allow_extra_args(false);
  app.add_option("--thread-counts", b.thread_counts,
                 "Time each row with these numbers of CPU threads, e.g. 1,2,4,8")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes("--threads")
      ->check(CLI::Range(1, 1024));
  app.add_option("--at", b.at, "Start timing at this simulated time in s; dam breaks splash at 0.6")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--warm", b.warm_up, "Warm-up steps that are not timed; default: 20")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--steps", b.steps, "Steps per repeat; default: 200")->check(CLI::Range(1, 1000000000));
  app.add_option("--spans", b.repeats, "Repeats, of which the median is reported; default: 3")
      ->check(CLI::Range(1, 1000000));
  app.add_flag(
      "--default-settings", b.default_settings,
      "Also run benchmarks with fluid at the default h, density diffusion, void relaxation and shifting");
  app.add_option(
         "--frames", b.frame_every,
         "Then time as many steps again with a frame every this many steps, into the folder for temporary "
         "files (TMPDIR), which is removed")
      ->check(CLI::Range(1, 1000000000))
      ->type_name("STEPS");
  app.add_option("--json", b.json, "Also write the numbers to a JSON file")->type_name("FILE")->check(kNamed);
}

void add_drag(CLI::App& app, Options& o) {
  DragOptions& d = o.drag;
  CLI::App* drag = app.add_subcommand(
      "drag", "Measure the drag of fixed grains on a lattice and write it as a table of drag.law");
  drag->add_option("--fractions", d.fractions, "Solid fractions; default: 0.1,0.2,0.3")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.001, 0.5));
  drag->add_option("--reynolds", d.reynolds,
                   "Reynolds numbers of the diameter and the mean velocity over all space; default: 0.1,1,10")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.01, 1000.0));
  drag->add_option("--array", d.array, "Arrangement of the grains; simple: cubic; default: random")
      ->check(CLI::IsMember({"random", "simple"}));
  drag->add_option("--spheres", d.spheres, "Grains of a random array; default: 54")
      ->check(CLI::Range(8, 2000));
  drag->add_option("--nodes", d.nodes, "Nodes across a grain, at least; default: 10")
      ->check(CLI::Range(5.0, 200.0));
  drag->add_option("--draws", d.draws, "Random arrays of which the mean is taken; default: 1")
      ->check(CLI::Range(1, 1000));
  add_common_options(*drag, o);
  drag->add_option("--out", o.out,
                   "File to write; default: drag_table.toml. Beside it, drag_table.csv: points and laws")
      ->type_name("FILE")
      ->check(kNamed);
  drag->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

/// Options of commands that write results.
void add_results_options(CLI::App& app, Options& o) {
  app.add_option("--out", o.out, "Results folder; default: results/<case>")->type_name("DIR")->check(kNamed);
  app.add_option("--until", o.until, "Stop at this simulated time in s; overrides time.end")
      ->check(CLI::Range(0.0, 1e12));
  app.add_flag("--overwrite", o.overwrite, "Overwrite an existing run in the results folder");
  app.add_flag("--quiet", o.quiet, "Print only results, warnings and errors");
}

/// --live with an optional port.
void add_live(CLI::App& run, Options& o) {
  run.add_option_function<std::string>(
         "--live",
         [&o](const std::string& port) {
           o.live = LiveServer::kDefaultPort;
           if (port.empty()) return;
           const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), *o.live);
           const bool free = *o.live == 0,
                      within = *o.live >= LiveServer::kLeastPort && *o.live <= LiveServer::kMostPort;
           if (error != std::errc() || end != port.data() + port.size() || !(free || within))
             throw CLI::ValidationError(
                 "--live", fmt::format("{} must be a port within {}..{}, or 0 for any free one", port,
                                       LiveServer::kLeastPort, LiveServer::kMostPort));
         },
         fmt::format("Show the run in a browser at 127.0.0.1 and this port; default: {}",
                     LiveServer::kDefaultPort))
      ->expected(0, 1)
      ->type_name("[PORT]");
}

void add_run(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* run = app.add_subcommand("run", "Run a case");
  add_case_options(*run, o, precision, force_dt);
  add_results_options(*run, o);
  run->add_option("--restart", o.restart,
                  "Restart from this checkpoint; latest: the newest in the results folder")
      ->type_name("FILE")
      ->check(kNamed);
  add_division(*run, o);
  run->add_flag("--mpi", o.mpi, "Divide the particles among the processes that mpirun or srun starts")
      ->excludes("--devices")
      ->excludes("--ranks");
  run->add_option(
         "--mpi-data", o.mpi_data,
         "Between GPUs of several processes: by NCCL or host memory; auto: NCCL where it can be used")
      ->needs("--mpi")
      ->check(CLI::IsMember({"auto", "nccl", "host"}));
  add_live(*run, o);
  run->add_flag("--allow-changes", o.allow_changes, "Restart with a modified case");
}

void add_viscometer(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* viscometer =
      app.add_subcommand("viscometer", "Run a plane shear flow and report its viscosity and stress");
  add_case_options(*viscometer, o, precision, force_dt);
  add_results_options(*viscometer, o);
  viscometer->add_flag("--relative", o.relative,
                       "Run the case without its grains first and report the relative viscosity");
}

void add_check(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* check = app.add_subcommand(
      "check", "Check a case: particles, step limits, memory, run time; writes no results");
  add_case_options(*check, o, precision, force_dt);
  add_division(*check, o);
  check->add_option("--preview", o.preview, "Write the initial particles and a picture of them to a folder")
      ->type_name("DIR")
      ->check(kNamed);
}

void add_new(CLI::App& app, Options& o) {
  CLI::App* add =
      app.add_subcommand("new", "Write a commented case to begin with; without a name: list them");
  add->add_option("template", o.case_template, "What the case is of")->check(CLI::IsMember(template_names()));
  add->add_option("file", o.file, "File to write; default: <template>.toml")
      ->type_name("NEW.toml")
      ->check(kNamed);
}

void add_demo(CLI::App& app, Options& o) {
  CLI::App* demo = app.add_subcommand("demo", "Run a small case that comes with the program, and draw it");
  demo->add_option("template", o.case_template,
                   fmt::format("One of `bedload new`; default: {}", kDemoTemplate))
      ->check(CLI::IsMember(template_names()));
  add_common_options(*demo, o);
  add_results_options(*demo, o);
}

void add_list(CLI::App& app, Options& o) {
  CLI::App* list = app.add_subcommand("list", "List case keys, laws, shapes and outputs");
  std::vector<std::string> listed = families();
  for (const std::string& section : sections()) listed.push_back(section);
  list->add_option("name", o.family, "A family, section or key, or a term of another program; default: all")
      ->check(CLI::Validator(not_listed, fmt::format("{{{}}}", fmt::join(listed, ","))));
  list->add_flag("--json", o.json, "Print JSON: key, kind, unit, default, bounds, choices");
}

void add_info(CLI::App& app, Options& o) {
  CLI::App* info = app.add_subcommand("info", "Show the contents of a result file");
  info->add_option("file", o.file, "Checkpoint, .vtkhdf or summary.json")
      ->required()
      ->type_name("FILE")
      ->check(kNamed);
}

void add_gui(CLI::App& app, Options& o) {
  CLI::App* gui = app.add_subcommand("gui", "Build, run and watch a case in a window (needs bedload[gui])");
  gui->add_option("case", o.file, "Case file; it is made if it does not exist")
      ->type_name("CASE.toml")
      ->check(kNamed);
  gui->add_option("--port", o.window.port, "Port at 127.0.0.1; 0: any that is free; default: 8030")
      ->check(CLI::Range(0, 65535));
  gui->add_flag("--no-browser", o.window.no_browser, "Print the address, open no browser");
}

void add_convert(CLI::App& app, Options& o) {
  CLI::App* convert = app.add_subcommand(
      "convert", "Make a case from one of DualSPHysics or LIGGGHTS, or write frames for other programs");
  convert
      ->add_option("from", o.file,
                   "Case_Def.xml of DualSPHysics, input script of LIGGGHTS, results folder or .vtkhdf file")
      ->required()
      ->type_name("FILE")
      ->check(kNamed);
  convert->add_option("--to", o.to, "Format of frames; default: extxyz")
      ->check(CLI::IsMember({"extxyz", "lammps"}));
  convert->add_option("--out", o.out, "File to write; default: named after the input")
      ->type_name("FILE")
      ->check(kNamed);
  convert->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw CaseError(fmt::format("command line: unknown command {}; it must be one of {}", argv[1], names));
}

void refuse_restart_of_viscometer(int argc, const char* const* argv) {
  for (int i = 2; i < argc; ++i)
    if (argv[1] == std::string_view("viscometer") && std::string_view(argv[i]).starts_with("--restart"))
      throw CaseError(
          "command line: --restart: a viscometer averages over a whole run and cannot restart from a "
          "checkpoint");
}

}  // namespace

std::string version() { return BL_VERSION; }
std::string commit() { return BL_COMMIT; }

std::string case_name(const std::filesystem::path& file) {
  return file.stem() == "case" ? std::filesystem::absolute(file).parent_path().filename() : file.stem();
}

Options parse_options(int argc, const char* const* argv) {
  Options o;
  std::string precision;
  bool force_dt = false;
  CLI::App app("Bedload simulates free-surface flow with grains (SPH-DEM).", "bedload");
  app.require_subcommand(1);
  app.set_version_flag("--version", "bedload " + version());
  add_run(app, o, precision, force_dt);
  add_viscometer(app, o, precision, force_dt);
  add_check(app, o, precision, force_dt);
  add_new(app, o);
  add_demo(app, o);
  add_list(app, o);
  add_info(app, o);
  add_convert(app, o);
  add_bench_options(*app.add_subcommand("bench", "Time steps of benchmark cases"), o);
  add_drag(app, o);
  add_gui(app, o);
  app.add_subcommand("schema", "Print the JSON schema of case files, for editors");
  CLI::App* completion = app.add_subcommand("completion", "Print a script for shell completion");
  std::string shell;
  completion->add_option("shell", shell, "Shell")->required()->check(CLI::IsMember({"bash"}));
  app.add_subcommand("man", "Print the manual page: bedload man | man -l -");

  refuse_unknown_command(app, argc, argv);
  refuse_restart_of_viscometer(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    o.text = app.help();
    return o;
  } catch (const CLI::CallForVersion&) {
    o.text = "bedload " + version() + "\n";
    return o;
  } catch (const CLI::ParseError& error) {
    throw CaseError(std::string("command line: ") + error.what() + "; see bedload --help");
  }
  o.command = app.get_subcommands().front()->get_name();
  if (o.command == "schema") o.text = schema_text();
  if (o.command == "completion") o.text = bash_completion(app);
  if (o.command == "man") o.text = man_page(app);
  if (o.until && !std::isfinite(*o.until))
    throw CaseError("command line: --until must be a finite time in s");
  if (!precision.empty()) o.overrides.push_back("run.precision=" + precision);
  if (force_dt) o.overrides.push_back("time.force_dt=true");
  if (o.command == "demo" && o.case_template.empty()) o.case_template = kDemoTemplate;
  if (o.command == "new" && o.file.empty()) o.file = o.case_template + ".toml";
  if ((o.command == "run" || o.command == "viscometer") && o.out.empty())
    o.out = std::filesystem::path("results") / case_name(o.file);
  if (o.command == "drag" && o.out.empty()) o.out = "drag_table.toml";
  if (o.command == "demo") {
    if (o.out.empty()) o.out = std::filesystem::path("results") / o.case_template;
    o.file = o.out / (o.case_template + ".toml");
  }
  o.repeat = o.command == "demo" ? run_of_demo(o, argv[0]) : repeatable(argc, argv);
  return o;
}

}  // namespace bedload
