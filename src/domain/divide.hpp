#pragma once
// The particles of a store among ranks: which of them a rank keeps, which it gives away, and which it copies.

#include "bedload/core/frame.hpp"
#include "bedload/neighbours/cell_grid.hpp"
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

// x: of all that a store holds, by which it is sorted into cells.

/// Adds `each` for all particles of a store, on whichever ranks, to the load of their blocks.
template <class P>
void add_loads(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x, double each,
               std::vector<double>& load);

struct Division {
  std::shared_ptr<const Ownership> ownership;
  std::shared_ptr<const Ownership> near;  ///< the same, with copies of what is next to a rank's blocks alone
  double imbalance;                       ///< largest load of a rank over the mean
};
/// The cells of another phase: particles of one within `reach` (m) of a rank's blocks of the other are copied
/// to it as well.
struct OtherCells {
  CellGrid* grid = nullptr;  ///< null: there is none
  double reach = 0;
};
/// Of blocks with that load, the same on all ranks; those of `other` are divided alike. Particles within
/// `around` (m) of a rank's blocks are copied to it, and at least those in cells next to them.
Division divide_blocks(const CellGrid& grid, const std::vector<double>& load, double around = 0,
                       const OtherCells& other = {});

/// Those of a store's own particles that are in blocks of this rank.
template <class P>
std::vector<Index> find_own(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);

/// Particles of a store that are in blocks of other ranks.
struct Migrants {
  Buffer<Index> order;         ///< places of those that stay, then of those that go, by destination
  Index stay = 0;              ///< how many do
  std::vector<Index> of_rank;  ///< [ranks + 1] where those for a rank begin among those that go
  bool any = false;            ///< on any rank
  Span<const Index> going() const { return {order.data() + stay, Index(order.size()) - stay}; }
};
template <class P>
Migrants find_migrants(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);
/// Gives them to their ranks and takes what comes. kept: the former place of each particle of the store, and
/// of those that came numbers from that of its former particles on. `whole`: with all that checkpoints hold.
void move(Store& store, const Migrants& migrants, Buffer<Index>& kept, bool whole = false);

/// Gives particles to those ranks in whose blocks they are now, and takes what comes.
template <class P>
void migrate_to_owners(Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x) {
  Buffer<Index> kept;
  if (const Migrants migrants = find_migrants(store, grid, frame, x); migrants.any)
    move(store, migrants, kept);
}

/// Copies of those particles of others that are in cells next to this rank's; they are then to be added to
/// the grid. order: of the store by these cells; empty: it is sorted by them.
void make_ghosts(Store& store, const CellGrid& grid, Span<const Index> order = {});

/// Block in which each of a store's own particles is, as an array of files.
template <class P>
HostArray blocks_of(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);

}  // namespace BL_SOLVER
