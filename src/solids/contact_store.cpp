// Contact histories to and from a checkpoint.
#include <algorithm>
#include <cstring>
#include <map>
#include <string>

#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

template <class T>
HostArray to_array(const char* name, const std::string& unit, const std::vector<T>& values) {
  HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
  a.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(a.bytes.data(), values.data(), a.bytes.size());
  return a;
}

template <class T>
const T* from_array(const HostStore& store, const char* name, const std::string& unit) {
  const HostArray* a = store.find(name);
  if (!a || a->type != FileType<T>::scalar || a->components != FileType<T>::components || a->unit != unit ||
      a->count() != store.count)
    throw FileError("checkpoint has no usable array " + store.name + "/" + name);
  return a->as<T>();
}

std::uint64_t pair_key(Id lo, Id hi) { return std::uint64_t(lo) << 32 | hi; }

}  // namespace

HostStore SolidSolver::save_contacts(const GrainStore& grains) const {
  const HostVerletList list(list_);
  const std::vector<ContactHistory> history = histories_.to_host();
  const std::vector<Id> id = grains.id.values();
  std::vector<Id> lo, hi;
  std::vector<ContactHistory> kept;
  for (Index i = 0; i < list_.rows(); ++i)
    list.view().each(i, [&](std::uint64_t slot, Index j) {
      if (history[slot].overlap == 0 || id[i] > id[j]) return;  // both partners hold the same
      lo.push_back(id[i]), hi.push_back(id[j]);
      kept.push_back(history[slot]);
    });
  return {
      "contacts",
      kept.size(),
      {to_array("lo", "-", lo), to_array("hi", "-", hi), to_array("history", ContactHistory::units(), kept)}};
}

void SolidSolver::load_contacts(GrainStore& grains, CellGrid& grid, const HostStore& contacts) {
  choose_levels(grains);
  sort(grains.x_list.span(), grains, grid);
  const std::vector<Index> order = order_.to_host();
  if (!std::is_sorted(order.begin(), order.end()))
    throw FileError("checkpoint: grains are not in the order in which this build keeps them");
  build_list(grains, grid);

  const Id* lo = from_array<Id>(contacts, "lo", "-");
  const Id* hi = from_array<Id>(contacts, "hi", "-");
  const ContactHistory* kept = from_array<ContactHistory>(contacts, "history", ContactHistory::units());
  std::map<std::uint64_t, const ContactHistory*> by_pair;
  for (std::size_t c = 0; c < contacts.count; ++c) by_pair[pair_key(lo[c], hi[c])] = &kept[c];

  const HostVerletList list(list_);
  const std::vector<Id> id = grains.id.values();
  std::vector<ContactHistory> history(list_.slots());
  std::size_t found = 0;
  for (Index i = 0; i < list_.rows(); ++i)
    list.view().each(i, [&](std::uint64_t slot, Index j) {
      const auto it = by_pair.find(pair_key(std::min(id[i], id[j]), std::max(id[i], id[j])));
      if (it == by_pair.end()) return;
      history[slot] = *it->second;
      ++found;
    });
  if (found != 2 * contacts.count)
    throw FileError("checkpoint: contacts between grains that are not near each other");
  histories_.assign(history);
}

}  // namespace BL_SOLVER
