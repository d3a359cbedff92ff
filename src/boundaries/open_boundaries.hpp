#pragma once
// Where particles come in and go out. It acts where neighbour lists are renewed, so that nothing waits for it
// in between.

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

namespace bedload::inline BL_VARIANT {

class OpenBoundaries {
 public:
  /// Registers with `grains` the sides through which they leave. It and `motion` must outlive this.
  OpenBoundaries(const OpenBoundaryParameters& parameters, const Frame& frame, WallMotion& motion,
                 GrainStore& grains);

  /// The ids of what comes in follow those of what a case starts with.
  void start(const FluidStore& fluid, const GrainStore& grains);

  /// A layer of fluid has come through its orifice.
  bool fluid_due() const;
  /// A grain has come due at time t (s).
  bool grains_due(double t) const;

  /// Takes out the fluid that has left, lets in what has come through at time t. The fluid's lists must be
  /// renewed then.
  void renew(FluidStore& fluid, WallStore& walls, const EquationOfState& eos, double t, const Vec3d& gravity);
  /// Takes out and drops in grains; their lists must be renewed with what it returns.
  GrainRenewal renew(GrainStore& grains, double t);

  /// What has left the domain where there is no outlet, by sides, up to time t.
  std::vector<Loss> losses(const GrainStore& grains, double t) const;
  /// Counts and masses of what came and went, up to time t.
  std::vector<Quantity> report(double t) const;
  void save(std::vector<Quantity>& scalars) const;
  /// `scalar(name)`: as saved; t: the time reached.
  void load(const std::function<double(const std::string&)>& scalar, double t);

 private:
  struct Tally {
    double count = 0, mass = 0;  ///< kg
    double first = -1;           ///< s, when it first did; below 0: never
    void add(double n, double m, double t) {
      if (n > 0 && first < 0) first = t;
      count += n, mass += m;
    }
  };
  /// Of one phase: its outlets, and what left by which way: through the sides of the domain, then outlets.
  struct OutletRegions {
    WallGeometry geometry;
    std::vector<Tally> tally;
    OutletRegions(const OpenBoundaryParameters& parameters, const char* phase);
  };
  template <class P, class Mass>
  bool find_leaving(OutletRegions& regions, Span<const P> x, bool domain, const Mass& mass, double t);
  Tally lost_fluid() const;  ///< through all sides
  /// Of the grains outside now, by sides.
  std::vector<Tally> grains_outside(const GrainStore& grains, double t) const;
  void admit(std::size_t inlet, FluidStore& fluid, const WallStore& walls, const EquationOfState& eos,
             double t, const Vec3d& gravity);
  bool is_clear(const NewGrain& grain, double t) const;
  std::vector<NewGrain> new_grains(const GrainStore& grains, double t);
  bool drop_one(GrainSource& source, const GrainStore& grains, double t, std::vector<NewGrain>& all) const;
  /// f(name, unit, value) for all that a restart must know; value may be set.
  template <class Self, class F>
  static void each_scalar(Self& self, const F& f);

  OpenBoundaryParameters parameters_;
  Frame frame_;
  WallMotion& motion_;
  OutletRegions fluid_out_, grains_out_;
  GrainMatter matter_;
  Field<std::uint32_t> left_through_;  ///< 1 + side of the domain; 0: inside
  std::vector<double> grains_left_;    ///< s, when the first grain was found beyond each side; below 0: never
  std::vector<GrainSource> sources_;
  double next_fluid_ = 0, next_grain_ = 0;  ///< ids never given before

  Buffer<std::uint32_t> sink_;
  Buffer<Index> kept_, source_index_;
  Buffer<NewGrain> dropped_;
};

}  // namespace bedload::inline BL_VARIANT
