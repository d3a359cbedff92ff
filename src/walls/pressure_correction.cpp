#include "src/walls/pressure_correction.hpp"

#include "bedload/parallel/reductions.hpp"

namespace BL_SOLVER {
PressureCorrection::PressureCorrection(const std::vector<EnclosedSolid>& solids, int dimensions)
    : solids_(solids), dimensions_(dimensions) {
  device_solids_.assign(solids_);
  sums_.resize(solids_.size());
  of_bodies_.resize(solids_.size());
}

BodyPressures PressureCorrection::fit(const WallStore& walls, Span<const BodyPose> poses,
                                      const LoadBounds& bounds) {
  fitted_.resize(poses.size), added_.resize(poses.size);
  of_walls_.resize(walls.size());
  for (std::size_t k = 0; k < solids_.size(); ++k)
    total_into(sums_.data() + k, walls.owned(),
               BodyPressureReduction{particles_of(solids_[k].body, walls, poses), walls.state},
               BodyPressureReduction::largest(bounds));
  for_each(each(), FitBodyPressure{device_solids_, sums_, fitted_});
  return {fitted_, poses.data, of_walls_};
}

void PressureCorrection::find(const WallStore& walls, Span<const BodyPose> poses, const LoadBounds& bounds) {
  for (std::size_t k = 0; k < solids_.size(); ++k)
    total_into(of_bodies_.data() + k, walls.owned(),
               PairsOfBodyReduction{particles_of(solids_[k].body, walls, poses), walls.state, of_walls_},
               PairsOfBodyReduction::largest(bounds));
  for_each(each(), CorrectBody{.solids = device_solids_,
                               .poses = poses.data,
                               .fitted = fitted_,
                               .pairs = of_bodies_,
                               .dimensions = dimensions_,
                               .added = added_});
}

}  // namespace BL_SOLVER
