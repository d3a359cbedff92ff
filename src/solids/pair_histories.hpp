#pragma once
#include <cstdint>
#include <tuple>
#include <vector>

#include "bedload/parallel/buffer.hpp"
#include "kernels/contact/pair_histories.hpp"

namespace BL_SOLVER {

/// Contact histories for the entries of a list.
template <class... Parts>
class PairHistoryBuffersOf {
 public:
  /// Of one entry.
  static constexpr std::size_t kBytes = sizeof(std::uint8_t) + (sizeof(Parts) + ...);

  /// Resizes to `slots` pairs, none of them in contact.
  void reset(std::size_t slots) {
    touching_.reserve_and_resize(slots);
    touching_.zero();
    (part<Parts>().reserve_and_resize(slots), ...);
  }
  PairHistories view() {
    PairHistories all;
    all.touching = touching_.data();
    ((static_cast<PartArray<Parts>&>(all).values = part<Parts>().data()), ...);
    return all;
  }
  void swap(PairHistoryBuffersOf& o) {
    touching_.swap(o.touching_);
    (part<Parts>().swap(o.template part<Parts>()), ...);
  }

  /// By slot: 1 in contact.
  std::vector<std::uint8_t> touching() const { return touching_.to_host(); }
  /// By slot, to the host and back; not in contact: overlap 0.
  std::vector<ContactHistory> to_host() const {
    const auto touching = touching_.to_host();
    std::vector<PairHistory> all(touching.size());
    const auto take = [&](const auto& values) {
      for (std::size_t s = 0; s < all.size(); ++s)
        if (touching[s]) values[s].to(all[s]);
    };
    (take(std::get<Buffer<Parts>>(parts_).to_host()), ...);
    return {all.begin(), all.end()};
  }
  void assign(const std::vector<ContactHistory>& all) {
    std::vector<std::uint8_t> touching(all.size());
    for (std::size_t s = 0; s < all.size(); ++s) touching[s] = all[s].overlap != 0;
    touching_.assign(touching);
    const auto give = [&]<class Part>(Buffer<Part>& to) {
      std::vector<Part> values(all.size());
      for (std::size_t s = 0; s < all.size(); ++s) values[s].from(all[s]);
      to.assign(values);
    };
    (give(part<Parts>()), ...);
  }

 private:
  template <class Part>
  Buffer<Part>& part() {
    return std::get<Buffer<Part>>(parts_);
  }

  Buffer<std::uint8_t> touching_;
  std::tuple<Buffer<Parts>...> parts_;
};
using PairHistoryBuffers = HistoryParts::Apply<PairHistoryBuffersOf>;

}  // namespace BL_SOLVER
