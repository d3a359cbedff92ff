#pragma once
// A loop over all nodes of a box, whose passes wait for memory more than they compute.

#include "bedload/parallel/loops.hpp"

namespace BL_SOLVER {

#if BL_CUDA
/// In float half of the threads that a multiprocessor holds are at work, in 64 registers each.
template <class F>
__global__ void __launch_bounds__(256, sizeof(Real) == 4 ? 4 : 2) for_each_node_kernel(Index nodes, F f) {
  begin_loop();
  const Index i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < nodes) f(i);
}
#else
namespace detail {
template <class F>
struct RowsOf {
  F f;
  void operator()(Index row) const { f.row(row); }
};
}  // namespace detail
#endif

/// Calls f(i) for all nodes i of a box; on the CPU f.row(r) for all its rows along x.
template <class F>
void for_each_node(Index nodes, [[maybe_unused]] Index rows, const F& f) {
  if (nodes == 0) return;
#if BL_CUDA
  launch(for_each_node_kernel<F>, (nodes + 255) / 256, 256, 0, nodes, f);
#else
  for_each({0, rows}, detail::RowsOf<F>{f});
#endif
}

}  // namespace BL_SOLVER
