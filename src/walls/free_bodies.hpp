#pragma once
// Free rigid bodies: state, contacts with other bodies, substeps. For grains and fluid they are walls with
// poses.

#include <array>
#include <memory>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/bodies.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/simulation.hpp"
#include "kernels/bodies/ball_contacts.hpp"
#include "kernels/bodies/body_kicks.hpp"
#include "kernels/fluid/wall_repulsion.hpp"
#include "src/walls/parameters.hpp"
#include "src/walls/pressure_correction.hpp"
#include "src/walls/substep_loads.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

/// Loads on a body, about its centre.
struct BodyForces {
  LoadSum fluid = LoadSum::zero(), grains = LoadSum::zero(), bodies = LoadSum::zero();
};

/// Sums over the free bodies.
struct BodyTotals {
  double mass = 0, kinetic = 0, rotational = 0, potential = 0;  ///< kg, J; of the centres, about them
  Vec3d momentum, angular;                                      ///< kg m/s; about the origin, kg m2/s
  int outside = 0;  ///< number of bodies with their centre outside the domain
};

/// A rigid body with reference point `centre` (m) and the constraints `move` and `turn` (with `axis`) of a
/// case; plane: and those of a plane flow.
RigidBody rigid_body(const MassProperties& m, const Vec3d& centre, BodyMove move, BodyTurn turn,
                     const Vec3d& axis, bool plane);

class FreeBodies {
 public:
  /// `walls`: surfaces that stop grains and bodies; must outlive this.
  FreeBodies(const FreeBodyParameters& parameters, const Frame& frame, const WallGeometry& walls);

  int size() const { return int(parameters_.bodies.size()); }
  bool any() const { return size() > 0; }
  /// Index among the free bodies, -1 for other bodies.
  int place_of(int body) const { return places_[body]; }
  /// Index among the wall bodies.
  int body(int place) const { return int(rigid(place).body); }
  const RigidBody* constants() const { return constants_.data(); }
  /// Bodies are held while the grains settle.
  void settle(bool on) { settling_ = on; }
  bool settling() const { return settling_; }

  /// Writes the present poses into rows of poses on the device.
  void write(Span<BodyPose> poses, int row_size, int rows, double time) const;
  /// Writes the mid-step poses with the mean velocities over the last step into one row.
  void write_middle(Span<BodyPose> row, double dt) const;

  // A step: begin, first_kick, a substep for each row of poses except the first, and add_fluid_loads.
  /// poses: [substeps + 1][row_size], initially the present ones. Uses the loads of grains from the last
  /// evaluation and of the fluid from the end of the last step. fluid_kick (s): kick by the fluid at the
  /// start of the step.
  void begin(Span<BodyPose> poses, int row_size, double time, double dt, int substeps, double fluid_kick,
             const std::vector<Vec3d>& gravity);
  void first_kick();
  /// Contacts of the bodies in row s, with the loads recorded by grains, then kicks and drift.
  void substep(int s);
  /// All substeps, for a case without grains.
  void advance();
  /// Contacts at the present poses, without advancing time; poses: one row.
  void evaluate(Span<const BodyPose> poses);

  /// Buffer in which `grains` grains record their loads on bodies, until the next evaluation. bounds: of the
  /// load of one of them, N, N m. By all ranks, also those without grains.
  ContactLoads record(Index grains, const std::array<double, 6>& bounds);
  /// What that takes, bytes of one grain.
  std::size_t record_bytes() const {
    return any() ? sizeof(Index) + std::size_t(met_by_grain()) * sizeof(ContactLoad) : 0;
  }

  PressureCorrection& pressure_correction() { return pressure_correction_; }
  /// Sums the fluid force on the wall particles [walls] and the repulsion at the end of a step, and kicks the
  /// bodies with it. corrected: with what pressure_correction() has found; dt: the step, 0 at the start of a
  /// run. poses: one row.
  void add_fluid_loads(const WallStore& walls, const Buffer<Vec3d>& force, bool corrected,
                       const WallRepulsion* repulsion, const FluidStore& fluid, Span<const BodyPose> poses,
                       const LoadBounds& bounds, double kick, double dt);

  /// Copies positions and velocities at `time` (s) to the host; the velocity of a held body is zero.
  void read_back(double time);
  /// As last read back.
  const RigidMotion& motion(int place) const { return now_[place]; }
  /// The first body whose state is not finite, -1 if there is none.
  int broken() const;
  /// Largest speed of a point of a body, m/s, extrapolated by dt (s) from the last read back.
  double top_speed(double dt = 0) const;

  /// Limits on a substep. wall_speed: of prescribed walls, m/s.
  std::vector<StepLimit> limits(double wall_speed) const;

  BodyForces forces(int place) const;
  /// Loads of the grains by which each moved in the last substep, on the device, about their centres.
  const LoadSum* by_grains() const { return grain_sums_.data(); }
  /// Total load of the fluid on each, on the device; N, N m about their centres.
  Span<const Vec3d> fluid_force() const { return store_.fluid_force; }
  Span<const Vec3d> fluid_torque() const { return store_.fluid_torque; }
  /// State of the bodies, and of their contacts.
  std::vector<const Store*> stores() const {
    if (!any()) return {};
    return {&store_, &memory_};
  }
  /// Force and torque of free bodies on any wall body, in the last substep of this run.
  LoadSum contact_load(int body) const;
  /// Of other bodies in the substeps of the last step, for bodies on which it is recorded.
  SubstepLoads& substep_loads() { return substep_loads_; }
  BodyTotals totals(double time) const;
  /// Number of contacts of balls with surfaces that are left out (kMostWallContacts). poses: one row.
  double dropped_contacts(Span<const BodyPose> poses);
  /// Correction of the fluid load on a body by pressure.linear_exact.
  LoadSum correction(int place) const;

  void save(std::vector<HostStore>& stores) const;
  /// `find(name)`: the store of that name, as it was at `time` (s).
  template <class Find>
  void load(const Find& find, double time) {
    if (!any()) return;
    const auto fits = [&](const HostStore& saved, const Store& own) {
      if (saved.count != own.size())
        throw FileError("checkpoint: it was made with other free bodies, or other balls by which they touch");
    };
    fits(find("bodies"), store_);
    store_.load(find("bodies"));
    if (balls_.size() > 0) {
      fits(find("body_contacts"), memory_);
      memory_.load(find("body_contacts"));
      point_at_memory();
    }
    read_back(time);
  }

 private:
  const RigidBody& rigid(int place) const { return parameters_.bodies[place].rigid; }
  int met_by_grain() const { return std::min(size(), kMostWallContacts); }  ///< at once
  void point_at_memory();
  BodyFields fields() const;
  BallPass ball_pass(Span<const BodyPose> poses, double dt);
  void evaluate_contacts(Span<const BodyPose> poses, double dt);
  BodyPass pass() const;
  void kick(const BodyPass& pass) { for_each(store_.owned(), pass); }

  FreeBodyParameters parameters_;
  Frame frame_;
  const WallGeometry& walls_;
  bool settling_ = false;
  std::vector<int> places_;
  std::vector<RigidMotion> now_;
  double contact_radius_ = 0, largest_radius_ = 0;  ///< smallest and largest R*, m

  mutable BodyStore store_;  ///< mutable: const members pass its spans to kernels
  Buffer<RigidBody> constants_;
  Buffer<BodyLaw> laws_;                   ///< of the free bodies
  Buffer<ElasticCompliance> compliances_;  ///< of all wall bodies
  Buffer<ContactBall> balls_;
  /// [capacity][balls], as one list
  struct Memory : Store {
    Memory() : Store("body_contacts") {}
    Field<WallMemory> memory{*this, "memory", WallMemory::units(), Lifetime::kept};
    Field<Index> count{*this, "count", "-", Lifetime::kept};  ///< of each ball; further entries are unused
  } memory_;
  int capacity_ = 0;
  Buffer<WallMemory*> memory_pointers_;

  Buffer<ContactLoad> grain_slots_, ball_slots_;
  Buffer<Index> grain_counts_, ball_counts_;
  ContactLoads grain_loads_, ball_loads_;
  bool by_grains_ = false;  ///< grains record loads
  std::array<double, 6> grain_bounds_{};
  SubstepLoads substep_loads_;
  Buffer<LoadSum> grain_sums_, ball_sums_, wall_sums_, repulsion_sums_;
  PressureCorrection pressure_correction_;
  Buffer<RigidMotion> report_;

  struct Step {
    Span<BodyPose> poses;
    int row_size = 0, substeps = 0;
    double time = 0, dt = 0, fluid_kick = 0;
    std::vector<Vec3d> gravity;
  } step_;
};

}  // namespace BL_SOLVER
