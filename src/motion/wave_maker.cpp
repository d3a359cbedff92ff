#include "src/motion/wave_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace bedload {
namespace {

using std::numbers::pi;

/// From 0 to 1 with continuous velocity.
std::string risen(double ramp, const std::string& formula) {
  if (ramp <= 0) return formula;
  return fmt::format("0.5*(1 - cos(pi*min(1, t/{:.15g})))*({})", ramp, formula);
}

}  // namespace

double WaterWave::number() const {
  const double w = 2 * pi / period, deep = w * w / gravity * depth;  // k d in deep water
  double kd = std::max(deep, std::sqrt(deep));
  for (int n = 0; n < 50; ++n) {  // Newton's method converges from above
    const double t = std::tanh(kd), step = (kd * t - deep) / (t + kd * (1 - t * t));
    kd -= step;
    if (std::abs(step) < 1e-15 * kd) break;
  }
  return kd / depth;
}

double WaterWave::length() const { return 2 * pi / number(); }

double WaterWave::breaking_height() const {
  return std::min(0.142 * length() * std::tanh(number() * depth), 0.78 * depth);
}

double WaterWave::second_order_height() const {
  return 8 * pi * pi / 3 * depth * depth * depth / (length() * length());
}

namespace {

using Complex = std::complex<double>;

/// Wave numbers of the modes before a paddle, 1/m: that of the wave, then those that decay away from it, -i
/// kappa with w^2 = -g kappa tan(kappa d).
std::vector<Complex> mode_numbers(const WaterWave& wave, int count) {
  const double w = 2 * pi / wave.period, deep = w * w / wave.gravity * wave.depth;
  std::vector<Complex> k{wave.number()};
  for (int j = 1; j < count; ++j) {
    double low = (j - 0.5) * pi,
           high = j * pi;  // of kappa d, by bisection: x sin x + deep cos x changes its sign
    for (int n = 0; n < 60; ++n) {
      const double x = 0.5 * (low + high);
      const double sign = j % 2 ? 1 : -1;
      (sign * (x * std::sin(x) + deep * std::cos(x)) > 0 ? low : high) = x;
    }
    k.emplace_back(0, -0.5 * (low + high) / wave.depth);
  }
  return k;
}

/// Integral over the depth of cosh a(z + d) cosh b(z + d).
Complex product_integral(Complex a, Complex b, double d) {
  return (a * std::sinh(a * d) * std::cosh(b * d) - b * std::cosh(a * d) * std::sinh(b * d)) /
         (a * a - b * b);
}

/// Simpson's rule over the depth.
template <class F>
Complex over_depth(double d, F f) {
  constexpr int n = 2000;
  Complex sum = f(-d) + f(0.0);
  for (int k = 1; k < n; ++k) sum += (k % 2 ? 4.0 : 2.0) * f(-d + d * k / n);
  return sum * (d / (3 * n));
}

}  // namespace

/// Potentials are Re(Phi e^{iwt}) and Re(Psi e^{2iwt}), the displacement Re(f(z) (xi e^{iwt} + xi_2
/// e^{2iwt})). The second is that for which the part of Psi that obeys the free surface without forcing has
/// no component cosh K(z + d), the free wave of 2w.
Stroke stroke_of(const WaterWave& wave, Paddle paddle) {
  constexpr int modes = 60;
  const Complex i(0, 1);
  const double w = 2 * pi / wave.period, d = wave.depth, g = wave.gravity, s = w * w / g;
  const auto shape = [&](double z) { return paddle == Paddle::piston ? 1.0 : 1 + z / d; };
  const double slope = paddle == Paddle::piston ? 0 : 1 / d;

  // First order: Phi = sum a_j cosh k_j(z + d) / cosh k_j d e^{-i k_j x}, with Phi_x = i w xi f at the
  // paddle.
  const std::vector<Complex> k = mode_numbers(wave, modes);
  std::vector<Complex> a;
  for (const Complex& kj : k) {
    const Complex cosh = std::cosh(kj * d), kd = kj * d;
    const Complex of_shape =
        paddle == Paddle::piston ? std::sinh(kd) / kj : (kd * std::sinh(kd) - cosh + 1.0) / (kj * kd);
    const Complex of_square = d / 2 + std::sinh(2.0 * kd) / (4.0 * kj);
    a.push_back(-w * of_shape * cosh / (of_square * kj));
  }
  const double xi = 0.5 * wave.height * g / (w * std::abs(a[0]));
  for (Complex& aj : a) aj *= xi;

  // Second order: the free surface forces q_jl e^{-i (k_j + k_l) x}; K is the free wave.
  WaterWave half = wave;
  half.period = wave.period / 2;
  const double K = half.number();
  Complex forced = 0;  // of Psi_x at the paddle, times cosh K(z + d)
  for (int j = 0; j < modes; ++j)
    for (int l = 0; l < modes; ++l) {
      const Complex kjl = k[j] + k[l];
      const Complex q =
          a[j] * a[l] * i * w * (k[j] * k[l] - s * s + (k[j] * k[j] + k[l] * k[l] - 2 * s * s) / 4.0);
      const Complex response = g * kjl * std::sinh(kjl * d) - 4 * w * w * std::cosh(kjl * d);
      forced += -i * kjl * q / response * product_integral(kjl, K, d);
    }
  const Complex moved = over_depth(d, [&](double z) {  // the paddle is not at x = 0
    Complex phi_z = 0, phi_xx = 0;
    for (int j = 0; j < modes; ++j) {
      const Complex of = a[j] * k[j] / std::cosh(k[j] * d);
      phi_z += of * std::sinh(k[j] * (z + d));
      phi_xx -= of * k[j] * std::cosh(k[j] * (z + d));
    }
    return 0.5 * xi * (slope * phi_z - shape(z) * phi_xx) * std::cosh(K * (z + d));
  });
  const Complex pushed = over_depth(d, [&](double z) { return Complex(shape(z) * std::cosh(K * (z + d))); });
  const Complex second = (forced - moved) / (2.0 * i * w * pushed);
  return {xi, second.imag(), second.real()};  // a quarter of a period later: sin wt
}

namespace {

std::string displacement(const WaterWave& wave, Paddle paddle, int order) {
  const Stroke stroke = stroke_of(wave, paddle);
  std::string text = fmt::format("{:.15g}*sin(2*pi*t/{:.15g})", stroke.first, wave.period);
  if (order == 2)
    text += fmt::format(" + {:.15g}*sin(4*pi*t/{:.15g}) + {:.15g}*(1 - cos(4*pi*t/{:.15g}))", stroke.sine,
                        wave.period, stroke.cosine, wave.period);
  return text;
}

}  // namespace

std::string piston_stroke(const WaterWave& wave, int order, double ramp) {
  return risen(ramp, displacement(wave, Paddle::piston, order));
}

std::string flap_angle(const WaterWave& wave, int order, double ramp) {
  const std::string e = risen(ramp, displacement(wave, Paddle::flap, order));
  return fmt::format("180/pi*atan(({})/{:.15g})", e, wave.depth);
}

}  // namespace bedload
