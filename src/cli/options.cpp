#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bench_rows.hpp"
#include "commit.hpp"
#include "list.hpp"
#include "shell.hpp"
#include "src/viewer/live/server.hpp"

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

/// The command line less --restart and --overwrite, to be continued.
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

/// An empty name, as of a variable of a shell that is not set, would count as no option.
const CLI::Validator kNamed([](const std::string& name) { return name.empty() ? "is empty" : ""; }, "",
                            "named");

/// Those of all commands that compute.
void add_common_options(CLI::App& app, Options& o) {
  app.add_option("--backend", o.backend, "Where to compute: auto takes a GPU if there is one")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--set", o.overrides, "Wins over the case, e.g. grain.e=0.5; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--threads", o.threads, "CPU threads; all if not given")->check(CLI::Range(1, 1024));
}

const CLI::IsMember kPrecisions({"single", "mixed", "double"});

void add_case_options(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  app.add_option("case", o.file, "Case file")->required()->type_name("CASE.toml")->check(kNamed);
  add_common_options(app, o);
  app.add_option("--precision", precision, "single, mixed or double; wins over the case")->check(kPrecisions);
  app.add_flag("--force-dt", force_dt, "A fixed step above its limit only warns");
}

void add_bench_options(CLI::App& app, Options& o) {
  BenchOptions& b = o.bench;
  std::string names;
  for (const BenchRow& row : bench_rows()) names += " " + row.name;
  app.add_option(
         "row", b.cases,
         "Case files or rows built in:" + names + "; if none is given, 0.1M on a CPU, 1M 5M 8M 14M on a GPU")
      ->type_name("ROW | CASE.toml");
  app.add_option("--widths", b.widths, "Dam breaks of these widths in m besides, e.g. 0.2,0.4")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.01, 1e4));
  add_common_options(app, o);
  app.add_option("--precision", b.precisions, "single, mixed or double; repeatable")
      ->check(kPrecisions)
      ->allow_extra_args(false);
  app.add_option("--at", b.at, "Measure from this time in s; dam breaks splash at 0.6")
      ->check(CLI::Range(0.0, 1e12));
  app.add_option("--warm", b.warm, "Steps after that which do not count; 20 if not given")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--steps", b.steps, "Steps of one span; 200 if not given")->check(CLI::Range(1, 1000000000));
  app.add_option("--spans", b.spans, "Spans, of which the median counts; 3 if not given")
      ->check(CLI::Range(1, 1000000));
  app.add_flag(
      "--default-settings", b.default_settings,
      "Rows with fluid once more with Bedload's own h, density diffusion, void relaxation, shifting");
  app.add_option("--json", b.json, "Write the numbers there, too")->type_name("FILE")->check(kNamed);
}

/// Those of commands that leave results.
void add_results_options(CLI::App& app, Options& o) {
  app.add_option("--out", o.out, "Results folder; results/<case> if not given")
      ->type_name("DIR")
      ->check(kNamed);
  app.add_option("--until", o.until, "Stop at this time in s, in place of time.end")
      ->check(CLI::Range(0.0, 1e12));
  app.add_flag("--overwrite", o.overwrite, "Replace the run that the results folder holds");
  app.add_flag("--quiet", o.quiet, "Print nothing but results, warnings and errors");
}

/// A port, or none for the default one.
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
                 "--live", fmt::format("{} is no port within {}..{}, nor 0 for any that is free", port,
                                       LiveServer::kLeastPort, LiveServer::kMostPort));
         },
         fmt::format(
             "Show the run in a browser on this machine, at 127.0.0.1 and this port; {} if none is named",
             LiveServer::kDefaultPort))
      ->expected(0, 1)
      ->type_name("[PORT]");
}

void add_run(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* run = app.add_subcommand("run", "Run a case");
  add_case_options(*run, o, precision, force_dt);
  add_results_options(*run, o);
  run->add_option("--restart", o.restart,
                  "Go on from this checkpoint; latest: the newest in the results folder")
      ->type_name("FILE")
      ->check(kNamed);
  add_live(*run, o);
  run->add_flag("--allow-changes", o.allow_changes,
                "Go on though the case computes otherwise than the checkpoint's");
}

void add_viscometer(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* viscometer =
      app.add_subcommand("viscometer", "Run a plane shear flow and tell its viscosity and stress");
  add_case_options(*viscometer, o, precision, force_dt);
  add_results_options(*viscometer, o);
  viscometer->add_flag("--relative", o.relative,
                       "Run the case without its grains first, and tell the relative viscosity");
}

void add_check(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  CLI::App* check = app.add_subcommand(
      "check", "Check a case: particles, step limits, memory, time; leaves nothing behind");
  add_case_options(*check, o, precision, force_dt);
  check->add_option("--preview", o.preview, "Write the initial particles and a picture of them there")
      ->type_name("DIR")
      ->check(kNamed);
}

void add_list(CLI::App& app, Options& o) {
  CLI::App* list = app.add_subcommand("list", "Show what a case may hold");
  std::vector<std::string> listed = families();
  for (const std::string& section : sections()) listed.push_back(section);
  list->add_option("name", o.family,
                   "One of them, a section of a case, a key, or a word of another program; all if not given")
      ->check(CLI::Validator(not_listed, fmt::format("{{{}}}", fmt::join(listed, ","))));
  list->add_flag("--json", o.json, "For programs: key, kind, unit, default, bounds, choices");
}

void add_info(CLI::App& app, Options& o) {
  CLI::App* info = app.add_subcommand("info", "Show what a result file holds");
  info->add_option("file", o.file, "Checkpoint, .vtkhdf or summary.json")
      ->required()
      ->type_name("FILE")
      ->check(kNamed);
}

void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw CaseError(fmt::format("command line: {} is no command; it must be one of {}", argv[1], names));
}

void refuse_to_go_on(int argc, const char* const* argv) {
  for (int i = 2; i < argc; ++i)
    if (argv[1] == std::string_view("viscometer") && std::string_view(argv[i]).starts_with("--restart"))
      throw CaseError(
          "command line: --restart: a viscometer measures a run as a whole and cannot go on from a "
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
  CLI::App app("Bedload computes free-surface flow with grains (SPH-DEM).", "bedload");
  app.require_subcommand(1);
  app.set_version_flag("--version", "bedload " + version());
  add_run(app, o, precision, force_dt);
  add_viscometer(app, o, precision, force_dt);
  add_check(app, o, precision, force_dt);
  add_list(app, o);
  add_info(app, o);
  add_bench_options(*app.add_subcommand("bench", "Time whole steps of cases, as a table"), o);
  app.add_subcommand("schema", "Print the JSON schema of case files, for editors");
  CLI::App* completion =
      app.add_subcommand("completion", "Print a script that completes commands in a shell");
  std::string shell;
  completion->add_option("shell", shell, "Which shell")->required()->check(CLI::IsMember({"bash"}));
  app.add_subcommand("man", "Print the manual page: bedload man | man -l -");

  refuse_unknown_command(app, argc, argv);
  refuse_to_go_on(argc, argv);
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
  if (o.until && !std::isfinite(*o.until)) throw CaseError("command line: --until: must be a time in s");
  if (!precision.empty()) o.overrides.push_back("run.precision=" + precision);
  if (force_dt) o.overrides.push_back("time.force_dt=true");
  if ((o.command == "run" || o.command == "viscometer") && o.out.empty())
    o.out = std::filesystem::path("results") / case_name(o.file);
  o.repeat = repeatable(argc, argv);
  return o;
}

}  // namespace bedload
