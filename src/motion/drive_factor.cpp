#include "src/motion/drive_factor.hpp"

namespace bedload {

DriveFactor::DriveFactor(const DriveConfig& drive)
    : factor_(drive.factor, "xyzt"), varies_(factor_.uses('x') || factor_.uses('y') || factor_.uses('z')) {}

std::vector<double> DriveFactor::at(const std::vector<Vec3d>& x, double t) const {
  std::vector<double> factors;
  factors.reserve(x.size());
  for (const Vec3d& at : x) factors.push_back(factor_(at, t));
  return factors;
}

}  // namespace bedload
