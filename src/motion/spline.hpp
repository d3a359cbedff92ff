#pragma once
// Piecewise cubics through points.

#include <vector>

namespace bedload {

class Spline {
 public:
  struct Value {
    double y, rate, rate2;  ///< with its first two derivatives
  };

  /// Through the points (t, y): at least two, t ascending. Smooth: continuous second derivative, third
  /// derivative continuous next to the ends. Monotone: continuous first derivative, never beyond the
  /// points on either side.
  Spline(std::vector<double> t, std::vector<double> y, bool monotone);

  /// Between the first and the last point.
  Value at(double t) const;

 private:
  std::vector<double> t_, y_, slope_;
};

}  // namespace bedload
