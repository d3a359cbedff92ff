#include "picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/simulation.hpp"
#include "render.hpp"

namespace bedload {
namespace {

constexpr Colour kInk{0.15f, 0.17f, 0.2f}, kFrame{0.72f, 0.74f, 0.77f}, kFluid{0.2f, 0.55f, 0.95f};
constexpr Colour kGrain{0.9f, 0.68f, 0.36f}, kSmall{1.0f, 0.85f, 0.5f}, kLarge{0.5f, 0.22f, 0.1f};

void extend_bounds(Scene& scene, const std::vector<Sphere>& spheres) {
  for (const Sphere& s : spheres)
    for (int k = 0; k < 3; ++k) {
      scene.min[k] = std::min(scene.min[k], s.x[k] - s.radius);
      scene.max[k] = std::max(scene.max[k], s.x[k] + s.radius);
    }
}

Scene scene_of(const Config& config, const Setup& setup, const Setup::Walls& walls, double spacing) {
  Scene scene;
  for (const Vec3d& x : setup.fluid.x) scene.fluid.push_back({x, kFluidRadius * config.fluid.dx, kFluid});
  const double d_min = config.grain.d_min, range = config.grain.d_max - d_min;
  for (std::size_t i = 0; i < setup.grains.x.size(); ++i) {
    const double r = setup.grains.radius[i];
    const auto weight = float(range > 1e-9 * d_min ? (2 * r - d_min) / range : 0);
    scene.grains.push_back(
        {setup.grains.x[i], r, range > 1e-9 * d_min ? mix(kSmall, kLarge, weight) : kGrain});
  }
  for (std::size_t w = 0; w < walls.x.size(); ++w) {
    const bool inlet = walls.body[w] >= config.wall.bodies.size();
    const bool moves = inlet || config.wall.bodies[walls.body[w]].motion.kind != MotionKind::fixed;
    scene.walls.push_back({walls.x[w], 0.5 * spacing, moves ? kMoving : kWall});
  }
  scene.min = Vec3d{1e300, 1e300, 1e300}, scene.max = -1.0 * scene.min;
  for (const auto* spheres : {&scene.fluid, &scene.grains, &scene.walls}) extend_bounds(scene, *spheres);
  return scene;
}

Vec3d axis(int k) { return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; }

/// Millimetres, or metres for what is larger than one.
struct Lengths {
  double factor;
  const char* unit;
  explicit Lengths(double largest) : factor(largest < 1 ? 1000 : 1), unit(largest < 1 ? "mm" : "m") {}
};

class Picture {
 public:
  Picture(const Config& config, const Scene& scene)
      : config_(config),
        scene_(scene),
        axes_(config.gravity),
        size_(scene.max - scene.min),
        lengths_(std::max({size_.x, size_.y, size_.z})),
        image_(kWidth, kHeight, kPaper) {}

  Image draw(const Counts& n) {
    title(n);
    const double wide = size_[axes_.along], high = size_[axes_.up] + size_[axes_.into];
    const bool strip = wide > 2.5 * high;  // then the flat views use the full width
    const int left = kMargin + 80, top = 140, gap = 100, bottom = 60;
    const double space_x = strip ? kWidth - left - kMargin : 0.44 * kWidth - left;
    const double space_y = (strip ? 0.5 * kHeight : kHeight) - top - bottom - gap;
    const double scale = std::min(space_x / wide, space_y / high);

    const int across = std::max(1, int(std::lround(scale * wide)));
    int y = top;
    y += flat(axes_.front(), axes_.up, left, y, across, scale, "From the front") + gap;
    y += flat(axes_.above(), axes_.into, left, y, across, scale, "From above") + bottom;

    if (strip)
      perspective(kMargin, y, kWidth - 2 * kMargin, kHeight - y - kMargin);
    else
      perspective(left + across + kMargin, top, kWidth - left - across - 2 * kMargin,
                  kHeight - top - kMargin);
    return image_;
  }

 private:
  static constexpr int kWidth = 1800, kHeight = 1100, kMargin = 40;

  void title(const Counts& n) {
    image_.text(kMargin, 24, config_.title.empty() ? "Case" : config_.title, kInk, 3);
    int x = kMargin;
    const auto entry = [&](const Colour& colour, const std::string& text) {
      image_.dot(x + 7, 75, 7, colour);
      image_.text(x + 22, 68, text, kInk);
      x += 22 + text_width(text) + 36;
    };
    const auto diameter = [](double d) { return fmt::format("{:.4g} mm", 1e3 * d); };
    const double smallest = config_.grain.d_min, largest = config_.grain.d_max;
    if (n.fluid > 0)
      entry(kFluid, fmt::format("Fluid: {} particles, dx {:.4g} mm", n.fluid, 1e3 * config_.fluid.dx));
    if (n.grains > 0 && largest > smallest * (1 + 1e-9)) {
      entry(kSmall, fmt::format("{} grains from {}", n.grains, diameter(smallest)));
      entry(kLarge, "to " + diameter(largest));
    } else if (n.grains > 0) {
      entry(kGrain, fmt::format("{} grain{} of {}", n.grains, n.grains > 1 ? "s" : "", diameter(largest)));
    }
    bool fixed = false, moving = false;
    for (const WallBody& body : config_.wall.bodies)
      (body.motion.kind == MotionKind::fixed ? fixed : moving) = true;
    if (fixed) entry(kWall, "Walls");
    if (moving) entry(kMoving, "Moving walls");
  }

  /// One flat view with its axes; returns its height.
  int flat(const Sides& sides, int upward, int x0, int y0, int width, double scale, const char* name) {
    const int height = std::max(1, int(std::lround(scale * size_[upward])));
    View view{sides.right, sides.up, sides.toward, 0.5 * (scene_.min + scene_.max)};
    fit(view, scene_, width, height);
    image_.put(render(scene_, view, width, height, kPaper), x0, y0);
    for (const int x : {x0 - 1, x0 + width}) image_.line(x, y0 - 1, x, y0 + height, kFrame);
    for (const int y : {y0 - 1, y0 + height}) image_.line(x0 - 1, y, x0 + width, y, kFrame);
    image_.text(std::max(x0, x0 + width - text_width(name)), y0 - text_height() - 8, name, kInk);
    marks(view, axes_.along, x0, y0, height, width, false);
    marks(view, upward, x0, y0, height, width, true);
    return height;
  }

  void marks(const View& view, int k, int x0, int y0, int height, int width, bool upright) {
    const double step = mark_distance(size_[k]);
    const double space = upright ? text_height() + 6 : text_width("-0000 mm");
    int every = 1;
    while (every * step * view.scale < space && every < 20) ++every;
    const auto letter = fmt::format("{} [{}]", "xyz"[k], lengths_.unit);
    for (double n = std::ceil(scene_.min[k] / (every * step)); n * every * step <= scene_.max[k]; ++n) {
      const double value = n * every * step;
      Vec3d x = scene_.min;
      x[k] = value;
      const Spot at = view.place(x);
      const std::string text = fmt::format("{:.6g}", value * lengths_.factor + 0.0);
      if (upright) {
        const int y = y0 + int(std::lround(at.y));
        image_.line(x0 - 7, y, x0 - 1, y, kInk);
        image_.text(x0 - 12 - text_width(text), y - 7, text, kInk);
      } else {
        const int px = x0 + int(std::lround(at.x));
        image_.line(px, y0 + height, px, y0 + height + 6, kInk);
        image_.text(px - text_width(text) / 2, y0 + height + 11, text, kInk);
      }
    }
    if (upright)
      image_.text(x0 - 12 - text_width(letter), y0 - text_height() - 12, letter, kInk);
    else
      image_.text(x0 + width - text_width(letter), y0 + height + 33, letter, kInk);
  }

  void perspective(int x0, int y0, int width, int height) {
    const Sides sides = axes_.oblique();
    View view{sides.right, sides.up, sides.toward, 0.5 * (scene_.min + scene_.max), 2.2 * norm(size_)};
    fit(view, scene_, width, height);
    image_.put(render(scene_, view, width, height, kPaper), x0, y0);
    const auto length = [&](double l) { return fmt::format("{:.3g}", l * lengths_.factor); };
    const auto name = fmt::format("Spans {} x {} x {} {}", length(size_.x), length(size_.y), length(size_.z),
                                  lengths_.unit);
    image_.text(x0 + width - text_width(name), y0 - text_height() - 8, name, kInk);
  }

  const Config& config_;
  const Scene& scene_;
  Axes axes_;
  Vec3d size_;
  Lengths lengths_;
  Image image_;
};

}  // namespace

Axes::Axes(const Vec3d& gravity) {
  if (norm(gravity) == 0) return;
  for (int k = 0; k < 3; ++k)
    if (std::abs(gravity[k]) > std::abs(gravity[up])) up = k;
  along = up == 0 ? 1 : 0;
  into = 3 - up - along;
  sign = gravity[up] > 0 ? -1 : 1;
}

Sides Axes::front() const {
  const Vec3d right = axis(along), upward = sign * axis(up);
  return {right, upward, cross(right, upward)};
}

Sides Axes::above() const {
  const Sides f = front();
  return {f.right, cross(f.up, f.right), f.up};
}

Sides Axes::oblique() const {
  const Sides f = front();
  Vec3d toward = 0.55 * f.right + 0.8 * f.toward + 0.5 * f.up;
  toward = toward / norm(toward);
  Vec3d right = cross(f.up, toward);
  right = right / norm(right);
  return {right, cross(toward, right), toward};
}

double surface_spacing(const Config& config, double at_least) {
  double largest = norm(config.domain.max - config.domain.min);
  for (const WallBody& body : config.wall.bodies)
    if (body.shape != WallShape::plane) largest = std::max(largest, norm(body.max - body.min));
  return std::max(at_least, largest / 400);
}

Setup::Walls wall_surfaces(const Config& config, double at_least) {
  const double spacing = surface_spacing(config, at_least);
  Setup::Walls walls;
  const auto places = [&](std::size_t index) {
    try {
      return sample_body(config.wall.bodies[index], spacing, spacing, config.domain);
    } catch (const CaseError& error) {
      throw KeyError(fmt::format("wall.body.{}", index), error.what());
    }
  };
  for (std::size_t index = 0; index < config.wall.bodies.size(); ++index)
    for (const Vec3d& x : places(index)) {
      walls.x.push_back(x);
      walls.body.push_back(std::uint32_t(index));
    }
  for (std::size_t i = 0; i < config.inlets.size(); ++i)
    for (const Vec3d& x : orifice_layer(config.inlets[i], spacing, config.domain).points) {
      walls.x.push_back(x);
      walls.body.push_back(std::uint32_t(config.wall.bodies.size() + i));
    }
  return walls;
}

Image picture_of(const Config& config, const Setup& setup) {
  const Scene scene = scene_of(config, setup, wall_surfaces(config, 0), surface_spacing(config, 0));
  const Counts counts{std::int64_t(setup.fluid.x.size()), 0, std::int64_t(setup.grains.x.size())};
  return Picture(config, scene).draw(counts);
}

}  // namespace bedload
