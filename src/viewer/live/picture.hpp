#pragma once
// Pictures of frames.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "frame.hpp"
#include "src/viewer/image.hpp"

namespace bedload {

enum class LiveSide { front, above, oblique };

/// "front", "above" or "perspective".
std::optional<LiveSide> live_side(const std::string& name);

/// Colours of the speeds 0, half of the top speed, and the top speed or more.
using SpeedColours = std::array<Colour, 3>;
inline constexpr SpeedColours kFluidColours{
    {{0.10f, 0.27f, 0.62f}, {0.16f, 0.62f, 0.76f}, {0.72f, 0.93f, 0.55f}}};
inline constexpr SpeedColours kGrainColours{
    {{0.98f, 0.83f, 0.52f}, {0.93f, 0.50f, 0.20f}, {0.62f, 0.08f, 0.10f}}};

struct PictureSize {
  int width = 960, height = 600;  ///< pixels
  int fine = 1;                   ///< each pixel is the mean of fine x fine samples
};

/// Draws the frames of one run. The view only ever widens, so that things stay in place.
class LivePicture {
 public:
  explicit LivePicture(Config config) : config_(std::move(config)) {}
  /// Flat views are no larger than the scene.
  Image draw(const LiveFrame& frame, LiveSide side, PictureSize size = {});

 private:
  void sample_walls();

  Config config_;
  bool sampled_ = false;
  Setup::Walls walls_;              ///< at t = 0
  double spacing_ = 0;              ///< of them, m
  std::optional<Vec3d> min_, max_;  ///< bounds of everything shown so far, m
};

}  // namespace bedload
