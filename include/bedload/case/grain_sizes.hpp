#pragma once
// How large the grains of a fill are.

#include <cstddef>
#include <utility>
#include <vector>

#include "bedload/case/config/grains.hpp"

namespace bedload {

/// Smallest and largest diameter that `size` can give, m.
std::pair<double, double> size_range(const SizeClass& size);

/// `count` diameters in rising order, m: the k-th is where the fraction (k + 0.5) / count of all grains is
/// finer. Such a sample has the mass of the distribution to within a few grains.
std::vector<double> quantiles(const SizeClass& size, std::size_t count);

/// Diameters of `count` grains, m, entry after entry in whole numbers as near to the fractions as their sum
/// allows.
std::vector<double> diameters(const std::vector<SizeClass>& sizes, std::size_t count);

/// Mean volume of `count` such grains, m3; fractions taken exactly.
double mean_volume(const std::vector<SizeClass>& sizes, std::size_t count);

/// The number of grains that fill `volume` m3 best, as a real number near a whole one.
double count_for_volume(const std::vector<SizeClass>& sizes, double volume);

/// Volume fraction of the densest random packing of such grains: 0.64 for equal ones, up to
/// 1 - 0.36^2 = 0.870 for two very unlike sizes [furnas31], by the linear packing
/// density model between [stovall86].
double densest_packing(const std::vector<SizeClass>& sizes);

}  // namespace bedload
