// No composition of contact laws gives energy: what is done on a contact before it ends is never less than
// what comes back.
#include <gtest/gtest.h>

#include <random>

#include "kernels/contact/registry.hpp"
#include "tests/support/contact_law.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kRadius = 1.35e-3;
const Sphere kGrain{Real(kRadius), Real(2500 * 4.0 / 3.0 * M_PI * kRadius * kRadius * kRadius)};

/// f(config, names) with every composition that a case may name.
template <class F>
void each_composition(F&& f) {
  for (const auto& normal : kNames<NormalLaw>)
    for (const auto& sliding : kNames<SlidingLaw>)
      for (const auto& rolling : kNames<RollingLaw>) {
        if (normal.value == NormalLaw::none) continue;
        Config c;
        c.grain.d = 2 * kRadius;
        c.contact.normal = normal.value, c.contact.tangential = sliding.value;
        c.contact.rolling = rolling.value;
        c.contact.k = 1e3;
        f(c, std::string(normal.name) + ", " + std::string(sliding.name) + ", " + std::string(rolling.name));
      }
}

/// Where one of two grains that touch is, as its contact with the other sees it.
struct Place {
  double overlap;     ///< m
  Vec3d shift = {};   ///< along the surface, without turning, m
  Vec3d turn = {};    ///< about axes along the surface, rad
  double leg = 1e-4;  ///< time that it takes to get there, s
  double round = 0;   ///< angle by which it has gone round the other one, about z, rad

  /// Of the centres.
  Vec3d separation() const {
    const double gap = 2 * kRadius - overlap;
    return {gap * std::cos(round), gap * std::sin(round), 0};
  }
};

struct Work {
  double done;   ///< on the contact, J
  double spent;  ///< its parts without their signs, J
};

/// Of taking a contact from one place to the next in straight legs.
Work work_along(const ContactLaw& law, const std::vector<Place>& way) {
  const int steps = 500;
  ContactHistory h;
  Work work{};
  ContactForce before{};
  for (std::size_t k = 0; k + 1 < way.size(); ++k)
    for (int s = 1; s <= steps; ++s) {
      const double dt = way[k + 1].leg / steps;
      const auto along = [&](int step) {
        const double part = double(step) / steps;
        return Place{.overlap = way[k].overlap + part * (way[k + 1].overlap - way[k].overlap),
                     .round = way[k].round + part * (way[k + 1].round - way[k].round)};
      };
      const Place here = along(s);
      if (!(here.overlap > 0)) {
        h = {}, before = {};
        continue;
      }
      // sideways motion turns with the contact
      const auto with_contact = [&, middle = along(s - 1).round + here.round](const Vec3d& a) {
        return Quat<double>::from_rotation({0, 0, 0.5 * middle}).rotate(a);
      };
      const Vec3d shift = with_contact((way[k + 1].shift - way[k].shift) * (1.0 / steps)),
                  turn = with_contact((way[k + 1].turn - way[k].turn) * (1.0 / steps));
      const Vec3d r = here.separation(), drift = r - along(s - 1).separation(), moved = drift + shift;
      const ContactGeometry at = sphere_contact(kGrain, kGrain, r, norm(r), here.overlap, drift);
      const ContactForce now = law(at, Real3(moved * (1 / dt)), Real3(turn * (1 / dt)), {}, Real(dt), h);
      const double parts[] = {-0.5 * dot(Vec3d(before.force + now.force), drift),
                              -0.5 * dot(Vec3d(before.force + now.force), shift),
                              -0.5 * dot(Vec3d(before.torque_i + now.torque_i), turn)};
      for (double part : parts) work.done += part, work.spent += std::abs(part);
      before = now;
    }
  return work;
}

/// Ways from touch to leave, on which a law that gives energy would show it.
std::vector<std::vector<Place>> ways() {
  const double a = 4e-6, b = 1e-5, slow = 1e-2;  // overlaps, m; s
  const auto sheared = [](double overlap, double shift, double leg = 1e-4) {
    return Place{overlap, {0, shift, 0}, {}, leg};
  };
  const auto turned = [](double overlap, double turn) { return Place{overlap, {}, {0, turn, 0}}; };
  // rolls round the other one without slip, but for `more` of a turn about the axis of its way and across it
  const auto rolled = [](double overlap, double round, const Vec3d& more = {}) {
    return Place{overlap, {}, Vec3d{0, 0, 2 * round} + more, 1e-4, round};
  };
  std::vector<std::vector<Place>> all = {
      {{0}, {b}, sheared(b, 3e-5), sheared(b, -3e-5), {b}, {0}},  // gross slip
      {{0}, {b}, sheared(b, 3e-7), sheared(a, 3e-7), {a}, {0}},   // back on a softer spring
      {{0}, {a}, sheared(a, 3e-7), sheared(b, 3e-7), {b}, {0}},   // or a stiffer one
      {{0}, sheared(b, 4e-7), {0}},
      {{0}, {b}, turned(b, 1e-2), turned(a, 1e-2), {a}, {0}},
      {{0}, {a}, turned(a, 1e-2), turned(b, 1e-2), {b}, {0}},
      // a damper that stretches the spring the wrong way
      {{0}, {b, {}, {}, slow}, sheared(b, 1.5e-7, 1e-6), sheared(b, 2.4e-6, slow), {0, {}, {}, slow}},
      {{0}, {b}, rolled(b, 0.3), rolled(b, -0.3), {b}, {0}},
      {{0}, {b}, rolled(b, 0.3), rolled(a, 0.3), {a}, {0}},
      {{0}, {a}, rolled(a, 0.3, {0, 0, 1e-3}), rolled(b, 0.3, {0.2, 1e-3, 0}), {b}, {0}},
      {{0}, {b}, rolled(b, 0.1, {1, 1e-3, 0}), rolled(b, 0.3, {-1, 0, 1e-3}), rolled(b, 0, {0, 0.1, 0}), {0}},
      // out where damping takes from the pressure, back where it adds to it
      {{0}, {b, {}, {}, slow}, sheared(b - 1e-7, 1e-5, 1e-6), {b, {}, {}, 1e-6}, {0, {}, {}, slow}},
  };
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (int k = 0; k < 12; ++k) {
    const double size = std::pow(10, -2 * any(random));  // of the sideways motion, from slip to hardly any
    const auto sideways = [&](double most) {
      const double y = 2 * any(random) - 1, z = 2 * any(random) - 1;
      return Vec3d{0, y, z} * (most * size);
    };
    all.push_back({{0}});
    for (int leg = 0; leg < 6; ++leg) {
      const double overlap = b * (0.05 + 0.95 * any(random)), time = std::pow(10, -3 - 3 * any(random));
      const Vec3d shift = sideways(b), turn = sideways(0.03);
      const double round = k % 2 == 0 ? 0 : 0.01 * (2 * any(random) - 1);
      all.back().push_back({overlap, shift, turn, time, round});
    }
    all.back().push_back({0});
  }
  return all;
}

TEST(PassiveLaws, WaysFromTouchToLeaveNeverGiveWork) {
  const auto all = ways();
  each_composition([&](Config& c, const std::string& names) {
    c.grain.mu_r = 0.1;
    for (const double mu : {0.3, 5.0})
      for (const double e : {1.0, 0.2})
        for (const double damping : {1.0, 0.0}) {
          c.grain.mu = mu, c.grain.e = e;
          c.contact.tangential_damping = damping, c.contact.eta_r = 0.3 * damping;
          const ContactLaw law = contact_law_of(c);
          for (std::size_t k = 0; k < all.size(); ++k) {
            const Work work = work_along(law, all[k]);
            EXPECT_GT(work.done, -1e-4 * work.spent)  // of the sum over straight pieces
                << names << ", mu " << mu << ", e " << e << ", damping sideways " << damping << ", way " << k
                << ": " << -work.done / work.spent << " of the work came out";
          }
        }
  });
}

TEST(PassiveLaws, GrossSlipCostsWork) {
  each_composition([&](Config& c, const std::string& names) {
    if (c.contact.tangential == SlidingLaw::none) return;
    c.grain.mu = 0.3, c.grain.e = 1;
    const Work work = work_along(contact_law_of(c), ways()[0]);
    EXPECT_GT(work.done, 0.1 * work.spent) << names;
  });
}

TEST(PassiveLaws, PressingAloneIsReversible) {
  each_composition([&](Config& c, const std::string& names) {
    if (c.contact.normal == NormalLaw::democritus) return;
    c.grain.e = 1;
    const Work work = work_along(contact_law_of(c), {{0}, {1e-5}, {0}});
    EXPECT_LT(std::abs(work.done), 1e-5 * work.spent) << names;  // the last step of the sum
  });
}

/// A grain between two plates, stepped as the solver does: velocities in the middle of the steps.
class BetweenPlates {
 public:
  BetweenPlates(const ContactLaw& law, double gap) : law_(law), gap_(gap) {}
  /// Largest energy in flight over that at first, after `steps` of dt (s).
  double largest_gain(int steps, double dt) {
    const double first = energy();
    double most = first;
    for (int s = 0; s < steps; ++s) {
      x_ += dt * v_;
      Vec3d force, torque;
      const double below = kRadius - x_.z, above = kRadius - (2 * kRadius + gap_ - x_.z);
      touch_plate(lower_, below, {0, 0, 1}, dt, force, torque);
      touch_plate(upper_, above, {0, 0, -1}, dt, force, torque);
      v_ += force * (dt / double(kGrain.m));
      omega_ += torque * (dt / double(kGrain.inertia()));
      if (below < 0 && above < 0) most = std::max(most, energy());
    }
    return most / first - 1;
  }

 private:
  double energy() const {
    return 0.5 * double(kGrain.m) * norm2(v_) + 0.5 * double(kGrain.inertia()) * norm2(omega_);
  }
  void touch_plate(ContactHistory& h, double overlap, const Vec3d& n, double dt, Vec3d& force,
                   Vec3d& torque) const {
    if (!(overlap > 0)) {
      h = {};
      return;
    }
    const ContactForce f =
        law_(wall_contact(kGrain, n, n, overlap), Real3(v_), Real3(omega_), {}, Real(dt), h);
    force += Vec3d(f.force), torque += Vec3d(f.torque_i);
  }

  ContactLaw law_;
  double gap_;
  Vec3d x_{0, 0, kRadius + 0.3 * gap_}, v_{0.7, 0.2, -1}, omega_{100, 200, 50};
  ContactHistory lower_, upper_;
};

TEST(PassiveLaws, AGrainBetweenPlatesIsNeverFaster) {
  each_composition([&](Config& c, const std::string& names) {
    c.grain.mu = 0.5, c.grain.mu_r = 0.1, c.grain.e = 1;
    const double dt = 4e-6;  // that of a run
    EXPECT_LT(BetweenPlates(contact_law_of(c), 2e-4).largest_gain(int(6 / dt), dt), 1e-3) << names;
  });
}

/// A grain that bounces and rolls in a tube, its normals turning.
class InATube {
 public:
  InATube(const ContactLaw& law, double gap) : law_(law), gap_(gap) {}
  /// As of BetweenPlates.
  double largest_gain(int steps, double dt) {
    const double first = energy();
    double most = first;
    for (int s = 0; s < steps; ++s) {
      x_ += dt * v_;
      const double across = std::hypot(x_.x, x_.z), overlap = across - gap_;
      if (!(overlap > 0)) {
        h_ = {};
        most = std::max(most, energy());
        continue;
      }
      const Vec3d n = Vec3d{-x_.x, 0, -x_.z} * (1 / across);
      const ContactGeometry at = wall_contact(kGrain, h_.overlap > 0 ? n_ : n, n, overlap);
      const ContactForce f = law_(at, Real3(v_), Real3(omega_), {}, Real(dt), h_);
      n_ = n;
      v_ += Vec3d(f.force) * (dt / double(kGrain.m));
      omega_ += Vec3d(f.torque_i) * (dt / double(kGrain.inertia()));
    }
    return most / first - 1;
  }

 private:
  double energy() const {
    return 0.5 * double(kGrain.m) * norm2(v_) + 0.5 * double(kGrain.inertia()) * norm2(omega_);
  }

  ContactLaw law_;
  double gap_;  ///< between the grain and the tube when it is in the middle, m
  Vec3d x_, v_{0.7, 0.2, -1}, omega_{100, 200, 50}, n_;
  ContactHistory h_;
};

TEST(PassiveLaws, AGrainInATubeIsNeverFaster) {
  each_composition([&](Config& c, const std::string& names) {
    c.grain.mu = 0.5, c.grain.mu_r = 0.1, c.grain.e = 1;
    const double dt = 4e-6;  // that of a run
    EXPECT_LT(InATube(contact_law_of(c), 2 * kRadius).largest_gain(int(6 / dt), dt), 1e-3) << names;
  });
}

}  // namespace
}  // namespace BL_SOLVER
