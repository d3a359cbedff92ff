// Triangles from files, through assimp.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"
#include "bedload/output/files.hpp"

namespace bedload {
namespace {

bool has_line(const std::string& text, const std::string& line) {
  return text.find("\n" + line + "\n") != text.npos || text.find("\n" + line + "\r") != text.npos;
}

/// What is missing in a file that has been cut off, which the importer tells badly or hangs on; empty if
/// nothing.
std::string missing_in(const std::filesystem::path& file, const std::string& kind) {
  const std::string text = read_file(file);
  if (text.empty()) return "is empty";
  if (kind == ".ply" && !text.starts_with("ply")) return "is no PLY file: it does not begin with ply";
  if (kind == ".ply" && !has_line(text.substr(0, 1 << 16), "end_header"))
    return "is cut off: its header has no end_header";
  if (kind != ".stl") return "";
  constexpr std::size_t head = 84, triangle = 50;  // of a binary file, bytes
  std::uint32_t count = 0;
  if (text.size() >= head) std::memcpy(&count, text.data() + head - sizeof count, sizeof count);
  if (text.size() >= head && text.size() == head + triangle * std::size_t(count)) return "";
  if (text.starts_with("solid"))
    return text.find("endsolid") == text.npos ? "is cut off: it has no endsolid" : "";
  if (text.size() < head) return "is cut off: it ends within its head";
  if (text.size() > head + triangle * std::size_t(count)) return "";  // with more behind, as some write it
  return fmt::format("is cut off: its {} triangles take {} bytes, and it has {}", count,
                     head + triangle * std::size_t(count), text.size());
}

/// Whether there are faces to triangulate. The importer takes damaged ones for sound and then stops the
/// program.
bool has_polygons(const aiScene& scene, const std::string& name) {
  bool any = false;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      any |= face.mNumIndices > 3;
      for (unsigned i = 0; i < face.mNumIndices; ++i)
        if (face.mIndices[i] >= mesh.mNumVertices)
          throw FileError(fmt::format("{}: face {} names vertex {}, the mesh has {} (from 0)", name, f,
                                      face.mIndices[i], mesh.mNumVertices));
    }
  }
  return any;
}

}  // namespace

TriangleSoup read_triangles(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (kind != ".stl" && kind != ".obj" && kind != ".ply")
    throw CaseError(name + ": must be an STL, OBJ or PLY file");
  if (!std::filesystem::is_regular_file(file)) throw FileError(name + ": cannot read: no such file");

  if (const std::string why = missing_in(file, kind); !why.empty()) throw FileError(name + ": " + why);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(name, 0);
  if (scene != nullptr && has_polygons(*scene, name))
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) throw FileError(name + ": cannot read: " + importer.GetErrorString());
  TriangleSoup soup;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const std::uint32_t first = std::uint32_t(soup.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& x = mesh.mVertices[v];
      soup.vertices.push_back({x.x, x.y, x.z});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      soup.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  if (soup.triangles.empty()) throw CaseError(name + ": holds no triangles");
  return soup;
}

std::shared_ptr<const TriangleMesh> read_mesh(const std::filesystem::path& file, const MeshOptions& options) {
  return std::make_shared<const TriangleMesh>(read_triangles(file), file.string(), options);
}

}  // namespace bedload
