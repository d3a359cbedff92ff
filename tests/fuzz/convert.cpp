// Cases of other programs: those that begin with < are of DualSPHysics, all else is a script of LIGGGHTS.
// What they become must be TOML.

#include "src/convert/convert.hpp"
#include "bedload/case/section.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  const bool xml = size > 0 && data[0] == '<';
  const auto file = fuzz::file_of(xml ? "case.xml" : "in.case", {reinterpret_cast<const char*>(data), size});
  Conversion made;
  fuzz::attempt([&] {
    const auto folder = file.parent_path();
    made = xml ? from_dualsphysics(file, folder) : from_liggghts(file, folder);
  });
  for (const std::string& line : made.left) fuzz::check_sentence(line);
  parse_toml(made.toml, "made.toml");  // an error is a finding
  return 0;
}
