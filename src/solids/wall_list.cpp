#include "src/solids/wall_list.hpp"

#include <algorithm>

#include "bedload/parallel/ranks.hpp"

namespace BL_SOLVER {
namespace {

struct NoRowPass {
  Span<Index> row_of;
  BL_HD void operator()(Index i) const { row_of[i] = kNone; }
};

}  // namespace

void WallList::cover(const GrainStore& grains, Span<const BodyPose> poses, const Index* remembered,
                     double travel) {
  if (walls_.surfaces().empty()) return;
  moved_ += travel;
  if (!stale_ && moved_ <= covered_) return;
  stale_ = false;
  moved_ = travel;
  covered_ = std::max(travel, 0.5 * skin_);
  const WallNear near{.frame = frame_,
                      .walls = walls_.view(),
                      .poses = poses.data,
                      .x = grains.x_list.span(),
                      .radius = grains.radius.span(),
                      .remembered = remembered,
                      .beyond = 0.5 * skin_ + covered_ + gap_};
  find_all(grains.owned().size(), near, grain_);
  everywhere_ = all_reduce(size(), [](Index& into, Index rows) { into += rows; });
  count_.reserve_and_resize(size());
  for_each({0, size()}, CountWallsPass{near, grain_, count_});
  const std::uint32_t most = reduce({0, size()}, LargestCount{count_});
  entry_.reserve_and_resize(std::size_t(most) * size());
  row_of_.resize(grains.size());
  for_each(grains.owned(), NoRowPass{row_of_});
  for_each({0, size()}, FillWallsPass{near, rows(), entry_.data(), row_of_});
}

}  // namespace BL_SOLVER
