// Lists of the grains around fluid and of the fluid around grains.

#include "bedload/parallel/ranks.hpp"
#include "src/coupling/coupling.hpp"

namespace BL_SOLVER {
namespace {

/// How a store keeps positions.
template <class Store>
using Place = std::remove_cvref_t<decltype(std::declval<const Store&>().x_list.span()[0])>;

/// log2 of the lanes that share a row: rows are long, and four lanes read contiguous memory.
unsigned lanes_for(Index rows) { return min_of(max_of(lane_bits(rows), 2u), kSliceBits); }

/// Entries of a list, which are places in an order, become indices in the store.
struct StoredIndexPass {
  Span<const Index> order;
  VerletListView list;
  Index* entry;
  BL_HD void operator()(Index i) const {
    list.each(i, [&](std::uint64_t slot, Index k) { entry[slot] = order[k]; });
  }
};

/// Numbers of cells in the domain, in the order of which one rank has them.
struct CellNumberPass {
  CellGridView grid;
  Frame frame;
  Span<const FluidPosition> x;
  Span<std::uint32_t> cell;
  BL_HD void operator()(Index i) const {
    const Vec3d at = coordinates(frame, x[i]);
    cell[i] = grid.number(grid.coordinate(at.x, 0), grid.coordinate(at.y, 1), grid.coordinate(at.z, 2));
  }
};

/// CrossNear of fluid i and grain j, each grain with its own averaging length.
struct OwnGrainsNear {
  CrossNear<FluidPosition, Vec3d> near;  ///< b: in that order
  AveragingRange range;
  Span<const Real> radius;
  Span<const Index> order;  ///< empty: as grains are stored
  double largest;           ///< range, m
  BL_HD Vec3d place(Index i) const { return near.place(i); }
  BL_HD double reach(Index i) const { return largest + near.skin_a[i] + near.skin_b.most; }
  BL_HD bool operator()(Index i, Index j) const {
    const double r = range(double(radius[order ? order[j] : j]));
    return norm2(near.frame.separation(coordinates(near.frame, near.a[i]), near.b[j])) <
           square(r + near.skin_a[i] + near.skin_b[j]);
  }
};

/// The same of grain i and fluid j.
struct OwnFluidNear {
  CrossNear<Vec3d, FluidPosition> near;
  AveragingRange range;
  Span<const Real> radius;
  BL_HD Vec3d place(Index i) const { return near.place(i); }
  BL_HD double reach(Index i) const { return range(double(radius[i])) + near.skin_a[i] + near.skin_b.most; }
  BL_HD bool operator()(Index i, Index j) const {
    const double r = range(double(radius[i]));
    return norm2(near.frame.separation(near.a[i], coordinates(near.frame, near.b[j]))) <
           square(r + near.skin_a[i] + near.skin_b[j]);
  }
};

}  // namespace

void Coupling::pack(GrainStore& grains) {
  for_each(grains.all(), PackPass<Vec3d>{frame_, grains.x, grains.xp});
}

void Coupling::rebuild_lists(const FluidStore& fluid, const CellGridView& fluid_grid,
                             const HalfSkins& of_fluid, GrainStore& grains, const GrainCells& grain_cells,
                             const HalfSkins& of_grains, Span<const BodyPose> still) {
  pack(grains);
  walls_move_ = !still;
  if (cut_volumes_ && still)
    find_all(grains.size(),
             BesideWalls{.free = wall_free(still),
                         .range = range_,
                         .skin = double(of_grains.most),
                         .x_list = grains.x_list,
                         .radius = grains.radius},
             beside_walls_);
  const double reach = range_.least + of_fluid.most + of_grains.most;
  const Span<const Index> order = grain_cells.order;
  Span<const Vec3d> places = grains.x_list.span();
  if (order && !(own_lengths() && grain_cells.levels)) {
    grain_places_.reserve_and_resize(grains.size());
    for_each(grains.all(), InOrderPass{order, places, grain_places_});
    places = grain_places_;
  }
  if (own_lengths()) {
    build_own(fluid, fluid_grid, of_fluid, grains, grain_cells, of_grains, places);
  } else {
    build(fluid_of_grain_, grains, of_grains, fluid, of_fluid, fluid_grid.for_reach(reach),
          fluid.x_list.span());
    VerletList& of_fluid_rows = build(grains_of_fluid_, fluid, of_fluid, grains, of_grains,
                                      grain_cells.cells.for_reach(reach), places);
    if (order) for_each(fluid.owned(), StoredIndexPass{order, of_fluid_rows.view(), of_fluid_rows.entries()});
  }
  beside_grains_.find(grains_of_fluid_.list());
}

template <class Targets, class Sources, class P>
VerletList& Coupling::build(Pairing<>& pairs, const Targets& targets, const HalfSkins& skin_a,
                            const Sources& sources, const HalfSkins& skin_b, const CellGridView& grid,
                            Span<const P> places) {
  VerletList& list = pairs.between(frame_, targets, sources, range_.least);
  list.build(targets.owned().size(), grid,
             CrossNear<Place<Targets>, P>{.frame = frame_,
                                          .a = targets.x_list,
                                          .b = places,
                                          .range = range_.least,
                                          .skin_a = skin_a,
                                          .skin_b = skin_b},
             lanes_for(Index(targets.everywhere())));
  return list;
}

void Coupling::build_own(const FluidStore& fluid, const CellGridView& fluid_grid, const HalfSkins& of_fluid,
                         const GrainStore& grains, const GrainCells& grain_cells, const HalfSkins& of_grains,
                         Span<const Vec3d> places) {
  const double skins = double(of_fluid.most) + double(of_grains.most);
  const bool in_levels = grain_cells.levels;
  const Span<const Index> order = in_levels ? Span<const Index>() : grain_cells.order;
  VerletList& of_grain_rows = fluid_of_grain_.between(frame_, grains, fluid, farthest_);
  VerletList& of_fluid_rows = grains_of_fluid_.between(frame_, fluid, grains, farthest_);
  const unsigned fluid_bits = lanes_for(Index(fluid.everywhere())),
                 grain_bits = lanes_for(Index(grains.everywhere()));
  const OwnFluidNear fluid_near{.near = {.frame = frame_,
                                         .a = grains.x_list,
                                         .b = fluid.x_list,
                                         .range = range_.least,
                                         .skin_a = of_grains,
                                         .skin_b = of_fluid},
                                .range = range_,
                                .radius = grains.radius};
  const OwnGrainsNear grains_near{.near = {.frame = frame_,
                                           .a = fluid.x_list,
                                           .b = places,
                                           .range = range_.least,
                                           .skin_a = of_fluid,
                                           .skin_b = of_grains},
                                  .range = range_,
                                  .radius = grains.radius,
                                  .order = order,
                                  .largest = farthest_};
  const CellGridView fluid_cells = fluid_grid.for_reach(range_.least + skins);
  if (in_levels) {
    ListOrder rows{{}, fluid.owned().size()};
    if (Context::current().several()) {
      Buffer<std::uint32_t>& cell = Context::current().scratch<std::uint32_t>();
      cell.reserve_and_resize(fluid.size());
      for_each(fluid.all(), CellNumberPass{fluid_grid, frame_, fluid.x_list, cell});
      Buffer<Index>& order = Context::current().scratch<Index>(5);
      sort_keys(cell, order, 32);
      rows.order = order;
    }
    level_lists_.build(of_fluid_rows, of_grain_rows, *grain_cells.levels, rows, fluid.size(), grains_near,
                       range_, fluid_near, fluid_cells, fluid_bits, grain_bits);
  } else {
    of_grain_rows.build(grains.owned().size(), fluid_cells, fluid_near, grain_bits);
    of_fluid_rows.build(fluid.owned().size(), grain_cells.cells.for_reach(farthest_ + skins), grains_near,
                        fluid_bits);
    if (order) for_each(fluid.owned(), StoredIndexPass{order, of_fluid_rows.view(), of_fluid_rows.entries()});
  }
  cut_rows_.cut(of_grain_rows);
}

}  // namespace BL_SOLVER
