#include "src/viewer/animation.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cstring>
#include <string>
#include <vector>

namespace bedload::testing {
namespace {

constexpr Colour kWhite{1, 1, 1}, kRed{1, 0, 0}, kBlack{};

struct Chunk {
  std::string name, data;
};

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = at; k < at + 4; ++k) value = value << 8 | std::uint8_t(bytes[k]);
  return value;
}

/// The chunks of a PNG file, whose checksums are right.
std::vector<Chunk> chunks_of(const std::string& png) {
  std::vector<Chunk> out;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t length = number_at(png, at);
    const std::string checked = png.substr(at + 4, 4 + length);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size())),
              number_at(png, at + 8 + length));
    out.push_back({checked.substr(0, 4), checked.substr(4)});
    at += 12 + length;
  }
  return out;
}

std::string number(std::uint32_t value) {
  return {char(value >> 24), char(value >> 16 & 0xff), char(value >> 8 & 0xff), char(value & 0xff)};
}

std::string file_of(const std::vector<Chunk>& chunks) {
  std::string out = "\x89PNG\r\n\x1a\n";
  for (const auto& [name, data] : chunks) {
    const std::string checked = name + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
    out += number(std::uint32_t(data.size())) + checked + number(std::uint32_t(sum));
  }
  return out;
}

/// Red, green and blue of every pixel, as other programs read the file.
std::vector<int> pixels_of(const std::string& file) {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&png, file.data(), file.size())) << png.message;
  png.format = PNG_FORMAT_RGB;
  std::vector<png_byte> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr)) << png.message;
  return {pixels.begin(), pixels.end()};
}

TEST(Animation, ShowsItsImagesOneAfterTheOther) {
  Animation animation(100);
  animation.add(Image(2, 1, kWhite));
  Image second(2, 1, kBlack);
  second.set(1, 0, kRed);
  animation.add(second);
  const std::vector<Chunk> chunks = chunks_of(animation.png());

  std::string names, then;
  std::uint32_t serial = 0;
  for (const Chunk& chunk : chunks) {
    if (chunk.name == "fdAT") then += chunk.data.substr(4);
    if (chunk.name == "fcTL" || chunk.name == "fdAT") {
      EXPECT_EQ(number_at(chunk.data, 0), serial++);
    }
    if (chunk.name == "fcTL") {
      EXPECT_EQ(number_at(chunk.data, 20), 100u << 16 | 1000u);  // ms
    }
    if (chunk.name == "acTL") {
      EXPECT_EQ(number_at(chunk.data, 0), 2u);
    }
    if (chunk.name.starts_with("I") || chunk.name.ends_with("TL") || chunk.name == "fdAT")
      names += chunk.name + " ";
  }
  EXPECT_EQ(names, "IHDR acTL fcTL IDAT fcTL fdAT IEND ");
  EXPECT_EQ(pixels_of(animation.png()), (std::vector<int>{255, 255, 255, 255, 255, 255}));
  EXPECT_EQ(pixels_of(file_of({chunks[0], {"IDAT", then}, chunks.back()})),
            (std::vector<int>{0, 0, 0, 255, 0, 0}));
}

}  // namespace
}  // namespace bedload::testing
