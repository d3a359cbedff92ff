#include "src/viewer/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "bedload/core/error.hpp"
#include "font.hpp"

namespace bedload {

void Image::put(const Image& part, int x, int y) {
  for (int row = 0; row < part.height(); ++row)
    for (int column = 0; column < part.width(); ++column) set(x + column, y + row, part.at(column, row));
}

void Image::line(double x0, double y0, double x1, double y1, const Colour& colour) {
  const int steps = std::max(1, int(std::ceil(std::max(std::abs(x1 - x0), std::abs(y1 - y0)))));
  for (int n = 0; n <= steps; ++n) {
    const double s = double(n) / steps;
    set(int(std::lround(x0 + s * (x1 - x0))), int(std::lround(y0 + s * (y1 - y0))), colour);
  }
}

void Image::dot(double x, double y, double radius, const Colour& colour) {
  for (int j = int(std::floor(y - radius)); j <= int(std::ceil(y + radius)); ++j)
    for (int i = int(std::floor(x - radius)); i <= int(std::ceil(x + radius)); ++i)
      if ((i - x) * (i - x) + (j - y) * (j - y) <= radius * radius) set(i, j, colour);
}

void Image::text(int x, int y, std::string_view text, const Colour& colour, int scale) {
  for (const char character : text) {
    for (int row = 0; row < kGlyphHeight * scale; ++row)
      for (int column = 0; column < kGlyphWidth * scale; ++column)
        if (glyph_dot(character, column / scale, row / scale)) set(x + column, y + row, colour);
    x += (kGlyphWidth + 1) * scale;
  }
}

namespace {

/// An image in the form of libpng.
struct PngImage {
  png_image head;
  std::vector<png_byte> bytes;

  PngImage(int width, int height, const std::vector<Colour>& pixels) {
    bytes.reserve(3 * pixels.size());
    for (const Colour& c : pixels)
      for (const float part : {c.r, c.g, c.b})
        bytes.push_back(png_byte(std::lround(255 * std::clamp(part, 0.0f, 1.0f))));
    std::memset(&head, 0, sizeof head);
    head.version = PNG_IMAGE_VERSION;
    head.width = png_uint_32(width);
    head.height = png_uint_32(height);
    head.format = PNG_FORMAT_RGB;
  }
};

}  // namespace

std::string Image::png(bool quickly) const {
  PngImage image(width_, height_, pixels_);
  if (quickly) image.head.flags = PNG_IMAGE_FLAG_FAST;
  std::string out;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image.head);
  out.resize(size);
  if (!png_image_write_to_memory(&image.head, out.data(), &size, 0, image.bytes.data(), 0, nullptr))
    throw std::runtime_error(image.head.message);
  out.resize(size);
  return out;
}

void Image::write_png(const std::filesystem::path& path) const {
  PngImage image(width_, height_, pixels_);
  if (!png_image_write_to_file(&image.head, path.c_str(), 0, image.bytes.data(), 0, nullptr))
    throw FileError(fmt::format("{}: cannot write: {}", path.string(), image.head.message));
}

double rounded_up(double value) {
  if (!(value > 0)) return 0;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double round : {1.0, 2.0, 5.0})
    if (value <= round * power) return round * power;
  return 10 * power;
}

double mark_distance(double length) { return rounded_up(length / 5); }

int text_width(std::string_view text, int scale) { return int(text.size()) * (kGlyphWidth + 1) * scale; }
int text_height(int scale) { return kGlyphHeight * scale; }

}  // namespace bedload
