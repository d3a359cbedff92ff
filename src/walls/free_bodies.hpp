#pragma once
// Bodies that move by the forces on them: their state, their contacts with other bodies, their substeps.
// Grains and fluid meet them as walls, by their poses.

#include <memory>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/bodies.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/simulation.hpp"
#include "kernels/bodies/ball_contacts.hpp"
#include "kernels/bodies/body_kicks.hpp"
#include "kernels/fluid/body_pressure.hpp"
#include "kernels/fluid/wall_repulsion.hpp"
#include "src/walls/parameters.hpp"
#include "src/walls/substep_loads.hpp"
#include "src/walls/wall_geometry.hpp"

namespace bedload::inline BL_VARIANT {

/// What acts on a body, about its centre.
struct BodyForces {
  LoadSum fluid = LoadSum::zero(), grains = LoadSum::zero(), bodies = LoadSum::zero();
};

/// Sums over the free bodies.
struct BodyTotals {
  double mass = 0, kinetic = 0, rotational = 0, potential = 0;  ///< kg, J; of the centres, about them
  Vec3d momentum, angular;                                      ///< kg m/s; about the origin, kg m2/s
  int outside = 0;  ///< how many have their centre outside the domain
};

struct BodyCorrection {
  Vec3d force;       ///< N
  double power = 0;  ///< W
};

/// A rigid body about `centre` (m) under the constraints `move` and `turn` (with `axis`) of a case, and those
/// of a plane flow if it is one.
RigidBody rigid_body(const MassProperties& m, const Vec3d& centre, const std::string& move,
                     const std::string& turn, const Vec3d& axis, bool plane);

class FreeBodies {
 public:
  /// `walls`: surfaces that stop grains, which bodies meet too; must outlive this.
  FreeBodies(const FreeBodyParameters& parameters, const Frame& frame, const WallGeometry& walls);

  int size() const { return int(parameters_.bodies.size()); }
  bool any() const { return size() > 0; }
  /// Place among the free bodies, -1 for a body that is none.
  int place_of(int body) const { return places_[body]; }
  /// Place among the wall bodies.
  int body(int place) const { return int(rigid(place).body); }
  const RigidBody* constants() const { return constants_.data(); }
  /// While the grains settle the bodies are held.
  void settle(bool on) { settling_ = on; }
  bool settling() const { return settling_; }

  /// Puts the bodies as they are into rows of poses, on the device.
  void write(Span<BodyPose> poses, int row_size, int rows, double time) const;
  /// Their mean motion over the last step into one row.
  void write_middle(Span<BodyPose> row, double dt) const;

  // One step: begin, then first_kick, a substep for each row of poses but the first, and the fluid's kick.
  /// poses: [substeps + 1][row_size], as the bodies are now; what grains did at the last evaluation and the
  /// fluid at the last step end is known. fluid_kick (s): of the fluid's force at the start of the step.
  void begin(Span<BodyPose> poses, int row_size, double time, double dt, int substeps, double fluid_kick,
             const std::vector<Vec3d>& gravity);
  void first_kick();
  /// Contacts where the bodies are in row s, with what the grains have recorded there, then kicks and drift.
  void substep(int s);
  /// All substeps, where there are no grains.
  void advance();
  /// Contacts as the bodies are, with no time passing; poses: one row.
  void evaluate(Span<const BodyPose> poses);

  /// Where `grains` grains record what they do to bodies, until the next evaluation.
  ContactLoads record(Index grains);

  /// Fits a linear pressure to that of the wet wall particles of each body. poses: one row.
  BodyPressures fit_pressure(const WallStore& walls, Span<const BodyPose> poses);
  /// Takes the fluid's force from the wall particles [walls] and repulsion at the end of a step and kicks
  /// with it; in_fit: that of the pairs in the fitted pressure, as BodyPressurePass leaves it, null where
  /// bodies keep the pairs' force; dt: of the step, 0 at the start of a run. poses: one row.
  void add_fluid_loads(const WallStore& walls, const Buffer<Vec3d>& force, const Buffer<Vec4<double>>* in_fit,
                       const WallRepulsion* repulsion, const FluidStore& fluid, Span<const BodyPose> poses,
                       double kick, double dt);

  /// Copies places and velocities at `time` (s) to the host; bodies that are held have none.
  void read_back(double time);
  /// As read back last.
  const RigidMotion& motion(int place) const { return now_[place]; }
  /// The first body whose state is not finite, -1 if all are well.
  int broken() const;
  /// Largest speed of a point of a body, m/s, dt (s) after what was read back if nothing else pushes it.
  double top_speed(double dt = 0) const;

  /// Limits on a substep. wall_speed: of prescribed walls, m/s.
  std::vector<StepLimit> limits(double wall_speed) const;

  BodyForces forces(int place) const;
  /// All that the fluid does to each, on the device; N, N m about their centres.
  Span<const Vec3d> fluid_force() const { return store_.fluid_force; }
  Span<const Vec3d> fluid_torque() const { return store_.fluid_torque; }
  /// Of the bodies and of what they touch.
  std::vector<const Store*> stores() const {
    if (!any()) return {};
    return {&store_, &memory_};
  }
  /// Force and torque by free bodies on any wall body, of the last substep in this run.
  LoadSum contact_load(int body) const;
  /// The same in the substeps of the last step, for bodies on which they are recorded.
  SubstepLoads& substep_loads() { return substep_loads_; }
  BodyTotals totals(double time) const;
  /// What pressure.linear_exact adds to the fluid's load on a body.
  LoadSum correction(int place) const;
  /// Sum over those that the fluid moves.
  BodyCorrection correction() const;

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
  void point_at_memory();
  BodyFields fields() const;
  void evaluate_contacts(Span<const BodyPose> poses, double dt);
  void correct_pressure(const WallStore& walls, const Buffer<Vec4<double>>& in_fit,
                        Span<const BodyPose> poses);
  BodyPass pass() const;
  void kick(const BodyPass& pass) { for_each(store_.owned(), pass); }

  FreeBodyParameters parameters_;
  Frame frame_;
  const WallGeometry& walls_;
  bool settling_ = false;
  std::vector<int> places_;
  std::vector<RigidMotion> now_;
  double contact_radius_ = 0, largest_radius_ = 0;  ///< smallest and largest R*, m

  mutable BodyStore store_;  ///< kernels take its spans from const members too
  Buffer<RigidBody> constants_;
  Buffer<BodyLaw> laws_;                   ///< of the free bodies
  Buffer<ElasticCompliance> compliances_;  ///< of all wall bodies
  Buffer<ContactBall> balls_;
  /// [capacity][balls], as one list
  struct Memory : Store {
    Memory() : Store("body_contacts") {}
    Field<WallMemory> memory{*this, "memory", "-, -, m, N m, m, m/s", Lifetime::kept};
    Field<Index> count{*this, "count", "-", Lifetime::kept};  ///< of a ball; the rest unused
  } memory_;
  int capacity_ = 0;
  Buffer<WallMemory*> memory_pointers_;

  Buffer<ContactLoad> grain_slots_, ball_slots_;
  Buffer<Index> grain_counts_, ball_counts_;
  ContactLoads grain_loads_, ball_loads_;
  SubstepLoads substep_loads_;
  Buffer<LoadSum> grain_sums_, ball_sums_, wall_sums_, repulsion_sums_;
  Buffer<BodyPressureSums> fit_sums_;
  Buffer<BodyPressure> pressures_;
  Buffer<PairsInPressure> in_pressure_;
  Buffer<RigidMotion> report_;

  struct Step {
    Span<BodyPose> poses;
    int row_size = 0, substeps = 0;
    double time = 0, dt = 0, fluid_kick = 0;
    std::vector<Vec3d> gravity;
  } step_;
};

}  // namespace bedload::inline BL_VARIANT
