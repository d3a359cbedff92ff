// Triangles from files, through assimp.

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"

namespace bedload {

TriangleSoup read_triangles(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (kind != ".stl" && kind != ".obj" && kind != ".ply")
    throw CaseError(name + ": must be an STL, OBJ or PLY file");
  if (!std::filesystem::is_regular_file(file)) throw FileError(name + ": cannot read: no such file");

  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate);
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
