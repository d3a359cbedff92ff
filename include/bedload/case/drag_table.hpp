#pragma once
// Drag laws from outside, as the table of drag.law = table.

#include <functional>
#include <vector>

#include "bedload/case/choices.hpp"
#include "bedload/case/config/coupling.hpp"

namespace bedload {

/// Porosities and Reynolds numbers at which a law is evaluated by default: 0.3 to 1 in steps of
/// 0.05; 0, and 8 a decade from 0.001 to 1e5.
DragTable drag_nodes();

/// The table of a law: factor(porosity, Reynolds number) is the drag on a grain over its Stokes drag,
/// K / (3 pi mu d), K the force per interstitial slip w (kg/s), at the Reynolds number rho eps w d / mu.
/// Above 0.
DragTable drag_table(const std::function<double(double, double)>& factor);

/// The same of a law of drag.law other than the table.
double drag_factor(DragLaw law, double porosity, double reynolds);

}  // namespace bedload
