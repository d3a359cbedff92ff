// Meshes. The first byte chooses the kind of file and whether it is repaired; the file is the rest.

#include "bedload/geometry/mesh.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  if (size == 0) return -1;
  constexpr const char* names[] = {"mesh.stl", "mesh.obj", "mesh.ply"};
  const auto file = fuzz::file_of(names[data[0] % 3], {reinterpret_cast<const char*>(data) + 1, size - 1});
  MeshOptions options;
  options.repair = data[0] / 3 % 2 == 1;
  fuzz::attempt([&] { read_mesh(file, options); });
  return 0;
}
