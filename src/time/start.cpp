// How a stepper begins, is saved and continues.

#include <algorithm>
#include <cmath>
#include <utility>

#include "bedload/geometry/depth.hpp"
#include "bedload/parallel/ranks.hpp"
#include "bedload/parallel/reductions.hpp"
#include "src/domain/divide.hpp"
#include "src/time/stepper.hpp"

namespace BL_SOLVER {
namespace {

/// Initial fluid fills what the grains leave, at hydrostatic pressure and the density that goes with
/// it: in balance from the start, and heavier than at rho0 by its compression.
struct InitialDensityPass {
  EquationOfState eos;
  Frame frame;
  Span<const Real> eps, pressure;  ///< eps empty unless fluid gives way to grains
  Span<Real> mass, compression;
  BL_HD void operator()(Index a) const {
    const Real x = eos.compression(pressure[a]);
    mass[a] *= (eps ? eps[a] : Real(1)) * (1 + x);
    compression[a] = x;
  }
};

/// Of a grain, v^2 / d, m/s2.
struct LivelinessBody {
  Span<const Real3> v;
  Span<const Real> radius;
  BL_HD void operator()(Index i, double* out) const { out[0] = norm2(Vec3d(v[i])) / (2 * double(radius[i])); }
};

/// Depth below the top of the block of fluid that holds x, along gravity, m.
double depth_at(const Config& config, const Vec3d& gravity, const Vec3d& x) {
  const double g = norm(gravity);
  if (g == 0) return 0;
  const Vec3d up = gravity * (-1 / g);
  double depth = 0;
  for (const auto& fill : config.fluid.fills) {
    if (!fill.file.empty()) continue;
    bool inside = true;
    double top = 0;
    for (int k = 0; k < 3; ++k) {
      inside = inside && x[k] >= fill.min[k] && x[k] <= fill.max[k];
      top += up[k] * (up[k] > 0 ? fill.max[k] : fill.min[k]);
    }
    if (inside) depth = std::max(depth, std::min(top, fill.level) - dot(up, x));
  }
  return depth;
}

/// A particle in a column of fluid: its place and the edge of the cell for which it stands, m.
struct ColumnParticle {
  Vec3d x;
  double size;
};

/// Those of all other ranks.
std::vector<ColumnParticle> of_others(std::vector<ColumnParticle> own) {
  if (!Context::current().several()) return {};
  const std::vector<std::size_t> counts = all_gather(own.size());
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  std::vector<ColumnParticle> all(most * counts.size()), out;
  own.resize(most);
  Context::current().link()->all_gather(own.data(), all.data(), most * sizeof(ColumnParticle));
  for (std::size_t r = 0; r < counts.size(); ++r)
    if (int(r) != Context::current().rank())
      out.insert(out.end(), all.data() + r * most, all.data() + r * most + counts[r]);
  return out;
}

/// Whether some fluid came from a file, of which no box says how deep it is.
bool any_listed(const Config& config) {
  return std::any_of(config.fluid.fills.begin(), config.fluid.fills.end(),
                     [](const FluidFill& fill) { return !fill.file.empty(); });
}

/// Depth of each fluid particle of that mass (kg) among the particles themselves, m. The first `own` are this
/// rank's.
std::vector<double> depths_in_columns(const Config& config, const Vec3d& gravity, const std::vector<Vec3d>& x,
                                      const std::vector<Real>& mass, std::size_t own) {
  std::vector<ColumnParticle> column;
  const double thickness = config.domain.thickness();
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double volume = double(mass[a]) / config.fluid.rho0;
    column.push_back({x[a], thickness > 0 ? std::sqrt(volume / thickness) : std::cbrt(volume)});
  }
  // ghosts are then there twice, which does not matter
  const auto more = of_others({column.begin(), column.begin() + std::ptrdiff_t(own)});
  column.insert(column.end(), more.begin(), more.end());
  std::vector<Vec3d> places;
  std::vector<double> size;
  for (const ColumnParticle& p : column) places.push_back(p.x), size.push_back(p.size);
  return depth_in_columns(places, gravity * (-1 / norm(gravity)), config.fluid.dx, size);
}

/// Gravity works against a wall or a free surface, not along a periodic axis.
bool hydrostatic(const Config& config) {
  for (int k = 0; k < 3; ++k)
    if (config.domain.periodic[k] && config.gravity[k] != 0) return false;
  return norm(config.gravity) > 0;
}

/// The part of the effective gravity along gravity. Fluid starts with a level surface, which cannot balance
/// what acts across it.
Vec3d level_gravity(const Config& config, const Vec3d& effective) {
  return config.gravity * std::max(0.0, dot(effective, config.gravity) / norm2(config.gravity));
}

}  // namespace

void Stepper::initialise_fluid(Step& now) {
  if (two_way()) porosity(now);
  const Real background = Real(config_.eos.background);
  Buffer<Real> pressure(fluid_.size());
  if (hydrostatic(config_)) {
    const Vec3d g = level_gravity(config_, gravity_.at(0));
    std::vector<double> below;
    if (any_listed(config_) && norm(g) > 0) {
      std::vector<Vec3d> x;
      for (const auto& at : fluid_.x.values()) x.push_back(coordinates(frame_, at));
      below = depths_in_columns(config_, g, x, fluid_.mass.values(), fluid_.owned().size());
    }
    set_from_host(pressure, fluid_.x.buffer(), [&](Index a, const FluidPosition& x) {
      double depth = depth_at(config_, g, coordinates(frame_, x));
      if (depth == 0 && !below.empty()) depth = below[a];
      Real at = background;
      at += Real(config_.fluid.rho0 * norm(g) * depth);
      return at;
    });
  } else {
    set_from_host(pressure, fluid_.size(), [&](Index) { return background; });
  }
  fluid_.correction.buffer().zero();
  fluid_.compression_rate.buffer().zero();
  fluid_.exposure.buffer().zero();
  for_each(fluid_.owned(), InitialDensityPass{fluid_solver_->eos(), frame_,
                                              two_way() ? Span<const Real>(fluid_.eps) : Span<const Real>(),
                                              pressure, fluid_.mass, fluid_.compression});
  outdate({&fluid_.mass, &fluid_.compression});
}

void Stepper::settle(double longest, const std::function<void(double)>& progress) {
  if (!has_grains()) return;
  refresh(false, true);
  bodies_.settle(true);
  solid_solver_->evaluate(grains_, poses_now());
  const double rest = 1e-3 * std::sqrt(norm(config_.gravity) * config_.grain.d_max);  // rms speed, m/s
  double done = 0;
  for (int k = 0; done < longest; ++k) {
    grain_watch_ = solid_solver_->watch(grains_);
    const double v = grain_watch_.speed, tau = solid_solver_->stable_dt(grain_watch_).seconds;
    const double dt = std::min({20 * tau, v > 0 ? 0.05 * config_.grain.d_min / v : 20 * tau, longest - done});
    if (2 * (grain_watch_.displacement + 1.5 * v * dt) > solid_solver_->skin())
      grains_.drop_ghosts(), solid_solver_->refresh(grains_, grain_grid_);
    const int n = std::max(1, int(std::ceil(dt / tau)));
    solid_solver_->advance(grains_, motion_.poses(clock_.time, 0, n), motion_.bodies(), dt, n, false, {}, 0);
    done += dt;
    if (k % 50 == 0) {
      progress(done);
      if (k == 0) continue;
      const auto totals = solid_solver_->totals(grains_);
      if (std::sqrt(2 * totals.kinetic / totals.mass) > rest) continue;
      // where a few grains have most of the mass, the others too
      const double lively =
          sum_over<1>(grains_.owned(), LivelinessBody{std::as_const(grains_).v, grains_.radius}).v[0];
      if (lively < 1e-6 * norm(config_.gravity) * double(grains_.everywhere())) break;
    }
  }
  grains_.v.buffer().zero();
  grains_.omega.buffer().zero();
  solid_solver_->clumps().stop();
  bodies_.settle(false);
}

void Stepper::save_grains(SavedState& out) const {
  if (!has_grains()) return;
  out.stores.push_back(grains_.save());
  solid_solver_->save_walls(out.stores.back());
  if (Context::current().several()) {
    const HostArray blocks = blocks_of_grains();
    out.stores.push_back(solid_solver_->save_contacts(grains_, &blocks));
  } else {
    out.stores.push_back(solid_solver_->save_contacts(grains_));
  }
  solid_solver_->clumps().save(out.stores);
}

void Stepper::load_grains(const SavedState& saved) {
  if (!has_grains()) return;
  take({.grains = saved_particles(store_of(saved, "grains"), grains_)}, true);
  solid_solver_->load_walls(store_of(saved, "grains"), grains_);
  load_clumps(saved);
  solid_solver_->load_contacts(grains_, grain_grid_, store_of(saved, "contacts"));
}

void Stepper::load_clumps(const SavedState& saved) {
  if (!has_grains()) return;
  Clumps& clumps = solid_solver_->clumps();
  if (clumps.any()) clumps.load(store_of(saved, "clumps"), grains_);
}

void Stepper::take(const HostState& from, bool listed) {
  const auto stores = {&from.fluid, &from.walls, &from.grains};
  if (!Context::current().several()) {
    for (const HostParticles* each : stores)
      if (each->store) each->put({.count = each->count});
    return;
  }
  const auto grains = [&] { return Span<const Vec3d>(listed ? grains_.x_list : grains_.x); };
  for (const HostParticles* each : stores)
    if (each->store) take_share(*each);
  grain_grid_.divide(nullptr);
  if (from.fluid.store) {
    fluid_solver_->divide(fluid_, walls_, listed);
    take_own(from.fluid, [&] { return fluid_solver_->own_places(fluid_, listed); });
    take_own(from.walls, [&] { return fluid_solver_->own_places(walls_, listed); });
  }
  if (!from.grains.store) return;
  if (!grain_grid_.ownership()) solid_solver_->divide(grains_, grain_grid_, grains());
  take_own(from.grains, [&] { return find_own(grains_, grain_grid_, frame_, grains()); });
}

void Stepper::save(SavedState& out) const {
  out.scalars.push_back({"walls_moved", "m", walls_moved_});
  out.scalars.push_back({"rebuilds", "-", double(rebuilds_)});
  if (has_fluid()) fluid_solver_->save(out.scalars);
  if (coupled()) coupling_->save(out.scalars);
  if (has_grains()) solid_solver_->save(out.scalars), solid_solver_->save_histograms(out.stores);
}

void Stepper::load(const SavedState& saved) {
  const auto scalar = [&](const std::string& name) { return scalar_of(saved, name); };
  walls_moved_ = scalar("walls_moved");
  rebuilds_ = std::int64_t(scalar("rebuilds"));
  if (has_fluid()) fluid_solver_->load(scalar);
  if (coupled()) coupling_->load(scalar);
  take(state_.particles_of(config_, saved), true);
  if (has_grains()) solid_solver_->load_walls(store_of(saved, "grains"), grains_);
  if (has_fluid()) {
    moment_ = moment(clock_.time, clock_.step);
    corrected_ = 0;
  }
  load_clumps(saved);
  if (has_grains()) solid_solver_->load(saved.scalars), solid_solver_->load_histograms(saved.stores);
  restore_lists(saved);
  if (has_fluid()) fluid_solver_->survey(fluid_);
  sweep();
}

/// The lists as they were when the checkpoint was written: built at the positions x_list.
void Stepper::restore_lists(const SavedState& saved) {
  if (has_grains()) solid_solver_->load_contacts(grains_, grain_grid_, store_of(saved, "contacts"));
  const auto swap_positions = [&] {
    fluid_.x.buffer().swap(fluid_.x_list.buffer());
    walls_.x.buffer().swap(walls_.x_list.buffer());
    walls_.mirrors.x.buffer().swap(walls_.mirrors.x_list.buffer());
  };
  if (has_fluid()) {
    swap_positions();
    fluid_solver_->relist(fluid_, walls_, true);
    swap_positions();
    fluid_solver_->pack(fluid_);
    fluid_solver_->pack(walls_);
  }
  if (coupled()) relist_coupling();
}

}  // namespace BL_SOLVER
