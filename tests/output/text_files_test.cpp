// Text as editors and spreadsheets save it, by every reader of the files that a user brings.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "bedload/case/particle_file.hpp"
#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"
#include "src/motion/table.hpp"
#include "tests/case/support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {
namespace {

struct Reader {
  const char* file;
  std::string text;
  std::function<void(const std::filesystem::path&)> read;
};

const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const char* const kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const char* const kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid a\n";

std::vector<Reader> readers() {
  const auto mesh = [](const std::filesystem::path& path) {
    EXPECT_GE(read_triangles(path).triangles.size(), 1u);
  };
  return {{"case.toml", kCase,
           [](const std::filesystem::path& path) {
             std::vector<std::string> warnings;
             EXPECT_EQ(read_case(path, {}, warnings).title, "dam");
           }},
          {"grains.csv", "x,y,z\n1,2,3\n",
           [](const std::filesystem::path& path) { EXPECT_EQ(read_particles(path, -1).x.size(), 1u); }},
          {"motion.csv", "t,x\n0,0\n1,1\n",
           [](const std::filesystem::path& path) { EXPECT_EQ(read_motion_table(path).size(), 2u); }},
          {"a.stl", kStl, mesh},
          {"a.obj", kObj, mesh},
          {"a.ply", kPly, mesh}};
}

/// Of plain characters.
std::string in_utf16(const std::string& text, bool big) {
  std::string out = big ? "\xfe\xff" : "\xff\xfe";
  for (const char c : text) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

TEST(TextFiles, MayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  for (const Reader& reader : readers())
    for (const char* mark : {"", "\xef\xbb\xbf"}) {
      std::ofstream(folder / reader.file, std::ios::binary) << mark << reader.text;
      EXPECT_NO_THROW(reader.read(folder / reader.file)) << reader.file;
    }
}

TEST(TextFiles, AreRefusedInUtf16) {
  const TemporaryFolder folder;
  for (const Reader& reader : readers())
    for (const bool big : {false, true}) {
      const std::filesystem::path path = folder / reader.file;
      std::ofstream(path, std::ios::binary) << in_utf16(reader.text, big);
      try {
        reader.read(path);
        ADD_FAILURE() << reader.file << " was read";
      } catch (const FileError& error) {
        EXPECT_EQ(error.what(), path.string() + ": is in UTF-16; save it as UTF-8");
      }
    }
}

}  // namespace
}  // namespace bedload::test
