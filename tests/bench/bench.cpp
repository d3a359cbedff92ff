// Times whole steps of a case and prints one JSON line; tools/bench.py runs it and makes the table.
// Start-up, settling, files and the first steps are not counted; list rebuilds and the adaptive step are.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/prepare.hpp"
#include "cli/progress.hpp"
#include "cli/settle.hpp"

namespace {

struct Span {
  double seconds = 0;
  double simulated = 0;  // s
  std::int64_t substeps = 0, rebuilds = 0;
};

Span time_steps(bedload::Simulation& simulation, int steps) {
  Span span;
  const auto from = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) {
    const bedload::StepInfo info = simulation.step();
    span.simulated += info.dt;
    span.substeps += info.substeps;
    span.rebuilds += info.rebuilt;
  }
  span.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  return span;
}

}  // namespace

int main(int argc, char** argv) {
  bedload::Options options;
  std::string precision;
  int warm = 20, steps = 200, spans = 3;
  double at = 0;
  CLI::App app("Times whole steps of a case.", "bedload_bench");
  app.add_option("case", options.file)->required();
  app.add_option("--backend", options.backend);
  app.add_option("--precision", precision)->required();
  app.add_option("--set", options.overrides)->allow_extra_args(false);
  app.add_option("--threads", options.threads);
  app.add_option("--at", at, "Time at which measuring begins, s");
  app.add_option("--warm", warm, "Steps after that which are not counted");
  app.add_option("--steps", steps, "Steps of one span");
  app.add_option("--spans", spans);
  CLI11_PARSE(app, argc, argv);
  options.overrides.push_back("run.precision=" + precision);

  try {
    bedload::Prepared p = bedload::prepare(options);
    const auto simulation = bedload::make_simulation(p.config, p.setup, p.device);
    if (p.config.grain.present && p.config.grain.settle) {
      bedload::Progress progress(true, 0, p.config.grain.settle_time);
      simulation->load_grains(bedload::settled_grains(p.config, p.setup, p.device, progress, p.warnings).state);
    }
    simulation->start();
    while (simulation->time() < at) simulation->step();
    time_steps(*simulation, warm);

    auto measured = nlohmann::json::array();
    for (int k = 0; k < spans; ++k) {
      const Span s = time_steps(*simulation, steps);
      measured.push_back({{"seconds", s.seconds},
                          {"simulated", s.simulated},
                          {"substeps", s.substeps},
                          {"rebuilds", s.rebuilds}});
    }
    const bedload::Counts n = simulation->counts();
    const nlohmann::json result{{"device", p.device.name},
                                {"precision", p.config.precision},
                                {"fluid", n.fluid},
                                {"walls", n.walls},
                                {"grains", n.grains},
                                {"bytes", simulation->bytes()},
                                {"h_over_dx", p.config.fluid.h_over_dx},
                                {"steps", steps},
                                {"spans", measured}};
    std::printf("%s\n", result.dump().c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
