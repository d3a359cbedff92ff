#pragma once
// Frames of one store in one file: VTKHDF 2.0, temporal PolyData with one vertex
// cell per particle, as VTK >= 9.3 and ParaView >= 5.12 open it.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bedload/host_data.hpp"

namespace bedload {

/// The file is opened for each call and closed after it, so a run that is killed
/// leaves every frame so far readable, and viewers may look on. What did not
/// change since the last frame (walls at rest, vertex cells) is not stored again.
class FrameFile {
 public:
  /// Points are stored in fp32, or as they come with `double_points`. `deflate`:
  /// 0 (none) to 9.
  explicit FrameFile(std::filesystem::path path, bool double_points = false, int deflate = 0)
      : path_(std::move(path)), double_points_(double_points), deflate_(deflate) {}

  /// Adds one frame at `time` s; the first array of the store is the position. The first frame makes the
  /// file, unless it is `begun`. Throws FileError; on a full disk before the file is touched.
  void append(const HostStore& store, double time, bool begun = false) const;

  /// Throws FileError if there is a file with other arrays than frames of this store have.
  void expect(const HostStore& store) const;

  /// Times of the frames, s; none if there is no file.
  std::vector<double> times() const;

  /// One frame, as stored; the first array is the position. Throws FileError.
  HostStore read(std::size_t frame) const;

  /// Drops all frames but the first `count`; with none the file goes, and its side-car.
  void keep(std::size_t count) const;

  /// Writes the .xdmf side-car for older readers: hyperslabs of this file.
  void write_xdmf() const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path xdmf_path() const { return std::filesystem::path(path_).replace_extension(".xdmf"); }

 private:
  std::filesystem::path path_;
  bool double_points_;
  int deflate_;
};

}  // namespace bedload
