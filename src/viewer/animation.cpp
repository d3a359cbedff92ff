#include "animation.hpp"

#include <zlib.h>

#include <cstdint>
#include <string_view>

#include "bedload/output/files.hpp"

namespace bedload {
namespace {

// A PNG file is a signature and chunks: length, name of four letters, data, checksum of name and data;
// numbers are big-endian. An animation has a count of images (acTL) ahead of the data and, ahead of each
// image, its size and time (fcTL). Data of the images after the first are in chunks fdAT, which begin with a
// number. W3C, PNG specification, third edition, 2025.
constexpr std::size_t kSignature = 8, kAround = 12;  // bytes; the latter of a chunk beside its data

std::string number(std::uint32_t value, int bytes = 4) {
  std::string out;
  while (bytes-- > 0) out += char(value >> (8 * bytes) & 0xffu);
  return out;
}

std::uint32_t number_at(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | std::uint8_t(c);
  return value;
}

std::string chunk(const std::string& name, const std::string& data) {
  const std::string checked = name + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
  return number(std::uint32_t(data.size())) + checked + number(std::uint32_t(sum));
}

/// f(name, data) with each chunk of a PNG file.
template <class F>
void each_chunk(std::string_view png, F&& f) {
  png.remove_prefix(kSignature);
  while (png.size() >= kAround) {
    const std::size_t length = number_at(png);
    f(std::string(png.substr(4, 4)), std::string(png.substr(8, length)));
    png.remove_prefix(kAround + length);
  }
}

}  // namespace

std::string Animation::png() const {
  std::string out = images_.front().substr(0, kSignature);
  std::uint32_t serial = 0;
  for (const std::string& image : images_) {
    const bool first = &image == &images_.front();
    each_chunk(image, [&](const std::string& name, const std::string& data) {
      if (name == "IHDR") {
        const std::string size = data.substr(0, 8), place(8, '\0'), replace(2, '\0');
        if (first)
          out += chunk(name, data) + chunk("acTL", number(std::uint32_t(images_.size())) + number(0));
        out += chunk("fcTL", number(serial++) + size + place + number(std::uint32_t(interval_), 2) +
                                 number(1000, 2) + replace);
      } else if (name == "IDAT") {
        out += first ? chunk(name, data) : chunk("fdAT", number(serial++) + data);
      } else if (first &&
                 name != "IEND") {  // such as the colour space; ahead of the data, before or after fcTL
        out += chunk(name, data);
      }
    });
  }
  return out + chunk("IEND", "");
}

void Animation::write(const std::filesystem::path& path) const { write_file(path, png()); }

}  // namespace bedload
