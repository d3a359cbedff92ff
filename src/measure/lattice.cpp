// Frames, diagnostics and probes of fluid on nodes.

#include <array>
#include <cmath>

#include "bedload/case/lattice_step.hpp"
#include "src/measure/body_rows.hpp"
#include "src/measure/probe_points.hpp"
#include "src/time/lattice_simulation.hpp"

namespace BL_SOLVER {
namespace {

template <class T>
HostArray array_of(const char* name, const char* unit, const std::vector<T>& values) {
  HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  a.bytes.assign(bytes, bytes + values.size() * sizeof(T));
  return a;
}

template <class N>
HostArray array_of(const char* name, const std::vector<PairMoment<N>>& values) {
  HostArray a{name, "J", FileType<N>::scalar, 9, {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  a.bytes.assign(bytes, bytes + values.size() * sizeof values[0]);
  return a;
}

/// Of second moments in the order of lattice::RowSums.
PairMoment<double> moment_of(double scale, const double (&m)[lattice::RowSums::kMoments]) {
  return {
      {scale * Vec3d{m[0], m[3], m[4]}, scale * Vec3d{m[3], m[1], m[5]}, scale * Vec3d{m[4], m[5], m[2]}}};
}

}  // namespace

HostStore LatticeSimulation::snapshot(const std::string& name) {
  if (name == "grains" && grains_) {
    HostStore out = grains_->snapshot(name);
    out.arrays.push_back(grains_->state().grains.fluid_force.to_host());
    out.arrays.push_back(resolved_->torque().to_host());
    return out;
  }
  if (name != "fluid") return {name, 0, {}};
  const LatticeUnits& units = solver_.units();
  const lattice::NodeGrid& nodes = solver_.grid();
  Index begin[3], end[3];  // without those outside the domain
  HostGrid grid;
  for (int k = 0; k < 3; ++k) {
    const Index beyond = has_outer_nodes(config_, k) ? 1 : 0;
    begin[k] = beyond, end[k] = nodes.n[k] - beyond;
    grid.count[std::size_t(k)] = end[k] - begin[k];
  }
  grid.first = solver_.place(nodes.node({{begin[0], begin[1], begin[2]}}));
  grid.spacing = units.dx;

  std::vector<Vec3d> x;
  std::vector<Real3> v;
  std::vector<Real> pressure, density;
  std::vector<std::uint32_t> solid, id;
  const std::vector<Real4> states = solver_.states();
  for (Index k = begin[2]; k < end[2]; ++k)
    for (Index j = begin[1]; j < end[1]; ++j)
      for (Index i = begin[0]; i < end[0]; ++i) {
        const Index node = nodes.node({{i, j, k}});
        const Real4& s = states[node];
        const bool fluid = s.w > -1;
        x.push_back(solver_.place(node));
        v.push_back(Real3(units.velocity() * Vec3d(s.xyz())));
        pressure.push_back(fluid ? Real(units.pressure() * double(s.w)) : Real(0));
        density.push_back(Real(units.rho * (1 + double(s.w))));
        solid.push_back(fluid ? 0 : 1);
        id.push_back(std::uint32_t(id.size()));
      }
  return {name,
          x.size(),
          {array_of("position", "m", x), array_of("velocity", "m/s", v), array_of("pressure", "Pa", pressure),
           array_of("density", "kg/m3", density), array_of("solid", "-", solid), array_of("id", "-", id)},
          grid};
}

/// Of the fluid an entry for each row of nodes along a periodic axis.
HostStore LatticeSimulation::rheology(const std::string& name) {
  const int axis = config_.domain.periodic[0] ? 0 : 1;
  Buffer<PairMoment<>> stresslets;
  const std::vector<lattice::RowSums> rows = solver_.stress(axis, clock_.time, held(), stresslets);
  if (name == "grains" && grains_) {
    HostStore out = grains_->rheology(name);
    out.arrays.push_back(array_of("stress_particles", stresslets.to_host()));
    return out;
  }
  if (name != "fluid") return {name, 0, {}};
  const LatticeUnits& units = solver_.units();
  std::vector<Vec3d> x, v, drive;
  std::vector<double> mass, volume;
  std::vector<PairMoment<double>> pressure, friction, kinetic;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const lattice::RowSums& row = rows[r];
    const lattice::NodeGrid::Place at = lattice::RowStressPass::place(solver_.grid(), axis, Index(r), 0);
    if (config_.domain.sheared() && (at.of[2] == 0 || at.of[2] + 1 == solver_.grid().n[2])) continue;
    const double m = row.fluid + row.excess;
    x.push_back(solver_.place(solver_.grid().node(at)));
    v.push_back(m > 0 ? units.velocity() / m * row.momentum : Vec3d{});
    drive.push_back(row.fluid * solver_.force_on_node());
    mass.push_back(units.mass() * m);
    volume.push_back(units.dx * units.dx * units.dx * row.nodes);
    const double p = row.excess / 3;
    const double isotropic[lattice::RowSums::kMoments] = {p, p, p};
    pressure.push_back(moment_of(units.energy(), isotropic));
    friction.push_back(moment_of(units.energy(), row.friction));
    kinetic.push_back(moment_of(units.energy(), row.flow));
    kinetic.back().add(-mass.back() * v.back(), v.back());  // about the mean of the row
  }
  return {
      name,
      x.size(),
      {array_of("position", "m", x), array_of("velocity", "m/s", v), array_of("mass", "kg", mass),
       array_of("volume", "m3", volume), array_of("drive", "N", drive), array_of("stress_pressure", pressure),
       array_of("stress_friction", friction), array_of("stress_kinetic", kinetic)}};
}

std::vector<Quantity> LatticeSimulation::diagnostics() {
  const LatticeUnits& units = solver_.units();
  const FluidSums sums = solver_.totals();
  const lattice::NodeExtremes e = solver_.extremes();
  Vec3d by_walls, impulse;
  for (int b = 0; b < int(config_.wall.bodies.size()); ++b) {
    const WallSums wall = solver_.wall(b, clock_.time);
    by_walls -= wall.force;
    impulse -= wall.impulse;
  }
  std::vector<Quantity> out{{"fluid_mass", "kg", sums.mass}};
  add(out, "fluid_momentum", "kg m/s", sums.momentum);
  add(out, "fluid_angular_momentum", "kg m2/s", sums.angular);
  out.push_back({"fluid_kinetic_energy", "J", sums.kinetic});
  add(out, "force_walls_on_fluid", "N", by_walls);
  add(out, "impulse_by_walls", "N s", impulse);
  add(out, "impulse_by_forces", "N s", solver_.driven());
  if (config_.domain.sheared()) add(out, "impulse_by_images", "N s", solver_.by_images());
  add(out, "fluid_momentum_residual", "kg m/s", sums.residual);  // round-off
  out.push_back({"fluid_mass_restored", "kg", solver_.restored()});
  out.push_back({"fluid_speed_max", "m/s", units.velocity() * std::sqrt(e.speed2)});
  out.push_back({"pressure_max", "Pa", units.pressure() * e.most});
  out.push_back({"pressure_min", "Pa", units.pressure() * e.least});
  out.push_back({"density_max", "kg/m3", units.rho * (1 + e.most)});
  out.push_back({"density_min", "kg/m3", units.rho * (1 + e.least)});
  out.push_back({"fluid_count", "-", sums.nodes});
  if (!grains_) return out;
  const ResolvedGrains::Sums of = resolved_->sums();
  add(out, "impulse_on_grains", "N s", of.received);
  add(out, "impulse_owed_to_grains", "N s", of.owed);
  for (const Quantity& q : grains_->diagnostics()) out.push_back(q);
  return out;
}

std::vector<Quantity> LatticeSimulation::measure(const ProbeConfig& p) {
  switch (p.type) {
    case ProbeType::point:
      return at_each_point(p, [&](const ProbeConfig& one) { return point(one); });
    case ProbeType::box:
      return box(p);
    case ProbeType::force:
      return body_force(p);
    case ProbeType::front:
    case ProbeType::height:
    case ProbeType::flux:
    case ProbeType::mixing:
    case ProbeType::field:
    case ProbeType::wall_pressure:  // refused when the case is read
      break;
  }
  return {};
}

/// Trilinear between the fluid nodes around the point.
std::vector<Quantity> LatticeSimulation::point(const ProbeConfig& p) const {
  const Vec3d at = p.body.empty() ? p.at : solver_.motion(wall_named(p.body), clock_.time).place(p.at);
  const lattice::NodeGrid& grid = solver_.grid();
  const Vec3d cells = (at - solver_.place(0)) / solver_.units().dx;
  std::vector<Index> nodes;
  std::array<double, 8> weight;
  for (int corner = 0; corner < 8; ++corner) {
    lattice::NodeGrid::Place place;
    weight[std::size_t(corner)] = 1;
    for (int k = 0; k < 3; ++k) {
      const bool upper = corner >> k & 1;
      const double below = std::floor(cells[k]), fraction = cells[k] - below, n = double(grid.n[k]);
      const double wrapped = below + upper - n * std::floor((below + upper) / n);
      place.of[k] = std::min(Index(wrapped), grid.n[k] - 1);
      weight[std::size_t(corner)] *= upper ? fraction : 1 - fraction;
    }
    nodes.push_back(grid.node(place));
  }
  double sum = 0, pressure = 0;
  Vec3d v;
  const std::vector<NodeValue> values = solver_.values(nodes);
  for (std::size_t k = 0; k < 8; ++k) {
    if (!values[k].fluid) continue;
    sum += weight[k];
    pressure += weight[k] * values[k].pressure;
    v += weight[k] * values[k].velocity;
  }
  const double whole = sum > 0 ? sum : std::nan("");
  std::vector<Quantity> out{{"pressure", "Pa", pressure / whole}};
  add(out, "velocity", "m/s", v / whole);
  out.push_back({"kernel_sum", "-", sum});
  return out;
}

std::vector<Quantity> LatticeSimulation::box(const ProbeConfig& p) const {
  const LatticeUnits& units = solver_.units();
  double count = 0, mass = 0, pressure = 0;
  Vec3d momentum;
  const std::vector<Real4> states = solver_.states();
  for (Index n = 0; n < states.size(); ++n) {
    const Real4& s = states[n];
    if (!(s.w > -1)) continue;
    const Vec3d x = solver_.place(n);
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside = inside && x[k] >= p.min[k] && x[k] <= p.max[k];
    if (!inside) continue;
    const double m = units.mass() * (1 + double(s.w));
    count += 1, mass += m;
    pressure += m * units.pressure() * double(s.w);
    momentum += m * units.velocity() * Vec3d(s.xyz());
  }
  const double m = mass > 0 ? mass : std::nan("");
  std::vector<Quantity> out{{"count", "-", count}, {"mass", "kg", mass}};
  add(out, "velocity", "m/s", momentum / m);
  out.push_back({"pressure", "Pa", pressure / m});
  return out;
}

int LatticeSimulation::wall_named(const std::string& name) const {
  int body = 0;
  for (int b = 0; b < int(config_.wall.bodies.size()); ++b)
    if (config_.wall.bodies[std::size_t(b)].name == name) body = b;
  return body;
}

void LatticeSimulation::begin_interval(const ProbeConfig& p) {
  if (p.type == ProbeType::force)
    intervals_[p.name] = {clock_.time, solver_.wall(wall_named(p.body), clock_.time)};
}

std::vector<Quantity> LatticeSimulation::body_force(const ProbeConfig& p) const {
  const int body = wall_named(p.body);
  WallSums now = solver_.wall(body, clock_.time);
  const RigidMotion motion = solver_.motion(body, clock_.time);
  Vec3d force = now.force, torque = now.torque + cross(motion.origin() - p.about, now.force);
  double power = dot(now.force, motion.v) + dot(now.torque, motion.omega);
  const Interval& since = intervals_.at(p.name);
  if (const double span = clock_.time - since.time; p.sample == ForceSample::mean && span > 0) {
    force = (now.impulse - since.sums.impulse) / span;
    torque = (now.turned - since.sums.turned) / span - cross(p.about, force);
    power = (now.work - since.sums.work) / span;
  }
  std::vector<Quantity> out;
  add(out, "force_by_fluid", "N", force);
  add(out, "torque_by_fluid", "N m", torque);
  out.push_back({"power_by_fluid", "W", power});
  return out;
}

std::vector<Quantity> LatticeSimulation::body_state(int body) {
  const WallSums sums = solver_.wall(body, clock_.time);
  LoadSum load = LoadSum::zero();
  load.add(sums.force, sums.torque);
  std::vector<Quantity> out = rows_of(solver_.motion(body, clock_.time), {{"fluid", load}});
  if (!grains_) return out;
  for (const Quantity& q : grains_->body_state(body))
    if (q.name.find("_by_grains") != std::string::npos) out.push_back(q);
  return out;
}

}  // namespace BL_SOLVER
