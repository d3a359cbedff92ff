#pragma once
#include <algorithm>
#include <tuple>
#include <vector>

#include "bedload/parallel/buffer.hpp"
#include "kernels/contact/pair_histories.hpp"
#include "kernels/contact/registry.hpp"

namespace BL_SOLVER {

/// Contact histories for the entries of a list; only the parts that any of the laws needs.
template <class... Parts>
class PairHistoryBuffersOf {
 public:
  explicit PairHistoryBuffersOf(const std::vector<ContactLaw>& laws)
      : parts_(Kept<Parts>{
            std::any_of(laws.begin(), laws.end(), [](const ContactLaw& law) { return Parts::keeps(law); }),
            {}}...) {}

  /// Of one entry.
  std::size_t entry_bytes() const {
    return sizeof(std::uint8_t) + ((part<Parts>().used ? sizeof(Parts) : 0) + ...);
  }
  /// Resizes to `slots` pairs, none of them in contact.
  void reset(std::size_t slots) {
    touching_.reserve_and_resize(slots);
    touching_.zero();
    each([&](auto& part) { part.values.reserve_and_resize(slots); });
  }
  PairHistories view() {
    PairHistories all;
    all.touching = touching_.data();
    each([&]<class Part>(Kept<Part>& part) {
      static_cast<PartArray<Part>&>(all).values = part.values.data();
    });
    return all;
  }
  void swap(PairHistoryBuffersOf& o) {
    touching_.swap(o.touching_);
    each([&]<class Part>(Kept<Part>& part) { part.values.swap(o.template part<Part>().values); });
  }

  /// By slot: 1 in contact.
  std::vector<std::uint8_t> touching() const { return touching_.to_host(); }
  /// By slot, to the host and back; not in contact: overlap 0.
  std::vector<ContactHistory> to_host() const {
    const auto touching = touching_.to_host();
    std::vector<ContactHistory> all(touching.size());
    each([&](const auto& part) {
      const auto values = part.values.to_host();
      for (std::size_t s = 0; s < all.size(); ++s)
        if (touching[s]) values[s].to(all[s]);
    });
    return all;
  }
  void assign(const std::vector<ContactHistory>& all) {
    std::vector<std::uint8_t> touching(all.size());
    for (std::size_t s = 0; s < all.size(); ++s) touching[s] = all[s].overlap != 0;
    touching_.assign(touching);
    each([&]<class Part>(Kept<Part>& part) {
      std::vector<Part> values(all.size());
      for (std::size_t s = 0; s < all.size(); ++s) values[s].from(all[s]);
      part.values.assign(values);
    });
  }

 private:
  template <class Part>
  struct Kept {
    bool used;
    Buffer<Part> values;
  };
  template <class Part>
  Kept<Part>& part() {
    return std::get<Kept<Part>>(parts_);
  }
  template <class Part>
  const Kept<Part>& part() const {
    return std::get<Kept<Part>>(parts_);
  }
  /// f(part) with each that is used.
  template <class F>
  void each(F&& f) {
    ((part<Parts>().used ? f(part<Parts>()) : void()), ...);
  }
  template <class F>
  void each(F&& f) const {
    ((part<Parts>().used ? f(part<Parts>()) : void()), ...);
  }

  Buffer<std::uint8_t> touching_;
  std::tuple<Kept<Parts>...> parts_;
};
using PairHistoryBuffers = HistoryParts::Apply<PairHistoryBuffersOf>;

}  // namespace BL_SOLVER
