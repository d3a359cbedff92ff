// Cells, order and lists of fluid and walls.

#include <algorithm>
#include <cmath>
#include <utility>

#include "bedload/neighbours/filled_rows.hpp"
#include "bedload/neighbours/tile_search.hpp"
#include "bedload/parallel/reductions.hpp"
#include "kernels/walls/crossing.hpp"
#include "src/domain/divide.hpp"
#include "src/fluid/fluid_solver.hpp"

namespace BL_SOLVER {
namespace {

template <class P>
struct WrapPass {
  Frame frame;
  Span<P> x;
  BL_HD void operator()(Index i) const { x[i] = as_position<P>(frame, frame.wrap(coordinates(frame, x[i]))); }
};

/// The same of sheared fluid, which changes its velocity where it comes back.
struct ShearedWrapPass {
  FluidMotion fluid;
  BL_HD void operator()(Index a) const {
    const auto& [frame, shear, x, v_rho] = fluid;
    Vec3d at = fluid.at(a);
    Real3 v = v_rho[a].v;
    shear.wrap(at, v);
    x[a] = as_position<FluidPosition>(frame, frame.wrap(at));
    v_rho[a] = {v, v_rho[a].rho};
  }
};

struct LatticePass {
  Frame frame;
  MeanShear shear;
  Span<const FluidPosition> x;
  Span<Vec3d> out;
  BL_HD void operator()(Index a) const { out[a] = shear.lattice(coordinates(frame, x[a])); }
};

/// Positions of fluid as pair loops read them, with their weights; of sheared fluid also peculiar velocities.
struct PackFluidPass {
  FluidMotion fluid;
  Span<const EosState<>> eos_state;
  PairCopies copies;
  BL_HD void operator()(Index a) const {
    const auto& [frame, shear, x, v_rho] = fluid;
    const auto& [xp, xp_mid, flux] = copies;
    const Vec3d at = fluid.at(a);
    xp[a] = pair_position(frame, shear.lattice(at), eos_state[a].mass_over_eps);
    if (xp_mid) xp_mid[a] = xp[a];
    if (flux) flux[a] = {shear.peculiar(v_rho[a].v, at.z), v_rho[a].rho};
  }
};

/// Positions of walls, now and `back` (s) ago.
struct PackWallPass {
  Frame frame;
  Real back;
  Span<const Vec3d> x;
  Span<const VelocityDensity<>> v_rho;
  Span<PairPosition> xp, xp_mid;  ///< xp_mid may be empty
  BL_HD void operator()(Index w) const {
    xp[w] = pair_position(frame, x[w]);
    if (xp_mid) xp_mid[w] = pair_position(frame, x[w] - Vec3d(back * v_rho[w].v));
  }
};

/// How far particles will have gone in a time to come, m, between bounds.
struct HalfSkinPass {
  FluidMotion fluid;
  Real horizon;  ///< s
  Real least, most;
  Span<const Real3> drift, acc;  ///< drift: empty where particles move with their velocity alone
  Span<Real> half_skin;
  BL_HD void operator()(Index a) const {
    Real3 v = fluid.v_rho[a].v;
    if (drift) v += drift[a];
    const Real speed = norm(fluid.shear.peculiar(v, fluid.at(a).z));
    half_skin[a] = clamp(horizon * (speed + horizon / 2 * norm(acc[a])), least, most);
  }
};

struct LengthBody {
  Span<const Real> h;
  BL_HD double operator()(Index a) const { return h[a]; }
};

/// From a wall particle to its image, m.
struct ImageDistance {
  Span<const Vec3d> x, image;
  BL_HD double operator()(Index b) const { return norm(image[b] - x[b]); }
};

/// Walls around those that have their own density.
struct BesideFrozen : SphNear<Vec3d> {
  Span<const Real> compression;
  BL_HD bool operator()(Index b, Index j) const {
    return compression[b] != kNoCompression && SphNear<Vec3d>::operator()(b, j);
  }
#if !BL_CUDA
  PackMask lanes(Index b, PackRun j) const {
    return compression[b] != kNoCompression ? SphNear<Vec3d>::lanes(b, j) : PackMask{};
  }
#endif
};

struct CountBody {
  Span<const std::uint32_t> count;
  BL_HD void operator()(Index a, double* out) const { out[0] = count[a]; }
};

/// What a grain costs in a step, with its substeps, of what a particle of fluid costs.
constexpr double kGrainLoad = 4;

}  // namespace

double FluidSolver::least_skin() const { return parameters_.skin / 2; }

double FluidSolver::longest_step() const {
  const TimeConfig& time = parameters_.time;
  return time.dt > 0 ? time.dt : time.cfl * kappa_ * parameters_.fluid.h_most() / 2 / parameters_.fluid.c;
}

double FluidSolver::wide_skin() const {
  // sheared, positions and velocities are peculiar and all reach as far
  return (shear_.acts() ? 1.5 : 4) * least_skin();
}

std::size_t FluidSolver::growth() const {
  if (half_skin_ > least_skin()) return 0;
  const double mean = shear_.acts() ? wide_skin() : wide_skin() / 2;
  const double factor =
      std::pow((range() + 2 * mean) / (range() + 2 * least_skin()), parameters_.domain.two_d ? 2 : 3);
  const std::size_t bytes =
      fluid_fluid_.list().bytes() + fluid_wall_.list().bytes() + wall_fluid_.list().bytes();
  return std::size_t((factor - 1) * double(bytes));
}

bool FluidSolver::renew_skins(const ListSpeeds& now) {
  const double least = least_skin(), former = half_skin_;
  const double fastest = std::max(now.fluid, now.walls), eight_steps = 8 * now.dt * fastest;
  if (eight_steps > least) half_skin_ = wide_skin();
  if (2 * eight_steps < least || former == 0) half_skin_ = least;  // in between, as it was
  horizon_ = fastest > 0 ? half_skin_ / fastest : 0;
  wall_skin_ = now.walls_move ? std::clamp(horizon_ * now.walls, least, half_skin_) : 0;
  if (half_skin_ == former) return false;
  make_cells();
  return true;
}

void FluidSolver::make_cells() {
  MeanShear most = shear_;  // strains are taken to half a period
  if (shear_.acts()) most.strain = 0.5 * frame_.length.x / frame_.length.z;
  for (CellGrid* grid : {&grid_, &wall_grid_})
    *grid = CellGrid(frame_, frame_.origin, frame_.origin + frame_.length,
                     most.stretch() * (range() + skin()), parameters_.block);
}

Span<const Vec3d> FluidSolver::lattice(const FluidStore& fluid, bool listed) {
  MeanShear shear = shear_;
  if (listed) shear.strain = listed_strain_;
  of_fluid_.resize(fluid.size());
  for_each(fluid.all(), LatticePass{frame_, shear, listed ? fluid.x_list : fluid.x, lattice_});
  return lattice_;
}

template <class F>
void FluidSolver::with_places(FluidStore& fluid, bool listed, const F& f) {
  if (shear_.acts())
    f([&] { return lattice(fluid, listed); });
  else
    f([&] { return Span<const FluidPosition>(listed ? fluid.x_list : fluid.x); });
}

void FluidSolver::sort_cells(FluidStore& fluid) {
  with_places(fluid, false, [&](const auto& places) { grid_.sort(frame_, places(), order_, fluid.id); });
}

double FluidSolver::reach_of_images(const WallStore& walls) const {
  const MirrorStore& images = walls.mirrors;
  if (images.everywhere() == 0) return 0;
  return range() + skin() + max_over(images.owned(), ImageDistance{walls.x0, images.x0});
}

void FluidSolver::divide(FluidStore& fluid, const WallStore& walls, bool listed) {
  std::vector<double> load;
  with_places(fluid, listed, [&](const auto& places) { add_loads(fluid, grid_, frame_, places(), 1, load); });
  add_loads(walls, wall_grid_, frame_, (listed ? walls.x_list : walls.x).span(), 1, load);
  if (grains_)
    add_loads(*grains_, grid_, frame_, (listed ? grains_->x_list : grains_->x).span(), kGrainLoad, load);
  OtherCells grains;
  if (grains_) grains = {grain_cells_, grain_range_ + half_skin_};
  const Division division = divide_blocks(grid_, load, reach_of_images(walls), grains);
  imbalance_ = division.imbalance;
  grid_.divide(division.ownership), wall_grid_.divide(division.near);
}

bool FluidSolver::unbalanced(const FluidStore& fluid, const WallStore& walls) const {
  const auto load = [&](const auto& of) {
    return double(of(fluid)) + double(of(walls)) + (grains_ ? kGrainLoad * double(of(*grains_)) : 0);
  };
  const double own = load([](const Store&store) { return store.owned().size(); }),
               all = load([](const Store&store) { return store.everywhere(); }),
               most = all_reduce(own, [](double&into, double more) { into = std::max(into, more); });
  return most * Context::current().ranks() > 1.1 * imbalance_ * all;
}

std::vector<Index> FluidSolver::own_places(FluidStore& fluid, bool listed) {
  std::vector<Index> own;
  with_places(fluid, listed, [&](const auto& places) { own = find_own(fluid, grid_, frame_, places()); });
  return own;
}

std::vector<Index> FluidSolver::own_places(const WallStore& walls, bool listed) const {
  return find_own(walls, wall_grid_, frame_, Span<const Vec3d>(listed ? walls.x_list : walls.x));
}

void FluidSolver::migrate(WallStore& walls) {
  const Migrants migrants = find_migrants(walls, wall_grid_, frame_, Span<const Vec3d>(walls.x));
  if (!migrants.any) return;
  Buffer<Index> kept;
  move(walls, migrants, kept);
  if (walls.mirrors.everywhere() > 0) move(walls.mirrors, migrants, kept);
}

void FluidSolver::make_ghosts_of(FluidStore& fluid) {
  make_ghosts(fluid, grid_);
  with_places(fluid, false, [&](const auto& places) { grid_.add_ghosts(frame_, places()); });
}

void FluidSolver::make_ghosts_of(WallStore& walls) {
  make_ghosts(walls, wall_grid_);
  wall_grid_.add_ghosts(frame_, Span<const Vec3d>(walls.x));
}

HostArray FluidSolver::blocks(FluidStore& fluid) {
  HostArray out;
  with_places(fluid, true, [&](const auto& places) { out = blocks_of(fluid, grid_, frame_, places()); });
  return out;
}

HostArray FluidSolver::blocks(const WallStore& walls) {
  return blocks_of(walls, wall_grid_, frame_, walls.x_list.span());
}

bool FluidSolver::renew_lengths(FluidStore& fluid) {
  for_each(fluid.owned(), length_pass(fluid, true));
  lengths_->begun = true;
  const double h0 = parameters_.fluid.h(), longest = max_over(fluid.owned(), LengthBody{lengths_->h});
  // in steps of a ninth, so that cells seldom change; never below h0, to which walls reach
  const double listed = h0 * std::exp2(std::ceil(8 * std::log2(std::max(1.0, longest / h0)) - 1e-6) / 8);
  if (listed == lengths_->listed) return false;
  lengths_->listed = listed;
  make_cells();
  return true;
}

void FluidSolver::refresh(FluidStore& fluid, WallStore& walls, bool walls_moved, const ListSpeeds& speeds) {
  if (renew_skins(speeds)) walls_moved = true;
  if (lengths_ && renew_lengths(fluid)) walls_moved = true;
  if (shear_.acts()) {
    const double period = frame_.length.x / frame_.length.z;
    listed_strain_ = shear_.strain -= period * std::rint(shear_.strain / period);
    for_each(fluid.owned(), ShearedWrapPass{motion(fluid)});
  } else {
    for_each(fluid.owned(), WrapPass<FluidPosition>{frame_, fluid.x});
  }
  const bool several = Context::current().several();
  if (several) {
    if (!grid_.ownership() || unbalanced(fluid, walls)) divide(fluid, walls, false), walls_moved = true;
    with_places(fluid, false, [&](const auto& places) { migrate_to_owners(fluid, grid_, frame_, places()); });
  }
  sort_cells(fluid);
  fluid.reorder(order_);
  fluid.count();
  if (several) make_ghosts_of(fluid);
  fluid.x_list.copy(fluid.x);
  for_each(fluid.all(), HalfSkinPass{.fluid = motion(fluid),
                                     .horizon = Real(horizon_),
                                     .least = Real(shear_.acts() ? half_skin_ : least_skin()),
                                     .most = Real(half_skin_),
                                     .drift = drift_of(fluid),
                                     .acc = fluid.acc,
                                     .half_skin = fluid.half_skin});
  if (lengths_) lengths_->h_list.copy(lengths_->h);
  if (walls_moved && walls.everywhere() > 0) {
    MirrorStore& images = walls.mirrors;
    walls.drop_ghosts();
    for_each(walls.owned(), WrapPass<Vec3d>{frame_, walls.x});
    for_each(images.owned(), WrapPass<Vec3d>{frame_, images.x});
    if (several) migrate(walls);
    wall_grid_.sort(frame_, Span<const Vec3d>(walls.x), order_, walls.id);
    walls.reorder(order_);
    walls.count();
    if (several) make_ghosts_of(walls);
    walls.x_list.copy(walls.x);
    if (images.everywhere() > 0) images.reorder(order_), images.count(), images.x_list.copy(images.x);
  }
  relist(fluid, walls, false);
}

void FluidSolver::relist(FluidStore& fluid, WallStore& walls, bool sort) {
  const double strain = std::exchange(shear_.strain, listed_strain_);
  if (sort) {  // saved sorted: the order is the identity
    sort_cells(fluid);
    wall_grid_.sort(frame_, Span<const Vec3d>(walls.x), order_, walls.id);
    fluid.count(), walls.count();
    if (Context::current().several()) {
      make_ghosts_of(fluid);
      make_ghosts_of(walls);
    }
  }
  pack(fluid);
  pack(walls);
  const HalfSkins own = half_skins(fluid), of_walls(wall_skin_);
  auto& of_fluid = fluid_fluid_.between(frame_, fluid, fluid, range());
  VerletList &of_walls_around = fluid_wall_.between(frame_, fluid, walls, range()),
             &around_walls = wall_fluid_.between(frame_, walls, fluid, range());
  // as many lanes a row as particles of all ranks ask for, so that sums do not depend on how they are divided
  const unsigned fluid_lanes = lane_bits(Index(fluid.everywhere()));
  const Index rows = fluid.owned().size(), wall_rows = walls.owned().size();
  using Near = SphNear<FluidPosition>;
  const Near fluid_near{frame_, fluid.x, fluid.xp, fluid.xp, range(), true, own, own};
  const Near fluid_near_walls{frame_, fluid.x, fluid.xp, walls.xp, range(), false, own, of_walls};
  const SphNear<Vec3d> walls_near{frame_, walls.x, walls.xp, fluid.xp, range(), false, of_walls, own};
#if BL_CUDA
  if (shear_.acts())  // by distances among positions that are sheared back
    of_fluid.build(rows, grid_, frame_, lattice(fluid), Span<const PairPosition>(fluid.xp),
                   (range() + skin()) * shear_.stretch(), {}, fluid_lanes);
  else
    of_fluid.build(rows, grid_, frame_, Span<const FluidPosition>(fluid.x),
                   Span<const PairPosition>(fluid.xp), range(), own, fluid_lanes);
#else
  if (shear_.acts())
    of_fluid.build(rows, grid_.view(),
                   ShearedNear<Vec3d>{{frame_, lattice(fluid), fluid.xp, fluid.xp, range() + skin(), true},
                                      Real(shear_.strain),
                                      (range() + skin()) * shear_.stretch()},
                   fluid_lanes);
  else if (!lengths_)
    of_fluid.build(rows, grid_.view(), fluid_near, fluid_lanes);
#endif
  const unsigned lanes = of_fluid.view().bits;  // as many for walls: few of them are wet
  if (lengths_) {
    const Span<const Real> h = lengths_->h_list, none;
    const PairReach pairs{Real(kappa_ * double(kLengthGrowth)), Real(parameters_.fluid.h())};
#if !BL_CUDA
    of_fluid.build(rows, grid_.view(), LengthNear<FluidPosition>{fluid_near, pairs, h, h}, fluid_lanes);
#endif
    of_walls_around.build(rows, wall_grid_.view(),
                          LengthNear<FluidPosition>{fluid_near_walls, pairs, h, none}, lanes);
    around_walls.build(wall_rows, grid_.view(), LengthNear<Vec3d>{walls_near, pairs, none, h}, lanes);
  } else {
    of_walls_around.build(rows, wall_grid_.view(), fluid_near_walls, lanes);
    around_walls.build(wall_rows, grid_.view(), walls_near, lanes);
  }
  if (parameters_.frozen && parameters_.density.method == DensityMethod::summation)
    wall_wall_.between(frame_, walls, walls, range())
        .build(wall_rows, wall_grid_.view(),
               BesideFrozen{{frame_, walls.x, walls.xp, walls.xp, range(), true, of_walls, of_walls},
                            walls.compression},
               lane_bits(Index(walls.everywhere())));
  find_all(rows, HasEntries{of_walls_around.view()}, beside_walls_);
  find_all(wall_rows, HasEntries{around_walls.view()}, wet_walls_);
  relisted_ = true;
  const MirrorStore& images = walls.mirrors;
  if (images.size() > 0)
    image_fluid_.between(frame_, images, fluid, range())
        .build(images.size(), grid_.view(),
               SphNear<Vec3d>{frame_, images.x, images.xp, fluid.xp, range(), false, of_walls, own},
               lane_bits(Index(images.everywhere())));
  shear_.strain = strain;
}

void FluidSolver::pack(FluidStore& fluid) {
  for_each(fluid.all(), PackFluidPass{motion(fluid), fluid.eos_state, copies(fluid)});
}

void FluidSolver::pack(WallStore& walls, double back) {
  for_each(walls.all(), PackWallPass{frame_, Real(back), walls.x, walls.v_rho, walls.xp, walls.xp_mid});
  for_each(walls.mirrors.all(), PackPass<Vec3d>{frame_, walls.mirrors.x, walls.mirrors.xp});
}

double FluidSolver::pairs_through(const FluidStore& fluid, const SurfaceSet& surfaces,
                                  Span<const BodyPose> pose) const {
  Buffer<NearestPoint> points(fluid.size());
  Buffer<std::uint32_t> count(fluid.size());
  const NearestPointPass nearest{frame_, surfaces, pose, range(), fluid.x, points};
  for_each(fluid.all(), nearest);
  fluid_fluid_.run(CrossingPass{nearest, 0.25 * parameters_.fluid.dx, count});
  return sum_over<1>(fluid.owned(), CountBody{count}).v[0] / 2;  // a pair stands in two lists
}

}  // namespace BL_SOLVER
