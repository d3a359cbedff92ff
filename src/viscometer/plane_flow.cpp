#include "src/viscometer/plane_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace bedload {
namespace {

constexpr const char* kFlows =
    "a viscometer needs reverse Poiseuille flow (drive.opposed in a periodic box), Lees-Edwards shear "
    "(domain.shear_rate), or flow between two parallel walls, driven along them (Poiseuille) or sheared by "
    "their motion (Couette)";

[[noreturn]] void refuse(const std::string& key, const std::string& why) {
  throw NoPlaneFlow(key, fmt::format("{}: {}; {}", key, why, kFlows));
}

/// A plane wall surface in contact with fluid; side +1: fluid is above it.
struct Surface {
  int body, axis;
  double at;  ///< m
  int side;
};

class Walls {
 public:
  explicit Walls(const Config& config) : c_(config) {
    for (int b = 0; b < int(c_.wall.bodies.size()); ++b)
      if (c_.wall.bodies[b].stops_fluid()) add(b);
  }

  /// The lower and upper surface around the fluid.
  std::pair<Surface, Surface> pair() const {
    std::optional<Surface> low, high;
    for (const Surface& s : surfaces_) {
      const double fluid = middle_of_fluid(s.axis);
      if (s.side > 0 ? s.at > fluid : s.at < fluid) continue;  // the far side of a plate
      auto& place = s.side > 0 ? low : high;
      if (place) refuse(key(s.body), "there are more than two walls around the fluid");
      place = s;
    }
    if (!low || !high) refuse("wall.body", "there is a wall on one side of the fluid only");
    if (low->axis != high->axis) refuse(key(high->body), "the walls are not parallel");
    return {*low, *high};
  }
  static std::string key(int body) { return fmt::format("wall.body.{}", body); }

 private:
  double middle_of_fluid(int axis) const {
    if (c_.fluid.fills.empty()) return 0.5 * (c_.domain.min[axis] + c_.domain.max[axis]);  // of a lattice
    double low = 1e300, high = -1e300;
    for (const FluidFill& fill : c_.fluid.fills)
      low = std::min(low, fill.min[axis]), high = std::max(high, fill.max[axis]);
    return 0.5 * (low + high);
  }
  bool spans(const WallBody& body, int axis) const {
    const double slack = 1e-6 * (c_.domain.max[axis] - c_.domain.min[axis]);
    return body.min[axis] <= c_.domain.min[axis] + slack && body.max[axis] >= c_.domain.max[axis] - slack;
  }
  void add(int b) {
    const WallBody& body = c_.wall.bodies[b];
    if (body.free.present) refuse(key(b) + ".free", "must not be a free body in a viscometer");
    const std::size_t before = surfaces_.size();
    if (body.shape == WallShape::plane) {
      for (int k = 0; k < 3; ++k)
        if (std::abs(body.normal[k]) > 1 - 1e-9)
          surfaces_.push_back({b, k, body.point[k], body.normal[k] > 0 ? 1 : -1});
    } else if (body.shape == WallShape::tank) {
      for (int face = 0; face < 6; ++face) {
        if (!body.faces[face]) continue;
        const int k = face / 2;
        surfaces_.push_back({b, k, face % 2 ? body.max[k] : body.min[k], face % 2 ? -1 : 1});
      }
    } else if (body.shape == WallShape::box) {
      for (int k = 0; k < 3; ++k)
        if (spans(body, (k + 1) % 3) && spans(body, (k + 2) % 3)) {
          surfaces_.push_back({b, k, body.max[k], 1});
          surfaces_.push_back({b, k, body.min[k], -1});
        }
    }
    if (surfaces_.size() == before)
      refuse(key(b) + ".shape",
             fmt::format("\"{}\" is not a plane wall across the whole domain", body.shape.name()));
  }

  const Config& c_;
  std::vector<Surface> surfaces_;
};

/// Velocity of a wall in its own plane, m/s.
Vec3d velocity_of(const Config& c, int b) {
  const WallBody& body = c.wall.bodies[b];
  const MotionConfig& m = body.motion;
  Vec3d v = body.surface_velocity;
  if (!m.moves()) return v;
  if (m.kind != MotionKind::velocity || m.scaled() || !m.add.empty() || m.start > 0 || std::isfinite(m.stop))
    refuse(Walls::key(b) + ".motion", "the velocity of the wall must be constant");
  return v + m.velocity;
}

/// The axis that a vector is parallel to; none if there is none.
std::optional<int> axis_of(const Vec3d& v) {
  std::optional<int> axis;
  for (int k = 0; k < 3; ++k) {
    if (v[k] == 0) continue;
    if (axis) return {};
    axis = k;
  }
  return axis;
}

/// Refuses what would add to the measured viscosity or prevents a steady state.
void refuse_additions(const Config& c) {
  const auto refuse_key = [](const std::string& key, const std::string& why) {
    throw KeyError(key, fmt::format("{}: {}", key, why));
  };
  if (!(c.fluid.mu > 0)) refuse_key("fluid.mu", "a viscometer needs a viscosity above 0");
  if (c.visc.alpha > 0 || c.visc.beta > 0)
    refuse_key("visc.alpha",
               "artificial viscosity must be 0 in a viscometer: it would add to the measured viscosity");
  if (c.frame.motion.moves()) refuse_key("frame.motion", "must be fixed in a viscometer");
  if (!c.inlets.empty()) refuse_key("inlet.0", "inlets are not allowed in a viscometer");
  if (!c.outlets.empty()) refuse_key("outlet.0", "outlets are not allowed in a viscometer");
  if (!c.grain_inlets.empty()) refuse_key("grain_inlet.0", "inlets are not allowed in a viscometer");
  if (c.drive.pulls()) refuse_key("drive.rate", "must be 0 in a viscometer");
  if (c.drive.factor != "1") refuse_key("drive.factor", "must be 1 in a viscometer, which needs steady flow");
  if (!c.fluid.species.empty())
    refuse_key("fluid.species.0", "a viscometer measures one fluid; remove the species");
}

PlaneFlow reverse_poiseuille(const Config& c) {
  PlaneFlow flow;
  if (c.drive.opposed == DriveReversal::none)
    refuse("drive.opposed", "the case has neither walls nor an opposed drive");
  flow.gradient = int(DriveReversal(c.drive.opposed)) - int(DriveReversal::x);
  const auto along = axis_of(c.drive.f);
  if (!along || *along == flow.gradient)
    refuse("drive.f", "must be along one axis, and not the axis of reversal");
  if (norm(c.gravity) > 0) refuse("gravity", "must be 0 in reverse Poiseuille flow");
  flow.along = *along;
  flow.low = c.domain.min[flow.gradient], flow.high = c.domain.max[flow.gradient];
  return flow;
}

/// Other requirements of Lees-Edwards boundaries are checked when the case is read.
PlaneFlow lees_edwards(const Config& c) {
  PlaneFlow flow{PlaneFlowKind::lees_edwards, 0, 2};
  flow.low = c.domain.min.z, flow.high = c.domain.max.z;
  flow.relative_speed = c.domain.shear_rate * (flow.high - flow.low);
  return flow;
}

PlaneFlow between_walls(const Config& c) {
  PlaneFlow flow;
  const auto [low, high] = Walls(c).pair();
  flow.gradient = low.axis;
  flow.low = low.at, flow.high = high.at;
  flow.lower = low.body, flow.upper = high.body;
  if (c.drive.opposed != DriveReversal::none) refuse("drive.opposed", "must be \"none\" between walls");
  const Vec3d slip = velocity_of(c, high.body) - velocity_of(c, low.body);
  const Vec3d push = c.drive.f + c.gravity;
  const bool driven = norm(push) > 0, sheared = norm(slip) > 0;
  if (driven && sheared) refuse("drive.f", "the flow is driven and sheared at the same time");
  if (!driven && !sheared) refuse("drive.f", "nothing drives the flow");
  const auto along = axis_of(driven ? push : slip);
  if (!along || *along == flow.gradient)
    refuse(driven ? (norm(c.drive.f) > 0 ? "drive.f" : "gravity") : Walls::key(high.body),
           "the flow must be driven along one axis, parallel to the walls");
  flow.kind = driven ? PlaneFlowKind::poiseuille : PlaneFlowKind::couette;
  flow.along = *along;
  flow.relative_speed = slip[*along];
  flow.fastest = std::max(norm(velocity_of(c, low.body)), norm(velocity_of(c, high.body)));
  return flow;
}

}  // namespace

std::string PlaneFlow::name() const {
  switch (kind) {
    case PlaneFlowKind::reverse_poiseuille:
      return "reverse Poiseuille";
    case PlaneFlowKind::poiseuille:
      return "Poiseuille";
    case PlaneFlowKind::couette:
      return "Couette";
    case PlaneFlowKind::lees_edwards:
      return "Lees-Edwards";
  }
  return "";
}

double PlaneFlow::relaxation(double nu) const {
  const double width = kind == PlaneFlowKind::lees_edwards ? gap() / 2 : gap();  // half a wavelength
  return width * width / (M_PI * M_PI * nu);
}

double left_out(const FluidConfig& fluid) { return fluid.lattice() ? fluid.dx : fluid.h(); }

PlaneFlow plane_flow_of(const Config& c) {
  if (!c.fluid.present) throw NoPlaneFlow("fluid.dx", "fluid.dx: a viscometer needs a fluid");
  bool walls = false;
  for (const WallBody& body : c.wall.bodies) walls = walls || body.stops_fluid();
  PlaneFlow flow = c.domain.sheared() ? lees_edwards(c) : walls ? between_walls(c) : reverse_poiseuille(c);
  for (int k = 0; k < 3; ++k)
    if (!c.domain.periodic[k] && !c.domain.flat(k) && !(walls && k == flow.gradient))
      refuse("domain.periodic", fmt::format("must be true along {}", "xyz"[k]));
  const Vec3d size = c.domain.max - c.domain.min;
  flow.area = size[flow.along] * size[flow.across()];
  refuse_additions(c);
  const double h = left_out(c.fluid), least = flow.kind == PlaneFlowKind::poiseuille ? 3.5 : 2.5;
  if (flow.kind != PlaneFlowKind::lees_edwards && flow.gap() < least * h)
    throw KeyError(
        "fluid.dx",
        fmt::format("fluid.dx = {}: {:g} m from {} is too narrow for h = {:.4g} m, one of which is "
                    "excluded on each side; a viscometer needs {} in {} flow",
                    c.fluid.dx, flow.gap(), walls ? "wall to wall" : "reversal to reversal", h, least,
                    flow.name()));
  return flow;
}

int blocks_until(const PlaneFlow& flow, double nu, double end) {
  const double relaxation = flow.relaxation(nu), from = kStart * relaxation;
  const int blocks = int(std::min((end - from) / relaxation * (1 + 1e-9), double(kMostBlocks)));
  if (blocks < kLeastBlocks)
    throw KeyError(
        "time.end",
        fmt::format("time.end = {:g} must be >= {:.4g} in a viscometer: the flow needs {:.3g} s to become "
                    "steady and {} blocks of {:.3g} s ({}) for the average",
                    end, from + kLeastBlocks * relaxation, from, kLeastBlocks, relaxation,
                    flow.kind == PlaneFlowKind::lees_edwards ? "L^2 / 4 pi^2 nu" : "D^2 / pi^2 nu"));
  return blocks;
}

}  // namespace bedload
