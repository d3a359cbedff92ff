#pragma once
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Symmetric 3 x 3 matrix.
template <class T>
struct SymmetricMatrix {
  T xx{}, yy{}, zz{}, yz{}, xz{}, xy{};

  /// this += s r r
  BL_HD void add_outer(T s, const Vec3<T>& r) {
    xx += s * r.x * r.x, yy += s * r.y * r.y, zz += s * r.z * r.z;
    yz += s * r.y * r.z, xz += s * r.x * r.z, xy += s * r.x * r.y;
  }
  BL_HD SymmetricMatrix& operator+=(const SymmetricMatrix& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, yz += o.yz, xz += o.xz, xy += o.xy;
    return *this;
  }
  BL_HD T trace() const { return xx + yy + zz; }
  /// trace 1 - this: from second moments to the moment of inertia.
  BL_HD SymmetricMatrix inertia() const { return {yy + zz, xx + zz, xx + yy, -yz, -xz, -xy}; }
  BL_HD Vec3<T> operator*(const Vec3<T>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  BL_HD T determinant() const {
    return xx * (yy * zz - yz * yz) + xy * (xz * yz - xy * zz) + xz * (xy * yz - yy * xz);
  }
  /// Infinite or NaN where singular.
  BL_HD SymmetricMatrix inverse() const {
    const SymmetricMatrix adjugate{yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy,
                                   xy * xz - xx * yz, xy * yz - yy * xz, xz * yz - zz * xy};
    const T s = 1 / (xx * adjugate.xx + xy * adjugate.xy + xz * adjugate.xz);
    return {s * adjugate.xx, s * adjugate.yy, s * adjugate.zz,
            s * adjugate.yz, s * adjugate.xz, s * adjugate.xy};
  }
  /// Root of the sum of all nine squares; at least the largest eigenvalue.
  BL_HD T norm() const { return std::sqrt(xx * xx + yy * yy + zz * zz + 2 * (yz * yz + xz * xz + xy * xy)); }
  /// By the angle of its characteristic polynomial's roots (Smith 1961).
  BL_HD T least_eigenvalue() const {
    const T mean = trace() / 3, x = xx - mean, y = yy - mean, z = zz - mean;
    const T size2 = (x * x + y * y + z * z + 2 * (yz * yz + xz * xz + xy * xy)) / 6;
    const T size = std::sqrt(size2), volume = size2 * size;
    if (!(volume > 0)) return mean;
    const SymmetricMatrix rest{x, y, z, yz, xz, xy};
    const T cosine = clamp(rest.determinant() / (2 * volume), T(-1), T(1));
    return mean + 2 * size * std::cos((std::acos(cosine) + T(2 * kPi)) / 3);
  }
  /// `scale` times this, in U.
  template <class U>
  BL_HD SymmetricMatrix<U> as(T scale) const {
    return {U(scale * xx), U(scale * yy), U(scale * zz), U(scale * yz), U(scale * xz), U(scale * xy)};
  }
};

}  // namespace BL_SOLVER
