#pragma once
// Images one after the other in one file.

#include <filesystem>
#include <string>
#include <vector>

#include "src/viewer/image.hpp"

namespace bedload {

/// An animated PNG: browsers play it, other programs show its first image.
class Animation {
 public:
  /// Milliseconds that each image is shown.
  explicit Animation(int interval) : interval_(interval) {}
  /// All images have the same size.
  void add(const Image& image) { images_.push_back(image.png(false)); }
  /// The bytes of the file; of at least one image.
  std::string png() const;
  /// Throws FileError.
  void write(const std::filesystem::path& path) const;

 private:
  int interval_;
  std::vector<std::string> images_;  ///< each as a PNG file
};

}  // namespace bedload
