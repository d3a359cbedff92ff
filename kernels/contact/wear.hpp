#pragma once
// What grains do to the patches of a wall body, from which laws of wear follow as factors.

#include "kernels/contact/contact_loss.hpp"
#include "kernels/walls/surface.hpp"

namespace BL_SOLVER {

/// Sums over the contacts of a patch, in units.
struct WearSums {
  WideSum path;    ///< normal force times the path that grains slide
  WideSum normal;  ///< dissipated by normal force
  WideSum shear;   ///< by sliding and rolling
  WideSum time;    ///< of contact
  WideSum cut;     ///< impact_cut of all impacts
  void add(const WearSums& other) {
    path.add(other.path), normal.add(other.normal), shear.add(other.shear), time.add(other.time);
    cut.add(other.cut);
  }
};
template <>
struct FileType<WearSums> {
  static constexpr Scalar scalar = Scalar::u64;
  static constexpr int components = sizeof(WearSums) / sizeof(std::uint64_t);
};

/// Patches of one body: cubes of a grid in its axes, of which those at its surface are met.
struct WearMap {
  WearSums* sums = nullptr;  ///< [patches()]; null: no wear
  Vec3d lo;                  ///< at t = 0, m
  double size = 0;           ///< m
  int count[3] = {};

  BL_HD int patches() const { return count[0] * count[1] * count[2]; }
  /// That of a place of the body at t = 0; from outside the grid, the nearest.
  BL_HD int patch(const Vec3d& x) const {
    int at[3];
    for (int k = 0; k < 3; ++k) {
      const double cell = (x[k] - lo[k]) / size;
      at[k] = cell > 0 ? int(min_of(cell, double(count[k] - 1))) : 0;
    }
    return (at[2] * count[1] + at[1]) * count[0] + at[0];
  }
  /// The middle of a patch at t = 0, m.
  BL_HD Vec3d middle(int patch) const {
    const int i = patch % count[0], j = patch / count[0] % count[1], k = patch / count[0] / count[1];
    return lo + size * Vec3d{i + 0.5, j + 0.5, k + 0.5};
  }
};

/// What an impact of mass m (kg) at velocity v (m/s), `into` of it into the wall, cuts, over a pressure, J: m
/// v2 times Finnie's function of the angle to the wall, with vertical forces twice the horizontal ones
/// [finnie60].
BL_HD double impact_cut(double m, const Vec3d& v, double into) {
  constexpr double K = 2;
  if (!(into > 0)) return 0;
  const double sin2 = square(into), cos2 = max_of(norm2(v) - sin2, 0.0);  // times v2
  if (36 * sin2 > K * K * cos2) return m * K / 6 * cos2;
  return m * (2 * std::sqrt(sin2 * cos2) - 6 / K * sin2);
}

struct WallWear {
  static constexpr double kTime = 1e-15;  ///< unit of times, s
  const WearMap* maps = nullptr;          ///< [bodies]; null: none of them wears
  double unit = 0;                        ///< J
  BL_HD explicit operator bool() const { return maps; }

  /// r: from the body's centre to the contact, m; path: normal force times path, J; time: of contact, s.
  BL_HD void add(std::uint32_t body, const BodyPose& pose, const Vec3d& r, double path, double time,
                 const ContactLoss& loss) const {
    if (!maps[body].sums) return;
    WearSums& at = sums(body, pose, r);
    at.path.add(whole(path / unit));
    at.normal.add(whole(loss.normal / unit));
    at.shear.add(whole(loss.tangential / unit));
    at.time.add(whole(time / kTime));
  }
  /// A grain of mass m (kg) begins to touch the body there, at velocity v to it (m/s); n: to the grain.
  BL_HD void strike(std::uint32_t body, const BodyPose& pose, const Vec3d& r, double m, const Vec3d& v,
                    const Vec3d& n) const {
    if (maps[body].sums) sums(body, pose, r).cut.add(whole(impact_cut(m, v, -dot(v, n)) / unit));
  }

 private:
  BL_HD WearSums& sums(std::uint32_t body, const BodyPose& pose, const Vec3d& r) const {
    const WearMap& map = maps[body];
    return map.sums[map.patch(pose.centre + (pose.turned() ? pose.rotation.conjugate().rotate(r) : r))];
  }
};

}  // namespace BL_SOLVER
