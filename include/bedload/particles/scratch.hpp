#pragma once
// Memory of a solver beside the fields of stores: arrays with an entry for each particle, filled anew
// wherever they are used.

#include <vector>

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

/// The arrays for one kind of particles. What resize() allocates is what entry_bytes() counts, before there
/// are particles, too.
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) = delete;

  /// To n particles; contents are lost where an array must grow.
  void resize(std::size_t n) {
    for (Array* array : arrays_) array->make(n);
  }
  /// Of one particle in all arrays.
  std::size_t entry_bytes() const {
    std::size_t sum = 0;
    for (const Array* array : arrays_) sum += array->entry_bytes();
    return sum;
  }

 private:
  template <class T>
  friend class ScratchArray;
  struct Array {
    virtual void make(std::size_t n) = 0;
    virtual std::size_t entry_bytes() const = 0;

   protected:
    ~Array() = default;
  };
  std::vector<Array*> arrays_;
};

/// A member of a solver, declared after the Scratch that it belongs to.
template <class T>
class ScratchArray final : public Buffer<T>, Scratch::Array {
 public:
  /// needed: by the case; else it stays empty.
  explicit ScratchArray(Scratch& of, bool needed = true) {
    if (needed) of.arrays_.push_back(this);
  }
  ScratchArray(const ScratchArray&) = delete;

 private:
  void make(std::size_t n) override { this->resize(n); }
  std::size_t entry_bytes() const override { return sizeof(T); }
};

}  // namespace BL_SOLVER
