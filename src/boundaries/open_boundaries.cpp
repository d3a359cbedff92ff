#include "src/boundaries/open_boundaries.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/parallel/reductions.hpp"
#include "kernels/boundaries/insert.hpp"
#include "kernels/boundaries/sinks.hpp"

namespace BL_SOLVER {
namespace {

constexpr int kPlaces = 16;  // candidate positions of a grain, tested together

/// The outlets of a phase as solids, for inside tests on the device.
std::vector<WallBody> outlets_as_walls(const std::vector<OutletConfig>& outlets, Phase phase) {
  std::vector<WallBody> walls;
  for (const OutletConfig& outlet : outlets) {
    WallBody& body = walls.emplace_back();
    if (!outlet.takes(phase)) {
      body.shape = WallShape::tank, body.faces = {};  // keeps its number, but takes nothing
      continue;
    }
    body.shape = outlet.shape == OutletShape::plane ? WallShape::plane : WallShape::box;
    body.min = outlet.min, body.max = outlet.max;
    body.point = outlet.point, body.normal = -outlet.normal;
    body.solid = outlet.solid;
  }
  return walls;
}

}  // namespace

OpenBoundaries::OutletRegions::OutletRegions(const OpenBoundaryParameters& p, Phase phase)
    : geometry(outlets_as_walls(p.outlets, phase), p.domain), tally(kSides + p.outlets.size()) {}

OpenBoundaries::OpenBoundaries(const OpenBoundaryParameters& parameters, const Frame& frame,
                               WallMotion& motion, GrainStore& grains)
    : parameters_(parameters),
      frame_(frame),
      motion_(motion),
      fluid_out_(parameters, Phase::fluid),
      grains_out_(parameters, Phase::grains),
      matter_(parameters.materials),
      left_through_(grains, "left_through", "-", Lifetime::kept),
      grains_left_(kSides, -1.0),
      sources_(parameters.sources) {
  left_through_.begin_at_zero();
}

void OpenBoundaries::start(const FluidStore& fluid, const GrainStore& grains) {
  next_fluid_ = Index(fluid.everywhere());
  next_grain_ = Index(grains.everywhere());
}

bool OpenBoundaries::fluid_due() const {
  const auto& inlets = motion_.inlets();
  return std::any_of(inlets.begin(), inlets.end(), [](const InletFlow& inlet) { return inlet.due(); });
}

bool OpenBoundaries::grains_due(double t) const {
  return std::any_of(sources_.begin(), sources_.end(), [&](const GrainSource& s) { return s.news(t); });
}

// -- out -----------------------------------------------------------------------------------------

/// Marks leaving particles in sink_ and tallies them; false if there are none.
template <class P, class Mass>
bool OpenBoundaries::find_leaving(OutletRegions& regions, Span<const P> x, Range owned, bool domain,
                                  const Mass& mass, double t, const Clumps* clumps) {
  if (!domain && regions.geometry.surfaces().empty()) return false;
  sink_.resize(x.size);
  for_each({0, x.size}, SinkPass<P>{frame_, regions.geometry.view(), domain, x, sink_});
  if (clumps && clumps->any()) leave_together(regions, *clumps);
  if (sum_over<1>(owned, LeavingBody{sink_}).v[0] == 0) return false;
  if (domain) {
    const auto gone = sum_over<2 * kSides>(owned, SideTally<Mass>{sink_, mass});
    for (std::uint32_t k = 0; k < kSides; ++k) regions.tally[k].add(gone.v[2 * k], gone.v[2 * k + 1], t);
  }
  const Span<const std::uint32_t> member = clumps ? clumps->members() : Span<const std::uint32_t>();
  for (std::uint32_t k = kSides; k < regions.tally.size(); ++k) {
    const auto gone = sum_over<2>(owned, SinkTally<Mass>{sink_, kLeftDomain + k, mass, member});
    regions.tally[k].add(gone.v[0], gone.v[1], t);
  }
  return true;
}

void OpenBoundaries::leave_together(const OutletRegions& regions, const Clumps& clumps) {
  const Index n = clumps.store().size();
  centres_.reserve_and_resize(n), clump_sink_.reserve_and_resize(n);
  const Range all{0, n};
  for_each(all, WrappedCentres{frame_, clumps.store().x.span(), centres_});
  for_each(all, SinkPass<Vec3d>{frame_, regions.geometry.view(), false, centres_, clump_sink_});
  for_each({0, clumps.of_grains().size}, LeaveTogetherPass{clumps.of_grains(), clump_sink_, sink_});
}

OpenBoundaries::Tally OpenBoundaries::lost_fluid() const {
  Tally all;
  for (std::uint32_t k = 0; k < kSides; ++k)
    all.count += fluid_out_.tally[k].count, all.mass += fluid_out_.tally[k].mass;
  return all;
}

std::vector<OpenBoundaries::Tally> OpenBoundaries::grains_outside(const GrainStore& grains, double t) const {
  const auto out = sum_over<2 * kSides>(
      grains.owned(),
      GrainSideTally<GrainMass>{{frame_, grains.x, left_through_}, {matter_.of(grains), grains.radius}});
  std::vector<Tally> sides(kSides);
  for (std::uint32_t k = 0; k < kSides; ++k) {
    sides[k].first = grains_left_[k];
    sides[k].add(out.v[2 * k], out.v[2 * k + 1], t);
  }
  return sides;
}

std::vector<Loss> OpenBoundaries::losses(const GrainStore& grains, double t) const {
  std::vector<Loss> out;
  const auto add = [&](const char* phase, const std::vector<Tally>& sides) {
    for (std::uint32_t k = 0; k < kSides; ++k)
      if (sides[k].count > 0)
        out.push_back({phase, {"xyz"[k / 2], "-+"[k % 2]}, sides[k].count, sides[k].mass, sides[k].first});
  };
  if (parameters_.has_fluid) add("fluid", fluid_out_.tally);
  if (parameters_.has_grains) add("grains", grains_outside(grains, t));
  return out;
}

void OpenBoundaries::renew(FluidStore& fluid, WallStore& walls, const EquationOfState& eos, double t,
                           const Vec3d& gravity) {
  if (find_leaving(fluid_out_, Span<const FluidPosition>(fluid.x), fluid.owned(), true, FluidMass{fluid.mass},
                   t)) {
    find_all(fluid.owned().size(), StaysTest{sink_}, kept_);
    fluid.reorder(kept_);
  }
  for (std::size_t i = 0; i < motion_.inlets().size(); ++i)
    while (motion_.inlets()[i].due()) {
      admit(i, fluid, walls, eos, t, gravity);
      motion_.inlets()[i].next_layer();
      WallMotion::place(frame_, walls, motion_.poses_at(t));
    }
}

// -- fluid in ------------------------------------------------------------------------------------

void OpenBoundaries::admit(std::size_t i, FluidStore& fluid, const WallStore& walls,
                           const EquationOfState& eos, double t, const Vec3d& gravity) {
  Index first = Index(walls.everywhere());  // inlet particles have the last ids of walls
  for (std::size_t k = i; k < motion_.inlets().size(); ++k) {
    const InletFlow& inlet = motion_.inlets()[k];
    first -= Index(buffer_layers(parameters_.fluid, inlet.thickness()) * inlet.points());
  }
  const Index count = Index(motion_.inlets()[i].points()), before = fluid.size();
  if (next_fluid_ + count >= double(kNone))
    throw SimulationFault("inlet \"" + motion_.inlets()[i].name() +
                          "\": more fluid particles than there are ids");
  find_all(walls.owned().size(), InLayer{Id(first), count, walls.id}, layer_);
  const Index here = Index(layer_.size());
  fluid.grow(before + here);
  for_each({0, here}, InsertPass{.frame = frame_,
                                 .eos = eos,
                                 .first = first,
                                 .place = before,
                                 .id = Id(next_fluid_),
                                 .mass = Real(parameters_.fluid_mass()),
                                 .acc = Real3(motion_.inlets()[i].motion(t).a),
                                 .gravity = Real3(gravity),
                                 .layer = layer_,
                                 .wall_id = walls.id,
                                 .wall_x = walls.x,
                                 .wall_v_rho = walls.v_rho,
                                 .wall_state = walls.state,
                                 .fluid_id = fluid.id,
                                 .x = fluid.x,
                                 .v_rho = fluid.v_rho,
                                 .flux = fluid.flux,
                                 .eos_state = fluid.eos_state,
                                 .compression = fluid.compression,
                                 .fluid_mass = fluid.mass,
                                 .eps = fluid.eps,
                                 .solid_factor = fluid.solid_factor,
                                 .out = {fluid.stress_acceleration, fluid.acc}});
  next_fluid_ += count;
}

// -- grains --------------------------------------------------------------------------------------

GrainRenewal OpenBoundaries::renew(GrainStore& grains, SolidSolver& solids, double t) {
  Clumps& clumps = solids.clumps();
  const Index before = grains.owned().size();
  const GrainMass mass{matter_.of(grains), grains.radius};
  const bool fewer =
      find_leaving(grains_out_, Span<const Vec3d>(grains.x), grains.owned(), false, mass, t, &clumps);
  if (fewer) solids.let_go(grains, sink_, clump_sink_);
  grains.drop_ghosts();
  if (fewer) {
    find_all(before, StaysTest{sink_}, source_index_);
    grains.reorder(source_index_);
    if (clumps.any()) {
      find_all(clumps.store().size(), StaysTest{clump_sink_}, kept_);
      if (kept_.size() < clumps.store().size()) clumps.keep(kept_, grains);
    }
  }
  for_each(grains.owned(), NoteSidePass{{frame_, grains.x, left_through_}, left_through_});
  const std::vector<Tally> outside = grains_outside(grains, t);
  for (std::uint32_t k = 0; k < kSides; ++k) grains_left_[k] = outside[k].first;
  Arrivals arrivals = new_grains(grains, clumps, t);
  const std::vector<NewGrain>& more = arrivals.grains;
  if (!fewer && more.empty()) return {};
  const Index kept = grains.size();
  if (!fewer) {
    source_index_.resize(kept);
    for_each({0, kept}, FillIndex{source_index_});
  }
  if (!more.empty()) {
    if (next_grain_ + double(more.size()) >= double(kNone))
      throw SimulationFault("grain_inlet: more grains than there are ids");
    if (Context::current().rank() > 0)
      dropped_.resize(0);  // the first gives them away with the next lists
    else
      dropped_.assign(more);
    const Index here = Index(dropped_.size()), clumps_before = clumps.store().size();
    grains.grow(kept + here);
    source_index_.grow(grains.size());
    const Clumps::Membership in = clumps.membership();
    for_each({0, here}, DropPass{.grain = dropped_,
                                 .place = kept,
                                 .first = Id(next_grain_),
                                 .id = grains.id,
                                 .x = grains.x,
                                 .v = grains.v,
                                 .radius = grains.radius,
                                 .eps = grains.eps,
                                 .material = grains.material,
                                 .source_index = source_index_,
                                 .clumps = clumps.store().size(),
                                 .clump = in.clump,
                                 .member = in.member,
                                 .arm = in.arm,
                                 .clump_d = grains.clump_d.span()});
    // the first grain of a clump has an id that no clump had at the start
    for (std::size_t k = 0; k < more.size(); ++k)
      if (more[k].clump > 0 && more[k].member == 0)
        arrivals.clumps[more[k].clump - 1].id = Id(next_grain_ + double(k) + 1);
    if (!arrivals.clumps.empty()) clumps.add(arrivals.clumps, grains, {kept, grains.size()});
    solids.let_in(grains, {kept, grains.size()}, clumps_before);
    next_grain_ += double(more.size());
  }
  return {source_index_, before, true};
}

OpenBoundaries::Arrivals OpenBoundaries::new_grains(const GrainStore& grains, const Clumps& clumps,
                                                    double t) {
  Arrivals all;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    GrainSource& source = sources_[k];
    while (source.due(t) && drop_one(k, grains, clumps, t, all)) source.dropped();
    source.state.asked = source.state.count + source.pending(t);
  }
  return all;
}

/// Adds the next grain or clump of a source at the first candidate position clear of grains and walls, if
/// there is one.
bool OpenBoundaries::drop_one(std::size_t s, const GrainStore& grains, const Clumps& clumps, double t,
                              Arrivals& all) {
  GrainSource& source = sources_[s];
  const std::vector<Vec3d> places = source.places();
  const auto spheres = source.spheres();
  const ClumpShape* shape = source.shape();
  ClearanceBody<kPlaces> space{frame_, {}, source.reach(), grains.x, grains.radius};
  if (shape) {
    std::vector<Vec4<double>> parts;
    for (const auto& [x, r] : spheres) parts.push_back({x.x, x.y, x.z, r});
    spheres_.assign(parts);
    space.spheres = spheres_;
  }
  std::copy_n(places.begin(), kPlaces, space.place);
  const auto touching = sum_over<kPlaces>(grains.owned(), space);
  for (int k = 0; k < kPlaces; ++k) {
    std::vector<NewGrain> come;
    for (const auto& [x, r] : spheres)
      come.push_back({frame_.wrap(places[k] + x), source.velocity(), r, source.material()});
    const auto blocked = [&](const NewGrain& grain) {
      return std::any_of(all.grains.begin(), all.grains.end(),
                         [&](const NewGrain& other) {
                           return norm(frame_.separation(grain.x, other.x)) < grain.radius + other.radius;
                         }) ||
             !is_clear(grain, t);
    };
    if (touching.v[k] > 0 || std::any_of(come.begin(), come.end(), blocked)) continue;
    if (shape) {
      std::vector<Real> radii;
      for (const NewGrain& grain : come) radii.push_back(Real(grain.radius));
      const double size = Clumps::size_of(*shape, radii);
      const std::uint32_t kind = clumps.kind_of_dropped(source.material());
      for (std::uint32_t n = 0; n < come.size(); ++n) {
        const ClumpSphere& of = shape->spheres[n];
        come[n].clump = std::uint32_t(all.clumps.size() + 1), come[n].member = n;
        come[n].arm = size * Vec3d{of[0], of[1], of[2]},
        come[n].clump_d = clumps.share_drag(kind) ? 2 * source.radius() : 0;
      }
      all.clumps.push_back({0, kind, size, places[k], source.velocity(), to_vec4(source.rotation())});
    }
    all.grains.insert(all.grains.end(), come.begin(), come.end());
    return true;
  }
  return false;
}

/// Whether a grain is clear of all walls at time t.
bool OpenBoundaries::is_clear(const NewGrain& grain, double t) const {
  for (int b = 0; b < motion_.walls(); ++b) {
    const WallBody& body = parameters_.walls[b];
    if (!body.stops_grains() || motion_.removed(b)) continue;
    const Vec3d x = motion_.pose(b, t).undo(grain.x);
    if (wall_clearance(body, x, 10 * parameters_.d_max, parameters_.domain) < grain.radius) return false;
  }
  return true;
}

// -- mass balance ---------------------------------------------------------------------------------------

std::vector<Quantity> OpenBoundaries::report(double t) const {
  std::vector<Quantity> out;
  const auto tally = [&](const std::string& name, const Tally& gone) {
    out.push_back({name + "_count", "-", gone.count});
    out.push_back({name + "_mass", "kg", gone.mass});
  };
  if (parameters_.has_fluid) tally("lost_fluid", lost_fluid());
  for (std::size_t i = 0; i < motion_.inlets().size(); ++i) {
    const InletFlow& inlet = motion_.inlets()[i];
    const std::string name = "inlet_" + inlet.name();
    out.push_back({name + "_volume", "m3", inlet.volume(t)});
    out.push_back({name + "_mass", "kg", inlet.layers() * inlet.points() * parameters_.fluid_mass()});
  }
  for (std::size_t k = 0; k < parameters_.outlets.size(); ++k) {
    const OutletConfig& outlet = parameters_.outlets[k];
    const std::string name = "outlet_" + outlet.name;
    if (parameters_.has_fluid && outlet.takes(Phase::fluid))
      tally(name + "_fluid", fluid_out_.tally[kSides + k]);
    if (parameters_.has_grains && outlet.takes(Phase::grains))
      tally(name + "_grain", grains_out_.tally[kSides + k]);
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const std::string name = "grain_inlet_" + sources_[i].name();
    tally(name, {sources_[i].state.count, sources_[i].state.mass});
    out.push_back({name + "_waiting", "-", sources_[i].pending(t)});
  }
  return out;
}

template <class Self, class F>
void OpenBoundaries::each_scalar(Self& self, const F& f) {
  f("next_fluid_id", "-", self.next_fluid_);
  f("next_grain_id", "-", self.next_grain_);
  for (std::uint32_t k = 0; k < kSides; ++k) {
    auto& tally = self.fluid_out_.tally[k];
    const std::string side = std::to_string(k);
    f("lost_fluid_" + side, "-", tally.count);
    f("lost_mass_" + side, "kg", tally.mass);
    f("lost_fluid_since_" + side, "s", tally.first);
    f("lost_grains_since_" + side, "s", self.grains_left_[k]);
  }
  for (std::size_t k = 0; k < self.parameters_.outlets.size(); ++k) {
    const std::string name = "outlet_" + self.parameters_.outlets[k].name;
    f(name + "_fluid_count", "-", self.fluid_out_.tally[kSides + k].count);
    f(name + "_fluid_mass", "kg", self.fluid_out_.tally[kSides + k].mass);
    f(name + "_grain_count", "-", self.grains_out_.tally[kSides + k].count);
    f(name + "_grain_mass", "kg", self.grains_out_.tally[kSides + k].mass);
  }
  for (std::size_t i = 0; i < self.sources_.size(); ++i) {
    auto& state = self.sources_[i].state;
    const std::string name = "grain_inlet_" + self.sources_[i].name();
    f(name + "_count", "-", state.count);
    f(name + "_mass", "kg", state.mass);
    f(name + "_rounds", "-", state.rounds);
    f(name + "_asked", "-", state.asked);
  }
}

void OpenBoundaries::save(std::vector<Quantity>& scalars) const {
  each_scalar(*this, [&](const std::string& name, const char* unit, double value) {
    scalars.push_back({name, unit, value});
  });
  for (std::size_t i = 0; i < motion_.inlets().size(); ++i) {
    const InletFlow& inlet = motion_.inlets()[i];
    const std::string name = "inlet_" + inlet.name();
    scalars.push_back({name + "_volume", "m3", inlet.counted()});
    scalars.push_back({name + "_layers", "-", inlet.layers()});
  }
}

void OpenBoundaries::load(const std::function<double(const std::string&)>& scalar, double t) {
  each_scalar(*this, [&](const std::string& name, const char*, double& value) { value = scalar(name); });
  for (GrainSource& source : sources_) source.resume();
  for (std::size_t i = 0; i < motion_.inlets().size(); ++i) {
    const std::string name = "inlet_" + motion_.inlets()[i].name();
    motion_.inlets()[i].resume(t, scalar(name + "_volume"), scalar(name + "_layers"));
  }
}

}  // namespace BL_SOLVER
