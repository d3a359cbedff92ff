#include "bedload/motion/law.hpp"

#include <algorithm>
#include <cmath>

#include "src/motion/track.hpp"

namespace bedload {
namespace {

/// Factors in the angular velocity of a rotation vector of length p, and their derivatives over p.
struct TurnFactors {
  double a, b;            ///< (1 - cos p)/p^2, (p - sin p)/p^3
  double a_rate, b_rate;  ///< a'(p)/p, b'(p)/p
  explicit TurnFactors(double p) {
    const double p2 = p * p;
    if (p < 0.05) {
      a = 1.0 / 2 - p2 / 24 * (1 - p2 / 30), b = 1.0 / 6 - p2 / 120 * (1 - p2 / 42);
      a_rate = -1.0 / 12 + p2 / 180 * (1 - 3 * p2 / 112), b_rate = -1.0 / 60 + p2 / 1260 * (1 - p2 / 48);
      return;
    }
    const double s = std::sin(p), c = 1 - std::cos(p);
    a = c / p2, b = (p - s) / (p2 * p);
    a_rate = (p * s - 2 * c) / (p2 * p2), b_rate = (p * c - 3 * (p - s)) / (p2 * p2 * p);
  }
};

/// Turn about a fixed point.
struct Turn {
  Quat<double> q;
  Vec3d omega, alpha;

  /// omega = r' + a r x r' + b r x (r x r') for the rotation vector r, and its derivative.
  explicit Turn(const Jet& r) : q(Quat<double>::from_rotation(r.value)) {
    const TurnFactors f(norm(r.value));
    const double growth = dot(r.value, r.rate);  // length times its rate
    const Vec3d u = cross(r.value, r.rate), u_rate = cross(r.value, r.rate2);
    const Vec3d w = cross(r.value, u), w_rate = cross(r.rate, u) + cross(r.value, u_rate);
    omega = r.rate + f.a * u + f.b * w;
    alpha = r.rate2 + f.a * u_rate + f.b * w_rate + growth * (f.a_rate * u + f.b_rate * w);
  }
};

/// A point's image under rotations one after another, with velocity and acceleration.
struct TurnedPoint {
  Vec3d x, v, a;
  void turn(const Turn& t, const Vec3d& centre) {
    const Vec3d r = t.q.rotate(x - centre), u = t.q.rotate(v);
    a = t.q.rotate(a) + 2.0 * cross(t.omega, u) + cross(t.alpha, r) + cross(t.omega, cross(t.omega, r));
    v = u + cross(t.omega, r);
    x = centre + r;
  }
};

/// `later` after what `all` has turned so far.
void add_turn(RigidMotion& all, const Turn& later) {
  const Vec3d carried = later.q.rotate(all.omega);
  all.alpha = later.alpha + later.q.rotate(all.alpha) + cross(later.omega, carried);
  all.omega = later.omega + carried;
  all.rotation = later.q * all.rotation;
}

/// Seconds after the start of a part between which it moves; `lasting`: until it is stopped.
struct Window {
  double begin, end;
  Window(double lasting, const Track& track)
      : begin(std::max(0.0, track.begin())), end(std::max(begin, std::min(lasting, track.end()))) {}
};

TrackPoint resting(TrackPoint p) {
  return {.shift = {p.shift.value, {}, {}}, .turn = {p.turn.value, {}, {}}};
}

}  // namespace

MotionLaw::MotionLaw(const MotionConfig& motion, double until) : centre_(motion.centre) {
  std::vector<const MotionPart*> all{&motion};
  for (const MotionPart& part : motion.add) all.push_back(&part);
  bool turns = false;
  for (const MotionPart* m : all) {
    const double span = std::min(m->stop, until) - m->start;
    std::shared_ptr<const Track> track = make_track(*m, span > 0 ? span : 1);
    if (!track) continue;
    if (track->turns() && !turns) centre_ = m->centre, turns = true;
    parts_.push_back({m->start, m->stop, m->centre, std::move(track)});
  }
}

RigidMotion MotionLaw::at(double t) const {
  RigidMotion all;
  all.centre = centre_;
  TurnedPoint point{centre_, {}, {}};
  Jet shift;
  for (const Part& part : parts_) {
    const Track& track = *part.track;
    const Window moves(part.stop - part.start, track);
    const double now = t - part.start, s = std::clamp(now, moves.begin, moves.end);
    const TrackPoint p = now >= moves.begin && now < moves.end ? track.at(s) : resting(track.at(s));
    shift.value += p.shift.value;
    shift.rate += p.shift.rate;
    shift.rate2 += p.shift.rate2;
    if (!track.turns()) continue;
    const Turn turn(p.turn);
    point.turn(turn, part.centre);
    add_turn(all, turn);
  }
  all.translation = shift.value + (point.x - centre_);
  all.v = shift.rate + point.v;
  all.a = shift.rate2 + point.a;
  return all;
}

std::vector<double> MotionLaw::events() const {
  std::vector<double> all;
  for (const Part& part : parts_) {
    const Window moves(part.stop - part.start, *part.track);
    all.push_back(part.start + moves.begin);
    all.push_back(part.start + moves.end);
    for (const double s : part.track->breaks())
      if (s > moves.begin && s < moves.end) all.push_back(part.start + s);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  while (!all.empty() && std::isinf(all.back())) all.pop_back();
  return all;
}

}  // namespace bedload
