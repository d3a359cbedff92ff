// Meshes and height maps. The first byte chooses the kind of file, whether it is repaired and whether it is a
// floor; the file is the rest.

#include "bedload/geometry/mesh.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  if (size == 0) return -1;
  constexpr const char* names[] = {"mesh.stl", "mesh.obj", "mesh.ply", "map.asc"};
  const bool floor = data[0] % 8 >= 6;
  const char* name = names[!floor ? data[0] % 8 % 3 : data[0] % 8 == 6 ? 3 : 1];
  const auto file = fuzz::file_of(name, {reinterpret_cast<const char*>(data) + 1, size - 1});
  MeshOptions options;
  options.repair = data[0] % 8 >= 3;
  fuzz::attempt(
      [&] { floor ? read_terrain(file, {.thickness = 0, .below = 1}, options) : read_mesh(file, options); });
  return 0;
}
