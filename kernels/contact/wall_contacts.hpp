#pragma once
// What a grain touches of the walls: the closest points of all surfaces, none of them twice, and what is
// remembered of each from one substep to the next.

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

  /// In ascending order of key, each with its memory or the one that it inherits from a neighbouring feature.
  BL_HD void settle() {
    for (int k = 1; k < size_; ++k)
      for (int l = k; l > 0 && touches_[l].key() < touches_[l - 1].key(); --l) {
        const WallTouch other = touches_[l];
        touches_[l] = touches_[l - 1];
        touches_[l - 1] = other;
      }
    for (int k = 0; k < size_; ++k)
      if (touches_[k].from == kNone) touches_[k].from = inherited(touches_[k], true);
  }

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
  /// Memory of another feature of the same body that a touch inherits. `left`: only one that no other
  /// touch holds.
  BL_HD Index inherited(const WallTouch& touch, bool left) const {
    Index best = kNone;
    double nearest = kNear;
    for (Index k = 0; k < remembered_; ++k) {
      const WallMemory& memory = memories_[k];
      if (surfaces_[memory.surface()].body != touch.body) continue;
      bool held = false;
      for (int l = 0; left && l < size_; ++l) held = held || touches_[l].from == k;
      const double along = dot(memory.normal, touch.closest.normal);
      if (!held && along > nearest) nearest = along, best = k;
    }
    return best;
  }
  BL_HD void insert(const WallTouch& touch) {
    for (int k = 0; k < size_; ++k) {
      WallTouch& other = touches_[k];
      if (other.body != touch.body || dot(other.closest.normal, touch.closest.normal) < kSame) continue;
      if (deeper(touch, other)) other = touch;
      return;
    }
    if (size_ < capacity_) {
      touches_[size_++] = touch;
      return;
    }
    int shallowest = 0;
    for (int k = 1; k < size_; ++k)
      if (deeper(touches_[shallowest], touches_[k])) shallowest = k;
    if (deeper(touch, touches_[shallowest])) touches_[shallowest] = touch;
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
