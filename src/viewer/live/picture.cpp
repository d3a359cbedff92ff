#include "picture.hpp"

#include <algorithm>
#include <cmath>

#include "src/viewer/picture.hpp"
#include "src/viewer/render.hpp"

namespace bedload {
namespace {

constexpr int kMargin = 8, kLeast = 160;  // pixels
constexpr double kAcross = 150;           // wall particles along the largest wall

Colour colour_of(const SpeedColours& colours, double fraction) {
  const auto f = float(std::clamp(fraction, 0.0, 1.0));
  return f < 0.5f ? mix(colours[0], colours[1], 2 * f) : mix(colours[1], colours[2], 2 * f - 1);
}

class Bounds {
 public:
  Bounds(const DomainConfig& domain) {
    const Vec3d beyond = 0.03 * (domain.max - domain.min);
    min_ = domain.min - beyond, max_ = domain.max + beyond;
  }
  bool contain(const Vec3d& x) const {
    for (int k = 0; k < 3; ++k)
      if (x[k] < min_[k] || x[k] > max_[k]) return false;
    return true;
  }

 private:
  Vec3d min_, max_;
};

}  // namespace

std::optional<LiveSide> live_side(const std::string& name) {
  if (name == "front") return LiveSide::front;
  if (name == "above") return LiveSide::above;
  if (name == "perspective") return LiveSide::oblique;
  return {};
}

void LivePicture::sample_walls() {
  double largest = 0;
  for (const WallBody& body : config_.wall.bodies)
    largest = std::max(largest, norm(body.shape == WallShape::plane ? config_.domain.max - config_.domain.min
                                                                    : body.max - body.min));
  spacing_ = surface_spacing(config_, largest / kAcross);
  walls_ = wall_surfaces(config_, spacing_);
  sampled_ = true;
}

Image LivePicture::draw(const LiveFrame& frame, LiveSide side, PictureSize picture) {
  if (!sampled_) sample_walls();
  const Bounds bounds(config_.domain);
  Scene scene;
  const auto add = [&](std::vector<Sphere>& to, const Sphere& s) {
    if (!bounds.contain(s.x)) return;
    to.push_back(s);
    if (!min_) min_ = max_ = s.x;
    for (int k = 0; k < 3; ++k) {
      (*min_)[k] = std::min((*min_)[k], s.x[k] - s.radius);
      (*max_)[k] = std::max((*max_)[k], s.x[k] + s.radius);
    }
  };
  const double speed = frame.top_speed > 0 ? 1 / frame.top_speed : 0;
  const double fluid_radius = kFluidRadius * config_.fluid.dx * frame.fluid.enlarged;
  for (std::size_t k = 0; k < frame.fluid.x.size(); ++k)
    add(scene.fluid,
        {frame.fluid.x[k], fluid_radius, colour_of(kFluidColours, speed * frame.fluid.speed[k])});
  for (std::size_t k = 0; k < frame.grains.x.size(); ++k)
    add(scene.grains,
        {frame.grains.x[k], frame.grains.radius[k], colour_of(kGrainColours, speed * frame.grains.speed[k])});
  for (std::size_t k = 0; k < walls_.x.size(); ++k) {
    const std::uint32_t body = walls_.body[k];
    if (body < frame.removed.size() && frame.removed[body]) continue;
    const bool moves = body < frame.bodies.size() && frame.bodies[body];
    const bool inlet = body >= config_.wall.bodies.size();
    add(scene.walls, {moves ? frame.bodies[body]->place(walls_.x[k]) : walls_.x[k], 0.5 * spacing_,
                      moves || inlet ? kMoving : kWall});
  }
  if (!min_) return Image(picture.width, picture.height, kPaper);
  scene.min = *min_, scene.max = *max_;

  const Axes axes(config_.gravity);
  const Sides sides = side == LiveSide::front   ? axes.front()
                      : side == LiveSide::above ? axes.above()
                                                : axes.oblique();
  const Vec3d size = scene.max - scene.min;
  View view{sides.right, sides.up, sides.toward, 0.5 * (scene.min + scene.max),
            side == LiveSide::oblique ? 2.2 * norm(size) : 0};
  int width = picture.width, height = picture.height;
  fit(view, scene, width - 2 * kMargin, height - 2 * kMargin);
  if (side != LiveSide::oblique) {
    const auto pixels = [&](const Vec3d& along, int most) {
      double extent = 0;
      for (int k = 0; k < 3; ++k) extent += std::abs(along[k]) * size[k];
      return std::clamp(int(std::ceil(view.scale * extent)) + 2 * kMargin, kLeast, most);
    };
    width = pixels(sides.right, width), height = pixels(sides.up, height);
  }
  fit(view, scene, width - 2 * kMargin, height - 2 * kMargin);
  view.x0 += kMargin, view.y0 += kMargin;
  return render(scene, view, width, height, kPaper, picture.fine);
}

}  // namespace bedload
