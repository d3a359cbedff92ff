// The host's build of the drag laws, in double.

#include "bedload/case/drag_table.hpp"
#include "kernels/drag/registry.hpp"

namespace bedload {

double drag_factor(DragLaw law, double porosity, double reynolds) {
  double K = 0;  // of a grain of diameter 1 in fluid of density and viscosity 1
  auto evaluate = [&](auto of) { K = of.K(porosity, 1, 1, 1, reynolds / porosity); };
  with_drag_law(law, evaluate);
  return K / stokes_drag(1, 1);
}

}  // namespace bedload
