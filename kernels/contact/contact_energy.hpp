#pragma once
// Where the energy of grains goes. In a substep dt a contact does the work
//   W = dt/2 (P + P'),  P = F.v + T_i.omega_i + T_j.omega_j,
// P by its forces now, P' by those at the end of the substep before, both with the velocities between them.
// What it does not store it has dissipated: D = - W - (U - U'). The leapfrog changes kinetic energies by W,
// but for terms that cancel from one substep to the next.

#include "kernels/bodies/clumps.hpp"
#include "kernels/contact/contact_loss.hpp"
#include "kernels/contact/wall_pass.hpp"
#include "kernels/contact/wear.hpp"

namespace BL_SOLVER {

/// Forces of a contact at the end of a substep, on the first grain.
struct ContactAction {
  Real3 normal, sliding;  ///< N
  Real3 couple, rolling;  ///< of sliding, per arm, N; of rolling friction, N m

  BL_HD static ContactAction of(const ContactForce& f, const ContactGeometry& at) {
    const Real3 n = at.n, normal = dot(f.force, n) * n, sliding = f.force - normal;
    const Real3 couple = cross(sliding, n);
    return {normal, sliding, couple, f.torque_i - at.arm_i * couple};
  }
};

/// Of two partners in the middle of a substep; walls have no arm.
struct ContactMotion {
  Real3 v, omega_i, omega_j;  ///< v = v_i - v_j
  Real arm_i, arm_j;

  BL_HD StoredEnergy power(const ContactAction& a) const {
    return {double(dot(a.normal, v)),
            double(dot(a.sliding, v) + dot(a.couple, arm_i * omega_i + arm_j * omega_j)),
            double(dot(a.rolling, omega_i - omega_j))};
  }
};

/// Losses of the wall contacts of a grain, in the order of its memories.
struct WallLosses {
  ContactLoss of[kMostWallContacts];
};
template <>
struct FileType<WallLosses> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(WallLosses) / sizeof(double);
};
/// Likewise their peaks.
struct WallPeaks {
  ContactPeak of[kMostWallContacts];
};
template <>
struct FileType<WallPeaks> {
  static constexpr Scalar scalar = FileType<ContactPeak>::scalar;
  static constexpr int components = kMostWallContacts * FileType<ContactPeak>::components;
};
/// Contacts whose losses are added up; nothing where spectra are not asked for.
struct OpenLosses {
  ContactSpectra spectra;
  OpenContact* of_pairs = nullptr;  ///< [slots], the same in the rows of both grains
  WallLosses* at_walls = nullptr;   ///< [grains]
  WallPeaks* wall_peaks = nullptr;  ///< [grains]
  BL_HD explicit operator bool() const { return spectra.bins; }

  BL_HD std::uint32_t kind(const GrainView& g, Index i) const {
    return spectra.kind(g.mass_per_r3.material_of(i), g.radius[i]);
  }
  /// A contact of two grains, or of one and a wall body, that has ended.
  BL_HD void enter(const GrainView& g, Index i, Index j, const OpenContact& open) const {
    spectra.enter(spectra.of_pair(kind(g, i), kind(g, j)), open.loss, open.peak);
  }
  BL_HD void enter_at_wall(const GrainView& g, Index i, std::uint32_t body, const ContactLoss& loss,
                           const ContactPeak& peak) const {
    spectra.enter(spectra.on_wall(body, kind(g, i)), loss, peak);
  }
};

/// J: dissipated in contacts and by lubrication, work on the grains.
struct EnergyFlow {
  enum Term { normal, sliding, rolling, films, walls, gravity, fluid, kTerms };
  double of[kTerms];

  BL_HD static EnergyFlow zero() {
    EnergyFlow z;
    for (double& term : z.of) term = 0;
    return z;
  }
  BL_HD void add(const EnergyFlow& other) {
    for (int k = 0; k < kTerms; ++k) of[k] += other.of[k];
  }
  BL_HD void add_to(ContactLoss& loss) const {
    loss.normal += of[normal], loss.tangential += of[sliding] + of[rolling];
  }
  /// What a contact dissipates in a substep of dt, from one action and stored energy to the next.
  BL_HD void dissipate(const ContactMotion& motion, double dt, const ContactAction& before,
                       const ContactAction& now, const StoredEnergy& had, const StoredEnergy& has) {
    const StoredEnergy a = motion.power(before), b = motion.power(now);
    of[normal] -= 0.5 * dt * (a.normal + b.normal) + has.normal - had.normal;
    of[sliding] -= 0.5 * dt * (a.sliding + b.sliding) + has.sliding - had.sliding;
    of[rolling] -= 0.5 * dt * (a.rolling + b.rolling) + has.rolling - had.rolling;
  }
};

/// Sums flows over grains.
struct FlowTotal {
  using Value = EnergyFlow;
  const EnergyFlow* of_grains;
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const { return of_grains[i]; }
  BL_HD void combine(Value& into, const Value& from) const { into.add(from); }
};

/// Contacts between grains, before they are evaluated: histories stay as they are. Each counts in the row of
/// its lower id. Losses are added up in both rows, as histories are. Runs over the lanes that share the rows.
template <class Law>
struct PairFlowPass {
  ContactPass contacts;    ///< of the substep; dt = 0: notes what acts at its start
  ContactAction* actions;  ///< [slots]
  EnergyFlow* flows;       ///< [grains]
  OpenLosses losses = {};

  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, contacts.list.bits);
    const Index i = lane.row;
    EnergyFlow flow = EnergyFlow::zero();
    contacts.list.each(lane, [&](std::uint64_t slot, Index j) {
      const bool first = contacts.grains.id[i] < contacts.grains.id[j];
      if (!first && !losses) return;
      EnergyFlow one = EnergyFlow::zero();
      add(first ? i : j, first ? j : i, slot, first, one);
      if (first) flow.add(one);
    });
    lane.combine(flow, [](EnergyFlow& into, const EnergyFlow& other) { into.add(other); });
    if (lane.index == 0) flows[i].add(flow);
  }

 private:
  /// counts: this row is the one that enters the loss of a contact that ends.
  BL_HD void add(Index i, Index j, std::uint64_t slot, bool counts, EnergyFlow& flow) const {
    const GrainView& g = contacts.grains;
    const ContactPass::Seen pair = contacts.look<Law>(i, j, slot);
    if (!pair.touched && !pair.acts) return;
    const Sphere a = g.sphere(i), b = g.sphere(j);
    const Real R_star = a.R * b.R / (a.R + b.R), m_star = a.m * b.m / (a.m + b.m);
    const Law& law = composed<Law>(contacts.law_of(i, j));
    ContactMotion motion{pair.v, g.omega[i], g.omega[j], a.R, b.R};
    StoredEnergy had, has;
    ContactAction before{}, now{};
    if (pair.touched) had = law.energy(R_star, m_star, pair.before), before = actions[slot];
    if (pair.acts) {
      now = ContactAction::of(pair.on_lo, pair.at);
      has = law.energy(R_star, m_star, pair.after);
      motion.arm_i = pair.at.arm_i, motion.arm_j = pair.at.arm_j;
    }
    actions[slot] = now;
    if (!(contacts.dt > 0)) return;
    flow.dissipate(motion, contacts.dt, before, now, had, has);
    if (!losses) return;
    OpenContact& open = losses.of_pairs[slot];
    if (!pair.touched) open = {};
    flow.add_to(open.loss);
    if (pair.acts)
      open.peak.take(Real(has.total()), dot(pair.on_lo.force, pair.at.n));
    else if (counts)
      losses.enter(g, i, j, open);
  }
};

/// The same of contacts with walls, over the grains near them, and the work of the walls.
struct WallFlowPass {
  WallContacts contacts;
  WallRows rows;
  ContactAction* actions;  ///< [capacity][grains]
  EnergyFlow* flows;       ///< [grains]
  OpenLosses losses = {};
  WallWear wear = {};

  BL_HD void operator()(Index row) const {
    const Index i = rows.grain[row];
    const GrainView& g = contacts.grains;
    const WallMemories memories = contacts.memories(i);
    const Sphere own = g.sphere(i);
    const double dt = contacts.dt;
    EnergyFlow flow = EnergyFlow::zero();
    RawArray<ContactAction, kMostWallContacts> now;
    RawArray<ContactLoss, kMostWallContacts> lost;
    RawArray<ContactPeak, kMostWallContacts> peak;
    unsigned kept = 0;  // memories that contacts continue, by bits
    int n = 0;
    const auto count = [&](const Turn& c, ContactLoss& loss) {
      const BodyPose& pose = contacts.poses[c.body];
      const Real3 v = g.v[i] - Real3(c.v_wall);
      EnergyFlow one = EnergyFlow::zero();
      one.dissipate({v, g.omega[i], Real3(pose.omega), c.arm, 0}, dt, c.before, c.after, c.had, c.has);
      one.add_to(loss);
      flow.add(one);
      const auto work = [&](const ContactAction& a) {
        return dot(Vec3d(a.normal + a.sliding), c.v_wall) + dot(Vec3d(a.rolling), pose.omega);
      };
      flow.of[EnergyFlow::walls] += 0.5 * dt * (work(c.before) + work(c.after));
      if (!wear) return;
      ContactLoss here;
      one.add_to(here);
      const Real3 slip = v - dot(v, c.n) * c.n - cross(c.arm * g.omega[i], c.n);
      const double force = 0.5 * (norm(c.before.normal) + norm(c.after.normal));
      wear.add(c.body, pose, contacts.arm(pose, c.point), force * norm(slip) * dt, c.ended ? 0 : dt, here);
    };
    const auto memory_energy = [&](Index k) {
      return contacts.law(body_of(memories[k]), i).energy(own.R, own.m, memories[k].history);
    };
    contacts.each(
        Lane(i, 0), i, rows.count[row], [&](Index k) { return rows(row, k); }, false,
        [&](std::uint32_t body, const WallContacts::Contact& c, const WallContacts::Course& course) {
          now[n] = ContactAction::of(c.on_grain, course.at);
          ContactAction before{};
          StoredEnergy had;
          lost[n] = {}, peak[n] = {};
          if (course.from != kNone) {
            kept |= 1u << course.from;
            before = action(course.from, i), had = memory_energy(course.from);
            if (losses)
              lost[n] = losses.at_walls[i].of[course.from], peak[n] = losses.wall_peaks[i].of[course.from];
          } else if (wear && dt > 0) {
            const BodyPose& pose = contacts.poses[body];
            wear.strike(body, pose, contacts.arm(pose, c.point), own.m, Vec3d(g.v[i]) - course.v_wall,
                        Vec3d(course.at.n));
          }
          const StoredEnergy has = course.law.energy(own.R, own.m, course.after);
          if (losses) peak[n].take(Real(has.total()), dot(c.on_grain.force, course.at.n));
          if (dt > 0)
            count({.body = body,
                   .point = c.point,
                   .v_wall = course.v_wall,
                   .n = Real3(course.at.n),
                   .arm = course.at.arm_i,
                   .before = before,
                   .after = now[n],
                   .had = had,
                   .has = has},
                  lost[n]);
          ++n;
        });
    for (Index k = 0; dt > 0 && k < memories.count(); ++k) {
      if (kept >> k & 1) continue;  // else it has ended
      const std::uint32_t body = body_of(memories[k]);
      const BodyPose& pose = contacts.poses[body];
      ContactLoss loss = losses ? losses.at_walls[i].of[k] : ContactLoss{};
      const Vec3d point = g.x[i] - double(own.R) * memories[k].normal;
      count({.body = body,
             .point = point,
             .v_wall = contacts.surface_velocity(pose, contacts.arm(pose, point)),
             .n = Real3(memories[k].normal),
             .arm = own.R,
             .before = action(k, i),
             .after = {},
             .had = memory_energy(k),
             .has = {},
             .ended = true},
            loss);
      if (losses) losses.enter_at_wall(g, i, body, loss, losses.wall_peaks[i].of[k]);
    }
    for (int k = 0; k < n; ++k) {
      action(Index(k), i) = now[k];
      if (losses && dt > 0) losses.at_walls[i].of[k] = lost[k], losses.wall_peaks[i].of[k] = peak[k];
    }
    flows[i].add(flow);
  }

 private:
  /// A contact in a substep.
  struct Turn {
    std::uint32_t body;
    Vec3d point, v_wall;  ///< m; of the wall there, m/s
    Real3 n;
    Real arm;
    ContactAction before, after;
    StoredEnergy had, has;
    bool ended = false;
  };
  BL_HD std::uint32_t body_of(const WallMemory& memory) const {
    return contacts.walls.surfaces[memory.surface()].body;
  }
  BL_HD ContactAction& action(Index k, Index i) const {
    return actions[std::size_t(k) * contacts.grains.x.size + i];
  }
};

/// Motion of a grain, and what drag has given it, at the last look.
struct GrainCourse {
  Real3 v, omega;                  ///< m/s, rad/s
  Real3 impulse, angular_impulse;  ///< N s, N m s
};

/// Work of gravity and of the fluid since the last look: of what is constant between two kicks with the
/// velocity there, of drag with the mean of those before and after. That of gravity on clumps: ClumpFlowPass.
struct KickFlowPass {
  GrainView grains;
  Vec3d gravity;  ///< mean over the substep, m/s2
  double dt;      ///< s; 0: drag alone
  Span<const Real3> fluid_force, drive;
  Span<const Real3> impulse, angular_impulse;  ///< of drag in this advance so far; empty without fluid
  GrainCourse* course;                         ///< [grains]; null without fluid
  EnergyFlow* flows;                           ///< [grains]
  bool begins = false;                         ///< notes how an advance starts
  Span<const std::uint32_t> clump = {};        ///< of each grain, 0: none; empty without

  BL_HD void operator()(Index i) const {
    EnergyFlow flow = EnergyFlow::zero();
    const Vec3d v(grains.v[i]), omega(grains.omega[i]);
    if (!clump || clump[i] == 0) flow.of[EnergyFlow::gravity] = dt * grains.mass(i) * dot(gravity, v);
    Vec3d force;
    if (fluid_force) force += Vec3d(fluid_force[i]);
    if (drive) force += Vec3d(drive[i]);
    flow.of[EnergyFlow::fluid] = dt * dot(force, v);
    if (course) follow_drag(i, v, omega, flow);
    flows[i].add(flow);
  }

 private:
  BL_HD void follow_drag(Index i, const Vec3d& v, const Vec3d& omega, EnergyFlow& flow) const {
    GrainCourse now{grains.v[i], grains.omega[i], {}, {}};
    if (!begins) {
      const GrainCourse& was = course[i];
      now.impulse = impulse[i], now.angular_impulse = angular_impulse[i];
      flow.of[EnergyFlow::fluid] +=
          0.5 * (dot(Vec3d(now.impulse - was.impulse), v + Vec3d(was.v)) +
                 dot(Vec3d(now.angular_impulse - was.angular_impulse), omega + Vec3d(was.omega)));
    }
    course[i] = now;
  }
};

/// Motion of a clump, and what drag has given it, at the last look.
struct ClumpCourse {
  Vec3d v, impulse;  ///< m/s, N s
};

/// Work of gravity on clumps since the last look: at the centre of mass, which is not that of the masses of
/// their grains. Also that of drag, where it acts there, as in KickFlowPass.
struct ClumpFlowPass {
  ClumpView clumps;
  Vec3d gravity;                     ///< mean over the substep, m/s2
  double dt;                         ///< s; 0: drag alone
  EnergyFlow* flows;                 ///< [clumps]
  const CentreDrag* drag = nullptr;  ///< [clumps]; null: it acts on grains
  ClumpCourse* course = nullptr;     ///< [clumps], with it
  bool begins = false;               ///< notes how an advance starts

  BL_HD void operator()(Index c) const {
    flows[c].of[EnergyFlow::gravity] += dt * clumps.mass(c) * dot(gravity, clumps.v[c]);
    if (!drag) return;
    const ClumpCourse now{clumps.v[c], drag[c].impulse}, was = course[c];
    if (!begins) flows[c].of[EnergyFlow::fluid] += 0.5 * dot(now.impulse - was.impulse, now.v + was.v);
    course[c] = now;
  }
};

}  // namespace BL_SOLVER
