// `bedload drag`: drag of grains that a fluid on a lattice flows around, as a table for drag.law = "table".

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/case/drag_table.hpp"
#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "benchmarks.hpp"
#include "commands.hpp"
#include "prepare.hpp"
#include "random_spheres.hpp"
#include "stop.hpp"

namespace bedload {
namespace {

/// Fixed spheres of diameter 1 in a lattice_cube() of fluid of density 1; the mean velocity over all space is
/// to be 1.
constexpr const char* kArray = R"(rho0 = 1
mu = {mu}
vmax = {vmax}
[drive]
f = [{push}, 0, 0]
[lattice]
velocity = 0.1
[grain]
d = 1
fixed = true
[[grain.fill]]
positions = [{places}]
[time]
end = 1e9
[out]
every = 1e9
)";

constexpr double kAcross = 4;     // fastest flow over the mean between grains
constexpr double kSteady = 2e-4;  // change of the mean velocity in a block that counts as none
constexpr int kBlocks = 200;      // at most; the flow may fluctuate for ever

// Drag without the mean pressure gradient over Stokes drag at the mean velocity, of random arrays.

double creeping(double fraction) {
  const double eps = 1 - fraction;
  return 10 * fraction / (eps * eps) + eps * eps * (1 + 1.5 * std::sqrt(fraction));
}
/// By [beetstra07]; the push follows from it.
double beetstra(double fraction, double reynolds) {
  const double eps = 1 - fraction;
  return creeping(fraction) + 0.413 * reynolds / (24 * eps * eps) *
                                  (1 / eps + 3 * fraction * eps + 8.4 * std::pow(reynolds, -0.343)) /
                                  (1 + std::pow(10, 3 * fraction) * std::pow(reynolds, -0.5 - 2 * fraction));
}
/// By [tang15].
double tang(double fraction, double reynolds) {
  const double eps = 1 - fraction, fourth = std::pow(eps, -4);
  return creeping(fraction) + reynolds * (0.11 * fraction * (1 + fraction) - 0.00456 * fourth +
                                          (0.169 * eps + 0.0644 * fourth) * std::pow(reynolds, -0.343));
}

struct Point {
  double reynolds = 0, factor = 0;  ///< factor: as in DragTable
};
struct Measured : Point {          ///< mean of the draws
  double least = 1e300, most = 0;  ///< of the factor
};

double value_of(const std::vector<Quantity>& rows, const std::string& name) {
  for (const Quantity& q : rows)
    if (q.name == name) return q.value;
  return 0;
}

class Arrays {
 public:
  explicit Arrays(const Options& o) : o_(o) {}

  /// Throws CaseError where the lattice cannot have it.
  Prepared read(double fraction, double reynolds, int draw) const {
    using fmt::arg;
    const bool simple = o_.drag.array == "simple";
    const int spheres = simple ? 8 : o_.drag.spheres;
    const double volume = spheres * std::numbers::pi / 6 / fraction, side = std::cbrt(volume);
    const double nodes = std::ceil(side * o_.drag.nodes - 1e-9), eps = 1 - fraction;
    const double push =
        spheres * 3 * std::numbers::pi / reynolds * beetstra(fraction, reynolds) / (volume * eps);
    std::string places;
    for (const Vec3d& x : simple ? cubic(side) : random_spheres(spheres, side, draw + 1))
      places += fmt::format("[{:.17g}, {:.17g}, {:.17g}],", x.x, x.y, x.z);
    const std::string text = lattice_cube(side, side / nodes) +
                             fmt::format(kArray, arg("mu", 1 / reynolds), arg("vmax", kAcross / eps),
                                         arg("push", push), arg("places", places));
    Prepared p;
    p.config =
        read_case_text(text, fmt::format("array of solid fraction {:g} at Re {:g}", fraction, reynolds),
                       o_.overrides, p.warnings);
    return p;
  }

  Point measure(double fraction, double reynolds, int draw) const {
    Prepared p = read(fraction, reynolds, draw);
    initialise(o_, p);
    const auto simulation = make_simulation(p.config, p.setup, p.device);
    simulation->start();
    const Vec3d side = p.config.domain.max - p.config.domain.min;
    return steady(*simulation, side.x * side.y * side.z, int(simulation->counts().grains), 1 - fraction,
                  1 / reynolds);
  }

 private:
  /// Two along each side, not at the same place among nodes along the axes.
  static std::vector<Vec3d> cubic(double side) {
    std::vector<Vec3d> x;
    for (int k = 0; k < 8; ++k)
      x.push_back(side * Vec3d{0.26 + 0.5 * (k & 1), 0.27 + 0.25 * (k & 2), 0.24 + 0.125 * (k & 4)});
    return x;
  }
  /// Runs until the mean velocity no longer changes; where it fluctuates, the mean of the second half.
  static Point steady(Simulation& simulation, double volume, int spheres, double eps, double mu) {
    const double block = std::min(0.25, 0.05 / mu);  // of the time in which fluid passes a sphere
    std::vector<double> flow, force;
    for (int k = 0; k < kBlocks; ++k) {
      for (const double until = simulation.time() + block; simulation.time() < until;) {
        if (stop_requested()) throw Stopped();
        simulation.step();
      }
      const auto rows = simulation.diagnostics();
      flow.push_back(value_of(rows, "fluid_momentum_x") / volume);
      force.push_back(value_of(rows, "force_fluid_on_grains_x") / spheres);
      if (k > 3 && std::abs(flow[k] - flow[k - 1]) < kSteady * flow[k] &&
          std::abs(flow[k] - flow[k - 2]) < 2 * kSteady * flow[k])
        return of(flow.back(), force.back(), eps, mu);
    }
    double u = 0, F = 0;
    constexpr int half = kBlocks / 2;
    for (int k = half; k < kBlocks; ++k) u += flow[k] / half, F += force[k] / half;
    return of(u, F, eps, mu);
  }
  static Point of(double u, double force, double eps, double mu) {
    return {u / mu, force * eps / (3 * std::numbers::pi * mu * u)};
  }

  const Options& o_;
};

/// ln of the factor, linear in ln(1 + Re) between points and beyond them, as the table has it.
double between(const std::vector<Measured>& points, double reynolds) {
  if (points.size() < 2) return points.front().factor;
  std::size_t k = 0;
  while (k + 2 < points.size() && points[k + 1].reynolds < reynolds) ++k;
  const Point &a = points[k], &b = points[k + 1];
  const double from = std::log1p(a.reynolds),
               fraction = (std::log1p(reynolds) - from) / (std::log1p(b.reynolds) - from);
  return a.factor * std::pow(b.factor / a.factor, fraction);
}

std::string table_text(const DragOptions& d, const std::vector<double>& porosity,
                       const std::vector<std::vector<Measured>>& rows) {
  std::vector<double> reynolds{0};
  reynolds.insert(reynolds.end(), d.reynolds.begin(), d.reynolds.end());
  std::string factor;
  for (std::size_t k = 0; k < porosity.size(); ++k) {
    factor += "  ";
    for (const double re : reynolds)
      factor += fmt::format("{:.5g}, ", between(rows[k], std::max(re, d.reynolds.front())));
    factor += fmt::format(" # porosity {:g}\n", porosity[k]);
  }
  return fmt::format(
      "# Drag on spheres by `bedload drag`: {} arrays, {} nodes across a sphere. The row of porosity 1 is a "
      "single\n"
      "# sphere by Schiller & Naumann. Below the first Reynolds number drag is as there.\n"
      "[drag]\nlaw = \"table\"\nporosity = [{:g}]\nreynolds = [{:g}]\nfactor = [\n{}]\n",
      d.array, d.nodes, fmt::join(porosity, ", "), fmt::join(reynolds, ", "), factor);
}

/// Measured points beside the laws of drag.law at the same porosity, and the laws alone between them.
std::string comparison_text(const DragOptions& d, const std::vector<std::vector<Measured>>& rows) {
  std::string text = fmt::format(
      "# K / (3 pi mu d) by `bedload drag`: {} arrays, {} nodes across a sphere, {} draws; and by the laws\n"
      "# of drag.law and, of random arrays, [beetstra07] and [tang15]. nan: not measured.\n"
      "solid_fraction,reynolds,measured,least,most,beetstra07,tang15",
      d.array, d.nodes, d.draws);
  for (const auto& law : kNames<DragLaw>)
    if (law.value != DragLaw::table) text += "," + std::string(law.name);
  text += "\n";
  const auto add = [&](double fraction, const Measured& at) {
    const double eps = 1 - fraction, re = at.reynolds;
    text += fmt::format("{:g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g}", fraction, re, at.factor, at.least,
                        at.most, eps * beetstra(fraction, re), eps * tang(fraction, re));
    for (const auto& law : kNames<DragLaw>)
      if (law.value != DragLaw::table) text += fmt::format(",{:.5g}", drag_factor(law.value, eps, re));
    text += "\n";
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const Measured& point : rows[k]) add(d.fractions[k], point);
    const double decades = std::log10(d.reynolds.back() / d.reynolds.front());
    const int steps = int(std::ceil(8 * decades));
    for (int i = 0; i <= steps && steps > 0; ++i)
      add(d.fractions[k], {{d.reynolds.front() * std::pow(10, decades * i / steps), none}, none, none});
  }
  return text;
}

}  // namespace

int drag(const Options& options) {
  watch_signals();
  DragOptions d = options.drag;
  std::sort(d.fractions.begin(), d.fractions.end(), std::greater<>());
  std::sort(d.reynolds.begin(), d.reynolds.end());
  for (auto* list : {&d.fractions, &d.reynolds})
    list->erase(std::unique(list->begin(), list->end()), list->end());
  std::filesystem::path comparison = options.out;
  comparison.replace_extension(".csv");
  if (comparison == options.out)
    throw CaseError(
        fmt::format("command line: --out {} must not end in .csv: points and laws go to that file",
                    options.out.string()));
  for (const auto& file : {options.out, comparison})
    if (std::filesystem::exists(file) && !options.overwrite)
      throw FileError(file.string() + ": exists; give --overwrite to replace it");
  const Arrays arrays(options);
  for (const double fraction : d.fractions)
    for (const double re : d.reynolds) arrays.read(fraction, re, 0);  // none is lost to one that cannot be
  std::vector<double> porosity;
  std::vector<std::vector<Measured>> rows;
  fmt::print("solid fraction  Re        K / (3 pi mu d)  spread of draws\n");
  for (const double fraction : d.fractions) {
    porosity.push_back(1 - fraction);
    rows.emplace_back();
    for (const double re : d.reynolds) {
      Measured mean;
      for (int k = 0; k < d.draws; ++k) {
        const Point p = arrays.measure(fraction, re, k);
        mean.reynolds += p.reynolds / d.draws, mean.factor += p.factor / d.draws;
        mean.least = std::min(mean.least, p.factor), mean.most = std::max(mean.most, p.factor);
      }
      fmt::print("{:<15g} {:<9.4g} {:<16.4f} {:.1f} %\n", fraction, mean.reynolds, mean.factor,
                 100 * (mean.most - mean.least) / mean.factor);
      std::fflush(stdout);
      rows.back().push_back(mean);
    }
  }
  write_file(comparison, comparison_text(d, rows));
  porosity.push_back(1);
  rows.emplace_back();
  for (const double re : d.reynolds)
    rows.back().push_back({{re, drag_factor(DragLaw::schiller_naumann, 1, re)}});
  write_file(options.out, table_text(d, porosity, rows));
  fmt::print("table      {}\nlaws       {}\n", options.out.string(), comparison.string());
  return 0;
}

}  // namespace bedload
