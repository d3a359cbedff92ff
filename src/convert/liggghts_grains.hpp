#pragma once
// Regions, particle templates and insertions of a LIGGGHTS script, as fills and inlets of grains.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bedload/core/vec.hpp"
#include "case_text.hpp"
#include "liggghts_command.hpp"

namespace bedload {

/// The region of create_box.
struct ScriptBox {
  bool present = false;
  Vec3d min, max;  ///< m
};

class ScriptGrains {
 public:
  struct Region {
    std::string kind;  ///< block, cylinder, sphere
    Vec3d min, max;    ///< of a block, m
    Vec3d a, b;        ///< ends of a cylinder's axis; centre of a sphere, m
    double radius = 0;
  };
  struct Template {
    int type = 1;
    double radius = 0, density = 2500;  ///< m, kg/m3
  };

  // Commands.
  void region(const Command& c);
  void particle_template(const Command& c);
  void distribution(const Command& c);
  void insert(const Command& c, const ScriptBox& box);

  const Region& region_named(const Command& c, const std::string& name) const;
  bool empty() const { return templates_.empty(); }
  /// Its grains are those of [grain].
  const Template& first() const { return templates_.begin()->second; }
  int type() const { return empty() ? 1 : first().type; }
  /// [[shape]], [[grain.fill]] and [[grain_inlet]].
  const std::string& shapes() const { return shapes_; }
  const std::string& fills() const { return fills_; }
  const std::string& inlets() const { return inlets_; }

 private:
  struct Distribution {
    std::vector<std::pair<std::string, double>> of;
    bool by_mass = true;
  };
  std::string sizes(const Distribution& d) const;
  void fill(const Command& c, const Distribution& d, const Vec3d& velocity);
  void inlet(const Command& c, const Distribution& d, const Vec3d& velocity, const ScriptBox& box);
  void volume(Section& s, const Region& r);

  std::map<std::string, Region> regions_;
  std::map<std::string, Template> templates_;
  std::map<std::string, Distribution> distributions_;
  std::string shapes_, fills_, inlets_;
  int region_shapes_ = 0;
};

}  // namespace bedload
