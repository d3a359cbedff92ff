#pragma once
// How much fluid comes through an orifice, and where that has taken the particles upstream of it.

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/openings.hpp"
#include "bedload/case/formula.hpp"
#include "bedload/core/rigid_motion.hpp"

namespace bedload {

/// Flow through one inlet. Upstream of the orifice lie layers of fluid particles that move as one body; when
/// a layer has come through, the body starts over by its thickness further back, as one layer more.
class InletFlow {
 public:
  /// `dx`: spacing of the fluid, m.
  InletFlow(const InletConfig& inlet, double dx, const DomainConfig& domain);

  const std::string& name() const { return inlet_.name; }
  int points() const { return points_; }           ///< of the orifice: particles a layer
  double thickness() const { return thickness_; }  ///< of a layer, m
  double rate(double t) const;                     ///< m3/s
  /// Volume let in up to t, m3; t no earlier than that of the last advance().
  double volume(double t) const;
  double counted() const { return volume_; }  ///< up to the last advance(), m3
  double layers() const { return layers_; }   ///< come through so far

  /// Of the particles upstream, which begin half a layer behind the orifice.
  RigidMotion motion(double t) const;
  /// The foremost layer has come through.
  bool due() const { return travel(time_) >= 0.5 * thickness_; }
  void next_layer() { ++layers_; }

  /// Counts the volume up to t from now on.
  void advance(double t);
  /// Continues at t from another that ended after `volume` m3 and `layers`.
  void resume(double t, double volume, double layers) { time_ = t, volume_ = volume, layers_ = layers; }

 private:
  double open(double t) const;    ///< fraction of the flow that opening and closing let through
  double travel(double t) const;  ///< of the particles upstream from where they began, m
  double integral(double from, double to) const;

  InletConfig inlet_;
  Formula factor_;
  int points_;
  double thickness_, area_, full_;  ///< m; m2; m3/s
  double time_ = 0, volume_ = 0, layers_ = 0;
};

/// Largest speed of the fluid in the orifice (m/s) up to `until` (s), sampled where a formula sets it.
double inlet_speed(const InletConfig& inlet, double dx, const DomainConfig& domain, double until);

}  // namespace bedload
