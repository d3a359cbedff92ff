#pragma once
// What a grain touches of the walls: the closest points of all surfaces of all bodies, but for those that a
// nearer one hides, and what is remembered of each from one substep to the next.

#include "bedload/core/raw_array.hpp"
#include "kernels/contact/history.hpp"
#include "kernels/walls/surface.hpp"

namespace bedload::inline BL_VARIANT {

constexpr int kMostWallContacts = 8;  ///< of one grain at once; the deepest count

/// A contact kept from the last evaluation. Doubles only, so that it lies in files as it does here.
struct WallMemory {
  double key = 0;  ///< of surface and feature
  Vec3d normal;    ///< lab frame
  ContactHistory history;

  static BL_HD double key_of(Index surface, std::uint32_t feature) {
    return double(surface) * 4294967296.0 + double(feature);
  }
  BL_HD Index surface() const { return Index(key / 4294967296.0); }
};

template <>
struct FileType<WallMemory> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = 12;
};
static_assert(sizeof(WallMemory) == 12 * sizeof(double));

/// The memories of one grain, [count] of them in ascending order of key.
struct WallMemories {
  WallMemory* const* slots;  ///< [kMostWallContacts or fewer][grains]
  Index* counts;             ///< [grains]; null where there are no walls
  Index grain;

  BL_HD Index count() const { return counts ? counts[grain] : 0; }
  BL_HD WallMemory& operator[](Index k) const { return slots[k][grain]; }
};

/// A closest point of surface `surface` and where it came from in the memories.
struct WallTouch {
  ClosestPoint closest;
  Index surface;
  std::uint32_t body;
  Index from = kNone;
  BL_HD double key() const { return WallMemory::key_of(surface, closest.feature); }
};

/// Collects the touches of one grain, with surfaces of these kinds.
template <class Kinds = AllKinds>
class WallTouches {
 public:
  BL_HD WallTouches(const WallMemories& memories, const Surface* surfaces, int capacity)
      : memories_(memories), surfaces_(surfaces), remembered_(memories.count()), capacity_(capacity) {}

  /// A closest point of surface s. What lies behind a tracked surface counts only where it came through; a
  /// patch is touched from the side of the last contact. radius: of the grain, m.
  BL_HD void add(Index s, ClosestPoint closest, double radius) {
    const Surface& surface = surfaces_[s];
    WallTouch touch{closest, s, surface.body};
    touch.from = find(touch.key());
    if (closest.two_sided && touch.from != kNone)
      touch.closest.face(memories_[touch.from].history.overlap < 0 ? -1.0 : 1.0);
    if (!(touch.closest.distance < radius)) return;
    if (Kinds::tracked(surface) && touch.closest.distance < 0 && touch.from == kNone &&
        inherited(touch, false) == kNone)
      return;
    insert(touch);
  }

  /// Those that none hides, in ascending order of key, each with its memory or the one that it inherits from
  /// a neighbouring feature.
  BL_HD void settle() {
    shed();
    sort([](const WallTouch& a, const WallTouch& b) { return a.key() < b.key(); });
    for (int k = 0; k < size_; ++k)
      if (touches_[k].from == kNone) touches_[k].from = inherited(touches_[k], true);
  }

  BL_HD std::uint32_t body_of(const WallMemory& memory) const { return surfaces_[memory.surface()].body; }
  BL_HD int size() const { return size_; }
  BL_HD Index remembered() const { return remembered_; }
  BL_HD const WallTouch& operator[](int k) const { return touches_[k]; }

 private:
  static constexpr double kSame = 0.99984769515639124;  // cos 1 deg: coplanar faces
  static constexpr double kNear = 0.86602540378443865;  // cos 30 deg: a contact that has moved on

  BL_HD Index find(double key) const {
    for (Index k = 0; k < remembered_; ++k)
      if (memories_[k].key == key) return k;
    return kNone;
  }
  /// Memory of another feature that a touch inherits. `left`: of any body, but only one that no other touch
  /// holds; else of the same body.
  BL_HD Index inherited(const WallTouch& touch, bool left) const {
    Index best = kNone;
    double nearest = kNear;
    for (Index k = 0; k < remembered_; ++k) {
      const WallMemory& memory = memories_[k];
      if (!left && body_of(memory) != touch.body) continue;
      bool held = false;
      for (int l = 0; left && l < size_; ++l) held = held || touches_[l].from == k;
      const double along = dot(memory.normal, touch.closest.normal);
      if (!held && along > nearest) nearest = along, best = k;
    }
    return best;
  }
  BL_HD void insert(const WallTouch& touch) {
    if (size_ == capacity_) shed();
    if (size_ < capacity_)
      touches_[size_++] = touch;
    else if (deeper(touch, touches_[size_ - 1]))
      touches_[size_ - 1] = touch;
  }
  /// Leaves out what others hide, the rest with the deepest first.
  BL_HD void shed() {
    sort([](const WallTouch& a, const WallTouch& b) { return deeper(a, b); });
    int shown = 0;
    for (int k = 0; k < size_; ++k) {
      bool hidden = false;
      for (int l = 0; l < shown; ++l) hidden = hidden || hides(touches_[l], touches_[k]);
      if (!hidden) touches_[shown++] = touches_[k];
    }
    size_ = shown;
  }
  template <class Before>
  BL_HD void sort(Before&& before) {
    for (int k = 1; k < size_; ++k)
      for (int l = k; l > 0 && before(touches_[l], touches_[l - 1]); --l) {
        const WallTouch other = touches_[l];
        touches_[l] = touches_[l - 1];
        touches_[l - 1] = other;
      }
  }
  /// Whether the point of b, which is no deeper, lies behind the plane through that of a, or hardly before
  /// it: another face in one plane with a's, of the same body or one beside it, or an edge that a's covers.
  static BL_HD bool hides(const WallTouch& a, const WallTouch& b) {
    const double near = a.closest.distance, along = dot(a.closest.normal, b.closest.normal);
    return near > 0 ? along * b.closest.distance >= kSame * near : along >= kSame;
  }
  static BL_HD bool deeper(const WallTouch& a, const WallTouch& b) {
    return a.closest.distance < b.closest.distance ||
           (a.closest.distance == b.closest.distance && a.key() < b.key());
  }

  WallMemories memories_;
  const Surface* surfaces_;
  Index remembered_;
  int capacity_, size_ = 0;
  RawArray<WallTouch, kMostWallContacts> touches_;
};

}  // namespace bedload::inline BL_VARIANT
