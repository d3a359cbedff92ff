#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

constexpr int kWide = 900, kHigh = 700, kLeft = 150, kRight = 40, kTop = 110, kBottom = 90;
constexpr Colour kPaper{1, 1, 1}, kInk{0.15f, 0.17f, 0.2f}, kGrid{0.88f, 0.89f, 0.9f};

struct Axis {
  double low = 1e300, high = -1e300;
  double from = 0, to = 0;  ///< pixels

  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  void widen() {
    if (!(low <= high)) low = 0, high = 1;
    const double margin = high > low ? 0.05 * (high - low) : std::max(std::abs(low), 1e-300);
    low -= margin, high += margin;
  }
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

void draw_one(Image& image, int left, const Plot& plot) {
  Axis x, y;
  const auto each = [](const Curve& curve, const auto& f) {
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      if (std::isfinite(curve.x[k]) && std::isfinite(curve.y[k])) f(curve.x[k], curve.y[k]);
  };
  for (const Curve& curve : plot.curves) each(curve, [&](double u, double v) { x.include(u), y.include(v); });
  x.widen(), y.widen();
  x.from = left + kLeft, x.to = left + kWide - kRight;
  y.from = kHigh - kBottom, y.to = kTop;

  image.text(left + kLeft, 20, plot.title, kInk);
  const double step_x = mark_distance(x.high - x.low), step_y = mark_distance(y.high - y.low);
  const auto number = [](double value, double step) {
    return fmt::format("{:.4g}", std::abs(value) < 1e-9 * step ? 0.0 : value);
  };
  for (double mark = std::ceil(x.low / step_x) * step_x; mark <= x.high; mark += step_x) {
    image.line(x.at(mark), y.from, x.at(mark), y.to, kGrid);
    const std::string text = number(mark, step_x);
    image.text(int(x.at(mark)) - text_width(text) / 2, int(y.from) + 10, text, kInk);
  }
  for (double mark = std::ceil(y.low / step_y) * step_y; mark <= y.high; mark += step_y) {
    image.line(x.from, y.at(mark), x.to, y.at(mark), kGrid);
    const std::string text = number(mark, step_y);
    image.text(int(x.from) - 12 - text_width(text), int(y.at(mark)) - text_height() / 2, text, kInk);
  }
  image.line(x.from, y.from, x.to, y.from, kInk);
  image.line(x.from, y.from, x.from, y.to, kInk);
  image.text(int(x.to) - text_width(plot.x_name), int(y.from) + 45, plot.x_name, kInk);
  image.text(left + 20, kTop - 30, plot.y_name, kInk);

  int place = left + kLeft;
  for (const Curve& curve : plot.curves) {
    const int middle = 50 + text_height() / 2;
    if (curve.line)
      for (int thick = 0; thick < 3; ++thick)
        image.line(place, middle + thick, place + 24, middle + thick, curve.colour);
    else
      image.dot(place + 12, middle, 5, curve.colour);
    image.text(place + 32, 50, curve.name, kInk);
    place += 32 + text_width(curve.name) + 30;

    double before_x = std::nan(""), before_y = std::nan("");
    each(curve, [&](double u, double v) {
      const double px = x.at(u), py = y.at(v);
      if (!curve.line)
        image.dot(px, py, 5, curve.colour);
      else if (std::isfinite(before_x))
        for (int thick = -1; thick <= 1; ++thick)
          image.line(before_x, before_y + thick, px, py + thick, curve.colour);
      before_x = px, before_y = py;
    });
  }
}

}  // namespace

Image draw(const std::vector<Plot>& plots) {
  Image image(kWide * int(plots.size()), kHigh, kPaper);
  for (std::size_t k = 0; k < plots.size(); ++k) draw_one(image, kWide * int(k), plots[k]);
  return image;
}

}  // namespace bedload
