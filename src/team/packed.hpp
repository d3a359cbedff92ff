#pragma once
// Values as bytes, for other processes of the same build.

#include <cstddef>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "bedload/host_data.hpp"

namespace bedload {

/// Calls pass(part) for each part of a value that is no plain memory.
template <class Pass>
void each_part(Pass& pass, HostArray& a) {
  pass(a.name), pass(a.unit), pass(a.type), pass(a.components), pass(a.bytes);
}
template <class Pass>
void each_part(Pass& pass, HostStore& s) {
  bool grid = s.grid.has_value();
  pass(s.name), pass(s.count), pass(s.arrays), pass(s.lines), pass(grid);
  if (!grid) return;
  if (!s.grid) s.grid.emplace();
  pass(*s.grid);
}
template <class Pass>
void each_part(Pass& pass, Quantity& q) {
  pass(q.name), pass(q.unit), pass(q.value);
}
template <class Pass>
void each_part(Pass& pass, SavedState& s) {
  pass(s.stores), pass(s.scalars);
}

class Packer {
 public:
  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>)
      add(&value, sizeof(T));
    else
      each_part(*this, value);
  }
  template <class T, class A>
  void operator()(std::vector<T, A>& values) {
    std::size_t count = values.size();
    (*this)(count);
    if constexpr (std::is_trivially_copyable_v<T>)
      add(values.data(), count * sizeof(T));
    else
      for (T& value : values) (*this)(value);
  }
  void operator()(std::string& text) {
    std::size_t count = text.size();
    (*this)(count);
    add(text.data(), count);
  }
  HostBytes bytes;

 private:
  void add(const void* data, std::size_t size) {
    if (size == 0) return;
    bytes.resize(bytes.size() + size);
    std::memcpy(bytes.data() + bytes.size() - size, data, size);
  }
};

class Unpacker {
 public:
  explicit Unpacker(const HostBytes& bytes) : bytes_(bytes) {}
  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>)
      take(&value, sizeof(T));
    else
      each_part(*this, value);
  }
  template <class T, class A>
  void operator()(std::vector<T, A>& values) {
    values.resize(count());
    if constexpr (std::is_trivially_copyable_v<T>)
      take(values.data(), values.size() * sizeof(T));
    else
      for (T& value : values) (*this)(value);
  }
  void operator()(std::string& text) {
    text.resize(count());
    take(text.data(), text.size());
  }
  template <class T>
  T next() {
    T value{};
    (*this)(value);
    return value;
  }

 private:
  std::size_t count() { return next<std::size_t>(); }
  void take(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("a message between processes is too short");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  const HostBytes& bytes_;
  std::size_t at_ = 0;
};

template <class... T>
HostBytes packed(const T&... values) {
  Packer pack;
  (pack(const_cast<T&>(values)), ...);  // which changes nothing
  return std::move(pack.bytes);
}

}  // namespace bedload
