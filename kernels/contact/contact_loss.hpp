#pragma once
// What single contacts dissipate from their beginning to their end, their peaks, and histograms of both.

#include "bedload/parallel/atomic_add.hpp"
#include "bedload/particles/field.hpp"

namespace BL_SOLVER {

/// Dissipated by a contact since it began, J: by normal force, by sliding and rolling.
struct ContactLoss {
  double normal = 0, tangential = 0;
};
template <>
struct FileType<ContactLoss> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = 2;
};

/// The most that a contact has had since it began: elastic energy, J, normal force, N.
struct ContactPeak {
  Real energy = 0, force = 0;

  BL_HD void take(Real e, Real f) { energy = max_of(energy, e), force = max_of(force, f); }
};
template <>
struct FileType<ContactPeak> {
  static constexpr Scalar scalar = FileType<Real>::scalar;
  static constexpr int components = 2;
};
/// What is kept of a pair in contact.
struct OpenContact {
  ContactLoss loss;
  ContactPeak peak;
};
/// Bit by bit.
template <>
struct FileType<OpenContact> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(OpenContact) / sizeof(double);
};

/// A number of units; those too large for 64 bits are cut off there.
BL_HD std::int64_t whole(double units) {
  constexpr double kMost = 9.2e18;
  return std::int64_t(units > kMost ? kMost : units < -kMost ? -kMost : std::floor(units + 0.5));
}

/// A sum of integers by many threads, of 128 bits: the same in any order.
struct WideSum {
  std::uint64_t low, high;

  BL_HD void add(std::int64_t units) {
    const auto word = std::uint64_t(units);
    const std::uint64_t before = atomic_add(low, word);
    const std::uint64_t carry = (units < 0 ? ~std::uint64_t(0) : 0) + (before + word < before ? 1 : 0);
    if (carry != 0) atomic_add(high, carry);
  }
  /// By one thread.
  void add(const WideSum& other) { low += other.low, high += other.high + (low < other.low ? 1 : 0); }
  double value() const {
    const bool negative = high >> 63 != 0;
    const std::uint64_t lower = negative ? ~low + 1 : low, upper = negative ? ~high + (lower == 0) : high;
    return (negative ? -1 : 1) * (std::ldexp(double(upper), 64) + double(lower));
  }
};

/// Contacts that have ended: how many, and the sum of their energies or forces in units of the spectrum.
struct SpectrumBin {
  std::uint64_t count;
  WideSum sum;

  BL_HD void enter(std::int64_t units) { atomic_add(count, 1), sum.add(units); }
  void add(const SpectrumBin& other) { count += other.count, sum.add(other.sum); }
};
template <>
struct FileType<SpectrumBin> {
  static constexpr Scalar scalar = Scalar::u64;
  static constexpr int components = 3;
};

/// Bins over the logarithm of energies and forces, by class of contact: by the kinds of both grains, or that
/// of one and the wall body. Integers, so that the order in which contacts enter does not matter.
struct ContactSpectra {
  static constexpr int kKinds = 2, kDecades = 14, kMostSizes = 8;

  SpectrumBin* bins = nullptr;   ///< [class][kind][size()]; dissipated: normal, tangential
  SpectrumBin* peaks = nullptr;  ///< likewise; elastic energy, normal force
  double from = 0;               ///< lower edge of the first bin, J; it has what is less, too
  double from_force = 0;         ///< that of forces, N
  int per_decade = 0;
  std::uint32_t materials = 1, sizes = 1;
  Real least[kMostSizes - 1] = {};  ///< radius of each class of sizes but the first, m

  BL_HD int size() const { return kDecades * per_decade; }
  BL_HD double unit() const { return 1e-3 * from; }                 ///< of energies in bins, J
  BL_HD double unit_of_force() const { return 1e-3 * from_force; }  ///< N
  BL_HD std::uint32_t grains() const { return materials * sizes; }  ///< number of kinds
  BL_HD std::uint32_t kind(std::uint32_t material, Real radius) const {
    std::uint32_t size = 0;
    while (size + 1 < sizes && radius >= least[size]) ++size;
    return material * sizes + size;
  }
  BL_HD std::uint32_t of_pair(std::uint32_t a, std::uint32_t b) const {
    return a < b ? a * grains() + b : b * grains() + a;
  }
  BL_HD std::uint32_t on_wall(std::uint32_t body, std::uint32_t kind) const {
    return (grains() + body) * grains() + kind;
  }
  BL_HD void enter(std::uint32_t of, const ContactLoss& loss, const ContactPeak& peak) const {
    const std::size_t first = std::size_t(of) * kKinds * std::size_t(size()), second = first + size();
    bins[first + bin(loss.normal, from)].enter(whole(loss.normal / unit()));
    bins[second + bin(loss.tangential, from)].enter(whole(loss.tangential / unit()));
    peaks[first + bin(peak.energy, from)].enter(whole(peak.energy / unit()));
    peaks[second + bin(peak.force, from_force)].enter(whole(peak.force / unit_of_force()));
  }

 private:
  BL_HD int bin(double value, double lowest) const {
    if (!(value > lowest)) return 0;
    const double place = per_decade * std::log10(value / lowest);
    return place < size() - 1 ? int(place) : size() - 1;
  }
};

}  // namespace BL_SOLVER
