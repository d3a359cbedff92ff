#pragma once
// A picture in memory, with lines and text, and its way to a PNG file.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

/// Shares of red, green and blue, 0 to 1, as a screen takes them.
struct Colour {
  float r = 0, g = 0, b = 0;
};

/// `weight` of `b` over `a`.
inline Colour mix(const Colour& a, const Colour& b, float weight) {
  return {a.r + weight * (b.r - a.r), a.g + weight * (b.g - a.g), a.b + weight * (b.b - a.b)};
}

/// Pixels in rows from the top; places outside are passed over.
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
  /// A straight line one pixel wide.
  void line(double x0, double y0, double x1, double y1, const Colour& colour);
  /// A filled circle.
  void dot(double x, double y, double radius, const Colour& colour);
  /// Text with its upper left corner at (x, y); each dot of a letter is `scale` pixels
  /// wide.
  void text(int x, int y, std::string_view text, const Colour& colour, int scale = 2);

  /// The bytes of a PNG file, compressed quickly.
  std::string png() const;
  /// Throws FileError.
  void write_png(const std::filesystem::path& path) const;

 private:
  int width_, height_;
  std::vector<Colour> pixels_;
};

/// A round distance of marks, about a fifth of `length`.
double mark_distance(double length);

/// Size of a text in pixels.
int text_width(std::string_view text, int scale = 2);
int text_height(int scale = 2);

}  // namespace bedload
