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

namespace bedload::inline BL_VARIANT {

struct FillIndex {
  Span<Index> out;
  BL_HD void operator()(Index i) const { out[i] = i; }
};

/// Sorts 32-bit keys and says where each came from: after the call keys ascend and
/// order[i] is the former place of the i-th.
class Sorter {
 public:
  /// bits: how many low bits of the keys are in use.
  void sort(Buffer<std::uint32_t>& keys, Buffer<Index>& order, int bits) {
    const Index n = Index(keys.size());
    order.resize(n);
    for_each({0, n}, FillIndex{order});
    if (n == 0) return;
#if BL_CUDA
    keys_out_.resize(n);
    order_out_.resize(n);
    std::size_t bytes = 0;
    check_cuda(cub::DeviceRadixSort::SortPairs(nullptr, bytes, keys.data(), keys_out_.data(), order.data(),
                                               order_out_.data(), n, 0, bits),
               "radix sort");
    scratch_.reserve_and_resize(bytes);
    check_cuda(cub::DeviceRadixSort::SortPairs(scratch_.data(), bytes, keys.data(), keys_out_.data(),
                                               order.data(), order_out_.data(), n, 0, bits),
               "radix sort");
    keys.swap(keys_out_);
    order.swap(order_out_);
#else
    (void)bits;
    thrust::stable_sort_by_key(thrust::omp::par, keys.data(), keys.data() + n, order.data());
#endif
  }

  /// out[i] = sum of in[0..i); out has in.size() + 1 entries, the last is the total, which is returned.
  template <class T>
  T exclusive_scan(const Buffer<T>& in, Buffer<T>& out) {
    const Index n = Index(in.size());
    out.resize(n + 1);
    fill_zero(out.data(), sizeof(T));
    if (n > 0) {
#if BL_CUDA
      std::size_t bytes = 0;
      check_cuda(cub::DeviceScan::InclusiveSum(nullptr, bytes, in.data(), out.data() + 1, n), "scan");
      scratch_.reserve_and_resize(bytes);
      check_cuda(cub::DeviceScan::InclusiveSum(scratch_.data(), bytes, in.data(), out.data() + 1, n), "scan");
#else
      T sum = 0;
      for (Index i = 0; i < n; ++i) out.data()[i + 1] = (sum += in.data()[i]);
#endif
    }
    T total = 0;
    copy_to_host(&total, out.data() + n, sizeof total);
    return total;
  }

 private:
#if BL_CUDA
  Buffer<std::uint32_t> keys_out_;
  Buffer<Index> order_out_;
  Buffer<std::byte> scratch_;
#endif
};

}  // namespace bedload::inline BL_VARIANT
