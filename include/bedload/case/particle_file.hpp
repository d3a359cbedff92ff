#pragma once
// Particles that a case takes from a file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

struct ParticleList {
  std::filesystem::path file;
  std::vector<Vec3d> x;            ///< m
  std::vector<Vec3d> v;            ///< m/s; empty if the file has none
  std::vector<Vec3d> omega;        ///< rad/s; empty if the file has none
  std::vector<double> d;           ///< diameters, m; empty if the file has none
  std::vector<double> volume;      ///< of fluid particles, m3; empty if the file has none
  std::vector<std::int64_t> line;  ///< of a text file

  /// Place of particle n: "grains.csv:12", "grains.vtkhdf".
  std::string place(std::size_t n) const;
};

/// Whether `x` lies in the domain, to the rounding of positions in fp32; one beyond it by no more is put on
/// its side.
bool lies_inside(const DomainConfig& domain, Vec3d& x);

/// Whether `file` has frames to choose from, by its name.
bool has_frames(const std::filesystem::path& file);

/// The particles of a table, or of frame `step` (-1: the last) of a .vtkhdf file that a run wrote. A table
/// has a line of column names, x, y, z [m], optionally d or radius [m], volume [m3], vx, vy, vz [m/s] and wx,
/// wy, wz [rad/s], in any order and with or without their units; columns are separated by commas; empty lines
/// and lines that begin with # are passed over. Where it has a column `type`, fluid or grain, only those of
/// `type` count. Throws CaseError with file, line and column, and FileError.
ParticleList read_particles(const std::filesystem::path& file, std::int64_t step,
                            std::string_view type = "grain");
/// The particles of a grain.fill, from its file or its positions, where they lie in the domain.
ParticleList listed_grains(const GrainFill& fill, const DomainConfig& domain);

}  // namespace bedload
