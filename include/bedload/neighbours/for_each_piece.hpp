#pragma once
// Runs a pass over a list of which some rows are long: these are cut into pieces, whose sums are then joined
// in a fixed order.

#include "bedload/neighbours/for_each_pair.hpp"
#include "bedload/neighbours/long_rows.hpp"
#include "bedload/parallel/compact.hpp"

namespace BL_SOLVER {

template <class Pass>
using RowSum = decltype(std::declval<const Pass&>().start(Index()));

template <class Separation, class Pass>
struct PieceLoop {
  ListRow<Separation, Pass> row;
  Pass pass;
  LongRowsView cut;
  std::uint32_t piece;  ///< entries
  Span<RowSum<Pass>> sums;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, kSliceBits);
    const Index p = lane.row, i = cut.row[p];
    const std::uint32_t begin = (p - cut.first[i]) * piece, end = min_of(begin + piece, row.list.count[i]);
    auto sum = start_row(pass, i);
    row.part(i, begin, end, lane,
             [&](auto j, const auto& r, auto r2, auto weight) { add_pair(pass, sum, j, r, r2, weight); });
    const RowSum<Pass> all = sum_of_row(pass, lane, sum);
    if (lane.index == 0) sums[p] = all;
  }
};

template <class Pass>
struct JoinPieces {
  Pass pass;
  LongRowsView cut;
  Span<const Index> rows;
  Span<const RowSum<Pass>> sums;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, kSliceBits);
    const Index i = rows[lane.row];
    RowSum<Pass> sum = pass.start(i);
    for (Index p = cut.first[i] + lane.index; p < cut.first[i + 1]; p += lane.count) pass.merge(sum, sums[p]);
    lane.combine(sum, [&](RowSum<Pass>& into, const RowSum<Pass>& other) { pass.merge(into, other); });
    if (lane.index == 0) pass.finish(i, sum);
  }
};

struct IsCut {
  LongRowsView view;
  bool wanted;
  BL_HD bool operator()(Index i) const { return view.cut(i) == wanted; }
};

/// Which rows of a list are cut.
class CutRows {
 public:
#if BL_CUDA
  static constexpr std::uint32_t kPiece = 2048;  ///< entries, for a warp
#else
  static constexpr std::uint32_t kPiece = 512;
#endif

  /// For a list as it is now.
  void cut(const VerletList& list) {
    rows_.cut(list, list.rows(), kPiece);
    if (rows_.pieces() == 0) return;
    const LongRowsView view = rows_.view();
    find_all(list.rows(), IsCut{view, true}, long_);
    find_all(list.rows(), IsCut{view, false}, short_);
  }

  template <class Separation, class Pass>
  void run(Range targets, const VerletList& list, const Separation& separation, double cutoff,
           const Pass& pass) const {
    if (rows_.pieces() == 0) return for_each_pair(targets, list, separation, cutoff, pass);
    for_each_pair_of(short_, list, separation, cutoff, pass);
    Buffer<RowSum<Pass>>& sums = Context::current().scratch<RowSum<Pass>>();
    sums.reserve_and_resize(rows_.pieces());
    for_each({0, rows_.pieces() << kSliceBits},
             PieceLoop<Separation, Pass>{
                 {list.view(), separation, Real(cutoff * cutoff)}, pass, rows_.view(), kPiece, sums});
    for_each({0, Index(long_.size()) << kSliceBits}, JoinPieces<Pass>{pass, rows_.view(), long_, sums});
  }

 private:
  LongRows rows_;
  Buffer<Index> long_, short_;
};

}  // namespace BL_SOLVER
