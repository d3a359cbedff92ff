#pragma once
#include <string>
#include <vector>

#include "bedload/case/formula.hpp"
#include "src/motion/formula_breaks.hpp"

namespace bedload {

/// A formula in t, times a number, with its derivatives: those of the polynomial through nine values around
/// the time asked for, eighth order in their distance; none of them lies beyond a place where it breaks.
class SmoothFormula {
 public:
  struct Value {
    double y = 0, rate = 0, rate2 = 0;
  };

  /// `span`: seconds of interest from t = 0 on.
  SmoothFormula(const std::string& text, double factor, double span);

  double operator()(double s) const { return factor_ * formula_(s); }
  Value at(double s) const;
  const std::vector<Break>& breaks() const { return breaks_; }

 private:
  struct Piece {
    double begin, end;
  };
  Piece piece_at(double s) const;

  Formula formula_;
  double factor_, step_;  ///< s, between the nine values
  std::vector<Break> breaks_;
};

}  // namespace bedload
