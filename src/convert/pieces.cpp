#include "pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "case_text.hpp"

namespace bedload {
namespace {

constexpr const char* kFaceNames[6] = {"x-", "x+", "y-", "y+", "z-", "z+"};
constexpr double kPlateDepth = 4;  ///< dp: thickness of a plate that is drawn as a single layer
constexpr double kSame = 1e-6;     ///< dp: lengths closer than this are equal

class Writer {
 public:
  Writer(const std::vector<Piece>& pieces, const Place& place, const BodyKeys& keys,
         const std::map<int, std::string>& fill_keys, const std::set<int>& closed, const std::string& file,
         std::vector<std::string>& left)
      : pieces_(pieces),
        place_(place),
        keys_(keys),
        fill_keys_(fill_keys),
        closed_(closed),
        file_(file),
        left_(left) {}

  PiecesText write() {
    std::vector<int> done;
    for (const Piece& p : pieces_) {
      if (p.as != Drawn::bound || std::find(done.begin(), done.end(), p.mk) != done.end()) continue;
      done.push_back(p.mk);
      body(p.mk);
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (pieces_[k].as == Drawn::fluid) fill(k);
    return std::move(out_);
  }

 private:
  double near() const { return kSame * place_.dp; }
  bool flat(const Piece& p, int axis) const {
    return p.max[axis] - p.min[axis] <= near() && !(place_.two_d && axis == 1);
  }
  bool inside(const Piece& p, const Vec3d& x) const {
    const auto [lo, hi] = p.extent();
    for (int k = 0; k < 3; ++k)
      if (!(place_.two_d && k == 1) && (x[k] < lo[k] - near() || x[k] > hi[k] + near())) return false;
    return true;
  }
  bool covers(const Piece& outer, const Piece& inner) const {
    const auto [lo, hi] = inner.extent();
    return inside(outer, lo) && inside(outer, hi);
  }
  /// Whether they share more than a layer of particles.
  bool overlap(const Piece& p, const Piece& q) const {
    const auto [a, b] = p.extent();
    const auto [c, d] = q.extent();
    for (int k = 0; k < 3; ++k)
      if (!(place_.two_d && k == 1) && std::min(b[k], d[k]) - std::max(a[k], c[k]) < place_.dp / 2)
        return false;
    return true;
  }
  static Vec3d middle(const Piece& p) {
    const auto [lo, hi] = p.extent();
    return 0.5 * (lo + hi);
  }
  /// Of a fluid or of the seed of one.
  bool holds_fluid(const Piece& p) const {
    return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& q) {
      return q.as == Drawn::fluid && inside(p, q.flooded ? q.seed : middle(q));
    });
  }
  void remark(const Piece& p, const std::string& text) {
    left_.push_back(fmt::format("{}:{}: {}", file_, p.line, text));
  }

  /// Corners; in a plane flow as wide as the domain.
  Vec3d low(const Piece& p) const { return place_.two_d ? Vec3d{p.min.x, place_.min.y, p.min.z} : p.min; }
  Vec3d high(const Piece& p) const { return place_.two_d ? Vec3d{p.max.x, place_.max.y, p.max.z} : p.max; }

  std::string new_name(const std::string& stem) {
    int& used = names_[stem];
    return ++used == 1 ? stem : fmt::format("{}_{}", stem, used);
  }

  /// Writes the [[shape]] of a piece; returns its name.
  std::string shape(const Piece& p, const std::string& stem) {
    const std::string name = new_name(stem);
    Section s("[[shape]]");
    s.set("name", name);
    switch (p.form) {
      case Form::box:
        s.set("kind", "box").set("min", low(p)).set("max", high(p));
        break;
      case Form::cylinder:
        s.set("kind", "cylinder").set("a", p.a).set("b", p.b).set("radius", p.radius);
        break;
      case Form::sphere:
        s.set("kind", "sphere").set("centre", p.a).set("radius", p.radius);
        break;
      case Form::mesh:
        s.set("kind", "mesh").set("file", p.file);
        if (p.scale != 1) s.set("scale", p.scale);
        break;
    }
    if (p.turn_angle != 0) s.set("turn_axis", p.turn_axis).set("turn_angle", p.turn_angle);
    if (norm(p.shift) > 0) s.set("translate", p.shift);
    out_.shapes += s.text() + '\n';
    return name;
  }

  std::string combined(const char* kind, const std::vector<std::string>& of, const std::string& stem) {
    const std::string name = new_name(stem);
    out_.shapes += Section("[[shape]]").set("name", name).set("kind", kind).set("of", of).text() + '\n';
    return name;
  }

  /// A piece that is drawn later and takes away from this one.
  std::vector<const Piece*> later(std::size_t from, auto takes) const {
    std::vector<const Piece*> out;
    for (std::size_t k = from + 1; k < pieces_.size(); ++k) {
      const Piece& q = pieces_[k];
      if (q.by_faces() || q.surface || q.flooded || !overlap(pieces_[from], q) || !takes(q)) continue;
      const bool wall_there = std::any_of(pieces_.begin() + k + 1, pieces_.end(), [&](const Piece& w) {
        return w.as == Drawn::bound && covers(w, q) && !holds_fluid(w);
      });
      if (!wall_there) out.push_back(&q);
    }
    return out;
  }

  std::string shape_without(const Piece& p, const std::vector<const Piece*>& others,
                            const std::string& stem) {
    if (others.empty()) return shape(p, stem);
    std::vector<std::string> of{shape(p, stem + "_whole")};
    for (const Piece* q : others)
      of.push_back(shape(*q, q->as == Drawn::nothing ? "opening" : fmt::format("fluid_{}", q->mk)));
    return combined("difference", of, stem);
  }

  // Walls.

  void write_body(int mk, Section body) { out_.bodies += body.text() + extra(mk) + '\n'; }
  std::string extra(int mk) const {
    const auto found = keys_.find(mk);
    return found == keys_.end() ? "" : found->second;
  }

  void body(int mk) {
    std::vector<std::string> solids;
    const Piece* box = nullptr;  // the only solid, if it needs no shape
    int count = 0;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const Piece& p = pieces_[k];
      if (p.as != Drawn::bound || p.mk != mk) continue;
      if (p.form == Form::box && p.by_faces() && !is_sheet(p) && holds_fluid(p)) {
        tank(p);
        continue;
      }
      if (p.form == Form::box && is_sheet(p)) {
        sheet(p);
        continue;
      }
      ++count;
      const auto takes = [&](const Piece& q) { return q.as != Drawn::bound; };
      const auto others = p.by_faces() || p.surface ? std::vector<const Piece*>{} : later(k, takes);
      if (count == 1 && p.form == Form::box && p.turn_angle == 0 && others.empty() && only_solid(mk)) {
        box = &p;
        continue;
      }
      if (p.surface && holds_fluid(p)) {
        const std::string within = shape(p, body_name(mk) + "_inside");
        inside_[k] = within;
        solids.push_back(combined("hollow", {within}, body_name(mk)));
      } else {
        solids.push_back(shape_without(p, others, body_name(mk)));
      }
    }
    if (box) {
      write_body(mk, Section("[[wall.body]]")
                         .set("name", new_body(mk))
                         .set("shape", "box")
                         .set("min", low(*box))
                         .set("max", high(*box)));
    } else if (!solids.empty()) {
      const std::string name =
          solids.size() == 1 ? solids[0] : combined("union", solids, body_name(mk) + "_all");
      write_body(mk, Section("[[wall.body]]").set("name", new_body(mk)).set("shape", name));
    }
  }

  std::string new_body(int mk) {
    int& used = bodies_[mk];
    return ++used == 1 ? body_name(mk) : fmt::format("{}_{}", body_name(mk), used);
  }

  bool only_solid(int mk) const {
    return std::count_if(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
             return p.as == Drawn::bound && p.mk == mk &&
                    !(p.form == Form::box && (is_sheet(p) || (p.by_faces() && holds_fluid(p))));
           }) == 1;
  }

  /// A single layer: of no thickness, or one face of a box.
  bool is_sheet(const Piece& p) const {
    if (p.form != Form::box || closed_.contains(p.mk)) return false;
    if (flat(p, 0) || flat(p, 1) || flat(p, 2)) return true;
    int faces = 0;
    for (int f = 0; f < 6; ++f) faces += p.faces[f] && !(place_.two_d && f / 2 == 1);
    return faces == 1;
  }

  void tank(const Piece& p) {
    Section s("[[wall.body]]");
    s.set("name", new_body(p.mk)).set("shape", "tank").set("min", low(p)).set("max", high(p));
    std::vector<std::string> names;
    for (int f = 0; f < 6; ++f)
      if (p.faces[f] && !(place_.two_d && f / 2 == 1)) names.push_back(kFaceNames[f]);
    if (names.size() < 6) s.set("faces", names);
    write_body(p.mk, s);
  }

  /// A plate behind the sheet, seen from the fluid; between fluids a single layer.
  void sheet(const Piece& p) {
    int axis = 0;
    double at = 0;
    for (int k = 0; k < 3; ++k)
      if (flat(p, k)) axis = k, at = p.min[k];
    if (!flat(p, axis))
      for (int f = 0; f < 6; ++f)
        if (p.faces[f] && !(place_.two_d && f / 2 == 1)) axis = f / 2, at = f % 2 ? p.max[axis] : p.min[axis];
    double nearest = 1e300, side = 1;
    bool between = false;
    for (const Piece& q : pieces_) {
      if (q.as != Drawn::fluid) continue;
      between = between || (q.min[axis] < at - place_.dp && q.max[axis] > at + place_.dp);
      const double off = middle(q)[axis] - at, gap = std::max({q.min[axis] - at, at - q.max[axis], 0.0});
      if (gap < nearest) nearest = gap, side = off < 0 ? -1 : 1;
    }
    Vec3d lo = low(p), hi = high(p);
    Section s("[[wall.body]]");
    s.set("name", new_body(p.mk)).set("shape", "box");
    if (between) {
      lo[axis] = at - place_.dp / 2, hi[axis] = at + place_.dp / 2;
      remark(p, "one layer of particles between fluids becomes a plate one dp thick, of type single_layer");
    } else {
      lo[axis] = side > 0 ? at - kPlateDepth * place_.dp : at;
      hi[axis] = side > 0 ? at : at + kPlateDepth * place_.dp;
      remark(p, fmt::format("one layer of particles becomes a plate {} dp thick, away from the fluid",
                            kPlateDepth));
    }
    s.set("min", lo).set("max", hi);
    if (between) s.set("type", "single_layer");
    write_body(p.mk, s);
  }

  // Fluid.

  void write_fill(const Piece& p, Section s) {
    const auto found = fill_keys_.find(p.mk);
    out_.fills += s.text() + (found == fill_keys_.end() ? "" : found->second) + '\n';
  }

  void fill(std::size_t k) {
    const Piece& p = pieces_[k];
    if (p.flooded) {
      flood(p);
      return;
    }
    const auto others = later(k, [](const Piece& q) { return q.as != Drawn::bound; });
    if (p.form == Form::box && p.turn_angle == 0 && others.empty())
      write_fill(p, Section("[[fluid.fill]]").set("min", low(p)).set("max", high(p)));
    else
      write_fill(
          p, Section("[[fluid.fill]]").set("shape", shape_without(p, others, fmt::format("fluid_{}", p.mk))));
  }

  /// The box of the fill within the vessel around its seed.
  void flood(const Piece& p) {
    for (const auto& [k, name] : inside_)
      if (inside(pieces_[k], p.seed)) {
        write_fill(p, Section("[[fluid.fill]]").set("shape", name).set("level", p.max.z));
        return;
      }
    Piece box = p;
    for (const Piece& q : pieces_)
      if (q.as == Drawn::bound && q.form == Form::box && q.by_faces() && !is_sheet(q) && inside(q, p.seed))
        for (int axis = 0; axis < 3; ++axis) {
          if (q.faces[2 * axis]) box.min[axis] = std::max(box.min[axis], q.min[axis]);
          if (q.faces[2 * axis + 1]) box.max[axis] = std::min(box.max[axis], q.max[axis]);
        }
    end_at_walls(box, p.seed);
    remark(p, "filled up to the walls around a seed there, here all of the box that is not solid");
    write_fill(p, Section("[[fluid.fill]]").set("min", low(box)).set("max", high(box)));
  }

  /// Ends a box at walls right across it, as seen from a seed.
  void end_at_walls(Piece& box, const Vec3d& seed) const {
    for (const Piece& q : pieces_) {
      if (q.as != Drawn::bound || q.form != Form::box || q.turn_angle != 0 || q.by_faces()) continue;
      for (int axis = 0; axis < 3; ++axis) {
        bool across = true;
        for (int k = 0; k < 3; ++k)
          across = across && (k == axis || (place_.two_d && k == 1) ||
                              (q.min[k] <= box.min[k] + near() && q.max[k] >= box.max[k] - near()));
        if (!across || (place_.two_d && axis == 1)) continue;
        if (q.max[axis] < seed[axis]) box.min[axis] = std::max(box.min[axis], q.max[axis]);
        if (q.min[axis] > seed[axis]) box.max[axis] = std::min(box.max[axis], q.min[axis]);
      }
    }
  }

  const std::vector<Piece>& pieces_;
  const Place& place_;
  const BodyKeys& keys_;
  const std::map<int, std::string>& fill_keys_;
  const std::set<int>& closed_;
  const std::string& file_;
  std::vector<std::string>& left_;
  PiecesText out_;
  std::map<std::string, int> names_;
  std::map<int, int> bodies_;
  std::map<std::size_t, std::string> inside_;  ///< shape within the vessel of a piece
};

}  // namespace

std::pair<Vec3d, Vec3d> Piece::extent() const {
  if (form != Form::box || turn_angle == 0) return {min, max};
  const auto turn = Quat<double>::from_rotation(turn_axis * (turn_angle * std::numbers::pi / 180));
  Vec3d lo{1e300, 1e300, 1e300}, hi = -lo;
  for (int c = 0; c < 8; ++c) {
    const Vec3d x =
        shift + turn.rotate({c & 1 ? max.x : min.x, c & 2 ? max.y : min.y, c & 4 ? max.z : min.z});
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], x[k]), hi[k] = std::max(hi[k], x[k]);
  }
  return {lo, hi};
}

void Piece::turn_and_move(const Quat<double>& turn, const Vec3d& by) {
  const Vec3d middle = 0.5 * (min + max), half = 0.5 * (max - min);
  if (form == Form::cylinder || form == Form::sphere) a = by + turn.rotate(a), b = by + turn.rotate(b);
  if (form != Form::box && norm(Vec3d{turn.x, turn.y, turn.z}) == 0) {
    min += by, max += by;
  } else if (form != Form::box) {
    const double reach = form == Form::sphere ? half.x : norm(half);  // a box around it that is not too small
    const Vec3d to = by + turn.rotate(middle), around{reach, reach, reach};
    min = to - around, max = to + around;
  }
  if (form == Form::cylinder || form == Form::sphere) return;
  const auto before = Quat<double>::from_rotation(turn_axis * (turn_angle * std::numbers::pi / 180));
  const Quat<double> both = turn * before;
  const Vec3d axis{both.x, both.y, both.z};
  shift = by + turn.rotate(shift);
  if (form == Form::box && !(norm(axis) > 0)) {  // its sides are along the axes
    min += shift, max += shift, shift = {}, turn_angle = 0;
    return;
  }
  turn_angle = 2 * std::atan2(norm(axis), both.w) * 180 / std::numbers::pi;
  turn_axis = norm(axis) > 0 ? axis / norm(axis) : Vec3d{0, 0, 1};
  if (form == Form::box && by_faces()) faces.fill(false), surface = true;
}

std::string body_name(int mk) { return fmt::format("bound_{}", mk); }

PiecesText text_of(const std::vector<Piece>& pieces, const Place& place, const BodyKeys& keys,
                   const std::map<int, std::string>& fill_keys, const std::set<int>& closed,
                   const std::string& file, std::vector<std::string>& left) {
  return Writer(pieces, place, keys, fill_keys, closed, file, left).write();
}

}  // namespace bedload
