#pragma once
// for_each and reduce over a range. A body is a named struct with operator()(Index);
// each call writes only its own entries, so the result never depends on the order.

#include "bedload/parallel/buffer.hpp"
#include "bedload/parallel/launch.hpp"
#if !BL_CUDA
#include <omp.h>
#endif

namespace BL_SOLVER {

/// Elements summed into one partial, the same on every backend: few where there are few, which then do not wait
/// for one another.
constexpr Index reduce_chunk(Index elements) { return elements < 1u << 17 ? 128 : 1024; }

#if BL_CUDA
/// kEarly: f waits itself for the loops before.
template <bool kEarly, class F>
__global__ void __launch_bounds__(256, 2) for_each_kernel(Index begin, Index end, F f) {
  if constexpr (!kEarly) begin_loop();
  const Index i = begin + blockIdx.x * blockDim.x + threadIdx.x;
  if (i < end) f(i);
}

template <class F>
__global__ void __launch_bounds__(128)
    reduce_kernel(Index begin, Index end, Index chunk, F f, typename F::Value* partial) {
  begin_loop();
  __shared__ typename F::Value shared[128];
  const Index first = begin + blockIdx.x * chunk;
  const Index last = min_of(end, first + chunk);
  typename F::Value sum = f.identity();
  for (Index i = first + threadIdx.x; i < last; i += 128) f.combine(sum, f(i));
  shared[threadIdx.x] = sum;
  __syncthreads();
  for (int half = 64; half > 0; half /= 2) {
    if (threadIdx.x < half) f.combine(shared[threadIdx.x], shared[threadIdx.x + half]);
    __syncthreads();
  }
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
}
#endif

#if BL_CUDA
/// Small ranges reach every multiprocessor; in large ones what lies together shares a first-level cache.
inline Index block_size(Range range) {
  return range.size() < 1u << 16 ? 32 : range.size() < 1u << 18 ? 128 : 256;
}
#endif

/// Calls f(i) for every i of the range.
template <class F>
void for_each(Range range, const F& f) {
  if (range.size() == 0) return;
#if BL_CUDA
  const Index block = block_size(range);
  launch(for_each_kernel<false, F>, (range.size() + block - 1) / block, block, 0, range.begin, range.end, f);
#else
  const Index share = max_of(Index(128), range.size() / Index(64 * omp_get_max_threads()));
#pragma omp parallel for schedule(dynamic, share) if (range.size() > 128)
  for (Index i = range.begin; i < range.end; ++i) f(i);
#endif
}

namespace detail {
/// Combines partials of an earlier reduction.
template <class F>
struct Again {
  using Value = typename F::Value;
  F f;
  const Value* from;
  BL_HD Value identity() const { return f.identity(); }
  BL_HD Value operator()(Index i) const { return from[i]; }
  BL_HD void combine(Value& into, const Value& v) const { f.combine(into, v); }
};
}  // namespace detail

namespace detail {
/// Leaves the sum over a range that is not empty where the solver computes.
template <class F>
const typename F::Value* reduce_there(Range range, const F& f) {
  using Value = typename F::Value;
  Context& context = Context::current();
  Buffer<Value>* const partial[2] = {&context.scratch<Value>(0), &context.scratch<Value>(1)};
  const Index chunk = reduce_chunk(range.size());
  Index chunks = (range.size() + chunk - 1) / chunk;
  partial[0]->reserve_and_resize(chunks);
#if BL_CUDA
  launch(reduce_kernel<F>, chunks, 128, 0, range.begin, range.end, chunk, f, partial[0]->data());
  int from = 0;
  while (chunks > 1) {
    constexpr Index of_partials = 1024;
    const Index n = chunks;
    chunks = (n + of_partials - 1) / of_partials;
    partial[1 - from]->reserve_and_resize(chunks);
    launch(reduce_kernel<Again<F>>, chunks, 128, 0, 0u, n, of_partials, Again<F>{f, partial[from]->data()},
           partial[1 - from]->data());
    from = 1 - from;
  }
  return partial[from]->data();
#else
  Value* out = partial[0]->data();
#pragma omp parallel for schedule(dynamic, 4) if (chunks > 1)
  for (Index c = 0; c < chunks; ++c) {
    const Index first = range.begin + c * chunk;
    const Index last = min_of(range.end, first + chunk);
    Value sum = f.identity();
    for (Index i = first; i < last; ++i) f.combine(sum, f(i));
    out[c] = sum;
  }
  Value result = f.identity();
  for (Index c = 0; c < chunks; ++c) f.combine(result, out[c]);
  out[0] = result;
  return out;
#endif
}
}  // namespace detail

/// Combines f(i) over the range: F has Value, identity(), operator()(Index), combine(Value&, Value).
/// The tree is fixed, so the result does not depend on threads or blocks. Waits for the device.
template <class F>
typename F::Value reduce(Range range, const F& f) {
  if (range.size() == 0) return f.identity();
  typename F::Value result;
  copy_to_host(&result, detail::reduce_there(range, f), sizeof result);
  return result;
}

/// As reduce, of a range that is not empty, into device memory and without waiting.
template <class F>
void reduce_into(typename F::Value* out, Range range, const F& f) {
  copy_on_device(out, detail::reduce_there(range, f), sizeof(typename F::Value));
}

}  // namespace BL_SOLVER
