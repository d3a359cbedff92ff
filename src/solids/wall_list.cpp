#include "src/solids/wall_list.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <unordered_map>
#include <utility>

#include "bedload/parallel/ranks.hpp"

namespace BL_SOLVER {
namespace {

struct NoRowPass {
  Span<Index> row_of;
  BL_HD void operator()(Index i) const { row_of[i] = kNone; }
};

std::string name_of(std::size_t k) { return "wall_memory_" + std::to_string(k); }

}  // namespace

/// Memories of grains that go to other ranks.
struct WallList::Records : Store {
  explicit Records(std::size_t memories) : Store("wall_memories") {
    for (std::size_t k = 0; k < memories; ++k)
      of.push_back(std::make_unique<Field<WallMemory>>(*this, name_of(k).c_str(), WallMemory::units(),
                                                       Lifetime::kept));
  }
  std::vector<std::unique_ptr<Field<WallMemory>>> of;
};

WallList::WallList(const Frame& frame, const WallGeometry& walls, GrainStore& grains, double skin, double gap)
    : frame_(frame), walls_(walls), skin_(skin), gap_(gap), memory_(std::size_t(walls.contacts())) {
  if (memory_.empty()) return;
  remembered_ = std::make_unique<Field<Index>>(grains, "wall_contacts", "-", Lifetime::kept);
  row_of_ = std::make_unique<Field<Index>>(grains, "wall_row", "-", Lifetime::carried);
  for (auto* field : {remembered_.get(), row_of_.get()}) field->resize(grains.size());
}

void WallList::cover(const GrainStore& grains, Span<const BodyPose> poses, double travel) {
  if (memory_.empty()) return;
  moved_ += travel;
  if (!stale_ && moved_ <= covered_) return;
  stale_ = false;
  moved_ = travel;
  covered_ = std::max(travel, 0.5 * skin_);
  const WallNear near{.frame = frame_,
                      .walls = walls_.view(),
                      .poses = poses.data,
                      .x = grains.x_list.span(),
                      .radius = grains.radius.span(),
                      .remembered = remembered(),
                      .beyond = 0.5 * skin_ + covered_ + gap_};
  find_all(grains.owned().size(), near, grain_);
  everywhere_ = all_reduce(size(), [](Index& into, Index rows) { into += rows; });
  count_.reserve_and_resize(size());
  for_each({0, size()}, CountWallsPass{near, grain_, count_});
  const std::uint32_t most = reduce({0, size()}, LargestCount{count_});
  entry_.reserve_and_resize(std::size_t(most) * size());
  for (std::size_t k = 0; k < memory_.size(); ++k) {
    next_.reserve_and_resize(size());
    for_each({0, size()},
             CarryWallMemoryPass{grain_, remembered(), row_of(), Index(k), memory_[k].data(), next_.data()});
    memory_[k].swap(next_);
  }
  const Span<Index> row_of = row_of_->span();
  for_each(grains.owned(), NoRowPass{row_of});
  for_each({0, size()}, FillWallsPass{near, rows(), entry_.data(), row_of});
}

WallMemory* const* WallList::memories() const {
  std::vector<WallMemory*> now;
  for (const Buffer<WallMemory>& of : memory_) now.push_back(const_cast<WallMemory*>(of.data()));
  if (now != pointers_) {
    pointers_ = now;
    device_pointers_.assign(pointers_);
  }
  return device_pointers_.data();
}

std::vector<Index> WallList::remembered(Index grains) const {
  std::vector<Index> all = remembered_ ? remembered_->values() : std::vector<Index>();
  all.resize(grains);
  return all;
}

std::vector<WallMemory> WallList::memory(int k, Index grains) const {
  const std::vector<Index> count = remembered(grains), row = row_of_->values();
  const std::vector<WallMemory> in_rows = memory_[k].to_host();
  std::vector<WallMemory> all(grains);
  for (Index i = 0; i < grains; ++i)
    if (count[i] > Index(k)) all[i] = in_rows[row[i]];
  return all;
}

std::vector<const FieldBase*> WallList::counts() const {
  if (memory_.empty()) return {};
  return {remembered_.get()};
}
std::vector<const FieldBase*> WallList::places() const {
  if (memory_.empty()) return {};
  return {row_of_.get()};
}

void WallList::send(const Migrants& migrants) {
  if (memory_.empty()) return;
  const Span<const Index> going = migrants.going();
  going_ = std::make_shared<Records>(memory_.size());
  going_->resize(going.size);
  for (std::size_t k = 0; k < memory_.size(); ++k)
    for_each({0, going.size}, CarryWallMemoryPass{going, remembered(), row_of(), Index(k), memory_[k].data(),
                                                  going_->of[k]->buffer().data()});
  going_->count();
  Buffer<Index> places(going.size);
  for_each({0, going.size}, FillIndex{places});
  going_->make_ghosts(migrants.of_rank, places);
}

void WallList::settle(Index before, Span<const Index> kept) {
  if (memory_.empty()) return;
  const Index rows = Index(memory_[0].size()), went = going_->owned().size(), come = going_->size() - went;
  for (std::size_t k = 0; k < memory_.size(); ++k) {
    memory_[k].grow(rows + come);
    copy_on_device(memory_[k].data() + rows, going_->of[k]->buffer().data() + went,
                   come * sizeof(WallMemory));
  }
  for_each({0, kept.size}, ArrivingRowsPass{kept, before, rows, row_of_->span()});
  going_.reset();
}

void WallList::save(HostStore& grains) const {
  for (std::size_t k = 0; k < memory_.size(); ++k) {
    using Type = FileType<WallMemory>;
    HostArray a{name_of(k), WallMemory::units(), Type::scalar, Type::components,
                HostBytes(grains.count * sizeof(WallMemory))};
    const std::vector<WallMemory> all = memory(int(k), Index(grains.count));
    if (!all.empty()) std::memcpy(a.bytes.data(), all.data(), a.bytes.size());
    grains.arrays.push_back(std::move(a));
  }
}

void WallList::load(const HostStore& saved, const GrainStore& grains) {
  forget();
  if (memory_.empty()) return;
  const Index n = grains.owned().size();
  const std::vector<Id> id = grains.id.values();
  const std::vector<Index> count = remembered(n);
  std::vector<Index> row(n, kNone);
  std::unordered_map<Id, Index> row_of;  // of those that remember anything
  for (Index i = 0; i < n; ++i)
    if (count[i] > 0) row[i] = Index(row_of.size()), row_of[id[i]] = row[i];
  row_of_->assign(row);
  std::vector<Index> in_file(row_of.size());
  const HostArray* const ids = saved.find("id");
  for (std::size_t i = 0; i < saved.count && !row_of.empty(); ++i)
    if (const auto found = row_of.find(ids->as<Id>()[i]); found != row_of.end())
      in_file[found->second] = Index(i);
  for (std::size_t k = 0; k < memory_.size(); ++k) {
    const HostArray* const a = saved.find(name_of(k));
    if (!a) throw FileError("checkpoint has no array grains/" + name_of(k));
    if (a->type != FileType<WallMemory>::scalar || a->components != FileType<WallMemory>::components ||
        a->count() != saved.count)
      throw FileError("checkpoint's array grains/" + name_of(k) + " is not one that this build keeps");
    std::vector<WallMemory> rows;
    for (const Index i : in_file) rows.push_back(a->as<WallMemory>()[i]);
    memory_[k].assign(rows);
  }
}

}  // namespace BL_SOLVER
