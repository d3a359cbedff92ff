#pragma once
// Which rank owns which block of cells, and what a rank must know of the blocks around its own.

#include <array>
#include <cstdint>
#include <vector>

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

struct CellGridView;

/// Blocks, of another phase or the same, whose ranks need copies of what is around them, too.
struct OtherBlocks {
  const CellGridView& grid;                 ///< their shape
  const std::vector<std::uint16_t>& owner;  ///< of each
  double reach;                             ///< m
};

struct Ownership {
  /// owner: of each block of the domain. `grid`: its shape.
  Ownership(const CellGridView& grid, const std::vector<std::uint16_t>& owner,
            const std::vector<OtherBlocks>& others = {});

  Index ghost_blocks = 0;            ///< of other ranks, with cells next to this rank's or in reach of others
  Buffer<Index> owner;               ///< [blocks of the domain]
  Buffer<Index> ghost_place;         ///< [blocks of the domain] among the ghost blocks, by owner; kNone: none
  Buffer<Index> beside;              ///< [blocks of the domain] 1: a cell of it is next to a ghost block
  Buffer<std::uint32_t> sent_cells;  ///< numbers of this rank's cells of which others have copies, by rank
  std::vector<Index> of_rank;        ///< [ranks + 1] where those for a rank begin
};

/// Owners of blocks of another shape: each belongs to the rank that has its middle.
std::vector<std::uint16_t> owners_of(const CellGridView& blocks, const CellGridView& owned,
                                     const std::vector<std::uint16_t>& owner);

/// Where the blocks of a domain are, in blocks along each axis.
std::vector<std::array<int, 3>> block_places(const CellGridView& grid);

}  // namespace BL_SOLVER
