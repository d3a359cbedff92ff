#pragma once
// The lattice Boltzmann equation between walls: what is kept, and the order of passes in a step.

#include <functional>
#include <vector>

#include "bedload/case/formula.hpp"
#include "bedload/host_data.hpp"
#include "kernels/lattice/node_passes.hpp"
#include "src/lattice/lattice_store.hpp"
#include "src/lattice/parameters.hpp"
#include "src/lattice/resolved_grains.hpp"

namespace BL_SOLVER {

/// Sums over the fluid, SI.
struct FluidSums {
  double nodes = 0, mass = 0, kinetic = 0;
  Vec3d momentum, angular;
  Vec3d residual;  ///< of the momentum: what neither walls nor forces account for
};
/// What a wall body has from the fluid, SI.
struct WallSums {
  Vec3d force, torque;    ///< in the last step, torque about its centre
  Vec3d impulse, turned;  ///< since the start; moment about the origin
  double work = 0;        ///< since the start
};
/// State of the fluid at a node, SI.
struct NodeValue {
  Vec3d velocity;
  double pressure = 0;  ///< above that of rho0, Pa
  bool fluid = false;
};

class LatticeSolver {
 public:
  /// grains: around which the fluid flows; they must outlive this. Null: there are none.
  explicit LatticeSolver(const LatticeParameters& parameters, ResolvedGrains* grains = nullptr);

  /// The nodes of a case. Once, unless a state is loaded.
  void fill(const Setup::Nodes& nodes);
  /// Equilibrium of the velocities of a setup, at hydrostatic density.
  void begin();
  /// One step, from time (s), and its number, from 1. Grains are where they are at its end; held: at rest,
  /// and where they have been.
  void step(double time, std::int64_t number, bool held = true);
  double dt() const { return p_.units.dt; }

  const LatticeUnits& units() const { return p_.units; }
  const lattice::NodeGrid& grid() const { return grid_; }
  Vec3d place(Index node) const;  ///< m
  std::size_t bytes_of_node() const { return lattice::kVelocities * sizeof(Real) + nodes_.entry_bytes(); }

  lattice::NodeExtremes extremes() const;
  FluidSums totals() const;
  WallSums wall(int body, double time) const;                               ///< at time, s
  Vec3d force_on_node() const { return p_.units.force() * Vec3d(force_); }  ///< by gravity and drive, N
  RigidMotion motion(int body, double time) const { return p_.walls[std::size_t(body)].motion.at(time); }
  Vec3d by_images() const;  ///< momentum that fluid has from images of a sheared box since the start, kg m/s
  Vec3d driven() const;     ///< momentum by gravity and drive on the fluid since the start, kg m/s
  double restored() const { return p_.units.mass() * restored_; }  ///< mass that was added since, kg
  std::vector<NodeValue> values(const std::vector<Index>& nodes) const;
  /// Of all nodes: velocity in nodes a step, density less 1, which is -1 in solids.
  std::vector<Real4> states() const;

  /// Flow and stress of all rows of nodes along an axis at time (s), and the moments of the forces on grains,
  /// J. held: as in step().
  std::vector<lattice::RowSums> stress(int axis, double time, bool held, Buffer<PairMoment<>>& of_grains);

  void save(SavedState& out) const;
  /// Once the number of the last step is known.
  void load(const HostStore& nodes, const HostStore& links,
            const std::function<double(const std::string&)>& scalar, double time, std::int64_t step);

 private:
  lattice::Populations populations(bool odd) const;
  lattice::NodeMoments moments() const { return {populations(odd_), force_}; }
  Real3 force_at(double time) const;
  /// Populations of a step from walls at time (s); counted: walls receive what these lose.
  void follow_walls(double time, bool odd, bool counted = true);
  /// In a sheared box: what comes in from images in a step from time (s). counted: as of walls.
  void follow_images(double time, bool counted = true);
  lattice::SideImages images_at(double time) const;
  /// Nodes beyond sheared sides; grains are to cover them anew, with images where they are at time (s).
  void clear_layers(double time);
  void restore_mass();
  void find_ranges();
  /// Of the mass, beyond a density of 1 of all nodes that grains may cover, from NodeTotals.
  double excess_of(const double* totals) const { return totals[0] - count_ + totals[1]; }

  const LatticeParameters p_;
  ResolvedGrains* const grains_;
  const Formula drive_factor_;
  const lattice::Relaxation rate_;
  lattice::NodeGrid grid_;
  Vec3d first_;               ///< place of node 0, m
  Buffer<Real> populations_;  ///< as Populations has them
  NodeStore nodes_;
  LinkStore links_;
  std::vector<Range> ranges_;  ///< links of each body
  Buffer<Real3> velocity_;     ///< at the start alone
  bool odd_ = false;           ///< the number of the last step
  Real3 force_{};              ///< per volume in it, in units of the lattice
  double excess_ = 0;          ///< of the mass at the start, as excess_of has it
  Vec3d momentum_;             ///< at the start, likewise, with half a step of the force
  double count_ = 0;           ///< nodes in no wall
  Vec3d driven_;               ///< kg m/s, of these nodes
  double restored_ = 0;        ///< in units of the lattice
};

}  // namespace BL_SOLVER
