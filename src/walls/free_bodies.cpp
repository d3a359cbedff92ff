#include "src/walls/free_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/parallel/reductions.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Sum of two loads on each body, into its fields.
struct AddLoads {
  Span<const LoadSum> a, b;
  Span<Vec3d> force, torque;
  BL_HD void operator()(Index k) const {
    LoadSum sum = a[k];
    LoadSum::combine(sum, b[k]);
    force[k] = sum.force();
    torque[k] = sum.torque();
  }
};

/// Adds what the pressure correction has found for each.
struct AddCorrection {
  const RigidBody* bodies;
  Span<const LoadSum> found;  ///< [wall bodies]
  Span<Vec3d> force, torque, added_force, added_torque;
  BL_HD void operator()(Index k) const {
    const LoadSum& more = found[bodies[k].body];
    added_force[k] = more.force(), added_torque[k] = more.torque();
    force[k] += added_force[k], torque[k] += added_torque[k];
  }
};

std::vector<EnclosedSolid> solids_of(const FreeBodyParameters& parameters) {
  std::vector<EnclosedSolid> solids;
  for (const FreeBody& body : parameters.bodies)
    solids.push_back({body.rigid.body, body.rigid.volume, body.rigid.middle});
  return solids;
}

struct DroppedContacts {
  BallPass balls;
  BL_HD void operator()(Index i, double* out) const { out[0] = balls.dropped(i); }
};

/// Restricts a body to a plane flow: motion in x and z, rotation about y.
void confine(RigidBody& k) {
  const Vec3d y{0, 1, 0};
  const bool in_plane = k.axis.y == 0;
  if (k.move == BodyMove::all) {
    k.move = BodyMove::plane;
    k.axis = y;
  } else if (k.move == BodyMove::plane && in_plane) {
    k.move = BodyMove::axis;
    k.axis = cross(k.axis, y);
  } else if (k.move == BodyMove::axis && !in_plane) {
    k.move = BodyMove::none;
  }
  if (k.turn == BodyTurn::axis && in_plane) k.turn = BodyTurn::none;
  if (k.turn == BodyTurn::all) k.turn = BodyTurn::axis;
  k.hinge = y;
}

}  // namespace

FreeBodies::FreeBodies(const FreeBodyParameters& parameters, const Frame& frame, const WallGeometry& walls)
    : parameters_(parameters),
      frame_(frame),
      walls_(walls),
      places_(parameters.walls, -1),
      pressure_correction_(solids_of(parameters)) {
  if (!any()) return;
  contact_radius_ = kInfinity;
  std::vector<RigidBody> rigid;
  std::vector<BodyLaw> laws;
  std::vector<ContactBall> balls;
  std::vector<Vec3d> x, v, angular_momentum;
  for (const FreeBody& body : parameters.bodies) {
    const RigidBody& k = body.rigid;
    places_[k.body] = int(rigid.size());
    rigid.push_back(k);
    laws.push_back(body.law);
    for (const ContactBall& ball : body.balls) {
      contact_radius_ = std::min(contact_radius_, ball.R_star);
      largest_radius_ = std::max(largest_radius_, ball.R_star);
      balls.push_back(ball);
    }
    x.push_back(k.centre);
    v.push_back(k.movable(body.velocity));
    angular_momentum.push_back(k.momentum({}, k.turnable(body.spin)));
  }
  constants_.assign(rigid);
  laws_.assign(laws);
  compliances_.assign(parameters.compliances);
  balls_.assign(balls);
  store_.resize(Index(size()));
  store_.x.assign(x), store_.v.assign(v), store_.angular_momentum.assign(angular_momentum);
  store_.rotation.assign(std::vector<Vec4<double>>(size(), to_vec4({})));

  const Index n = Index(balls.size());
  capacity_ = walls.contacts();
  memory_.resize(Index(n * capacity_));
  point_at_memory();
  const int bodies_met = std::min(int(parameters.walls), kMostWallContacts + 1);
  ball_slots_.resize(std::size_t(n) * bodies_met);
  ball_counts_.resize(n);
  ball_loads_ = {ball_slots_.data(), ball_counts_.data(), n, bodies_met};
  for (Buffer<LoadSum>* sums : {&grain_sums_, &ball_sums_, &wall_sums_, &repulsion_sums_})
    sums->resize(size());
  store_.corrected_force.begin_at_zero(), store_.corrected_torque.begin_at_zero();
  report_.resize(size());
  read_back(0);
}

RigidBody rigid_body(const MassProperties& m, const Vec3d& centre, BodyMove move, BodyTurn turn,
                     const Vec3d& axis, bool plane) {
  RigidBody k;
  k.move = move;
  k.turn = turn;
  k.mass = m.mass;
  k.centre = centre;
  k.arm = m.centre - centre;
  k.volume = m.volume, k.middle = m.middle - centre;
  const auto inertia = shifted_inertia(m.inertia, m.mass, k.arm);
  const PrincipalInertia principal = principal_inertia(inertia);
  k.moments = principal.moments;
  k.principal = principal.axes;
  k.axis = k.hinge = axis;
  if (plane) confine(k);
  const Vec3d& n = k.hinge;
  k.axial = inertia[0] * n.x * n.x + inertia[1] * n.y * n.y + inertia[2] * n.z * n.z +
            2 * (inertia[3] * n.x * n.y + inertia[4] * n.x * n.z + inertia[5] * n.y * n.z);
  return k;
}

void FreeBodies::point_at_memory() {
  std::vector<WallMemory*> slots;
  for (int k = 0; k < capacity_; ++k)
    slots.push_back(memory_.memory.buffer().data() + std::size_t(k) * balls_.size());
  memory_pointers_.assign(slots);
}

BodyFields FreeBodies::fields() const {
  BodyStore& s = store_;
  return {.x = s.x,
          .v = s.v,
          .angular_momentum = s.angular_momentum,
          .a = s.a,
          .alpha = s.alpha,
          .rotation = s.rotation,
          .grain_force = s.grain_force,
          .grain_torque = s.grain_torque,
          .contact_force = s.contact_force,
          .contact_torque = s.contact_torque,
          .fluid_force = s.fluid_force,
          .fluid_torque = s.fluid_torque,
          .x_before = s.x_before,
          .v_before = s.v_before,
          .omega_before = s.omega_before,
          .rotation_before = s.rotation_before};
}

// -- poses -------------------------------------------------------------------

void FreeBodies::write(Span<BodyPose> poses, int row_size, int rows, double time) const {
  for_each(store_.owned(), BodyPosePass{.bodies = constants_.data(),
                                        .s = fields(),
                                        .time = time,
                                        .settling = settling_ ? 1u : 0u,
                                        .rows = rows,
                                        .row_size = row_size,
                                        .poses = poses.data});
}

void FreeBodies::write_middle(Span<BodyPose> row, double dt) const {
  for_each(store_.owned(), MidPosePass{constants_.data(), fields(), dt, row.data});
}

void FreeBodies::read_back(double time) {
  if (!any()) return;
  for_each(store_.owned(), BodyReportPass{constants_.data(), fields(), time, report_});
  now_ = report_.to_host();
}

// -- a step ------------------------------------------------------------------

BodyPass FreeBodies::pass() const {
  BodyPass p{};
  p.bodies = constants_.data();
  p.s = fields();
  p.time = step_.time;
  return p;
}

void FreeBodies::begin(Span<BodyPose> poses, int row_size, double time, double dt, int substeps,
                       double fluid_kick, const std::vector<Vec3d>& gravity) {
  step_ = {.poses = poses,
           .row_size = row_size,
           .substeps = substeps,
           .time = time,
           .dt = dt,
           .fluid_kick = fluid_kick,
           .gravity = gravity};
  substep_loads_.begin(substeps);
}

void FreeBodies::first_kick() {
  const double tau = step_.dt / step_.substeps;
  BodyPass p = pass();
  p.gravity = step_.gravity[0];
  p.kick = 0.5 * tau, p.fluid_kick = step_.fluid_kick, p.drift = tau;
  p.begins = 1;
  p.row = step_.poses.data + step_.row_size;
  kick(p);
}

void FreeBodies::substep(int s) {
  const double tau = step_.dt / step_.substeps;
  const bool last = s == step_.substeps;
  evaluate_contacts({step_.poses.data + std::size_t(s) * step_.row_size, Index(step_.row_size)}, tau);
  substep_loads_.record(s, [&](std::uint32_t body, LoadSum* load) {
    if (const int k = place_of(int(body)); k >= 0)
      copy_on_device(load, ball_sums_.data() + k, sizeof *load);
    else if (ball_loads_.size > 0)
      reduce_into(load, {0, ball_loads_.size}, ContactLoadReduction{ball_loads_, body});
  });
  BodyPass p = pass();
  p.by_grains = grain_sums_.data();
  p.by_contacts = ball_sums_.data();
  p.gravity = step_.gravity[s];
  p.kick = last ? 0.5 * tau : tau;
  p.drift = last ? 0 : tau;
  if (!last) p.row = step_.poses.data + std::size_t(s + 1) * step_.row_size;
  kick(p);
}

void FreeBodies::advance() {
  first_kick();
  for (int s = 1; s <= step_.substeps; ++s) substep(s);
}

void FreeBodies::evaluate(Span<const BodyPose> poses) {
  evaluate_contacts(poses, 0);
  BodyPass p = pass();
  p.by_grains = grain_sums_.data();
  p.by_contacts = ball_sums_.data();
  kick(p);
}

ContactLoads FreeBodies::record(Index grains, const std::array<double, 6>& bounds) {
  by_grains_ = true, grain_bounds_ = bounds;
  const int capacity = met_by_grain();
  grain_slots_.resize(std::size_t(grains) * capacity);
  grain_counts_.resize(grains);
  grain_counts_.zero();  // grains far from walls write nothing
  grain_loads_ = {grain_slots_.data(), grain_counts_.data(), grains, capacity};
  return grain_loads_;
}

BallPass FreeBodies::ball_pass(Span<const BodyPose> poses, double dt) {
  return {.frame = frame_,
          .walls = walls_.view(),
          .poses = poses.data,
          .bodies = constants_.data(),
          .laws = laws_.data(),
          .compliances = compliances_.data(),
          .balls = balls_,
          .memory = memory_pointers_.data(),
          .contacts = memory_.count.buffer().data(),
          .capacity = capacity_,
          .dt = dt,
          .loads = ball_loads_};
}

double FreeBodies::dropped_contacts(Span<const BodyPose> poses) {
  if (balls_.size() == 0) return 0;
  const Range balls{0, Context::current().rank() == 0 ? Index(balls_.size()) : 0};  // all ranks have them
  return sum_over<1>(balls, DroppedContacts{ball_pass(poses, 0)}).v[0];
}

/// Contacts of balls with surfaces, then the sums of the recorded loads of balls and grains.
void FreeBodies::evaluate_contacts(Span<const BodyPose> poses, double dt) {
  if (balls_.size() > 0) for_each({0, Index(balls_.size())}, ball_pass(poses, dt));
  grain_sums_.zero();
  ball_sums_.zero();
  for (int k = 0; k < size(); ++k) {
    const std::uint32_t body = rigid(k).body;
    if (by_grains_)
      total_into(grain_sums_.data() + k, {0, grain_loads_.size}, ContactLoadReduction{grain_loads_, body},
                 grain_bounds_);
    if (balls_.size() > 0)
      reduce_into(ball_sums_.data() + k, {0, ball_loads_.size}, ContactLoadReduction{ball_loads_, body});
  }
}

void FreeBodies::add_fluid_loads(const WallStore& walls, const Buffer<Vec3d>& force, bool corrected,
                                 const WallRepulsion* repulsion, const FluidStore& fluid,
                                 Span<const BodyPose> poses, const LoadBounds& bounds, double kick_time,
                                 double dt) {
  repulsion_sums_.zero();
  for (int k = 0; k < size(); ++k) {
    const std::uint32_t body = rigid(k).body;
    total_into(wall_sums_.data() + k, walls.owned(),
               WallLoadReduction{particles_of(body, walls, poses), force}, bounds.load());
    if (repulsion)
      total_into(repulsion_sums_.data() + k, fluid.owned(),
                 BodyRepulsion{*repulsion, body, fluid.x, fluid.mass, fluid.heading}, bounds.load());
  }
  BodyStore& s = store_;
  for_each(s.owned(), AddLoads{wall_sums_, repulsion_sums_, s.fluid_force, s.fluid_torque});
  if (corrected)
    for_each(s.owned(), AddCorrection{constants_.data(), pressure_correction_.added(), s.fluid_force,
                                      s.fluid_torque, s.corrected_force, s.corrected_torque});
  else
    s.corrected_force.buffer().zero(), s.corrected_torque.buffer().zero();
  if (dt == 0) return;
  BodyPass p = pass();
  p.fluid_kick = kick_time;
  kick(p);
  const double followed = -std::expm1(-dt / parameters_.response);
  for_each(store_.owned(), BodyAccelerationPass{constants_.data(), fields(), dt, followed});
}

}  // namespace BL_SOLVER
