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

/// Paddles whose displacement along the wave is the same at all depths, or grows from a hinge at the floor.
enum class Paddle { piston, flap };

/// Displacement of a paddle at the still water level, first order: amplitude of sin wt; second order: those
/// of sin 2wt and 1 - cos 2wt, m.
struct Stroke {
  double first = 0, sine = 0, cosine = 0;
};

/// The stroke that makes a wave of first order [biesel51] without free waves of twice its frequency, to
/// second order [schaffer96].
Stroke stroke_of(const WaterWave& wave, Paddle paddle);

/// Displacement of a piston, m: a formula in t that rises over `ramp` seconds, to first or second order.
std::string piston_stroke(const WaterWave& wave, int order, double ramp);

/// Angle of a flap hinged at the floor, degrees.
std::string flap_angle(const WaterWave& wave, int order, double ramp);

}  // namespace bedload
