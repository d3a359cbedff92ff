// Rows of spectra.csv and spectra_peaks.csv.

#include <algorithm>
#include <array>
#include <cmath>

#include "bedload/case/materials.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

/// A class of contacts that can come about: all of one name.
struct ContactClass {
  std::string name;
  std::vector<std::uint32_t> places;
};

/// Of each material in the order of GrainConfig::all_materials; those of clumps by the name of the clump.
std::vector<std::string> names_of_materials(const GrainConfig& g) {
  std::vector<std::string> names;
  for (const GrainMaterial& m : g.named_materials()) names.push_back(name_in_pairs(m));
  const auto add = [&](const std::string& clump, const std::string& of) {
    names.push_back(clump + "_of_" + names[g.material(of)]);
  };
  for (const GrainFill& fill : g.fills)
    if (!fill.clump.empty()) add(fill.clump, fill.material);
  for (const ClumpConfig& clump : g.clumps)
    for (const std::string& of : clump.dropped) add(clump.name, of);
  return names;
}

std::vector<ContactClass> classes_of(const Config& c, const ContactSpectra& layout) {
  std::vector<ContactClass> out;
  const auto add = [&](const std::string& name, std::uint32_t place) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const auto& of) { return of.name == name; });
    if (same != out.end())
      same->places.push_back(place);
    else
      out.push_back({name, {place}});
  };
  std::vector<std::string> kinds;
  for (const std::string& name : names_of_materials(c.grain))
    for (std::uint32_t size = 0; size < layout.sizes; ++size)
      kinds.push_back(name + (layout.sizes > 1 ? "_" + std::to_string(size) : ""));
  const auto first = [&](std::uint32_t kind) {  // of the same name
    return std::uint32_t(std::find(kinds.begin(), kinds.end(), kinds[kind]) - kinds.begin());
  };
  for (std::uint32_t a = 0; a < kinds.size(); ++a)
    for (std::uint32_t b = a; b < kinds.size(); ++b) {
      const auto [one, other] = std::minmax({first(a), first(b)});
      add(kinds[one] + "_" + kinds[other], layout.of_pair(a, b));
    }
  for (std::uint32_t body = 0; body < c.wall.bodies.size(); ++body)
    for (std::uint32_t kind = 0; kind < kinds.size(); ++kind)
      if (c.wall.bodies[body].stops_grains())
        add(kinds[kind] + "_on_" + c.wall.bodies[body].name, layout.on_wall(body, kind));
  return out;
}

/// A quantity of contacts, and what the sum over those in a bin is called.
struct BinnedKind {
  const char *count, *sum, *unit;
  double in_unit;  ///< of a unit of the bins
};

/// A row for each bin from the first to the last with any contact; edges(bin): its columns before those of
/// the classes.
template <class Edges>
std::vector<std::vector<Quantity>> rows_of(const std::vector<SpectrumBin>& bins, const Config& config,
                                           const ContactSpectra& layout,
                                           const std::array<BinnedKind, ContactSpectra::kKinds>& kinds,
                                           Edges&& edges) {
  const std::vector<ContactClass> classes = classes_of(config, layout);
  const int size = layout.size();
  int first = size, last = -1;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const int bin = int(k % std::size_t(size));
    if (bins[k].count > 0) first = std::min(first, bin), last = std::max(last, bin);
  }
  if (last < 0) first = last = 0;
  std::vector<std::vector<Quantity>> rows;
  for (int bin = first; bin <= last; ++bin) {
    rows.push_back(edges(std::pow(10.0, double(bin) / layout.per_decade)));
    for (const ContactClass& c : classes)
      for (int kind = 0; kind < ContactSpectra::kKinds; ++kind) {
        SpectrumBin at{};
        for (const std::uint32_t place : c.places)
          at.add(bins[(std::size_t(place) * ContactSpectra::kKinds + kind) * std::size_t(size) + bin]);
        const BinnedKind& as = kinds[std::size_t(kind)];
        rows.back().push_back({c.name + as.count, "-", double(at.count)});
        rows.back().push_back({c.name + as.sum, as.unit, at.sum.value() * as.in_unit});
      }
  }
  return rows;
}

}  // namespace

std::vector<std::vector<Quantity>> CoupledSimulation::spectra() {
  const SpectraBooks* const books = state_.has_grains ? stepper_.solids().spectra() : nullptr;
  if (!books) return {};
  const ContactSpectra& layout = books->layout();
  return rows_of(books->bins(), config_, layout,
                 {{{"_normal_count", "_normal_energy", "J", layout.unit()},
                   {"_tangential_count", "_tangential_energy", "J", layout.unit()}}},
                 [&](double up) {
                   return std::vector<Quantity>{{"from", "J", layout.from * up}};
                 });
}

std::vector<std::vector<Quantity>> CoupledSimulation::spectra_peaks() {
  const SpectraBooks* const books = state_.has_grains ? stepper_.solids().spectra() : nullptr;
  if (!books) return {};
  const ContactSpectra& layout = books->layout();
  return rows_of(books->peaks(), config_, layout,
                 {{{"_energy_count", "_energy_sum", "J", layout.unit()},
                   {"_force_count", "_force_sum", "N", layout.unit_of_force()}}},
                 [&](double up) {
                   return std::vector<Quantity>{{"from_energy", "J", layout.from * up},
                                                {"from_force", "N", layout.from_force * up}};
                 });
}

}  // namespace BL_SOLVER
