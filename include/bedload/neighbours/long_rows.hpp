#pragma once
// Long rows of a list are cut into pieces, on which threads work side by side.

#include "bedload/neighbours/verlet_list.hpp"

namespace BL_SOLVER {

struct LongRowsView {
  static constexpr std::uint32_t kPiece = 64;  ///< entries of a piece; a row with no more is not cut

  Index rows = 0;                ///< of the list, from its first: those after them are not cut
  const Index* first = nullptr;  ///< [rows + 1] first piece of each row
  const Index* row = nullptr;    ///< [pieces]

  BL_HD bool cut(Index i) const { return i < rows && first[i] < first[i + 1]; }
  BL_HD std::uint32_t begin(Index piece) const { return (piece - first[row[piece]]) * kPiece; }
};

class LongRows {
 public:
  /// Cuts rows 0..rows of a list into pieces of so many entries.
  void cut(const VerletList& list, Index rows, std::uint32_t piece = LongRowsView::kPiece);
  Index pieces() const { return Index(row_.size()); }
  LongRowsView view() const { return {Index(pieces_.size()), first_.data(), row_.data()}; }

 private:
  Buffer<Index> pieces_, first_, row_;
};

}  // namespace BL_SOLVER
