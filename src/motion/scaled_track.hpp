#pragma once
#include <string>
#include <vector>

#include "src/motion/smooth_formula.hpp"
#include "src/motion/track.hpp"

namespace bedload {

/// The integral of a formula from 0 on. Between nodes so close that it is known to 1e-13 of the largest value
/// times the time, by Gauss-Legendre; a node where halving an interval changes nothing more.
class Integral {
 public:
  Integral(const SmoothFormula& formula, double span);
  /// Up to s >= 0.
  double operator()(double s) const;

 private:
  struct Node {
    double time, sum;
  };
  void add(double from, double to, double whole, double allowed, int deeper);

  const SmoothFormula& formula_;
  std::vector<Node> nodes_{{0, 0}};
};

/// A steady velocity (m/s) and angular velocity (rad/s) times a formula in t; `span`: seconds of interest.
class ScaledTrack final : public Track {
 public:
  ScaledTrack(const Vec3d& velocity, const Vec3d& omega, const std::string& factor, double span);
  ScaledTrack(const ScaledTrack&) = delete;

  TrackPoint at(double s) const override;
  bool turns() const override { return turns_; }
  std::vector<double> breaks() const override;

 private:
  Vec3d velocity_, omega_;
  bool turns_;
  SmoothFormula factor_;
  Integral integral_;  ///< of factor_, s
};

}  // namespace bedload
