#pragma once
// The strokes of wave makers, for regular waves of given height.

#include <array>
#include <string>

namespace bedload {

/// A regular wave over a horizontal floor.
struct WaterWave {
  double height = 0, period = 0, depth = 0;  ///< m, s, m
  double gravity = 9.81;                     ///< m/s2

  /// 1/m, of omega^2 = g k tanh(k d).
  double number() const;
  double length() const;
  /// Height at which it breaks, for its steepness [miche44] or the depth [mccowan91], m.
  double breaking_height() const;
  /// Height up to which the second-order stroke is valid, H L^2 / d^3 < 8 pi^2 / 3 [madsen71], m.
  double second_order_height() const;
};

/// Displacement of a piston, m: a formula in t that rises over `ramp` seconds. First order [biesel51], or
/// with the bound second harmonic, without which a piston makes free waves [madsen71], as given by
/// [hughes93].
std::string piston_stroke(const WaterWave& wave, int order, double ramp);

/// Angle of a flap hinged at the floor, degrees, to first order [biesel51].
std::string flap_angle(const WaterWave& wave, double ramp);

}  // namespace bedload
