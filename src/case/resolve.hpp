#pragma once
// From what the user gave to what the solver needs.

#include <filesystem>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

/// Fills in the defaults that follow from other parameters: sound speed, spacings,
/// coupling length, grain sizes, intervals. Throws CaseError for values it needs and lacks. What follows from
/// particles in files is read there, or from `checkpoint` if that is given.
void resolve(Config& config, const Value& root, const std::filesystem::path& checkpoint = {});

/// Fills in the boxes of fluid.fill that come from files: around the particles, half a spacing beyond them.
void resolve_listed_fluid(Config& config, const Value& root, const std::filesystem::path& checkpoint);

/// Fills in box and count of a grain.fill that comes from a file, and what its diameters mean for the case;
/// false if the file has no diameters.
bool resolve_listed_grains(Config& config, std::size_t index, const Value& root,
                           const std::filesystem::path& checkpoint);

/// Checks parameters against each other. Throws CaseError; appends warnings.
void cross_check(const Config& config, const Value& root, std::vector<std::string>& warnings);

/// Largest speed of a wall body (m/s); an oscillation's peak, a rotation's outermost corner.
double wall_speed(const WallBody& body, const DomainConfig& domain);

/// Height along gravity that boxes [min, max] span together, m; 0 without gravity.
template <class Fill>
double height(const std::vector<Fill>& fills, const Vec3d& gravity) {
  const double g = norm(gravity);
  if (g == 0 || fills.empty()) return 0;
  double lo = 1e300, hi = -1e300;
  for (const Fill& fill : fills) {
    double low = 0, high = 0;
    for (int k = 0; k < 3; ++k) {
      const double a = -gravity[k] / g * fill.min[k], b = -gravity[k] / g * fill.max[k];
      low += a < b ? a : b;
      high += a < b ? b : a;
    }
    lo = low < lo ? low : lo;
    hi = high > hi ? high : hi;
  }
  return hi - lo;
}

/// Solid volume that a fill asks for, m3; from count, mass or packing fraction.
double solid_volume(const GrainFill& fill, double rho);

}  // namespace bedload
