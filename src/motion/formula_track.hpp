#pragma once
#include <array>
#include <string>
#include <vector>

#include "bedload/case/formula.hpp"
#include "src/motion/formula_breaks.hpp"
#include "src/motion/track.hpp"

namespace bedload {

/// Formulas in t. Derivatives are those of the polynomial through nine values around the time asked for,
/// eighth order in their distance; none of them lies beyond a place where the formula breaks.
class FormulaTrack final : public Track {
 public:
  using Texts = std::array<std::string, 3>;
  /// Displacement in m, rotation vector in degrees; `span`: seconds of interest.
  FormulaTrack(const Texts& displacement, const Texts& rotation, double span);

  TrackPoint at(double s) const override;
  bool turns() const override { return rotation_.any(); }
  std::vector<double> breaks() const override;

 private:
  /// Three formulas, times a factor.
  class Triple {
   public:
    Triple(const Texts& texts, double factor, double span);
    bool any() const { return !formulas_.empty(); }
    Jet at(double s) const;
    void add_breaks(std::vector<double>& times) const;

   private:
    struct Piece {
      double begin, end;
    };
    Piece piece_at(int k, double s) const;
    static double step_for(const Formula& formula, double span);
    std::vector<Formula> formulas_;  ///< none where all are "0"
    std::array<double, 3> step_{};   ///< between the nine values, s
    std::array<std::vector<Break>, 3> breaks_;
    double factor_;
  };
  Triple displacement_, rotation_;
};

}  // namespace bedload
