#pragma once
// An image in memory with lines and text, written as PNG.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

/// Red, green and blue in sRGB, 0 to 1.
struct Colour {
  float r = 0, g = 0, b = 0;
};

/// `weight` of `b` over `a`.
inline Colour mix(const Colour& a, const Colour& b, float weight) {
  return {a.r + weight * (b.r - a.r), a.g + weight * (b.g - a.g), a.b + weight * (b.b - a.b)};
}

/// Pixels in rows from the top; drawing outside is ignored.
class Image {
 public:
  Image(int width, int height, Colour background)
      : width_(width), height_(height), pixels_(std::size_t(width) * height, background) {}

  int width() const { return width_; }
  int height() const { return height_; }
  const Colour& at(int x, int y) const { return pixels_[std::size_t(y) * width_ + x]; }
  void set(int x, int y, const Colour& colour) {
    if (x >= 0 && y >= 0 && x < width_ && y < height_) pixels_[std::size_t(y) * width_ + x] = colour;
  }
  /// Copies `part` with its upper left corner to (x, y).
  void put(const Image& part, int x, int y);
  /// A straight line one pixel wide.
  void line(double x0, double y0, double x1, double y1, const Colour& colour);
  /// A filled circle.
  void dot(double x, double y, double radius, const Colour& colour);
  /// Text with its upper left corner at (x, y); each dot of a glyph is `scale` pixels wide.
  void text(int x, int y, std::string_view text, const Colour& colour, int scale = 2);

  /// The bytes of a PNG file, compressed quickly or well.
  std::string png(bool quickly = true) const;
  /// Throws FileError.
  void write_png(const std::filesystem::path& path) const;

 private:
  int width_, height_;
  std::vector<Colour> pixels_;
};

/// 1, 2 or 5 times a power of ten, at or above `value`; 0 for what is not above 0.
double rounded_up(double value);

/// A round distance between tick marks, about a fifth of `length`.
double mark_distance(double length);

/// Size of a text in pixels.
int text_width(std::string_view text, int scale = 2);
int text_height(int scale = 2);

}  // namespace bedload
