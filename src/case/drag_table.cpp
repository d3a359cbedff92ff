#include "bedload/case/drag_table.hpp"

#include <cmath>

namespace bedload {

DragTable drag_nodes() {
  DragTable table;
  for (int k = 6; k <= 20; ++k) table.porosity.push_back(k / 20.0);
  table.reynolds.push_back(0);
  for (int k = -24; k <= 40; ++k) table.reynolds.push_back(std::pow(10, k / 8.0));
  return table;
}

DragTable drag_table(const std::function<double(double, double)>& factor) {
  DragTable table = drag_nodes();
  for (const double porosity : table.porosity)
    for (const double reynolds : table.reynolds) table.factor.push_back(factor(porosity, reynolds));
  return table;
}

}  // namespace bedload
