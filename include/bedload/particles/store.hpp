#pragma once
// Fields that are resized, sorted and saved as one.

#include <typeinfo>
#include <vector>

#include "bedload/particles/field.hpp"

namespace BL_SOLVER {

class Store {
 public:
  explicit Store(const char* name) : name(name) {}
  Store(const Store&) = delete;

  const std::string name;

  // Loops that change a particle's state, and sums and outputs, run over owned(): each particle is then
  // moved, counted and written once, wherever its copies are. Loops that prepare what others read of a
  // particle (packed positions, records for pair loops), and sorting, run over all(), since pair loops read
  // copies of particles that others own, too. There are no such copies yet, so that both are the same.
  Range owned() const { return {0, size_}; }  ///< first in every field
  Range all() const { return {0, size_}; }    ///< all that it holds
  Index size() const { return size_; }        ///< of all()
  const std::vector<FieldBase*>& fields() const { return fields_; }
  /// Of one particle in all fields that are used.
  std::size_t entry_bytes() const {
    std::size_t sum = 0;
    for (const auto* f : fields_)
      if (f->used()) sum += f->entry_bytes();
    return sum;
  }
  /// Resizes all fields to n entries; the contents of a field that grows are lost.
  void resize(Index n) {
    size_ = n;
    for (auto* f : fields_)
      if (f->used()) f->resize(n);
  }
  /// Adds particles up to n, with all fields zero.
  void grow(Index n) {
    size_ = n;
    for (auto* f : fields_)
      if (f->used()) f->grow(n);
  }
  /// Reorders everything that outlives a step; may drop particles (order shorter than size).
  void reorder(Span<const Index> order) {
    for (auto* f : fields_)
      if (f->used() && f->sorted()) f->gather(order, scratch_for(*f));
    for (auto* f : fields_)
      if (f->used() && !f->sorted()) f->resize(order.size);
    size_ = order.size;
  }
  HostStore save() const {
    HostStore s{name, size_, {}};
    for (auto* f : fields_)
      if (f->used() && f->saved()) s.arrays.push_back(f->to_host());
    return s;
  }
  void load(const HostStore& s) {
    resize(Index(s.count));
    for (auto* f : fields_) {
      if (!f->used() || !f->saved()) continue;
      const HostArray* a = s.find(f->name);
      if (!a && f->needed()) throw FileError("checkpoint has no array " + name + "/" + f->name);
      if (a)
        f->from_host(*a);
      else
        f->resize(0), f->grow(size_);
    }
  }

 private:
  friend class FieldBase;
  /// A field of the same type that may be overwritten while particles are sorted; null if there is none.
  FieldBase* scratch_for(const FieldBase& field) const {
    for (auto* f : fields_)
      if (f->used() && !f->sorted() && typeid(*f) == typeid(field)) return f;
    return nullptr;
  }
  std::vector<FieldBase*> fields_;
  Index size_ = 0;
};

inline FieldBase::FieldBase(Store& store, const char* name, const std::string& unit, Lifetime lifetime,
                            const std::optional<Output>& output)
    : name(name), unit(unit), lifetime(lifetime), output(output) {
  store.fields_.push_back(this);
}

}  // namespace BL_SOLVER
