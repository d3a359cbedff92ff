#include "render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bedload {
namespace {

constexpr float kThinFluid = 0.25f, kThickFluid = 0.7f;  // opacity of the fluid in front of a grain
constexpr double kThick = 5;                             // diameters of fluid in between
constexpr float kFluidOverWalls = 0.85f;
constexpr double kHazeOfAWall = 0.13;  // optical depth through one wall
constexpr float kMostHaze = 0.35f;     // in front of particles
constexpr float kMostFog = 0.45f;      // on the farthest particles

/// The nearest particle of one kind at each pixel.
struct Layer {
  std::vector<float> depth;
  std::vector<Colour> colour;

  explicit Layer(std::size_t pixels)
      : depth(pixels, std::numeric_limits<float>::infinity()), colour(pixels) {}
};

struct Haze {
  std::vector<float> amount;
  std::vector<Colour> colour;  // times the amount

  explicit Haze(std::size_t pixels) : amount(pixels, 0), colour(pixels) {}
  void add(std::size_t pixel, float weight, const Colour& c) {
    amount[pixel] += weight;
    Colour& sum = colour[pixel];
    sum = {sum.r + weight * c.r, sum.g + weight * c.g, sum.b + weight * c.b};
  }
  Colour over(const Colour& behind, std::size_t pixel, float most) const {
    const float n = amount[pixel];
    if (n == 0) return behind;
    const Colour& sum = colour[pixel];
    return mix(behind, {sum.r / n, sum.g / n, sum.b / n}, most * (1 - std::exp(-n / most)));
  }
};

class Renderer {
 public:
  Renderer(const Scene& scene, const View& view, int width, int height, Colour background, int fine)
      : view_(view),
        fine_(fine),
        width_(fine * width),
        height_(fine * height),
        background_(background),
        grains_(pixels()),
        fluid_(pixels()),
        front_(pixels()),
        behind_(pixels()) {
    view_.scale *= fine, view_.x0 *= fine, view_.y0 *= fine;
    if (!scene.fluid.empty()) thick_ = float(2 * kThick * scene.fluid.front().radius);
    measure_depth(scene);
    for (const Sphere& s : scene.grains) add_solid(grains_, s);
    for (const Sphere& s : scene.fluid) add_solid(fluid_, s);
    for (const Sphere& s : scene.walls) add_haze(s);
  }

  Image picture() const {
    Image out(width_ / fine_, height_ / fine_, background_);
    const float weight = 1.0f / float(fine_ * fine_);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) {
        Colour sum;
        for (int n = 0; n < fine_ * fine_; ++n) {
          const Colour c = colour_at(std::size_t(y * fine_ + n / fine_) * width_ + x * fine_ + n % fine_);
          sum = {sum.r + c.r, sum.g + c.g, sum.b + c.b};
        }
        out.set(x, y, {weight * sum.r, weight * sum.g, weight * sum.b});
      }
    return out;
  }

 private:
  std::size_t pixels() const { return std::size_t(width_) * height_; }

  void measure_depth(const Scene& scene) {
    for (const auto* spheres : {&scene.grains, &scene.fluid})
      for (const Sphere& s : *spheres) {
        const double depth = view_.place(s.x).depth;
        near_ = std::min(near_, depth);
        far_ = std::max(far_, depth);
      }
  }

  /// Calls put(pixel, u, v) for the pixels of a disc, which u and v cross from -1 to 1.
  template <class Put>
  void for_disc(const Spot& at, double radius, Put put) const {
    const int x0 = std::max(0, int(std::ceil(at.x - radius))), x1 = std::min(width_ - 1, int(at.x + radius));
    const int y0 = std::max(0, int(std::ceil(at.y - radius))), y1 = std::min(height_ - 1, int(at.y + radius));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double u = (x - at.x) / radius, v = (y - at.y) / radius;
        if (u * u + v * v <= 1) put(std::size_t(y) * width_ + x, u, v);
      }
  }

  void add_solid(Layer& layer, const Sphere& s) const {
    const Spot at = view_.place(s.x);
    const float fog = far_ > near_ ? kMostFog * float((at.depth - near_) / (far_ - near_)) : 0;
    const Colour colour = mix(s.colour, background_, fog);
    for_disc(at, std::max(0.75, s.radius * at.scale), [&](std::size_t pixel, double u, double v) {
      const double w = std::sqrt(1 - u * u - v * v);
      const auto depth = float(at.depth - w * s.radius);
      if (depth >= layer.depth[pixel]) return;
      const double light = std::max(0.0, -0.42 * u - 0.52 * v + 0.74 * w);  // from the upper left, in front
      const auto shade = float(0.38 + 0.66 * light);
      layer.depth[pixel] = depth;
      layer.colour[pixel] = {shade * colour.r, shade * colour.g, shade * colour.b};
    });
  }

  /// Spread over twice its spacing, so that neighbours merge, with the total weight of one cell.
  void add_haze(const Sphere& s) {
    const Spot at = view_.place(s.x);
    const double spread = std::max(1.0, 2 * s.radius * at.scale),
                 area = 4 * s.radius * s.radius * at.scale * at.scale;
    const double peak = kHazeOfAWall * area / (0.33333 * 3.14159265 * spread * spread);
    for_disc(at, spread, [&](std::size_t pixel, double u, double v) {
      const double q = 1 - u * u - v * v;
      Haze& haze = at.depth < std::min(grains_.depth[pixel], fluid_.depth[pixel]) ? front_ : behind_;
      haze.add(pixel, float(peak * q * q), s.colour);
    });
  }

  Colour colour_at(std::size_t pixel) const {
    const bool grain = std::isfinite(grains_.depth[pixel]), fluid = std::isfinite(fluid_.depth[pixel]);
    Colour c = behind_.over(background_, pixel, 1);
    if (grain) c = grains_.colour[pixel];
    const float between = grains_.depth[pixel] - fluid_.depth[pixel];
    if (fluid && between > 0) c = mix(c, fluid_.colour[pixel], grain ? veil(between) : kFluidOverWalls);
    return front_.over(c, pixel, grain || fluid ? kMostHaze : 1);
  }

  /// The weight of fluid in the colour of a grain `distance` behind it.
  float veil(float distance) const {
    return kThinFluid + (kThickFluid - kThinFluid) * (1 - std::exp(-distance / thick_));
  }

  View view_;
  int fine_, width_, height_;
  Colour background_;
  Layer grains_, fluid_;
  Haze front_, behind_;
  float thick_ = 1;  // m
  double near_ = std::numeric_limits<double>::infinity(), far_ = -near_;
};

Vec3d corner_of(const Scene& scene, int n) {
  return {n & 1 ? scene.max.x : scene.min.x, n & 2 ? scene.max.y : scene.min.y,
          n & 4 ? scene.max.z : scene.min.z};
}

}  // namespace

Spot View::place(const Vec3d& x) const {
  const Vec3d r = x - centre;
  const double away = -dot(r, toward);
  const double here = distance > 0 ? scale * distance / std::max(1e-3 * distance, distance + away) : scale;
  return {x0 + here * dot(r, right), y0 - here * dot(r, up), away, here};
}

void fit(View& view, const Scene& scene, int width, int height) {
  view.scale = 1, view.x0 = view.y0 = 0;
  double x[2] = {1e300, -1e300}, y[2] = {1e300, -1e300};
  for (int n = 0; n < 8; ++n) {
    const Spot at = view.place(corner_of(scene, n));
    x[0] = std::min(x[0], at.x), x[1] = std::max(x[1], at.x);
    y[0] = std::min(y[0], at.y), y[1] = std::max(y[1], at.y);
  }
  view.scale = std::min(width / std::max(1e-12, x[1] - x[0]), height / std::max(1e-12, y[1] - y[0]));
  view.x0 = 0.5 * width - 0.5 * view.scale * (x[0] + x[1]);
  view.y0 = 0.5 * height - 0.5 * view.scale * (y[0] + y[1]);
}

Image render(const Scene& scene, const View& view, int width, int height, Colour background, int fine) {
  return Renderer(scene, view, width, height, background, fine).picture();
}

}  // namespace bedload
