#pragma once
// The particles of a store among ranks: which of them a rank keeps, which it gives away, and which it copies.

#include "bedload/core/frame.hpp"
#include "bedload/neighbours/cell_grid.hpp"
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

// x: of all that a store holds, by which it is sorted into cells.

/// Adds the number of a store's own particles in each block of the domain.
template <class P>
void add_loads(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x,
               std::vector<double>& load);

struct Division {
  std::shared_ptr<const Ownership> ownership;
  double imbalance;  ///< largest load of a rank over the mean
};
/// Of blocks with that load, the same on all ranks.
Division divide_blocks(const CellGrid& grid, const std::vector<double>& load);

/// Of particles that all ranks have, keeps those that are this rank's own.
template <class P>
void claim(Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);

/// Gives particles to those ranks in whose blocks they are now, and takes what comes.
template <class P>
void migrate(Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);

/// Copies of those particles of others that are in cells next to this rank's; they are then to be added to
/// the grid. The store is sorted.
void make_ghosts(Store& store, const CellGrid& grid);

/// Block in which each of a store's own particles is, as an array of files.
template <class P>
HostArray blocks_of(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x);

}  // namespace BL_SOLVER
