#pragma once
// Spectra of the energy that single contacts dissipate, and of their peaks.

#include <memory>
#include <vector>

#include "bedload/parallel/ranks.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/contact/contact_energy.hpp"
#include "src/solids/parameters.hpp"

namespace BL_SOLVER {

class SpectraBooks {
 public:
  /// Adds the losses and peaks of wall contacts to `grains`.
  SpectraBooks(const SolidParameters& p, GrainStore& grains, bool walls)
      : spectra_{.from = p.spectra.from,
                 .from_force = p.spectra.from_force,
                 .per_decade = p.spectra.per_decade,
                 .materials = std::uint32_t(p.materials.size()),
                 .sizes = std::uint32_t(p.spectra.sizes.size() + 1)} {
    for (std::size_t k = 0; k < p.spectra.sizes.size(); ++k) spectra_.least[k] = Real(p.spectra.sizes[k] / 2);
    bins_.resize(std::size_t(spectra_.on_wall(p.bodies(), 0)) * ContactSpectra::kKinds *
                 std::size_t(spectra_.size()));
    peaks_.resize(bins_.size());
    if (!walls) return;
    at_walls_ = std::make_unique<Field<WallLosses>>(grains, "wall_losses", "J", Lifetime::kept);
    at_walls_->begin_at_zero();
    at_walls_->resize(grains.size());
    wall_peaks_ = std::make_unique<Field<WallPeaks>>(grains, "wall_peaks", "J, N", Lifetime::kept);
    wall_peaks_->begin_at_zero();
    wall_peaks_->resize(grains.size());
  }

  /// Before and after lists are built anew: of_pairs of former slots and of new ones.
  void put_aside() { of_pairs_.swap(old_of_pairs_); }
  void renew(std::size_t slots) { of_pairs_.reserve_and_resize(slots); }
  const OpenContact* old_of_pairs() const { return old_of_pairs_.data(); }

  OpenLosses view() {
    spectra_.bins = bins_.data(), spectra_.peaks = peaks_.data();
    return {spectra_, of_pairs_.data(), at_walls_ ? at_walls_->buffer().data() : nullptr,
            wall_peaks_ ? wall_peaks_->buffer().data() : nullptr};
  }
  /// Begins anew.
  void forget() {
    bins_.zero(), peaks_.zero(), of_pairs_.zero();
    if (at_walls_) at_walls_->buffer().zero(), wall_peaks_->buffer().zero();
  }
  // null without walls
  const FieldBase* wall_losses() const { return at_walls_.get(); }
  const FieldBase* wall_peaks() const { return wall_peaks_.get(); }
  /// Of each grain; empty without walls.
  std::vector<WallLosses> at_walls() const {
    return at_walls_ ? at_walls_->values() : std::vector<WallLosses>{};
  }
  const ContactSpectra& layout() const { return spectra_; }
  std::size_t number_of_bins() const { return bins_.size(); }  ///< as many of peaks
  /// Of this rank and all others.
  std::vector<SpectrumBin> bins() const { return of_all(bins_); }
  std::vector<SpectrumBin> peaks() const { return of_all(peaks_); }
  void load(const std::vector<SpectrumBin>& bins, const std::vector<SpectrumBin>& peaks) {
    const bool first = Context::current().rank() == 0;
    first ? bins_.assign(bins) : bins_.zero();
    first ? peaks_.assign(peaks) : peaks_.zero();
  }
  Buffer<OpenContact>& of_pairs() { return of_pairs_; }
  const Buffer<OpenContact>& of_pairs() const { return of_pairs_; }

 private:
  static std::vector<SpectrumBin> of_all(const Buffer<SpectrumBin>& bins) {
    std::vector<SpectrumBin> sum = bins.to_host();
    all_reduce(sum, [](SpectrumBin& into, const SpectrumBin& more) { into.add(more); });
    return sum;
  }

  ContactSpectra spectra_;
  Buffer<SpectrumBin> bins_, peaks_;
  Buffer<OpenContact> of_pairs_, old_of_pairs_;
  std::unique_ptr<Field<WallLosses>> at_walls_;  ///< null without walls, as what follows
  std::unique_ptr<Field<WallPeaks>> wall_peaks_;
};

}  // namespace BL_SOLVER
