#pragma once
#include "bedload/parallel/buffer.hpp"
#include "kernels/contact/pair_histories.hpp"
#include "kernels/contact/registry.hpp"

namespace bedload::inline BL_VARIANT {

/// Contact histories for the entries of a list; only the arrays that the law needs.
class PairHistoryBuffers {
 public:
  explicit PairHistoryBuffers(const ContactLaw& law)
      : slides_(law.slides()), rolls_(law.remembers_couple()) {}

  /// Resizes to `slots` pairs, none of them in contact.
  void reset(std::size_t slots) {
    touching_.reserve_and_resize(slots);
    touching_.zero();
    normal_.reserve_and_resize(slots);
    if (slides_) xi_.reserve_and_resize(slots);
    if (rolls_) couple_.reserve_and_resize(slots);
  }
  PairHistories view() {
    return {touching_.data(), normal_.data(), slides_ ? xi_.data() : nullptr,
            rolls_ ? couple_.data() : nullptr};
  }
  void swap(PairHistoryBuffers& o) {
    touching_.swap(o.touching_), normal_.swap(o.normal_), xi_.swap(o.xi_), couple_.swap(o.couple_);
  }

  /// By slot, to the host and back; not in contact: overlap 0.
  std::vector<ContactHistory> to_host() const {
    const auto touching = touching_.to_host();
    const auto normal = normal_.to_host();
    const auto xi = xi_.to_host(), couple = couple_.to_host();
    std::vector<ContactHistory> all(touching.size());
    for (std::size_t s = 0; s < all.size(); ++s) {
      if (!touching[s]) continue;
      all[s].overlap = normal[s].overlap, all[s].recede = normal[s].recede;
      if (slides_) all[s].xi = xi[s];
      if (rolls_) all[s].couple = couple[s];
    }
    return all;
  }
  void assign(const std::vector<ContactHistory>& all) {
    std::vector<std::uint8_t> touching(all.size());
    std::vector<PairHistories::Normal> normal(all.size());
    std::vector<Vec3d> xi(slides_ ? all.size() : 0), couple(rolls_ ? all.size() : 0);
    for (std::size_t s = 0; s < all.size(); ++s) {
      touching[s] = all[s].overlap != 0;
      normal[s] = {Real(all[s].overlap), Real(all[s].recede)};
      if (slides_) xi[s] = all[s].xi;
      if (rolls_) couple[s] = all[s].couple;
    }
    touching_.assign(touching), normal_.assign(normal), xi_.assign(xi), couple_.assign(couple);
  }

 private:
  bool slides_, rolls_;
  Buffer<std::uint8_t> touching_;
  Buffer<PairHistories::Normal> normal_;
  Buffer<Vec3d> xi_, couple_;
};

}  // namespace bedload::inline BL_VARIANT
