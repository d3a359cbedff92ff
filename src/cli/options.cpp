#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "bedload/core/error.hpp"
#include "list.hpp"

namespace bedload {
namespace {

/// results/<case>; for cases/dam/case.toml results/dam.
std::filesystem::path default_folder(const std::filesystem::path& file) {
  const auto folder = std::filesystem::absolute(file).parent_path().filename();
  return std::filesystem::path("results") / (file.stem() == "case" ? folder : file.stem());
}

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

void add_case_options(CLI::App& app, Options& o, std::string& precision, bool& force_dt) {
  app.add_option("case", o.file, "Case file")->required()->type_name("CASE.toml");
  app.add_option("--backend", o.backend, "Where to compute: auto takes a GPU if there is one")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--precision", precision, "single, mixed or double; wins over the case")
      ->check(CLI::IsMember({"single", "mixed", "double"}));
  app.add_option("--set", o.overrides, "Wins over the case, e.g. grain.e=0.5; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--threads", o.threads, "CPU threads; all if not given")->check(CLI::Range(1, 1024));
  app.add_flag("--force-dt", force_dt, "A fixed step above its limit only warns");
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

}  // namespace

std::string version() { return BL_VERSION; }

Options parse_options(int argc, const char* const* argv) {
  Options o;
  std::string precision;
  bool force_dt = false;
  CLI::App app("Bedload computes free-surface flow with grains (SPH-DEM).", "bedload");
  app.require_subcommand(1);
  app.set_version_flag("--version", "bedload " + version());

  CLI::App* run = app.add_subcommand("run", "Run a case");
  add_case_options(*run, o, precision, force_dt);
  run->add_option("--out", o.out, "Results folder; results/<case> if not given")->type_name("DIR");
  run->add_option("--until", o.until, "Stop at this time in s, in place of time.end")
      ->check(CLI::Range(0.0, 1e12));
  run->add_option("--restart", o.restart,
                  "Go on from this checkpoint; latest: the newest in the results folder")
      ->type_name("FILE");
  run->add_flag("--allow-changes", o.allow_changes,
                "Go on though the case computes otherwise than the checkpoint's");
  run->add_flag("--overwrite", o.overwrite, "Replace the run that the results folder holds");
  run->add_flag("--quiet", o.quiet, "Print nothing but warnings and errors");

  CLI::App* check =
      app.add_subcommand("check", "Check a case: particles, step limits, memory, time; leaves nothing behind");
  add_case_options(*check, o, precision, force_dt);
  check->add_option("--preview", o.preview, "Write the initial particles and a picture of them there")
      ->type_name("DIR");

  CLI::App* list = app.add_subcommand("list", "Show what a case may hold");
  std::vector<std::string> listed = families();
  for (const std::string& section : sections()) listed.push_back(section);
  list->add_option("family", o.family, "One of them, or a section of a case; all if not given")
      ->check(CLI::IsMember(listed));

  CLI::App* info = app.add_subcommand("info", "Show what a result file holds");
  info->add_option("file", o.file, "Checkpoint, .vtkhdf or summary.json")->required()->type_name("FILE");

  refuse_unknown_command(app, argc, argv);
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
  if (o.until && !std::isfinite(*o.until)) throw CaseError("command line: --until: must be a time in s");
  if (!precision.empty()) o.overrides.push_back("run.precision=" + precision);
  if (force_dt) o.overrides.push_back("time.force_dt=true");
  if (o.command == "run" && o.out.empty()) o.out = default_folder(o.file);
  o.repeat = repeatable(argc, argv);
  return o;
}

}  // namespace bedload
