#pragma once
// One named array of a store: unit and lifetime declared once; allocation,
// sorting, output and checkpoints follow from that.

#include <algorithm>
#include <optional>
#include <string>

#include "bedload/core/frame.hpp"
#include "bedload/host_data.hpp"
#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

enum class Lifetime {
  kept,     ///< state: sorted with the particles, saved in checkpoints
  carried,  ///< like kept but recomputed before use after a restart: sorted, not saved
  renewed,  ///< like kept but set anew whenever particles are sorted: saved, not sorted
  derived,  ///< recomputed from state every step: neither sorted nor saved
};

/// Who gets an output, bits of Output::uses.
enum Use : unsigned {
  kNobody = 0,
  kFrames = 1,    ///< frames, pictures, the live view
  kViews = 2,     ///< Python, without a copy
  kRheology = 4,  ///< the viscometer
};

/// That a field is written, and how.
struct Output {
  int order = 50;  ///< outputs of a store are in this order
  unsigned uses = kFrames | kViews;
  bool coupled = false;        ///< only where fluid acts on grains
  const char* name = nullptr;  ///< if not that of the field
  const char* unit = nullptr;  ///< likewise
  int components = 0;          ///< of a field of several quantities, how many scalars; 0: all
  int first = 0;               ///< of these
};

/// How a C++ type looks in a file.
template <class T>
struct FileType;
template <>
struct FileType<float> {
  static constexpr Scalar scalar = Scalar::f32;
  static constexpr int components = 1;
};
template <>
struct FileType<double> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = 1;
};
template <>
struct FileType<std::uint32_t> {
  static constexpr Scalar scalar = Scalar::u32;
  static constexpr int components = 1;
};
template <class T>
struct FileType<Vec3<T>> {
  static constexpr Scalar scalar = FileType<T>::scalar;
  static constexpr int components = 3;
};
template <class T>
struct FileType<Vec4<T>> {
  static constexpr Scalar scalar = FileType<T>::scalar;
  static constexpr int components = 4;
};
template <class T>
struct FileType<VelocityDensity<T>> : FileType<Vec4<T>> {};
template <class T>
struct FileType<EosState<T>> : FileType<Vec4<T>> {};
template <class T>
struct FileType<WallState<T>> : FileType<Vec4<T>> {};
template <class T>
struct FileType<NoSlip<T>> : FileType<Vec4<T>> {};
template <>
struct FileType<PackedPosition> {
  static constexpr Scalar scalar = Scalar::u32;
  static constexpr int components = 4;
};
template <>
struct FileType<FixedPosition> : FileType<PackedPosition> {};
template <>
struct FileType<PlainPosition> : FileType<Vec4<double>> {};

class Store;

class FieldBase {
 public:
  FieldBase(Store& store, const char* name, const std::string& unit, Lifetime lifetime,
            const std::optional<Output>& output = {});
  virtual ~FieldBase() = default;
  FieldBase(const FieldBase&) = delete;

  const std::string name, unit;
  const Lifetime lifetime;
  const std::optional<Output> output;  ///< none: it is not written

  bool used() const { return used_; }
  bool sorted() const { return lifetime == Lifetime::kept || lifetime == Lifetime::carried; }
  bool saved() const { return lifetime == Lifetime::kept || lifetime == Lifetime::renewed; }
  /// For a case that does not need the field: it takes no memory, and its span is empty.
  void leave_out() { used_ = false; }
  /// May be missing from a checkpoint; then it is initialised to zero.
  void begin_at_zero() { needed_ = false; }
  bool needed() const { return needed_; }
  /// Whether ghosts have the values that their owners have.
  bool shared() const { return shared_; }
  void set_shared(bool shared) { shared_ = shared; }

  virtual void resize(Index n) = 0;
  /// To n entries, the new ones zero.
  virtual void grow(Index n) = 0;
  /// x[i] = old x[order[i]]; shrinks to order.size. If `by` has the same type its memory is used, and its
  /// values are lost.
  virtual void gather(Span<const Index> order, FieldBase* by) = 0;
  /// to[i] = x[places[i]], where the solver computes; `to` has room for as many entries.
  virtual void collect(Span<const Index> places, void* to) const = 0;
  virtual void* entry(Index i) = 0;
  HostArray to_host() const { return to_host(entries()); }
  virtual HostArray to_host(std::size_t first) const = 0;  ///< the first entries alone
  virtual std::size_t entries() const = 0;
  virtual FieldView view() const = 0;
  virtual std::size_t entry_bytes() const = 0;
  virtual void from_host(const HostArray& array) = 0;

 private:
  bool used_ = true, needed_ = true, shared_ = true;
};

template <class T>
class Field final : public FieldBase {
 public:
  using FieldBase::FieldBase;

  void resize(Index n) override { data_.resize(n); }
  void grow(Index n) override { data_.grow(n); }
  // these two in field.cpp, for the types listed there
  void gather(Span<const Index> order, FieldBase* by) override;
  void collect(Span<const Index> places, void* to) const override;
  void* entry(Index i) override { return data_.data() + i; }
  using FieldBase::to_host;
  std::size_t entries() const override { return data_.size(); }
  HostArray to_host(std::size_t first) const override {
    HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
    a.bytes.resize(std::min(first, data_.size()) * sizeof(T));
    copy_to_host(a.bytes.data(), data_.data(), a.bytes.size());
    return a;
  }
  FieldView view() const override {
    return {name,         unit,         FileType<T>::scalar, FileType<T>::components,
            data_.data(), data_.size(), sizeof(T),           data_.memory()};
  }
  std::size_t entry_bytes() const override { return sizeof(T); }
  void from_host(const HostArray& a) override {
    if (a.type != FileType<T>::scalar || a.components != FileType<T>::components)
      throw FileError("array " + name + " has another type than this build keeps");
    data_.resize(a.bytes.size() / sizeof(T));
    copy_to_device(data_.data(), a.bytes.data(), a.bytes.size());
  }

  Buffer<T>& buffer() { return data_; }
  /// The values of another field of as many entries.
  void copy(const Field& from) { copy_on_device(data_.data(), from.data_.data(), data_.size() * sizeof(T)); }
  const Buffer<T>& buffer() const { return data_; }
  void assign(const std::vector<T>& host) {
    if (used()) data_.assign(host);
  }
  std::vector<T> values() const { return data_.to_host(); }
  Span<T> span() { return data_.span(); }
  Span<const T> span() const { return data_.span(); }
  operator Span<T>() { return data_.span(); }
  operator Span<const T>() const { return data_.span(); }

 private:
  Buffer<T> data_;
};

/// A field or buffer for a pass that reads it in some cases alone: empty in the others.
template <class Of>
auto span_if(bool used, Of& of) {
  return used ? of.span() : decltype(of.span()){};
}

}  // namespace BL_SOLVER
