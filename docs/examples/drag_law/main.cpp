// Runs a case with the drag law of Beetstra, van der Hoef and Kuipers (AIChE J. 53, 2007), which is not built
// in, and prints how fast the grains sink on average. Usage: drag_law CASE
#include <bedload/case/drag_table.hpp>
#include <bedload/case/read.hpp>
#include <bedload/geometry/setup.hpp>
#include <bedload/simulation.hpp>
#include <cmath>
#include <cstdio>

/// Drag over Stokes drag. The paper counts it per superficial slip, hence the factor eps.
double beetstra(double eps, double Re) {
  const double phi = 1 - eps, slow = 10 * phi / (eps * eps) + eps * eps * (1 + 1.5 * std::sqrt(phi));
  if (Re == 0) return eps * slow;
  const double above = 1 / eps + 3 * eps * phi + 8.4 * std::pow(Re, -0.343);
  const double below = 1 + std::pow(10, 3 * phi) * std::pow(Re, -0.5 - 2 * phi);
  return eps * (slow + 0.413 * Re / (24 * eps * eps) * above / below);
}

int main(int argc, char** argv) try {
  std::vector<std::string> warnings;
  bedload::Config config = bedload::read_case(argc > 1 ? argv[1] : "case.toml", {}, warnings);
  config.couple.drag = bedload::DragLaw::table;
  config.couple.table = bedload::drag_table(beetstra);
  const auto device = bedload::find_device("auto", 0);
  const auto run = bedload::make_simulation(config, bedload::build_setup(config, warnings), device);
  run->start();
  while (run->time() < config.time.end) run->step();

  const bedload::HostStore grains = run->snapshot("grains");
  const float* v = grains.find("velocity")->as<float>();  // double where run.precision is double
  double sum = 0;
  for (std::size_t i = 0; i < grains.count; ++i) sum -= v[3 * i + 2];
  std::printf("%.6g m/s\n", sum / double(grains.count));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
