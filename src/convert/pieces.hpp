#pragma once
// What a case of DualSPHysics draws, in order, and the walls and fills that it becomes. There, what is drawn
// later replaces what is there; here, walls win over fluid, and differences of shapes do the rest.

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

enum class Drawn { fluid, bound, nothing };
enum class Form { box, cylinder, sphere, mesh };

/// One thing drawn.
struct Piece {
  Drawn as = Drawn::fluid;
  int mk = 0;
  int line = 0;
  Form form = Form::box;
  Vec3d min, max;                   ///< box: corners, before `turn`; otherwise what it extends over, m
  std::array<bool, 6> faces{};      ///< box drawn by its faces, "x-" .. "z+"; none: solid
  bool surface = false;             ///< only its surface is drawn: a vessel if there is fluid in it
  Vec3d a, b;                       ///< cylinder: ends of the axis; sphere: centre, m
  double radius = 0;                ///< m
  std::string file;                 ///< mesh, relative to the case
  double scale = 1;                 ///< mesh
  Vec3d turn_axis{0, 0, 1}, shift;  ///< mesh and turned boxes: turned about an axis through 0, then moved, m
  double turn_angle = 0;            ///< degrees
  bool flooded = false;             ///< a region filled from a seed, up to the walls around it
  Vec3d seed;

  /// The least and largest corner of what it extends over, m.
  std::pair<Vec3d, Vec3d> extent() const;
  /// Turned by `turn` about the origin, then moved by `shift`.
  void turn_and_move(const Quat<double>& turn, const Vec3d& shift);

  bool by_faces() const {
    for (const bool face : faces)
      if (face) return true;
    return false;
  }
};

/// Where pieces are, and how finely.
struct Place {
  double dp = 0;       ///< m
  bool two_d = false;  ///< flow in x and z
  Vec3d min, max;      ///< domain, m
};

/// Keys of a wall body that come from elsewhere, such as its motion, by mk.
using BodyKeys = std::map<int, std::string>;

/// [[shape]], [[wall.body]] and [[fluid.fill]] of the pieces. `keys` stand behind each body of an mk; `fills`
/// are lines of each fill of an mk. Remarks go to `left`, with `file`.
struct PiecesText {
  std::string shapes, bodies, fills;
};
PiecesText text_of(const std::vector<Piece>& pieces, const Place& place, const BodyKeys& keys,
                   const std::map<int, std::string>& fill_keys, const std::set<int>& closed,
                   const std::string& file, std::vector<std::string>& left);

/// The name of the first wall body of an mk.
std::string body_name(int mk);

}  // namespace bedload
