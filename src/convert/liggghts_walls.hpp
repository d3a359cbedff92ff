#pragma once
// Materials, meshes and walls of a LIGGGHTS script, as shapes and wall bodies.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bedload/core/vec.hpp"
#include "liggghts_command.hpp"
#include "liggghts_grains.hpp"

namespace bedload {

/// fix property/global, by type of material.
class ScriptMaterials {
 public:
  void read(const Command& c);
  /// Of a type, or of a pair of types, from 1.
  std::optional<double> value(const std::string& name, int i, int j) const;

 private:
  std::map<std::string, std::vector<double>> values_;
};

class ScriptWalls {
 public:
  // Commands; the file of a mesh becomes relative to the folder of the case.
  void mesh(const Command& c, const std::filesystem::path& script, const std::filesystem::path& folder);
  void move_mesh(const Command& c);
  void wall(const Command& c, const ScriptBox& box);

  /// [[shape]], [[wall.body]] and [[probe]] of all that is a wall.
  struct Text {
    std::string shapes, bodies, probes;
  };
  Text text(const ScriptMaterials& materials, int grain_type, const std::string& file,
            std::vector<std::string>& left) const;

 private:
  struct Mesh {
    std::string file;
    int type = 1;
    double scale = 1;
    Vec3d move, turn_axis{0, 0, 1};
    double turn_angle = 0;
    Vec3d surface_velocity;
    std::string motion;
  };
  struct Primitive {
    std::string keys;
    int type = 1;
  };

  std::map<std::string, Mesh> meshes_;
  std::set<std::string> walled_;       ///< meshes that are walls
  std::vector<std::string> stressed_;  ///< meshes on which forces are measured
  std::vector<Primitive> primitives_;
  std::string shapes_;
};

}  // namespace bedload
