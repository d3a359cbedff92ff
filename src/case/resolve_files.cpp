// Properties of particles from files that a case needs.

#include <fmt/format.h>

#include <algorithm>

#include "bedload/case/particle_file.hpp"
#include "bedload/output/output.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

/// The particles in a file, as used by the rest of a case.
struct Extent {
  Vec3d min{}, max{};           // around the centres, m
  double d_min = 0, d_max = 0;  // m; 0: the file has no diameters
  std::int64_t count = 0;
};

Extent extent_of(const ParticleList& list) {
  Extent e{.min = list.x.front(), .max = list.x.front(), .count = std::int64_t(list.x.size())};
  for (const Vec3d& x : list.x)
    for (int k = 0; k < 3; ++k) {
      e.min[k] = std::min(e.min[k], x[k]);
      e.max[k] = std::max(e.max[k], x[k]);
    }
  if (list.d.empty()) return e;
  const auto [smallest, largest] = std::minmax_element(list.d.begin(), list.d.end());
  e.d_min = *smallest, e.d_max = *largest;
  return e;
}

/// The same as a checkpoint keeps it; the file had diameters if the fill was given no sizes.
Extent extent_in(const std::filesystem::path& checkpoint, const std::string& fill) {
  const auto numbers = checkpoint_setup(checkpoint);
  const auto number = [&](const std::string& name) {
    const auto found = numbers.find(name);
    return found == numbers.end() ? 0.0 : found->second;
  };
  Extent e{.d_min = number("grain.d_min"), .d_max = number("grain.d_max")};
  for (int k = 0; k < 3; ++k) {
    e.min[k] = number(fmt::format("{}.min[{}]", fill, k));
    e.max[k] = number(fmt::format("{}.max[{}]", fill, k));
  }
  e.count = std::int64_t(number(fill + ".count"));
  const Value then = parse_toml(checkpoint_case(checkpoint), checkpoint.string());
  if (nearest_value(then, fill).find("sizes")) e.d_min = e.d_max = 0;
  return e;
}

/// Makes the name of a fill's file absolute; it counts from the folder of the case.
void find_file(const Config& c, std::string& file, const Value& root, const std::string& fill, bool needed) {
  namespace fs = std::filesystem;
  const std::string given = file;
  const fs::path path = fs::absolute(fs::path(c.file).parent_path() / file).lexically_normal();
  const auto fail = [&](const std::string& must) {
    reject(root, fill + ".file", fmt::format("\"{}\"", given), must);
  };
  if (path.extension() != ".csv" && !has_frames(path)) fail("must end in .csv or .vtkhdf");
  if (std::error_code unknown; needed && !fs::is_regular_file(path, unknown))
    fail(fmt::format("must be a file; there is no {}", path.string()));
  file = path.string();
}

[[noreturn]] void not_beside(const Value& root, const std::string& key, const std::string& file) {
  reject(root, key, nearest_value(root, key).text(), fmt::format("must be left out; {} holds its own", file));
}

}  // namespace

void resolve_listed_fluid(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  for (std::size_t i = 0; i < c.fluid.fills.size(); ++i) {
    FluidFill& fill = c.fluid.fills[i];
    if (fill.file.empty()) continue;
    const std::string path = fmt::format("fluid.fill.{}", i);
    find_file(c, fill.file, root, path, checkpoint.empty());
    if (!checkpoint.empty()) {
      const Extent extent = extent_in(checkpoint, path);
      fill.min = extent.min, fill.max = extent.max;
      continue;
    }
    const ParticleList list = read_particles(fill.file, fill.step, "fluid");
    if (!list.v.empty() && fill.velocity != FluidFill().velocity)
      not_beside(root, path + ".velocity", fill.file);
    const Extent extent = extent_of(list);
    const double half = c.fluid.dx / 2;
    fill.min = extent.min - Vec3d{half, half, half};
    fill.max = extent.max + Vec3d{half, half, half};
  }
}

bool resolve_listed_grains(Config& c, std::size_t index, const Value& root,
                           const std::filesystem::path& checkpoint) {
  GrainFill& fill = c.grain.fills[index];
  const std::string path = fmt::format("grain.fill.{}", index);
  find_file(c, fill.file, root, path, checkpoint.empty());
  Extent extent;
  if (checkpoint.empty()) {
    const ParticleList list = listed_grains(fill, c.domain);
    if (!list.volume.empty())
      throw CaseError(fill.file + ": has a column volume, which is for fluid; grains take d or radius");
    if (!list.v.empty() && fill.velocity != Vec3d{}) not_beside(root, path + ".velocity", fill.file);
    if (!list.omega.empty() && fill.spin != Vec3d{}) not_beside(root, path + ".spin", fill.file);
    if (!list.d.empty() && !fill.sizes.empty()) not_beside(root, path + ".sizes", fill.file);
    extent = extent_of(list);
  } else {
    extent = extent_in(checkpoint, path);
  }
  fill.min = extent.min, fill.max = extent.max, fill.count = extent.count;
  if (extent.d_min == 0) return false;
  c.grain.d_min = std::min(c.grain.d_min, extent.d_min);
  c.grain.d_max = std::max(c.grain.d_max, extent.d_max);
  return true;
}

}  // namespace bedload
