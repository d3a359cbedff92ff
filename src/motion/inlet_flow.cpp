#include "src/motion/inlet_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/orifice.hpp"

namespace bedload {
namespace {

/// Smooth step from 0 to 1 over `ramp` seconds.
double smooth_step(double s, double ramp) {
  const double q = ramp > 0 ? std::clamp(s / ramp, 0.0, 1.0) : (s >= 0 ? 1.0 : 0.0);
  return q * q * (3 - 2 * q);
}

}  // namespace

InletFlow::InletFlow(const InletConfig& inlet, double dx, const DomainConfig& domain)
    : inlet_(inlet), factor_(inlet.factor, "t"), area_(orifice_area(inlet)) {
  const OrificeLayer layer = orifice_layer(inlet, dx, domain);
  points_ = int(layer.points.size());
  thickness_ = layer.thickness;
  full_ = inlet.rate > 0 ? inlet.rate : inlet.velocity * area_;
}

double InletFlow::open(double t) const {
  return smooth_step(t - inlet_.start, inlet_.ramp) -
         (std::isfinite(inlet_.stop) ? smooth_step(t - inlet_.stop, inlet_.ramp) : 0);
}

double InletFlow::rate(double t) const { return std::max(0.0, full_ * open(t) * factor_(t)); }

/// Gauss-Legendre, four points between the times at which the flow changes its law.
double InletFlow::integral(double from, double to) const {
  constexpr double at[2] = {0.33998104358485626, 0.86113631159405258};
  constexpr double weight[2] = {0.65214515486254614, 0.34785484513745386};
  std::array<double, 5> ends{inlet_.start, inlet_.start + inlet_.ramp, inlet_.stop, inlet_.stop + inlet_.ramp,
                             to};
  std::sort(ends.begin(), ends.end());
  double sum = 0, a = from;
  for (const double b : ends) {
    if (!(b > a) || b > to) continue;
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    for (int k : {0, 1})
      sum += half * weight[k] * (rate(middle - half * at[k]) + rate(middle + half * at[k]));
    a = b;
  }
  return sum;
}

double InletFlow::volume(double t) const { return volume_ + integral(time_, t); }

void InletFlow::advance(double t) {
  if (!std::isfinite(factor_(t)))
    throw SimulationFault("inlet \"" + name() +
                          "\": inlet.factor is not finite at t = " + std::to_string(t) + " s");
  volume_ = volume(t);
  time_ = t;
}

double InletFlow::travel(double t) const { return volume(t) / area_ - layers_ * thickness_; }

RigidMotion InletFlow::motion(double t) const {
  const double apart = 1e-3 * (inlet_.ramp > 0 ? inlet_.ramp : 1e-3);
  RigidMotion m;
  m.translation = travel(t) * inlet_.direction;
  m.v = rate(t) / area_ * inlet_.direction;
  m.a = (rate(t + apart) - rate(t - apart)) / (2 * apart * area_) * inlet_.direction;
  return m;
}

double inlet_speed(const InletConfig& inlet, double dx, const DomainConfig& domain, double until) {
  const InletFlow flow(inlet, dx, domain);
  if (flow.points() == 0) return 0;
  constexpr int samples = 2000;
  double most = 0;
  for (int i = 0; i <= samples; ++i) most = std::max(most, flow.rate(until * i / samples));
  return most / orifice_area(inlet);
}

}  // namespace bedload
