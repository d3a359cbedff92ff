// Probes of fluid and grains: fronts, points, columns, boxes.

#include <algorithm>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/depth.hpp"
#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/along.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/measure/fluid_contents.hpp"
#include "src/measure/probe_points.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

constexpr const char* kAxis[3] = {"x", "y", "z"};

/// Shepard sums about a point over the cells around it, cell by cell: W V, pressure, velocity 3.
template <class W>
struct PointBody {
  CellGridView grid;
  CellGridView::Block cells;
  W w;
  Vec3d at;
  FluidContents fluid;
  Index owned;  ///< particles: others count on the rank that owns them
  BL_HD void operator()(Index q, double* out) const {
    if (!cells.touches(int(q))) return;
    const std::uint32_t c = grid.key(cells, int(q));
    for (Index a = grid.first(c); a < min_of(grid.last(c), owned); ++a) add(a, out);
  }

 private:
  BL_HD void add(Index a, double* out) const {
    const Vec3d r = fluid.frame.nearest_image(fluid.at(a) - at);
    const double r2 = norm2(r), support = w.kappa * double(w.h);
    if (r2 >= support * support) return;
    const EosState<> m = fluid.state[a];
    const double weight = double(m.mass_over_eps) / m.rho * w.W(Real(std::sqrt(r2)));
    out[0] += weight;
    out[1] += weight * m.pressure();
    for (int k = 0; k < 3; ++k) out[2 + k] += weight * fluid.v_rho[a].v[k];
  }
};

/// Lowest and highest fluid particle in one piece of a column, relative to `at`, m.
struct Extent {
  double lowest, highest;
};

/// Extent of the fluid in each piece of the column of `radius` around the line through `at`; particles on a
/// border count in both pieces.
struct ColumnPass {
  CellGridView grid;
  Frame frame;
  Vec3d at, up;
  double radius, length, skin;  ///< m; length: of a piece
  int first;                    ///< number of the first piece; piece 0 begins at `at`
  Span<const FluidPosition> x;
  Span<Extent> out;
  BL_HD void operator()(Index n) const {
    const double middle = (first + int(n) + 0.5) * length, half = 0.5 * length * (1 + 1e-9);
    const Vec3d centre = at + middle * up;
    Extent extent{1e300, -1e300};
    grid.each_near(centre, std::sqrt(radius * radius + half * half) + skin, [&](Index a) {
      const Vec3d r = frame.nearest_image(coordinates(frame, x[a]) - centre);
      const double height = dot(r, up);
      if (norm2(r - height * up) > radius * radius || std::abs(height) > half) return;
      extent.lowest = min_of(extent.lowest, middle + height);
      extent.highest = max_of(extent.highest, middle + height);
    });
    out[n] = extent;
  }
};

BL_HD bool within(const Vec3d& x, const Vec3d& lo, const Vec3d& hi) {
  return x.x >= lo.x && x.x <= hi.x && x.y >= lo.y && x.y <= hi.y && x.z >= lo.z && x.z <= hi.z;
}

/// Over a box: count, mass, pressure, velocity 3, porosity.
struct FluidBox {
  Vec3d lo, hi;
  FluidContents fluid;
  BL_HD void operator()(Index a, double* out) const {
    if (!within(fluid.at(a), lo, hi)) return;
    const double m = fluid.mass[a];
    out[0] = 1, out[1] = m, out[2] = m * fluid.state[a].pressure();
    for (int k = 0; k < 3; ++k) out[3 + k] = m * fluid.v_rho[a].v[k];
    out[6] = m * fluid.state[a].eps;
  }
};
struct GrainBox {
  Vec3d lo, hi;
  MassPerR3 per_r3;
  Span<const Vec3d> x;
  Span<const Real3> v;
  Span<const Real> radius;
  BL_HD void operator()(Index i, double* out) const {
    if (!within(x[i], lo, hi)) return;
    const double r = radius[i], m = per_r3(i) * r * r * r;
    out[0] = 1, out[1] = m;
    for (int k = 0; k < 3; ++k) out[3 + k] = m * v[i][k];
  }
};

/// Through a section, over a box of some length along it: mass and volume times velocity along `axis`.
struct FluidFlux {
  Vec3d lo, hi;
  int axis;
  FluidContents fluid;
  BL_HD void operator()(Index a, double* out) const {
    if (!within(fluid.at(a), lo, hi)) return;
    const double m = fluid.mass[a], v = fluid.v_rho[a].v[axis];
    out[0] = m * v, out[1] = m / double(fluid.state[a].rho) * v;
  }
};
struct GrainFlux {
  Vec3d lo, hi;
  int axis;
  MassPerR3 per_r3;
  VolumePerR3 volume_per_r3;
  Span<const Vec3d> x;
  Span<const Real3> v;
  Span<const Real> radius;
  BL_HD void operator()(Index i, double* out) const {
    if (!within(x[i], lo, hi)) return;
    const double r3 = cube(double(radius[i])), u = v[i][axis];
    out[0] = per_r3(i) * r3 * u, out[1] = volume_per_r3(i) * r3 * u;
  }
};

}  // namespace

std::vector<Quantity> CoupledSimulation::measure(const ProbeConfig& p) {
  stepper_.share_all();
  if (p.type == ProbeType::field) return field(p);
  return at_each_point(p, [&](const ProbeConfig& one) { return measure_one(one); });
}

std::vector<Quantity> CoupledSimulation::measure_one(const ProbeConfig& p) {
  switch (p.type) {
    case ProbeType::front:
      return front(p);
    case ProbeType::point:
      return point(p);
    case ProbeType::height:
      return column(p);
    case ProbeType::box:
      return box(p);
    case ProbeType::flux:
      return flux(p);
    case ProbeType::force:
      return body_force(p);
    case ProbeType::wall_pressure:
      return wall_pressure(p);
    case ProbeType::mixing:
      return mixing(p);
    case ProbeType::field:
      return field(p);
  }
  return {};
}

std::vector<Quantity> CoupledSimulation::front(const ProbeConfig& p) {
  Vec3d direction;
  direction[p.axis] = p.sign;
  double front = std::nan("");
  if (p.phase == Phase::fluid && state_.fluid.everywhere() > 0)
    front = p.sign * (max_over(state_.fluid.owned(),
                               AlongBody<FluidPosition>{state_.frame, state_.fluid.x, direction}) +
                      config_.fluid.dx / 2);
  if (p.phase == Phase::grains && state_.grains.everywhere() > 0)
    front = p.sign *
            (max_over(state_.grains.owned(), AlongBody<Vec3d>{state_.frame, state_.grains.x, direction}) +
             config_.grain.d_max / 2);
  return {{std::string("front_") + kAxis[p.axis], "m", front}};
}

std::vector<Quantity> CoupledSimulation::point(const ProbeConfig& p) {
  const Vec3d at =
      p.body.empty() ? p.at : state_.motion.pose(wall_named(p.body), state_.clock.time).place(p.at);
  double sum[5] = {};
  if (state_.has_fluid)
    with_fluid_kernel(config_.fluid, config_.domain, [&](const auto& w) {
      const CellGridView grid = stepper_.fluid().grid().view();
      const auto cells = grid.block(at, stepper_.fluid().range() + stepper_.fluid().skin());
      const auto s = sum_over<5>({0, Index(cells.size())},
                                 PointBody<std::decay_t<decltype(w)>>{.grid = grid,
                                                                      .cells = cells,
                                                                      .w = w,
                                                                      .at = at,
                                                                      .fluid = {state_.frame, state_.fluid},
                                                                      .owned = state_.fluid.owned().size()});
      std::copy(s.v, s.v + 5, sum);
    });
  const double nan = std::nan("");
  const bool wet = sum[0] > 0.05;  // too few neighbours for a mean
  return {{"pressure", "Pa", wet ? sum[1] / sum[0] : nan},
          {"velocity_x", "m/s", wet ? sum[2] / sum[0] : nan},
          {"velocity_y", "m/s", wet ? sum[3] / sum[0] : nan},
          {"velocity_z", "m/s", wet ? sum[4] / sum[0] : nan},
          {"kernel_sum", "-", sum[0]}};
}

std::vector<Quantity> CoupledSimulation::column(const ProbeConfig& p) {
  const double dx = config_.fluid.dx, radius = 1.5 * dx;
  const double piece = 2 * dx;  // fluid within a piece counts as connected
  const Vec3d up = p.along == Vec3d{} ? upwards(config_.gravity) : p.along;
  const LinePart part = line_in_box(p.at, up, state_.frame.origin, state_.frame.origin + state_.frame.length);
  const int first = int(std::floor((part.from - radius) / piece));
  const int last = int(std::floor((part.to + radius) / piece));
  Buffer<Extent> found(std::size_t(std::max(0, last - first + 1)));
  for_each({0, Index(found.size())}, ColumnPass{.grid = stepper_.fluid().grid().view(),
                                                .frame = state_.frame,
                                                .at = p.at,
                                                .up = up,
                                                .radius = radius,
                                                .length = piece,
                                                .skin = stepper_.fluid().skin(),
                                                .first = first,
                                                .x = state_.fluid.x,
                                                .out = found.span()});
  std::vector<Extent> extents = found.to_host();
  all_reduce(extents, [](Extent& into, const Extent& more) {
    into.lowest = std::min(into.lowest, more.lowest), into.highest = std::max(into.highest, more.highest);
  });
  double top = -1e300, connected = 0;
  int number = first;
  bool joins = true;
  for (const Extent& extent : extents) {
    if (extent.highest >= extent.lowest) top = std::max(top, extent.highest);
    if (number++ < 0) continue;
    joins = joins && extent.highest >= extent.lowest && extent.lowest - connected < piece;
    if (joins) connected = extent.highest;
  }
  return {{"height", "m", top > -1e299 ? top + dx / 2 : 0.0},
          {"column_depth", "m", connected > 0 ? connected + dx / 2 : 0.0}};
}

std::vector<Quantity> CoupledSimulation::box(const ProbeConfig& p) {
  double s[7] = {};
  if (p.phase == Phase::fluid) {
    const auto r = sum_over<7>(state_.fluid.owned(), FluidBox{p.min, p.max, {state_.frame, state_.fluid}});
    std::copy(r.v, r.v + 7, s);
  } else {
    const auto r = sum_over<7>(state_.grains.owned(), GrainBox{.lo = p.min,
                                                               .hi = p.max,
                                                               .per_r3 = state_.matter.of(state_.grains),
                                                               .x = state_.grains.x,
                                                               .v = state_.grains.v,
                                                               .radius = state_.grains.radius});
    std::copy(r.v, r.v + 7, s);
  }
  const double m = s[1] > 0 ? s[1] : std::nan("");
  std::vector<Quantity> out = {{"count", "-", s[0]}, {"mass", "kg", s[1]}};
  for (int k = 0; k < 3; ++k) out.push_back({std::string("velocity_") + kAxis[k], "m/s", s[3 + k] / m});
  if (p.phase == Phase::fluid) {
    out.push_back({"pressure", "Pa", s[2] / m});
    out.push_back({"porosity", "-", s[6] / m});
  }
  return out;
}

std::vector<Quantity> CoupledSimulation::flux(const ProbeConfig& p) {
  double flow[2] = {};  // kg m/s, m4/s
  if (p.phase == Phase::fluid) {
    const auto sum =
        sum_over<2>(state_.fluid.owned(), FluidFlux{p.min, p.max, p.axis, {state_.frame, state_.fluid}});
    std::copy(sum.v, sum.v + 2, flow);
  } else {
    const auto sum =
        sum_over<2>(state_.grains.owned(), GrainFlux{.lo = p.min,
                                                     .hi = p.max,
                                                     .axis = p.axis,
                                                     .per_r3 = state_.matter.of(state_.grains),
                                                     .volume_per_r3 = state_.matter.volume_of(state_.grains),
                                                     .x = state_.grains.x,
                                                     .v = state_.grains.v,
                                                     .radius = state_.grains.radius});
    std::copy(sum.v, sum.v + 2, flow);
  }
  const double per_length = p.sign / (p.max[p.axis] - p.min[p.axis]);
  return {{"mass_flow", "kg/s", flow[0] * per_length}, {"volume_flow", "m3/s", flow[1] * per_length}};
}

}  // namespace BL_SOLVER
