#pragma once
// Frames of one store in one file: VTKHDF 2.0, temporal PolyData with one vertex
// cell per particle, or ImageData of nodes, as VTK >= 9.3 and ParaView >= 5.12 open it.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bedload/host_data.hpp"

namespace bedload {

/// The file is opened and closed by each call, so all frames so far are readable during a run and after a
/// kill. Arrays that did not change since the last frame (walls at rest, vertex cells) are not stored again.
class FrameFile {
 public:
  /// Points are stored in fp32, or unchanged with `double_points`. `deflate`:
  /// 0 (none) to 9.
  explicit FrameFile(std::filesystem::path path, bool double_points = false, int deflate = 0)
      : path_(std::move(path)), double_points_(double_points), deflate_(deflate) {}

  /// Appends a frame at `time` s; the first array of the store is the position. The first frame creates the
  /// file, unless it is `begun`. Arrays that other frames have and this one lacks, or the reverse, are NaN
  /// there, 0 if whole numbers. Throws FileError; on a full disk before the file is changed.
  void append(const HostStore& store, double time, bool begun = false) const;

  /// Throws FileError if there is a file whose arrays have other number types or components than this store.
  void expect(const HostStore& store) const;

  /// Times of the frames, s; none if there is no file.
  std::vector<double> times() const;

  /// One frame, as stored; the first array is the position. Throws FileError.
  HostStore read(std::size_t frame) const;

  /// Keeps the first `count` frames; removes the file and its .xdmf file if that is none.
  void keep(std::size_t count) const;

  /// Writes the .xdmf file for older programs: hyperslabs of this file.
  void write_xdmf() const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path xdmf_path() const { return std::filesystem::path(path_).replace_extension(".xdmf"); }

 private:
  std::filesystem::path path_;
  bool double_points_;
  int deflate_;
};

}  // namespace bedload
