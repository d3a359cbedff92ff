#pragma once
// Pictures of a run, as a film and as a sheet.

#include <filesystem>
#include <vector>

#include "src/viewer/animation.hpp"
#include "src/viewer/live/frame.hpp"
#include "src/viewer/live/picture.hpp"

namespace bedload {

class Film {
 public:
  /// Of a run until `end`, s.
  Film(const Config& config, double end);
  /// Draws the run if it is time.
  void after_step(Simulation& simulation);
  /// Writes film.png, an animated PNG, and picture.png with six of its frames; nothing without a frame.
  /// Throws FileError.
  void write(const std::filesystem::path& folder) const;

 private:
  std::string title_;
  double every_, due_ = 0;  ///< s
  FrameTaker taker_;
  LivePicture picture_;
  Animation animation_;
  int frames_ = 0;            ///< drawn
  std::vector<Image> sheet_;  ///< of picture.png
};

}  // namespace bedload
