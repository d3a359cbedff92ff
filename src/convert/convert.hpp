#pragma once
// Cases of other programs to cases of Bedload, and frames of a run to files that other programs read.

#include <filesystem>
#include <string>
#include <vector>

namespace bedload {

/// A case made from another program's input.
struct Conversion {
  std::string toml;               ///< the case file
  std::vector<std::string> left;  ///< what has no counterpart, a line each: "dam.xml:12: <damping>: ..."
};

/// From a case of DualSPHysics (Case_Def.xml). Paths in the case are relative to `folder`, in which it will
/// be stored. Throws CaseError with file, line and element.
Conversion from_dualsphysics(const std::filesystem::path& file, const std::filesystem::path& folder);

/// From an input script of LIGGGHTS. The same of CaseError, with file, line and command.
Conversion from_liggghts(const std::filesystem::path& file, const std::filesystem::path& folder);

enum class FrameFormat { extxyz, lammps };

/// Writes the frames of fluid and grains of a results folder, or of one .vtkhdf file, to one file, the type
/// of a particle from its store; returns the number of frames. Throws FileError.
std::size_t convert_frames(const std::filesystem::path& from, FrameFormat format,
                           const std::filesystem::path& to);

}  // namespace bedload
