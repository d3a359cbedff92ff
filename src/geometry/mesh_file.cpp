// Triangles from STL, OBJ and PLY files. Files come damaged and cut off: every count and index is checked
// before it is used, and errors are reported with their line.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"
#include "bedload/output/files.hpp"
#include "geometry/polygon.hpp"
#include "geometry/text.hpp"

namespace bedload {
namespace {

// -- STL -----------------------------------------------------------------------

TriangleSoup read_ascii_stl(const std::string& name, std::string_view bytes) {
  TriangleSoup soup;
  Text text(name, bytes);
  while (text.next_line()) {
    std::string word = lower(text.word()), before;
    if (word == "solid" || word == "endsolid") continue;  // and a name, whatever it holds
    for (; !word.empty(); before = word, word = lower(text.word())) {
      if (word == "vertex") soup.vertices.push_back(text.place());
      const bool ends = word == "endloop" || (word == "loop" && before == "end");
      if (ends && soup.vertices.size() % 3 != 0) text.fail("a facet must have three vertices");
    }
  }
  if (soup.vertices.size() % 3 != 0) text.fail("the last facet is cut off");
  for (std::uint32_t v = 0; v < soup.vertices.size(); v += 3) soup.triangles.push_back({v, v + 1, v + 2});
  return soup;
}

/// Whether `word`, in small letters, stands in a text, in whatever letters.
bool holds(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(),
                     [](unsigned char a, char b) { return char(std::tolower(a)) == b; }) != text.end();
}

/// Text begins with "solid", in any letters, perhaps behind blanks; so do some binary files, which are as
/// long as their count of triangles requires.
TriangleSoup read_stl(const std::string& name, std::string_view bytes) {
  constexpr std::size_t head = 84, triangle = 50, normal = 12;  // of a binary file, bytes
  std::uint32_t count = 0;
  if (bytes.size() >= head) std::memcpy(&count, bytes.data() + head - sizeof count, sizeof count);
  const std::size_t size = head + triangle * std::size_t(count);
  const std::string_view text = bytes.size() == size ? "" : without_mark(bytes, name),
                         begin = text.substr(std::min(text.find_first_not_of(" \t\v\f\r\n"), text.size()));
  if (lower(begin.substr(0, 5)) == "solid") {
    if (!holds(text, "endsolid")) throw FileError(name + ": is cut off: it has no endsolid");
    return read_ascii_stl(name, text);
  }
  if (bytes.size() < head) throw FileError(name + ": is cut off: it ends within its head");
  if (bytes.size() < size)  // some write more behind
    throw FileError(fmt::format("{}: is cut off: its {} triangles take {} bytes, and it has {}", name, count,
                                size, bytes.size()));
  TriangleSoup soup;
  for (std::uint32_t t = 0; t < count; ++t) {
    float corners[9];
    std::memcpy(corners, bytes.data() + head + triangle * t + normal, sizeof corners);
    for (const float* c = corners; c < corners + 9; c += 3) soup.vertices.push_back({c[0], c[1], c[2]});
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return soup;
}

// -- OBJ -----------------------------------------------------------------------

TriangleSoup read_obj(const std::string& name, std::string_view bytes) {
  TriangleSoup soup;
  Text text(name, bytes);
  std::vector<std::uint32_t> face;
  while (text.next_line()) {
    const std::string_view word = text.word();
    if (word == "v") soup.vertices.push_back(text.place());
    if (word != "f") continue;
    face.clear();
    const long there = long(soup.vertices.size());
    for (std::string_view w = text.word(); !w.empty(); w = text.word()) {
      const long v = text.number<long>(w);  // from 1, or backwards from -1
      if (v == 0 || v > there || v < -there)
        text.fail(fmt::format("a face names vertex {}; {} stand before it (from 1)", v, there));
      face.push_back(std::uint32_t(v > 0 ? v - 1 : there + v));
    }
    if (face.size() > kMostCorners)
      text.fail(fmt::format("a face has {} corners; at most {}", face.size(), kMostCorners));
    add_polygon(soup, face);
  }
  return soup;
}

// -- PLY -----------------------------------------------------------------------

struct PlyType {
  int bytes = 0;
  enum { whole, natural, real } kind = whole;
};

/// No bytes: an unknown type.
PlyType ply_type(std::string_view word) {
  for (const auto& [names, type] : {std::pair{std::pair{"char", "int8"}, PlyType{1, PlyType::whole}},
                                    {{"uchar", "uint8"}, {1, PlyType::natural}},
                                    {{"short", "int16"}, {2, PlyType::whole}},
                                    {{"ushort", "uint16"}, {2, PlyType::natural}},
                                    {{"int", "int32"}, {4, PlyType::whole}},
                                    {{"uint", "uint32"}, {4, PlyType::natural}},
                                    {{"float", "float32"}, {4, PlyType::real}},
                                    {{"double", "float64"}, {8, PlyType::real}}})
    if (word == names.first || word == names.second) return type;
  return {};
}

struct PlyProperty {
  std::string name;
  PlyType type, count;  ///< count.bytes > 0: a list
};
struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

/// The numbers behind the header, in text or binary.
class PlyNumbers {
 public:
  PlyNumbers(const std::string& name, const Text& text, bool ascii, bool swap)
      : name_(name), text_(text), rest_(text.rest()), ascii_(ascii), swap_(swap) {}

  double next(PlyType type) {
    if (ascii_) {
      std::string_view w = text_.word();
      while (w.empty() && text_.next_line()) w = text_.word();
      if (w.empty()) cut_off();
      return text_.number<double>(w);
    }
    if (rest_.size() < std::size_t(type.bytes)) cut_off();
    unsigned char b[8] = {};
    std::memcpy(b, rest_.data(), std::size_t(type.bytes));
    rest_.remove_prefix(std::size_t(type.bytes));
    if (swap_) std::reverse(b, b + type.bytes);
    if (type.kind == PlyType::real) return type.bytes == 4 ? double(as<float>(b)) : as<double>(b);
    if (type.kind == PlyType::natural)
      return type.bytes == 1 ? double(b[0]) : type.bytes == 2 ? as<std::uint16_t>(b) : as<std::uint32_t>(b);
    return type.bytes == 1   ? double(as<std::int8_t>(b))
           : type.bytes == 2 ? as<std::int16_t>(b)
                             : as<std::int32_t>(b);
  }
  [[noreturn]] void cut_off() const {
    throw FileError(name_ + ": is cut off: it ends before its last element");
  }

 private:
  template <class T>
  static T as(const unsigned char* b) {
    T value;
    std::memcpy(&value, b, sizeof value);
    return value;
  }

  const std::string& name_;
  Text text_;
  std::string_view rest_;
  bool ascii_, swap_;
};

TriangleSoup read_ply(const std::string& name, std::string_view bytes) {
  if (!bytes.starts_with("ply")) throw FileError(name + ": is no PLY file: it does not begin with ply");
  Text text(name, bytes);
  std::vector<PlyElement> elements;
  std::string format;
  for (std::string word;;) {
    if (!text.next_line()) throw FileError(name + ": is cut off: its header has no end_header");
    word = text.word();
    if (word == "end_header") break;
    if (word == "format") format = text.word();
    if (word == "element") {
      const std::string what(text.word());
      elements.push_back({what, text.number<std::size_t>(text.word()), {}});
    }
    if (word != "property") continue;
    if (elements.empty()) text.fail("a property stands before the first element");
    PlyProperty property;
    std::string type(text.word());
    if (type == "list") {
      property.count = ply_type(text.word());
      type = text.word();
      if (property.count.bytes == 0) type = "";
    }
    property.type = ply_type(type);
    property.name = text.word();
    if (property.type.bytes == 0) text.fail("a property must be of a type such as float, or list uchar int");
    elements.back().properties.push_back(property);
  }
  if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
    throw FileError(name + ": its format must be ascii, binary_little_endian or binary_big_endian");

  TriangleSoup soup;
  std::vector<std::vector<std::uint32_t>> faces;
  PlyNumbers numbers(name, text, format == "ascii",
                     (format == "binary_big_endian") != (std::endian::native == std::endian::big));
  for (const PlyElement& element : elements) {
    if (element.properties.empty()) continue;
    if (element.count > bytes.size()) numbers.cut_off();
    for (std::size_t k = 0; k < element.count; ++k) {
      Vec3d x;
      for (const PlyProperty& p : element.properties) {
        if (p.count.bytes == 0) {
          const double value = numbers.next(p.type);
          if (p.name == "x" || p.name == "y" || p.name == "z") x[p.name[0] - 'x'] = value;
          continue;
        }
        const double n = numbers.next(p.count);
        const bool corners =
            element.name == "face" && (p.name == "vertex_indices" || p.name == "vertex_index");
        if (!(n >= 0) || n != std::floor(n) || (corners && n > kMostCorners))
          throw FileError(fmt::format("{}: {} {} has a list of {} numbers; {}", name, element.name, k, n,
                                      corners ? fmt::format("at most {} corners", kMostCorners) : "damaged"));
        if (n > double(bytes.size())) numbers.cut_off();
        if (corners) faces.emplace_back();
        for (std::size_t l = 0; l < std::size_t(n); ++l) {
          const double v = numbers.next(p.type);
          if (!corners) continue;
          if (!(v >= 0 && v < 4294967295.0))
            throw FileError(fmt::format("{}: face {} names vertex {}", name, k, v));
          faces.back().push_back(std::uint32_t(v));
        }
      }
      if (element.name == "vertex") soup.vertices.push_back(x);
    }
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const std::uint32_t v : faces[f])
      if (v >= soup.vertices.size())
        throw FileError(fmt::format("{}: face {} names vertex {}, the mesh has {} (from 0)", name, f, v,
                                    soup.vertices.size()));
    add_polygon(soup, faces[f]);
  }
  return soup;
}

}  // namespace

TriangleSoup read_triangles(const std::filesystem::path& file) {
  const std::string name = file.string(), kind = lower(file.extension().string());
  if (kind != ".stl" && kind != ".obj" && kind != ".ply")
    throw CaseError(name + ": must be an STL, OBJ or PLY file");
  if (!std::filesystem::is_regular_file(file)) throw FileError(name + ": cannot read: no such file");
  const std::string bytes = read_file(file);
  if (bytes.empty()) throw FileError(name + ": is empty");
  TriangleSoup soup = kind == ".stl"   ? read_stl(name, bytes)
                      : kind == ".obj" ? read_obj(name, without_mark(bytes, name))
                                       : read_ply(name, without_mark(bytes, name));
  for (std::size_t v = 0; v < soup.vertices.size(); ++v)
    if (const Vec3d& x = soup.vertices[v]; !(norm2(x) < 1e200))  // volumes and distances stay finite
      throw FileError(fmt::format("{}: vertex {} (from 0) is not within 1e100 of the origin", name, v));
  if (soup.triangles.empty()) throw CaseError(name + ": holds no triangles");
  return soup;
}

std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file, const MeshOptions& options) {
  return std::make_shared<const TriangleMesh>(read_triangles(file), file.string(), options);
}

}  // namespace bedload
