// Shapes of clumps.

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "bedload/geometry/body.hpp"
#include "bedload/geometry/clump.hpp"
#include "bedload/geometry/shape.hpp"
#include "resolve.hpp"
#include "shortened.hpp"

namespace bedload {
namespace {

/// What a fill of clumps has no use for.
void check_fill(const GrainFill& fill, const std::string& path, const Value& root) {
  const auto refuse = [&](const char* key, bool given) {
    if (given)
      reject(root, path + key, nearest_value(root, path + key).text(),
             "must be left out where the fill has a clump");
  };
  refuse(".file", !fill.file.empty());
  refuse(".every", !fill.every.empty());
  refuse(".replaces_fluid", fill.replaces_fluid);
  refuse(".rigid", fill.rigid.present);
}

}  // namespace

void resolve_clumps(Config& c, const Value& root) {
  constexpr std::size_t kMost = 256;
  std::set<std::string> names;
  std::string all;
  for (std::size_t k = 0; k < c.grain.clumps.size(); ++k) {
    ClumpConfig& clump = c.grain.clumps[k];
    clump.dropped.clear();
    const std::string path = fmt::format("clump.{}", k), key = path + ".spheres";
    if (clump.name.empty()) reject(root, path + ".name", "\"\"", "must not be empty");
    if (!names.insert(clump.name).second)
      reject(root, path + ".name", fmt::format("\"{}\"", clump.name), "must differ from other clumps'");
    all += (all.empty() ? "" : ", ") + clump.name;
    if ((!clump.spheres.empty()) + (!clump.file.empty()) + (!clump.solid.empty()) != 1)
      missing(root, key, "list of [x, y, z, r], or file, or shape: one of them");
    if (!clump.file.empty()) {
      const auto file = std::filesystem::absolute(std::filesystem::path(c.file).parent_path() / clump.file);
      try {
        clump.spheres = read_spheres(file.lexically_normal());
      } catch (const CaseError& error) {
        reject(root, path + ".file", fmt::format("\"{}\"", clump.file),
               fmt::format("holds no spheres: {}", shortened(error.what(), 600)));
      }
      clump.file.clear();
    }
    Solid solid;
    if (!clump.solid.empty()) {
      if (clump.count == 0) missing(root, path + ".count", "number of spheres in the shape");
      solid = shape_named(c, clump.solid, root, path + ".shape", "must be the name of a [[shape]]");
      clump.spheres = inner_spheres(*solid.shape, std::size_t(clump.count));
      clump.solid.clear(), clump.count = 0;
    }
    if (clump.spheres.empty() || clump.spheres.size() > kMost)
      reject(root, key, fmt::format("{} spheres", clump.spheres.size()),
             fmt::format("must be 1 to {}", kMost));
    for (const ClumpSphere& s : clump.spheres)
      if (!(s[3] > 0)) reject(root, key, fmt::format("[.., r = {}]", s[3]), "must have radii > 0");
    clump.shape = clump_shape(clump.spheres);
    if (solid.shape) {
      const double d = clump.spheres[0][3] / clump.shape.spheres[0][3];
      clump.filled = std::numbers::pi / 6 * d * d * d / solid_moments(*solid.shape).volume;
    }
  }
  const auto check_use = [&](const auto& of, const std::string& path) {
    if (!names.contains(of.clump))
      reject(root, path + ".clump", fmt::format("\"{}\"", of.clump),
             "must name a clump; this case has " + (all.empty() ? "none" : all));
    if (!of.orientation.empty() && of.orientation.size() != 3)
      reject(root, path + ".orientation", nearest_value(root, path + ".orientation").text(),
             "must be three angles in deg, [x, y, z]");
  };
  for (std::size_t i = 0; i < c.grain.fills.size(); ++i) {
    const GrainFill& fill = c.grain.fills[i];
    if (fill.clump.empty()) continue;
    const std::string path = fmt::format("grain.fill.{}", i);
    check_use(fill, path);
    check_fill(fill, path, root);
  }
  for (std::size_t i = 0; i < c.grain_inlets.size(); ++i) {
    const GrainInletConfig& inlet = c.grain_inlets[i];
    if (inlet.clump.empty()) continue;
    check_use(inlet, fmt::format("grain_inlet.{}", i));
    for (ClumpConfig& clump : c.grain.clumps)
      if (clump.name == inlet.clump &&
          std::count(clump.dropped.begin(), clump.dropped.end(), inlet.material) == 0)
        clump.dropped.push_back(inlet.material);
  }
  for (GrainInletConfig& inlet : c.grain_inlets)
    inlet.number = c.grain.material_of_dropped(inlet.clump, inlet.material);
}

}  // namespace bedload
