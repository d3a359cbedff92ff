#pragma once
// Plots of curves and points.

#include <string>
#include <vector>

#include "src/viewer/image.hpp"

namespace bedload {

/// One set of points, or the line through them.
struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< points that are not finite are skipped
  Colour colour;
  bool line = false;
};

struct Plot {
  std::string title, x_name, y_name;  ///< names with units: "z [m]"
  std::vector<Curve> curves;
};

/// The plots side by side, each 900 x 700 pixels.
Image draw(const std::vector<Plot>& plots);

}  // namespace bedload
