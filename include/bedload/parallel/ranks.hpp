#pragma once
// What all ranks find together. With one rank these return what they are given.

#include <type_traits>
#include <vector>

#include "bedload/parallel/context.hpp"

namespace BL_SOLVER {

/// The values of all ranks, in the order of ranks.
template <class T>
std::vector<T> all_gather(const T& own) {
  static_assert(std::is_trivially_copyable_v<T>);
  Link* const link = Context::current().link();
  if (!link) return {own};
  std::vector<T> all(std::size_t(link->size()));
  link->all_gather(&own, all.data(), sizeof(T));
  return all;
}

/// combine(into, value) over the values of all ranks; the same for any order of them, or it depends on how
/// particles are divided.
template <class T, class Combine>
T all_reduce(const T& own, const Combine& combine) {
  std::vector<T> all = all_gather(own);
  for (std::size_t r = 1; r < all.size(); ++r) combine(all[0], all[r]);
  return all[0];
}

/// The same, entry by entry, of arrays that are equally long on all ranks.
template <class T, class Combine>
void all_reduce(std::vector<T>& own, const Combine& combine) {
  static_assert(std::is_trivially_copyable_v<T>);
  Link* const link = Context::current().link();
  if (!link || own.empty()) return;
  std::vector<T> all(own.size() * std::size_t(link->size()));
  link->all_gather(own.data(), all.data(), own.size() * sizeof(T));
  for (std::size_t k = 0; k < own.size(); ++k) {
    own[k] = all[k];
    for (std::size_t r = 1; r < std::size_t(link->size()); ++r) combine(own[k], all[r * own.size() + k]);
  }
}

}  // namespace BL_SOLVER
