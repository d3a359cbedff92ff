#include "bedload/neighbours/long_rows.hpp"

namespace BL_SOLVER {
namespace {

struct CountPiecesPass {
  const std::uint32_t* count;
  std::uint32_t piece;
  Span<Index> pieces;
  BL_HD void operator()(Index i) const { pieces[i] = count[i] > piece ? (count[i] + piece - 1) / piece : 0; }
};

struct RowOfPiecePass {
  Span<const Index> first;
  Span<Index> row;
  BL_HD void operator()(Index i) const {
    for (Index piece = first[i]; piece < first[i + 1]; ++piece) row[piece] = i;
  }
};

}  // namespace

void LongRows::cut(const VerletList& list, Index rows, std::uint32_t piece) {
  pieces_.reserve_and_resize(rows);
  for_each({0, rows}, CountPiecesPass{list.view().count, piece, pieces_});
  row_.reserve_and_resize(exclusive_scan(pieces_, first_));
  for_each({0, rows}, RowOfPiecePass{first_, row_});
}

}  // namespace BL_SOLVER
