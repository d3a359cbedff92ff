#pragma once
// The table of a drag law, for host and device.

#include <cmath>
#include <vector>

#include "bedload/case/config/coupling.hpp"
#include "bedload/parallel/buffer.hpp"
#include "kernels/drag/tabulated.hpp"

namespace BL_SOLVER {

class TableOfDrag {
 public:
  explicit TableOfDrag(const DragTable& table)
      : rows_(Index(table.porosity.size())), columns_(Index(table.reynolds.size())) {
    for (const double eps : table.porosity) host_.push_back(Real(eps));
    for (const double re : table.reynolds) host_.push_back(Real(std::log1p(re)));
    for (const double factor : table.factor) host_.push_back(Real(std::log(factor)));
    device_.assign(host_);
  }

  Tabulated on_host() const { return over(host_.data()); }
  Tabulated on_device() const { return over(device_.data()); }

 private:
  Tabulated over(const Real* at) const {
    return {{at, rows_}, {at + rows_, columns_}, {at + rows_ + columns_, rows_ * columns_}};
  }

  Index rows_, columns_;
  std::vector<Real> host_;
  Buffer<Real> device_;
};

}  // namespace BL_SOLVER
