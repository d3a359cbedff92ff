#pragma once
// Particles that the host has, whole, and a store that takes all of them or those of its rank.

#include <algorithm>
#include <functional>
#include <vector>

#include "bedload/core/cores.hpp"
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

/// Some of them: `count` from `first` on, or those at `places`.
struct Taken {
  Index first = 0, count = 0;
  const std::vector<Index>* places = nullptr;
  Index operator[](Index i) const { return places ? (*places)[i] : first + i; }
};

struct HostParticles {
  Store* store = nullptr;  ///< null: there are none
  Index count = 0;
  /// Makes room for some and sets where they are.
  std::function<void(const Taken&)> put_places;
  /// And everything else.
  std::function<void(const Taken&)> put;
};

struct HostState {
  HostParticles fluid = {}, walls = {}, grains = {};
};

/// f(first, count) for parts of 0..n, one after the other, that need little memory.
template <class F>
void by_stages(Index n, const F& f) {
  constexpr Index most = 1u << 22;
  for (Index begin = 0; begin < n; begin += std::min(most, n - begin)) f(begin, std::min(most, n - begin));
}

/// to[i] = value(i, from[i]), worked out on the host.
template <class T, class From, class Value>
void set_from_host(Buffer<T>& to, const Buffer<From>& from, const Value& value) {
  const Index n = Index(from.size());
  to.resize(n);
  std::vector<T, HostAllocator<T>> some;
  std::vector<From, HostAllocator<From>> of;
  by_stages(n, [&](Index first, Index count) {
    some.resize(count), of.resize(count);
    copy_to_host(of.data(), from.data() + first, count * sizeof(From));
    in_stretches(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) some[k] = value(first + Index(k), of[k]);
    });
    copy_to_device(to.data() + first, some.data(), count * sizeof(T));
  });
}
/// to[i] = value(i), likewise.
template <class T, class Value>
void set_from_host(Buffer<T>& to, Index n, const Value& value) {
  to.resize(n);
  std::vector<T, HostAllocator<T>> some;
  by_stages(n, [&](Index first, Index count) {
    some.resize(count);
    in_stretches(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) some[k] = value(first + Index(k));
    });
    copy_to_device(to.data() + first, some.data(), count * sizeof(T));
  });
}
template <class T, class Value>
void set_from_host(Field<T>& to, Index n, const Value& value) {
  if (to.used()) set_from_host(to.buffer(), n, value);
}

/// The particles of a checkpoint; lists were built where its array `x_list` says.
HostParticles saved_particles(const HostStore& saved, Store& store);

/// Of particles that the host has, takes those that own_places() finds among what the store holds, in as many
/// parts as there are ranks: then it never has room for many more than are this rank's.
void take_own(const HostParticles& from, const std::function<std::vector<Index>()>& own_places);
/// Takes a part of all for this rank, whichever particles these are, to count them by where they are.
void take_share(const HostParticles& from);

}  // namespace BL_SOLVER
