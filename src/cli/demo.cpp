// A run of a template, drawn: what a new user sees first.

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "bedload/core/error.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "run.hpp"
#include "session.hpp"
#include "src/viewer/film.hpp"
#include "stop.hpp"
#include "templates.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

class Filming final : public RunWatcher {
 public:
  void begin(const Config& config, double end) override { film_.emplace(config, end); }
  void after_step(Simulation& simulation, const StepInfo&) override { film_->after_step(simulation); }
  bool may_restart() const override { return true; }
  const Film& film() const { return *film_; }

 private:
  std::optional<Film> film_;
};

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(fmt::format("{}: cannot write: {}", folder.string(), error.message()));
}

}  // namespace

int new_case(const Options& options) {
  if (options.case_template.empty()) {
    fmt::print("{}\nWrite one with: bedload new NAME [FILE]\n", templates_text());
    return 0;
  }
  for (const fs::path& path : write_template(options.case_template, options.file, false))
    fmt::print("wrote      {}\n", path.string());
  fmt::print("next       bedload check {} --preview look\n", options.file.string());
  return 0;
}

int demo(const Options& options) {
  watch_signals();
  refuse_other_run(options);
  make_folder(options.out);
  write_template(options.case_template, options.file, true);
  if (!options.quiet)
    fmt::print("demo       runs {} and draws it: a picture and a film\n", options.case_template);
  Filming filming;
  const int code = run_prepared(options, prepare(options), &filming);
  filming.film().write(options.out);
  if (options.quiet) return code;
  fmt::print("picture    {}\n", (options.out / "picture.png").string());
  fmt::print("film       {}; a browser plays it\n", (options.out / "film.png").string());
  fmt::print("case       {}; `bedload new` lists others to begin with\n", options.file.string());
  return code;
}

}  // namespace bedload
