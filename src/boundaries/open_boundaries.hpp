#pragma once
// Open boundaries: inlets, outlets, and particles that leave the domain. Particles are inserted and removed
// when neighbour lists are rebuilt.

#include <functional>
#include <string>
#include <vector>

#include "bedload/parallel/compact.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/simulation.hpp"
#include "kernels/boundaries/drop.hpp"
#include "kernels/fluid/equation_of_state.hpp"
#include "src/boundaries/parameters.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/solids/solid_solver.hpp"
#include "src/walls/wall_geometry.hpp"
#include "src/walls/wall_motion.hpp"

namespace BL_SOLVER {

class OpenBoundaries {
 public:
  /// Adds a field to `grains` with the side through which each left. `grains` and `motion` must outlive this.
  OpenBoundaries(const OpenBoundaryParameters& parameters, const Frame& frame, WallMotion& motion,
                 GrainStore& grains);

  /// New particles get ids after those of the initial particles.
  void start(const FluidStore& fluid, const GrainStore& grains);

  /// A buffer layer of fluid has passed its orifice.
  bool fluid_due() const;
  /// A grain is due at time t (s).
  bool grains_due(double t) const;

  /// Removes the fluid that has left and inserts the layers that are due at time t. The lists of the fluid
  /// must be rebuilt afterwards.
  void renew(FluidStore& fluid, WallStore& walls, const EquationOfState& eos, double t, const Vec3d& gravity);
  /// Removes and inserts grains and whole clumps, of which solids are told; their lists must be rebuilt with
  /// the result. Ghosts are dropped.
  GrainRenewal renew(GrainStore& grains, SolidSolver& solids, double t);

  /// Particles that have left the domain other than through outlets, by side, up to time t.
  std::vector<Loss> losses(const GrainStore& grains, double t) const;
  /// Counts and masses of inserted and removed particles, up to time t.
  std::vector<Quantity> report(double t) const;
  void save(std::vector<Quantity>& scalars) const;
  /// `scalar(name)`: as saved; t: the time reached.
  void load(const std::function<double(const std::string&)>& scalar, double t);

 private:
  struct Tally {
    double count = 0, mass = 0;  ///< kg
    double first = -1;           ///< time of the first, s; below 0: none
    void add(double n, double m, double t) {
      if (n > 0 && first < 0) first = t;
      count += n, mass += m;
    }
  };
  /// Outlets of one phase, and tallies of what left: through each side of the domain, then each outlet.
  struct OutletRegions {
    WallGeometry geometry;
    std::vector<Tally> tally;
    OutletRegions(const OpenBoundaryParameters& parameters, Phase phase);
  };
  struct Arrivals {
    std::vector<NewGrain> grains;  ///< those of a clump in the order of its spheres
    std::vector<NewClump> clumps;
  };
  /// x: of all particles, ghosts behind those that are `owned`. clumps: null for a phase without any.
  template <class P, class Mass>
  bool find_leaving(OutletRegions& regions, Span<const P> x, Range owned, bool domain, const Mass& mass,
                    double t, const Clumps* clumps = nullptr);
  /// Marks the grains of clumps as their centres are.
  void leave_together(const OutletRegions& regions, const Clumps& clumps);
  Tally lost_fluid() const;  ///< through all sides
  /// Grains that are outside now, by side.
  std::vector<Tally> grains_outside(const GrainStore& grains, double t) const;
  void admit(std::size_t inlet, FluidStore& fluid, const WallStore& walls, const EquationOfState& eos,
             double t, const Vec3d& gravity);
  bool is_clear(const NewGrain& grain, double t) const;
  Arrivals new_grains(const GrainStore& grains, const Clumps& clumps, double t);
  bool drop_one(std::size_t source, const GrainStore& grains, const Clumps& clumps, double t, Arrivals& all);
  /// f(name, unit, value) for the state of a restart; value may be set.
  template <class Self, class F>
  static void each_scalar(Self& self, const F& f);

  OpenBoundaryParameters parameters_;
  Frame frame_;
  WallMotion& motion_;
  OutletRegions fluid_out_, grains_out_;
  GrainMatter matter_;
  Field<std::uint32_t> left_through_;  ///< 1 + side of the domain; 0: inside
  std::vector<double> grains_left_;    ///< time when the first grain left through each side, s; below 0: none
  std::vector<GrainSource> sources_;
  double next_fluid_ = 0, next_grain_ = 0;  ///< next unused ids

  Buffer<std::uint32_t> sink_, clump_sink_;
  Buffer<Vec3d> centres_;         ///< of clumps, scratch
  Buffer<Vec4<double>> spheres_;  ///< of a clump to drop, scratch
  Buffer<Index> layer_;           ///< wall particles of a layer that comes in, scratch
  Buffer<Index> kept_, source_index_;
  Buffer<NewGrain> dropped_;
};

}  // namespace BL_SOLVER
