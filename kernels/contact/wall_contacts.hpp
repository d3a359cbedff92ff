#pragma once
// Contacts of one grain with walls: the closest points of all surfaces of all bodies, except those hidden by
// a nearer one, and the history of each from one substep to the next.

#include "bedload/core/raw_array.hpp"
#include "bedload/parallel/lanes.hpp"
#include "kernels/contact/history.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

constexpr int kMostWallContacts = 8;      ///< of one grain at once; the deepest count
constexpr int kCountedWallContacts = 64;  ///< up to which those left out are counted

/// A contact kept from the last evaluation. Checkpoints hold it bit by bit as columns of 8 bytes, of which
/// the first is the key, an integer.
struct WallMemory {
  std::uint64_t key = 0;  ///< surface, then feature
  Vec3d normal;           ///< lab frame
  ContactHistory history;

  static BL_HD std::uint64_t key_of(Index surface, std::uint32_t feature) {
    return std::uint64_t(surface) << 32 | feature;
  }
  BL_HD Index surface() const { return Index(key >> 32); }
  static std::string units() { return "-, -, " + ContactHistory::units(); }
};

template <>
struct FileType<WallMemory> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(WallMemory) / sizeof(double);
};

/// The memories of one grain, [count] of them in ascending order of key.
struct WallMemories {
  WallMemory* const* slots;  ///< [kMostWallContacts or fewer][rows]
  Index* counts;             ///< [grains]; null where there are no walls
  Index grain;
  Index row = grain;  ///< of this grain among those that may remember anything

  BL_HD Index count() const { return counts ? counts[grain] : 0; }
  BL_HD WallMemory& operator[](Index k) const { return slots[k][row]; }
};

/// Puts what grains remember of walls, their k-th memories, into other rows.
struct CarryWallMemoryPass {
  Span<const Index> grain;   ///< of the new rows
  const Index* count;        ///< [grains]
  Span<const Index> row_of;  ///< of each grain, until now
  Index k;
  const WallMemory* from;
  WallMemory* to;
  BL_HD void operator()(Index row) const {
    const Index i = grain[row];
    to[row] = count[i] > k ? from[row_of[i]] : WallMemory{};
  }
};
/// Gives rows to grains that have come from other ranks, from `first` on, in the order in which they came.
struct ArrivingRowsPass {
  Span<const Index> kept;  ///< of move()
  Index before, first;
  Span<Index> row_of;
  BL_HD void operator()(Index i) const {
    if (kept[i] >= before) row_of[i] = first + (kept[i] - before);
  }
};

/// A closest point of surface `surface`, and the memory that it continues.
struct SurfaceContact {
  ClosestPoint closest;
  Index surface;
  std::uint32_t body;
  Index from = kNone;
  BL_HD std::uint64_t key() const { return WallMemory::key_of(surface, closest.feature); }
};

/// Collects the contacts of one grain with surfaces of these kinds.
template <class Kinds = AllKinds, int kMost = kMostWallContacts>
class SurfaceContacts {
 public:
  BL_HD SurfaceContacts(const WallMemories& memories, const Surface* surfaces, int capacity)
      : memories_(memories), surfaces_(surfaces), remembered_(memories.count()), capacity_(capacity) {}

  /// Adds the contacts of a sphere at x with surface s in this pose. radius: of the sphere, m; what it has
  /// touched acts on it up to `reach` (m) from its centre. merge: see MeshSearch.
  BL_HD void seek(const SurfaceSet& walls, Index s, const BodyPose& pose, const Frame& frame, const Vec3d& x,
                  double merge, double radius, double reach) {
    const SurfaceView view(walls.surfaces[s], pose, frame, x);
    const double farthest = Kinds::reach(view.surface, reach);
    if (Kinds::kTracked && view.beyond(walls, farthest))
      return;  // for other kinds the closest point costs no more than this test
    MeshSearch search(merge);
    if (view.surface.kind == SurfaceKind::mesh && walls.meshes[view.surface.first].fine(radius) &&
        !(reach > radius)) {  // what has been touched is never hidden
      search.hides = 1 - kSame;
      search.near = last_triangle(s);
    }
    view.template each_closest_point<Kinds>(
        walls, farthest, search, [&](const ClosestPoint& closest) { add(s, closest, radius, reach); });
  }
  /// A closest point of surface s. Behind a tracked surface, or without touching, a sphere has a contact only
  /// if it had one before; a patch keeps the side of the last contact.
  BL_HD void add(Index s, ClosestPoint closest, double radius, double reach) {
    const Surface& surface = surfaces_[s];
    SurfaceContact contact{closest, s, surface.body};
    contact.from = find(contact.key());
    if (closest.two_sided && contact.from != kNone && dot(memories_[contact.from].normal, closest.normal) < 0)
      contact.closest.face(-closest.side);
    const double distance = contact.closest.distance;
    if (!(distance < reach)) return;
    if (((Kinds::tracked(surface) && distance < 0) || !(distance < radius)) && contact.from == kNone &&
        inherited(contact, false) == kNone)
      return;
    insert(contact);
  }

  /// Removes hidden contacts and sorts the rest by key; each gets its own memory, or inherits that of a
  /// neighbouring feature.
  BL_HD void resolve() {
    remove_hidden();
    sort([](const SurfaceContact& a, const SurfaceContact& b) { return a.key() < b.key(); });
    for (int k = 0; k < size_; ++k)
      if (contacts_[k].from == kNone) contacts_[k].from = inherited(contacts_[k], true);
  }
  /// After that: removes contacts of a sphere of this radius (m) that do not touch and inherit nothing.
  BL_HD void drop_apart(double radius) {
    int kept = 0;
    for (int k = 0; k < size_; ++k)
      if (contacts_[k].closest.distance < radius || contacts_[k].from != kNone)
        contacts_[kept++] = contacts_[k];
    size_ = kept;
  }
  /// After that: evaluate(contact, memory) for the lane's contacts; the lanes of a sphere share them. A
  /// memory may be inherited from another body that the sphere has left: take_over(contact, that body,
  /// history). A new contact has had its normal before. keep: memories are advanced.
  template <class TakeOver, class Evaluate>
  BL_HD void each(const Lane& lane, bool keep, TakeOver&& take_over, Evaluate&& evaluate) const {
    RawArray<WallMemory, kMostWallContacts> next;
    for (int k = int(lane.index); k < size_; k += int(lane.count))
      next[k] = memory_of(contacts_[k], take_over);
    lane.wait();  // until all have read their memories
    for (int k = int(lane.index); k < size_; k += int(lane.count)) {
      evaluate(contacts_[k], next[k]);
      if (keep) memories_[Index(k)] = next[k];
    }
    if (keep && lane.index == 0 && remembered_ != Index(size_))
      memories_.counts[memories_.grain] = Index(size_);
  }

  BL_HD std::uint32_t body_of(const WallMemory& memory) const { return surfaces_[memory.surface()].body; }
  BL_HD int size() const { return size_; }
  BL_HD const SurfaceContact& operator[](int k) const { return contacts_[k]; }

 private:
  static constexpr double kSame = 0.99984769515639124;  // cos 1 deg: coplanar faces
  static constexpr double kNear = 0.86602540378443865;  // cos 30 deg: a contact that has moved on

  /// Of a mesh without a shell: a triangle that was touched in the substep before; kNone: none.
  BL_HD std::uint32_t last_triangle(Index s) const {
    for (Index k = 0; k < remembered_; ++k)
      if (memories_[k].surface() == s) return MeshView::triangle_of(std::uint32_t(memories_[k].key));
    return kNone;
  }
  BL_HD Index find(std::uint64_t key) const {
    for (Index k = 0; k < remembered_; ++k)
      if (memories_[k].key == key) return k;
    return kNone;
  }
  /// Memory of another feature that a contact inherits. `left`: of any body, but only one that no other
  /// contact holds; else of the same body.
  BL_HD Index inherited(const SurfaceContact& contact, bool left) const {
    Index best = kNone;
    double nearest = kNear;
    for (Index k = 0; k < remembered_; ++k) {
      const WallMemory& memory = memories_[k];
      if (!left && body_of(memory) != contact.body) continue;
      bool held = false;
      for (int l = 0; left && l < size_; ++l) held = held || contacts_[l].from == k;
      const double along = dot(memory.normal, contact.closest.normal);
      if (!held && along > nearest) nearest = along, best = k;
    }
    return best;
  }
  template <class TakeOver>
  BL_HD WallMemory memory_of(const SurfaceContact& contact, TakeOver& take_over) const {
    if (contact.from == kNone) return {contact.key(), contact.closest.normal, {}};
    WallMemory memory = memories_[contact.from];
    const std::uint32_t left = body_of(memory);
    memory.key = contact.key();
    if (left != contact.body) take_over(contact, left, memory.history);
    return memory;
  }
  BL_HD void insert(const SurfaceContact& contact) {
    if (size_ == capacity_) remove_hidden();
    if (size_ < capacity_)
      contacts_[size_++] = contact;
    else if (deeper(contact, contacts_[size_ - 1]))
      contacts_[size_ - 1] = contact;
  }
  /// Removes contacts that others hide and sorts the rest, the deepest first.
  BL_HD void remove_hidden() {
    sort([](const SurfaceContact& a, const SurfaceContact& b) { return deeper(a, b); });
    int shown = 0;
    for (int k = 0; k < size_; ++k) {
      bool hidden = false;
      for (int l = 0; l < shown; ++l) hidden = hidden || hides(contacts_[l], contacts_[k]);
      if (!hidden) contacts_[shown++] = contacts_[k];
    }
    size_ = shown;
  }
  template <class Before>
  BL_HD void sort(Before&& before) {
    for (int k = 1; k < size_; ++k)
      for (int l = k; l > 0 && before(contacts_[l], contacts_[l - 1]); --l) {
        const SurfaceContact other = contacts_[l];
        contacts_[l] = contacts_[l - 1];
        contacts_[l - 1] = other;
      }
  }
  /// Whether the point of b, which is no deeper, lies behind the plane through that of a, or hardly before
  /// it: another face in one plane with a's, of the same body or an adjacent one, or an edge that a's covers.
  static BL_HD bool hides(const SurfaceContact& a, const SurfaceContact& b) {
    const double near = a.closest.distance, along = dot(a.closest.normal, b.closest.normal);
    return near > 0 ? along * b.closest.distance >= kSame * near : along >= kSame;
  }
  static BL_HD bool deeper(const SurfaceContact& a, const SurfaceContact& b) {
    return a.closest.distance < b.closest.distance ||
           (a.closest.distance == b.closest.distance && a.key() < b.key());
  }

  WallMemories memories_;
  const Surface* surfaces_;
  Index remembered_;
  int capacity_, size_ = 0;
  RawArray<SurfaceContact, kMost> contacts_;
};

/// Number of contacts of one grain that its `capacity` leaves out; find: calls add() of a SurfaceContacts for
/// each closest point. None unless the last evaluation has used all memories.
template <class Find>
BL_HD Index left_out(const WallMemories& memories, const Surface* surfaces, int capacity, Find&& find) {
  if (capacity < kMostWallContacts || memories.count() < Index(capacity)) return 0;
  SurfaceContacts<AllKinds, kCountedWallContacts> found(memories, surfaces, kCountedWallContacts);
  find(found);
  found.resolve();
  return Index(max_of(found.size() - capacity, 0));
}

}  // namespace BL_SOLVER
