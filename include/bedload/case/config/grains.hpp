#pragma once
// Grains: what they are made of, where they are at the start.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bedload/case/config/shapes.hpp"
#include "bedload/case/setup_choices.hpp"

namespace bedload {

/// Grain sizes: one of several entries, each with a number fraction; one diameter or a distribution.
struct SizeClass {
  double d = 0;                                ///< class: diameter, m
  double number_fraction = 1;                  ///< of the grains, relative to the other entries
  double mass_fraction = 0;                    ///< the same of their mass; 0: none, or made a number fraction (resolved)
  Chosen<SizeKind> kind = SizeKind::one_size;
  double d_min = 0, d_max = 0;                 ///< uniform, log_normal: ends, m
  double median = 0;                           ///< log_normal: m
  double sigma = 0;                            ///< log_normal: standard deviation of ln d
  std::vector<double> openings{};              ///< sieve: of its meshes, m
  std::vector<double> passing{};               ///< sieve: fraction of the mass that each lets through
  bool operator==(const SizeClass&) const = default;
};

/// Grains that keep their places among each other and move as one body.
struct RigidConfig {
  bool present = false;
  Chosen<BodyMove> move = BodyMove::all;
  Chosen<BodyTurn> turn = BodyTurn::all;
  Vec3d axis{0, 0, 1};                         ///< unit (resolved)
  bool operator==(const RigidConfig&) const = default;
};

/// Centre and radius of a sphere of a clump: x, y, z, r.
using ClumpSphere = std::array<double, 4>;

/// What follows from the spheres of a clump, whose union it fills. The unit of length is the diameter of the
/// sphere of its volume.
struct ClumpShape {
  std::vector<ClumpSphere> spheres;            ///< from the centre of mass
  double reach = 0;                            ///< radius of the sphere about the centre of mass that holds all
  double fullness = 0;                         ///< its volume over the sum of those of the spheres
  double contact_mass = 1;                     ///< with which its spheres resist a blow, over their masses: means over spheres and directions
  std::array<double, 6> inertia{};             ///< of density 1: xx, yy, zz, xy, xz, yz
  Vec3d offset;                                ///< centre of the spheres' volumes, those of overlaps counted twice
  bool operator==(const ClumpShape&) const = default;
};

/// A shape of grains: spheres that move as one body.
struct ClumpConfig {
  std::string name;
  std::vector<ClumpSphere> spheres;            ///< in any unit
  std::string file;                            ///< with the spheres, which replace it when the case is read
  std::string solid;                           ///< name of a shape that they fill; they replace it likewise
  std::int64_t count = 0;                      ///< of them, at most
  double filled = 1;                           ///< of the volume of that shape (resolved)
  double density = 0;                          ///< kg/m3; 0: that of the material
  Chosen<ClumpDrag> drag = ClumpDrag::clump;   ///< in fluid
  ClumpShape shape;                            ///< resolved
  std::vector<std::string> dropped{};          ///< materials of those that inlets drop (resolved)
  /// Whether its spheres share one drag.
  bool shares_drag() const { return drag == ClumpDrag::clump && shape.spheres.size() > 1; }
  bool operator==(const ClumpConfig&) const = default;
};

/// Where grains come from: thrown at random into a box or a shape, then settled; or given one by one.
struct GrainFill {
  Vec3d min, max;                              ///< m; of a shape or a file: around it (resolved)
  std::string shape;                           ///< name of a shape to fill instead of a box
  Solid solid;                                 ///< resolved
  std::int64_t count = 0;                      ///< exactly one of count, mass, packing_fraction
  double mass = 0;                             ///< kg
  double packing_fraction = 0;
  std::vector<SizeClass> sizes;                ///< default: one class, grain.d
  std::vector<Vec3d> positions;                ///< explicit centres instead of random ones, m
  Vec3d velocity;                              ///< m/s
  Vec3d spin{};                                ///< rad/s
  std::vector<Vec3d> velocities{}, spins{};    ///< of `positions`, one each: m/s, rad/s
  std::vector<double> every{};                 ///< x, y, z: each so many sites of the fluid's lattice carry a grain; empty: not on the lattice
  bool relative = false;                       ///< positions, also those of a file, are fractions of the domain
  bool replaces_fluid = false;                 ///< each grain takes the place of the nearest fluid particle
  std::string material{};                      ///< which of grain.material; empty: grain.*
  std::string clump{};                         ///< which shape; empty: spheres
  std::vector<double> orientation{};           ///< of clumps, all alike: rotation vector, deg; empty: at random
  std::string file{};                          ///< grains instead of a box; absolute (resolved)
  std::int64_t step = -1;                      ///< frame of a .vtkhdf file; -1: the last
  RigidConfig rigid{};
  bool operator==(const GrainFill&) const = default;
};

/// What grains of a fill are made of; 0 and infinity: as grain.* (until resolved).
struct GrainMaterial {
  std::string name;
  double rho = 0;                              ///< kg/m3
  double E = 0;                                ///< Pa
  double nu = std::numeric_limits<double>::infinity();
  double mu = std::numeric_limits<double>::infinity();
  double mu_r = std::numeric_limits<double>::infinity();
  double e = 0;
  double fullness = 1, contact_mass = 1;       ///< of a clump's grains: see ClumpShape
  bool operator==(const GrainMaterial&) const = default;
};

struct GrainConfig {
  bool present = false;
  double d = 0;                                ///< m
  double rho = 2500;                           ///< kg/m3
  double E = 1e8;                              ///< Pa
  double nu = 0.3;
  double mu = 0.3;                             ///< sliding friction
  double mu_r = 0.01;                          ///< rolling friction
  double e = 0.9;                              ///< restitution
  std::uint64_t seed = 1;
  bool settle = false;                         ///< settle before t = 0
  double settle_time = 0;                      ///< longest settling, s (0: 20 sqrt(2 H / g))
  double settle_mu = std::numeric_limits<double>::infinity();  ///< sliding friction meanwhile (default mu)
  double release_time = 0;                     ///< grains are held until then, s
  bool fixed = false;                          ///< grains never move
  Chosen<GrainResolve> resolve = GrainResolve::by_size;  ///< around which the fluid flows
  double d_max = 0, d_min = 0;                 ///< m (resolved)
  std::vector<GrainFill> fills;
  std::vector<GrainMaterial> materials;        ///< besides that of grain.*
  std::vector<ClumpConfig> clumps;
  double largest() const { return d_max > 0 ? d_max : d; }   ///< diameter, m
  double smallest() const { return d_min > 0 ? d_min : d; }  ///< diameter, m
  /// Those that the case names: first that of grain.*.
  std::vector<GrainMaterial> named_materials() const {
    std::vector<GrainMaterial> all{{"", rho, E, nu, mu, mu_r, e}};
    for (const GrainMaterial& m : materials) all.push_back(completed(m));
    return all;
  }
  /// All of them as they are numbered: those named, then one for each fill of clumps, one for each material in
  /// which a clump is dropped. It has the density with which the spheres of a clump together weigh what their
  /// union does.
  std::vector<GrainMaterial> all_materials() const {
    std::vector<GrainMaterial> all = named_materials();
    const auto add = [&](const std::string& name, const std::string& of) {
      const ClumpConfig* clump = clump_named(name);
      if (!clump) return;
      all.push_back(all[material(of)]);
      all.back().fullness = clump->shape.fullness;
      all.back().contact_mass = clump->shape.contact_mass;
      all.back().rho = density(name, of) * clump->shape.fullness;
    };
    for (const GrainFill& fill : fills) add(fill.clump, fill.material);
    for (const ClumpConfig& clump : clumps)
      for (const std::string& of : clump.dropped) add(clump.name, of);
    return all;
  }
  /// With that of grain.* where it has nothing of its own.
  GrainMaterial completed(GrainMaterial m) const {
    if (m.rho == 0) m.rho = rho;
    if (m.E == 0) m.E = E;
    if (std::isinf(m.nu)) m.nu = nu;
    if (std::isinf(m.mu)) m.mu = mu;
    if (std::isinf(m.mu_r)) m.mu_r = mu_r;
    if (m.e == 0) m.e = e;
    return m;
  }
  /// Its number; that of grain.* for an unknown name.
  std::uint32_t material(const std::string& name) const {
    for (std::size_t k = 0; k < materials.size(); ++k)
      if (materials[k].name == name) return std::uint32_t(k + 1);
    return 0;
  }
  /// Null: there is none.
  const ClumpConfig* clump_named(const std::string& name) const {
    for (const ClumpConfig& clump : clumps)
      if (!name.empty() && clump.name == name) return &clump;
    return nullptr;
  }
  /// The shape of a fill's grains; null: spheres, or no such clump.
  const ClumpConfig* clump_of(const GrainFill& fill) const { return clump_named(fill.clump); }
  /// Of the solid of clumps, or of spheres, by their names, kg/m3.
  double density(const std::string& clump, const std::string& of) const {
    const ClumpConfig* shape = clump_named(clump);
    return shape && shape->density > 0 ? shape->density : named_materials()[material(of)].rho;
  }
  double density(const GrainFill& fill) const { return density(fill.clump, fill.material); }
  /// The number of the material of a fill's grains.
  std::uint32_t material_of(std::size_t fill) const {
    if (!clump_of(fills[fill])) return material(fills[fill].material);
    std::uint32_t number = std::uint32_t(1 + materials.size());
    for (std::size_t k = 0; k < fill; ++k) number += clump_of(fills[k]) != nullptr;
    return number;
  }
  /// The number of the material of clumps that inlets drop; of spheres, without a clump.
  std::uint32_t material_of_dropped(const std::string& clump, const std::string& of) const {
    if (!clump_named(clump)) return material(of);
    std::size_t number = 1 + materials.size() + clump_fills().size();
    for (const ClumpConfig& each : clumps)
      for (const std::string& name : each.dropped) {
        if (each.name == clump && name == of) return std::uint32_t(number);
        ++number;
      }
    return std::uint32_t(number);
  }
  /// Of the fills with clumps, their places.
  std::vector<int> clump_fills() const {
    std::vector<int> all;
    for (std::size_t k = 0; k < fills.size(); ++k)
      if (clump_of(fills[k])) all.push_back(int(k));
    return all;
  }
  bool has_clumps() const {
    for (const ClumpConfig& clump : clumps)
      if (!clump.dropped.empty()) return true;
    return !clump_fills().empty();
  }
  /// Of the fills that move as one body each, their places.
  std::vector<int> rigid_fills() const {
    std::vector<int> all;
    for (std::size_t k = 0; k < fills.size(); ++k)
      if (fills[k].rigid.present) all.push_back(int(k));
    return all;
  }
  bool operator==(const GrainConfig&) const = default;
};

}  // namespace bedload
