#pragma once
// What a run measures and writes.

#include <cstdint>
#include <string>
#include <vector>

#include "bedload/case/setup_choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

/// What is measured along the way; one CSV file each under probes/.
struct ProbeConfig {
  std::string name;
  Chosen<ProbeType> type = ProbeType::front;
  Chosen<Phase> phase = Phase::fluid;          ///< front, box, flux
  int axis = 0;                                ///< front, flux: 0, 1, 2
  int sign = 1;                                ///< front: +1 largest coordinate, -1 smallest; flux: its sign
  Vec3d at;                                    ///< point, height, wall_pressure: at t = 0, m
  std::vector<Vec3d> span;                     ///< point, height: from the first to the last of several, m
  Vec3d min, max;                              ///< box, flux: m
  std::string body;                            ///< force, wall_pressure: wall body; point: that carries it
  double radius = 0;                           ///< wall_pressure: of a disc, m; 0: a rectangle; field: of the kernel
  std::vector<double> size;                    ///< wall_pressure: sides of the rectangle, m
  std::vector<double> count;                   ///< patches along them, or points along each span; empty: one
  Vec3d normal;                                ///< wall_pressure: unit, into the fluid (resolved)
  Vec3d along;                                 ///< unit (resolved); wall_pressure: of the first side; height: of
                                               ///< the line, 0: upwards
  Vec3d about;                                 ///< force: torque about this point, m
  Chosen<ForceSample> sample = ForceSample::mean;  ///< force
  std::string of;                              ///< mixing: name of the grain.material that is one kind
  double larger_than = 0;                      ///< mixing: or the diameter that grains of one kind exceed, m
  double cell = 0;                             ///< mixing: edge of the samples, m
  double every = 0;                            ///< s; 0: out.every
  double sample_every = 0;                     ///< field: between instants of a mean, s; 0: that of the row alone
  bool operator==(const ProbeConfig&) const = default;
};

struct OutputConfig {
  double every = 0;                            ///< s
  double diagnostics_every = 0;                ///< s (default out.every)
  double checkpoint_every = 0;                 ///< s; 0: only at the end
  bool walls = true;                           ///< write walls.vtkhdf
  std::vector<std::string> fields;             ///< names of arrays in frames; empty: all
  bool energy = false;                         ///< energy balance of the grains
  bool spectra = false;                        ///< spectra of what contacts dissipate
  std::int64_t spectra_bins = 20;              ///< a decade
  double spectra_from = 1e-12;                 ///< lower edge of the first bin, J
  double spectra_from_force = 1e-6;            ///< that of forces, N
  std::vector<double> spectra_sizes;           ///< diameters between classes of sizes, m; empty: one class
  Chosen<ContactFrames> contacts = ContactFrames::none;  ///< frames of single contacts of grains
  Chosen<BodyTables> bodies = BodyTables::moving;  ///< which have a bodies/*.csv
  std::vector<ProbeConfig> probes;
  bool operator==(const OutputConfig&) const = default;
};

}  // namespace bedload
