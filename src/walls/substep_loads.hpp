#pragma once
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "kernels/bodies/rigid_body.hpp"

namespace BL_SOLVER {

/// Loads on some wall bodies in each substep of the last step, about their centres. Stays on the device.
class SubstepLoads {
 public:
  void record_on(const std::vector<std::uint32_t>& bodies) { bodies_ = bodies; }
  bool wanted() const { return !bodies_.empty(); }
  /// Starts a step with all loads zero.
  void begin(int substeps) {
    substeps_ = wanted() ? substeps : 0;
    loads_.resize(std::size_t(substeps_) * bodies_.size());
    loads_.zero();
  }
  /// Of substep s, from 1: put(body, load) leaves that on each body where `load` points to.
  template <class F>
  void record(int s, const F& put) {
    for (std::size_t k = 0; k < bodies_.size(); ++k)
      put(bodies_[k], loads_.data() + (s - 1) * bodies_.size() + k);
  }
  int substeps() const { return substeps_; }
  /// [substeps][bodies]
  Span<const LoadSum> loads() const { return loads_; }

 private:
  std::vector<std::uint32_t> bodies_;
  int substeps_ = 0;
  Buffer<LoadSum> loads_;
};

}  // namespace BL_SOLVER
