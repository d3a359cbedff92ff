// Contact histories to and from a checkpoint.
#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "bedload/parallel/ranks.hpp"
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

/// Which contacts have a grain as the lower one.
class ContactsByGrain {
 public:
  /// lo: of each contact; those of ids above `last` are of no grain.
  ContactsByGrain(Span<const Id> lo, Id last) : first_(std::size_t(last) + 2), contact_(lo.size) {
    for (Index c = 0; c < lo.size; ++c)
      if (lo[c] <= last) ++first_[lo[c] + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index c = 0; c < lo.size; ++c)
      if (lo[c] <= last) contact_[next[lo[c]]++] = c;
  }
  std::span<const std::size_t> of(Id grain) const {
    return std::span(contact_).subspan(first_[grain], first_[grain + 1] - first_[grain]);
  }

 private:
  std::vector<std::size_t> first_, contact_;
};

}  // namespace

HostStore SolidSolver::save_contacts(const GrainStore& grains, const HostArray* blocks) const {
  const HostVerletList list(list_);
  const std::vector<ContactHistory> history = histories_.to_host();
  const std::vector<Id> id = grains.id.values();
  std::vector<Id> lo, hi;
  std::vector<ContactHistory> kept;
  const std::vector<OpenContact> open =
      spectra_ ? spectra_->of_pairs().to_host() : std::vector<OpenContact>{};
  std::vector<ContactLoss> loss;
  std::vector<ContactPeak> peak;
  HostArray block{"block", "-", Scalar::u32, blocks ? blocks->components : 1, {}};
  const std::size_t of_row = std::size_t(block.components) * sizeof(std::uint32_t);
  for (Index i = 0; i < list_.rows(); ++i)
    list.view().each(i, [&](std::uint64_t slot, Index j) {
      if (history[slot].overlap == 0 || id[i] > id[j]) return;  // both partners hold the same
      lo.push_back(id[i]), hi.push_back(id[j]);
      kept.push_back(history[slot]);
      if (spectra_) loss.push_back(open[slot].loss), peak.push_back(open[slot].peak);
      if (!blocks) return;
      block.bytes.resize(kept.size() * of_row);
      std::memcpy(block.bytes.data() + (kept.size() - 1) * of_row, blocks->bytes.data() + i * of_row, of_row);
    });
  HostStore out{
      "contacts",
      kept.size(),
      {to_array("lo", "-", lo), to_array("hi", "-", hi), to_array("history", ContactHistory::units(), kept)}};
  if (spectra_) {
    out.arrays.push_back(to_array("loss", "J", loss));
    out.arrays.push_back(to_array("peak", "J, N", peak));
  }
  if (blocks) out.arrays.push_back(std::move(block));
  return out;
}

void SolidSolver::load_contacts(GrainStore& grains, CellGrid& grid, const HostStore& contacts) {
  choose_levels(grains);
  sort(grains.x_list.span(), grains, grid);
  const std::vector<Index> order = order_.to_host();
  if (!std::is_sorted(order.begin(), order.end())) {
    if (!in_levels())
      throw FileError("checkpoint: grains are not in the order in which this build keeps them");
    grains.keep(order_);  // of a build that did not sort those of a cell by id
  }
  grains.count();
  if (Context::current().several()) make_ghosts_of(grains, grid, grains.x_list);
  build_list(grains, grid);

  const Id* lo = from_array<Id>(contacts, "lo", "-");
  const Id* hi = from_array<Id>(contacts, "hi", "-");
  const ContactHistory* kept = from_array<ContactHistory>(contacts, "history", ContactHistory::units());
  const ContactLoss* loss =
      spectra_ && contacts.find("loss") ? from_array<ContactLoss>(contacts, "loss", "J") : nullptr;
  const ContactPeak* peak =
      spectra_ && contacts.find("peak") ? from_array<ContactPeak>(contacts, "peak", "J, N") : nullptr;
  const HostVerletList list(list_);
  const std::vector<Id> id = grains.id.values();
  const ContactsByGrain by_grain({lo, Index(contacts.count)},
                                 id.empty() ? 0 : *std::max_element(id.begin(), id.end()));
  std::vector<ContactHistory> history(list_.slots());
  std::vector<OpenContact> open(spectra_ ? list_.slots() : 0);
  std::size_t found = 0;
  for (Index i = 0; i < list_.rows(); ++i)
    list.view().each(i, [&](std::uint64_t slot, Index j) {
      const Id first = std::min(id[i], id[j]), second = std::max(id[i], id[j]);
      for (const std::size_t c : by_grain.of(first)) {
        if (hi[c] != second) continue;
        history[slot] = kept[c];
        if (loss) open[slot].loss = loss[c];
        if (peak) open[slot].peak = peak[c];
        ++found;
        break;
      }
    });
  found = all_reduce(found, [](std::size_t& into, std::size_t more) { into += more; });
  if (found != 2 * contacts.count)
    throw FileError("checkpoint: contacts between grains that are not near each other");
  histories_.assign(history);
  if (spectra_) spectra_->of_pairs().assign(open);
}

void SolidSolver::save_histograms(std::vector<HostStore>& stores) const {
  if (wear_) wear_->save(stores);
  if (!spectra_) return;
  const auto add = [&](const char* name, const std::vector<SpectrumBin>& bins) {
    stores.push_back({name, bins.size(), {to_array("bins", "-", bins)}});
  };
  add("spectra", spectra_->bins());
  add("spectra_peaks", spectra_->peaks());
}

void SolidSolver::load_histograms(const std::vector<HostStore>& stores) {
  if (wear_) wear_->load(stores);
  if (!spectra_) return;
  const auto find = [&](const char* name) {
    std::vector<SpectrumBin> all(spectra_->number_of_bins());
    for (const HostStore& store : stores) {
      if (store.name != name) continue;
      const SpectrumBin* const bins = from_array<SpectrumBin>(store, "bins", "-");
      if (store.count != all.size())
        throw FileError(
            "checkpoint: spectra have other bins, materials, sizes or wall bodies than this case");
      all.assign(bins, bins + store.count);
    }
    return all;
  };
  spectra_->load(find("spectra"), find("spectra_peaks"));
}

}  // namespace BL_SOLVER
