#include "src/time/host_particles.hpp"

#include <cstring>
#include <string>

namespace BL_SOLVER {
namespace {

/// The part of rank r of as many parts as there are ranks.
Taken part_of(const HostParticles& from, int r) {
  const std::uint64_t n = from.count, ranks = std::uint64_t(Context::current().ranks());
  const auto begin = [&](int rank) { return Index(n * std::uint64_t(rank) / ranks); };
  return {begin(r), begin(r + 1) - begin(r)};
}

void load(FieldBase& field, const HostArray& all, const Taken& some) {
  const std::size_t row = size_of(all.type) * std::size_t(all.components);
  HostArray part{all.name, all.unit, all.type, all.components, HostBytes(some.count * row)};
  in_stretches(some.count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      std::memcpy(part.bytes.data() + k * row, all.bytes.data() + some[Index(k)] * row, row);
  });
  field.from_host(part);
}

}  // namespace

HostParticles saved_particles(const HostStore& saved, Store& store) {
  const auto put = [&saved, &store](const Taken& some, bool places) {
    store.resize(some.count);
    for (FieldBase* field : store.fields()) {
      if (!field->used() || !field->saved() || (places && field->name != "x_list")) continue;
      const HostArray* const array = saved.find(field->name);
      if (!array && field->needed())
        throw FileError("checkpoint has no array " + store.name + "/" + field->name);
      if (array && array->count() != saved.count)
        throw FileError("checkpoint's array " + store.name + "/" + field->name + " has " +
                        std::to_string(array->count()) + " entries, not " + std::to_string(saved.count));
      if (array)
        load(*field, *array, some);
      else
        field->resize(0), field->grow(some.count);
    }
  };
  return {&store, Index(saved.count), [put](const Taken& some) { put(some, true); },
          [put](const Taken& some) { put(some, false); }};
}

void take_own(const HostParticles& from, const std::function<std::vector<Index>()>& own_places) {
  std::vector<Index> own;
  for (int r = 0; r < Context::current().ranks(); ++r) {
    const Taken part = part_of(from, r);
    from.put_places(part);
    std::vector<Index> found = own_places();
    for (Index& place : found) place += part.first;
    own.insert(own.end(), found.begin(), found.end());
  }
  from.put({.count = Index(own.size()), .places = &own});
  from.store->count();
}

void take_share(const HostParticles& from) {
  from.put_places(part_of(from, Context::current().rank()));
  from.store->count();
}

}  // namespace BL_SOLVER
