// Tables of particles and of motions.

#include "src/motion/table.hpp"
#include "bedload/case/particle_file.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  const auto file = fuzz::file_of("table.csv", {reinterpret_cast<const char*>(data), size});
  fuzz::attempt([&] { read_particles(file, -1); });
  fuzz::attempt([&] { read_motion_table(file); });
  return 0;
}
