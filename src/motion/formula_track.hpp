#pragma once
#include <array>
#include <string>
#include <vector>

#include "src/motion/smooth_formula.hpp"
#include "src/motion/track.hpp"

namespace bedload {

/// Displacement and rotation vector by formulas in t.
class FormulaTrack final : public Track {
 public:
  using Texts = std::array<std::string, 3>;
  /// Displacement in m, rotation vector in degrees; `span`: seconds of interest.
  FormulaTrack(const Texts& displacement, const Texts& rotation, double span);

  TrackPoint at(double s) const override;
  bool turns() const override { return !rotation_.empty(); }
  std::vector<double> breaks() const override;

 private:
  using Triple = std::vector<SmoothFormula>;  ///< none where all are "0"
  Triple displacement_, rotation_;
};

}  // namespace bedload
