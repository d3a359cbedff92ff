#pragma once
// Small fixed-size vectors, the same on host and device.

#include <cmath>
#include <type_traits>

#if defined(__CUDACC__)
#define BL_HD __host__ __device__ __forceinline__
#define BL_INLINE
#else
#define BL_HD inline __attribute__((always_inline))
#define BL_INLINE __attribute__((always_inline))  ///< of a lambda in a loop of the CPU
#endif

namespace bedload {

/// Cartesian vector.
template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  Vec3() = default;
  BL_HD constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  template <class U>
    requires(!std::is_same_v<U, T>)
  BL_HD explicit constexpr Vec3(const Vec3<U>& o) : x(T(o.x)), y(T(o.y)), z(T(o.z)) {}

  BL_HD constexpr T operator[](int k) const { return k == 0 ? x : (k == 1 ? y : z); }
  BL_HD constexpr T& operator[](int k) { return k == 0 ? x : (k == 1 ? y : z); }

  BL_HD Vec3& operator+=(const Vec3& o) {
    x += o.x, y += o.y, z += o.z;
    return *this;
  }
  BL_HD Vec3& operator-=(const Vec3& o) {
    x -= o.x, y -= o.y, z -= o.z;
    return *this;
  }
  BL_HD Vec3& operator*=(T s) {
    x *= s, y *= s, z *= s;
    return *this;
  }
  friend BL_HD constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend BL_HD constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend BL_HD constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend BL_HD constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend BL_HD constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  friend BL_HD constexpr Vec3 operator/(const Vec3& a, T s) { return a * (T(1) / s); }
  friend BL_HD constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

template <class T>
BL_HD constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
BL_HD constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
BL_HD constexpr T norm2(const Vec3<T>& a) {
  return dot(a, a);
}
template <class T>
BL_HD T norm(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(norm2(a));
}

/// Four values that travel as one aligned load: 16 bytes in fp32.
template <class T>
struct alignas(4 * sizeof(T)) Vec4 {
  T x{}, y{}, z{}, w{};

  Vec4() = default;
  BL_HD constexpr Vec4(T x_, T y_, T z_, T w_) : x(x_), y(y_), z(z_), w(w_) {}
  BL_HD constexpr Vec4(const Vec3<T>& v, T w_) : x(v.x), y(v.y), z(v.z), w(w_) {}
  BL_HD constexpr Vec3<T> xyz() const { return {x, y, z}; }
};

/// Unit quaternion (w, x, y, z); rotates body-frame vectors into the lab frame.
template <class T>
struct Quat {
  T w{1}, x{}, y{}, z{};

  BL_HD Vec3<T> rotate(const Vec3<T>& v) const {
    const Vec3<T> u{x, y, z};
    const Vec3<T> t = T(2) * cross(u, v);
    return v + w * t + cross(u, t);
  }
  BL_HD Quat conjugate() const { return {w, -x, -y, -z}; }
  friend BL_HD Quat operator*(const Quat& a, const Quat& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
  /// Rotation by the vector `r` (axis times angle, rad).
  static BL_HD Quat from_rotation(const Vec3<T>& r) {
    const T angle = norm(r);
    if (angle == T(0)) return {};
    const T s = std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), r.x * s, r.y * s, r.z * s};
  }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

}  // namespace bedload
