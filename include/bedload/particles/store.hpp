#pragma once
// Fields that are resized, sorted and saved as one.

#include <initializer_list>
#include <typeinfo>
#include <vector>

#include "bedload/particles/exchange.hpp"

namespace BL_SOLVER {

class Store {
 public:
  explicit Store(const char* name) : name(name) {}
  Store(const Store&) = delete;

  const std::string name;

  // Loops that change a particle's state, and sums and outputs, run over owned(): each particle is then
  // moved, counted and written once, wherever its copies are. Behind them come ghosts: copies of particles of
  // other ranks that pair loops read. Loops that prepare what others read of a particle (packed positions,
  // records for pair loops) run over all().
  Range owned() const { return {0, owned_}; }  ///< first in every field
  Range all() const { return {0, size_}; }     ///< all that it holds
  Index size() const { return size_; }         ///< of all()
  /// Particles that all ranks own.
  std::int64_t everywhere() const { return divided_ ? everywhere_ : owned_; }
  bool divided() const { return divided_; }  ///< each rank has a part of them; else each has all
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
    size_ = owned_ = n;
    for (auto* f : fields_)
      if (f->used()) f->resize(n);
  }
  /// Adds particles up to n, with all fields zero.
  void grow(Index n) {
    size_ = owned_ = n;
    for (auto* f : fields_)
      if (f->used()) f->grow(n);
  }
  /// Reorders everything that outlives a step; may drop particles (order shorter than size). Then it has no
  /// ghosts.
  void reorder(Span<const Index> order) {
    for (auto* f : fields_)
      if (f->used() && f->sorted()) f->gather(order, scratch_for(*f));
    for (auto* f : fields_)
      if (f->used() && !f->sorted()) f->resize(order.size);
    size_ = owned_ = order.size;
  }
  /// Keeps the particles at these places alone, with all that checkpoints hold.
  void keep(Span<const Index> places) {
    for (auto* f : fields_)
      if (f->used()) f->sorted() || f->saved() ? f->gather(places, nullptr) : f->resize(places.size);
    size_ = owned_ = places.size;
  }

  // --- ghosts: by all ranks at the same time ---

  /// Particles of which other ranks want copies, for rank r those at places[of_rank[r]] to
  /// places[of_rank[r + 1]]. Makes room for the copies that come here, and brings all that outlives a step.
  void make_ghosts(const std::vector<Index>& of_rank, Span<const Index> places) {
    drop_ghosts();
    exchange_.plan(of_rank, places);
    size_ = owned_ + exchange_.incoming();
    for (auto* f : fields_) {
      if (f->used()) f->grow(size_);
      f->set_shared(!f->used() || f->lifetime == Lifetime::derived);
    }
    share([](const FieldBase&) { return true; });
  }
  void drop_ghosts() {
    if (size_ == owned_) return;
    resize(owned_);
  }
  /// Brings those values of ghosts that are not as their owners have them, of fields for which which(field)
  /// holds.
  template <class Which>
  void share(const Which& which) {
    if (!divided_ || everywhere_ == 0) return;  // then nobody has planned an exchange
    std::vector<FieldBase*> fields;
    for (auto* f : fields_)
      if (f->used() && !f->shared() && which(*f)) fields.push_back(f);
    if (fields.empty()) return;
    exchange_.run(fields, owned_);
    for (auto* f : fields) f->set_shared(true);
  }
  /// The same of these fields: within a stage, of what one pass has written and the next reads near.
  void share(std::initializer_list<FieldBase*> fields) {
    share([&](const FieldBase& f) { return std::find(fields.begin(), fields.end(), &f) != fields.end(); });
  }
  /// After particles have come or gone.
  void count() {
    divided_ = Context::current().several();
    everywhere_ = all_reduce(std::int64_t(owned_), [](std::int64_t& into, std::int64_t n) { into += n; });
  }

  /// What of it is kept in a file.
  HostStore save() const {
    HostStore s{name, owned_, {}};
    for (auto* f : fields_)
      if (f->used() && f->saved()) s.arrays.push_back(f->to_host(owned_));
    return s;
  }
  void load(const HostStore& s) {
    resize(Index(s.count));
    divided_ = false;
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
  Index owned_ = 0, size_ = 0;
  std::int64_t everywhere_ = 0;
  bool divided_ = false;  ///< among ranks
  Exchange exchange_;
};

inline FieldBase::FieldBase(Store& store, const char* name, const std::string& unit, Lifetime lifetime,
                            const std::optional<Output>& output)
    : name(name), unit(unit), lifetime(lifetime), output(output) {
  store.fields_.push_back(this);
}

}  // namespace BL_SOLVER
