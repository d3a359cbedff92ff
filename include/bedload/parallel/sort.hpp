#pragma once
// Sort and scan, stable and deterministic: CUB on the GPU, Thrust's OpenMP back end on the CPU.

#include "bedload/parallel/loops.hpp"

#if BL_CUDA
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#else
#include <thrust/scan.h>
#include <thrust/sort.h>
#include <thrust/system/omp/execution_policy.h>
#endif

namespace BL_SOLVER {

/// Place of the first of ascending values that is not below `value`.
BL_HD Index first_not_below(Span<const std::uint32_t> values, std::uint32_t value) {
  Index lo = 0, hi = values.size;
  while (lo < hi) {
    const Index middle = lo + (hi - lo) / 2;
    if (values[middle] < value)
      lo = middle + 1;
    else
      hi = middle;
  }
  return lo;
}

struct FillIndex {
  Span<Index> out;
  BL_HD void operator()(Index i) const { out[i] = i; }
};

#if BL_CUDA
namespace detail {
/// f(scratch, bytes, stream) of CUB, which without scratch returns how many bytes it needs.
template <class F>
void with_scratch(const char* what, const F& f) {
  Context& context = Context::current();
  std::size_t bytes = 0;
  check_cuda(f(nullptr, bytes, context.stream()), what);
  Buffer<std::byte>& scratch = context.scratch<std::byte>();
  scratch.reserve_and_resize(bytes);
  check_cuda(f(scratch.data(), bytes, context.stream()), what);
}
}  // namespace detail
#endif

/// Sorts 32-bit keys and returns where each came from: after the call keys ascend and order[i] is the former
/// place of the i-th. bits: how many low bits of the keys are in use.
inline void sort_keys(Buffer<std::uint32_t>& keys, Buffer<Index>& order, [[maybe_unused]] int bits) {
  const Index n = Index(keys.size());
  order.resize(n);
  if (n == 0) return;
#if BL_CUDA
  Buffer<std::uint32_t>& unsorted = Context::current().scratch<std::uint32_t>(1);
  Buffer<Index>& places = Context::current().scratch<Index>(2);
  unsorted.reserve_and_resize(n), places.reserve_and_resize(n);
  copy_on_device(unsorted.data(), keys.data(), n * sizeof(std::uint32_t));
  for_each({0, n}, FillIndex{places});
  detail::with_scratch("radix sort", [&](void* scratch, std::size_t& bytes, cudaStream_t stream) {
    return cub::DeviceRadixSort::SortPairs(scratch, bytes, unsorted.data(), keys.data(), places.data(),
                                           order.data(), n, 0, bits, stream);
  });
#else
  for_each({0, n}, FillIndex{order});
  thrust::stable_sort_by_key(thrust::omp::par, keys.data(), keys.data() + n, order.data());
#endif
}

/// out[i] = sum of in[0..i); out has in.size() + 1 entries, the last is the total, which is returned. Waits
/// for the device.
template <class T>
T exclusive_scan(const Buffer<T>& in, Buffer<T>& out) {
  const Index n = Index(in.size());
  out.resize(n + 1);
  fill_zero(out.data(), sizeof(T));
  if (n > 0) {
#if BL_CUDA
    detail::with_scratch("scan", [&](void* scratch, std::size_t& bytes, cudaStream_t stream) {
      return cub::DeviceScan::InclusiveSum(scratch, bytes, in.data(), out.data() + 1, n, stream);
    });
#else
    T sum = 0;
    for (Index i = 0; i < n; ++i) out.data()[i + 1] = (sum += in.data()[i]);
#endif
  }
  T total = 0;
  copy_to_host(&total, out.data() + n, sizeof total);
  return total;
}

}  // namespace BL_SOLVER
