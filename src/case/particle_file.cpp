#include "bedload/case/particle_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/vtkhdf.hpp"

namespace bedload {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\"";
  const auto from = text.find_first_not_of(blank);
  return from == text.npos ? std::string_view() : text.substr(from, text.find_last_not_of(blank) - from + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// A table of numbers, read line by line.
class ParticleTable {
 public:
  ParticleTable(const std::filesystem::path& file, std::string_view type)
      : file_(file), text_(read_text(file)), type_(type) {}

  ParticleList read() {
    ParticleList list;
    list.file = file_;
    if (!next_line()) fail("holds no line of column names");
    name_columns();
    while (next_line()) {
      cells_ = cells_of(line_);
      if (cells_.size() != names_.size())
        fail(
            fmt::format("has {} values where the first line names {} columns", cells_.size(), names_.size()));
      if (has("type") && !is_wanted(cell("type"))) continue;
      list.line.push_back(number_);
      list.x.push_back(vector({"x", "y", "z"}));
      if (has("vx")) list.v.push_back(vector({"vx", "vy", "vz"}));
      if (has("wx")) list.omega.push_back(vector({"wx", "wy", "wz"}));
      if (has("d")) list.d.push_back(positive("d"));
      if (has("radius")) list.d.push_back(2 * positive("radius"));
      if (has("volume")) list.volume.push_back(positive("volume"));
    }
    if (list.x.empty())
      fail(has("type") ? fmt::format("holds no particles of type {}", type_) : "holds no particles");
    return list;
  }

 private:
  bool is_wanted(std::string_view type) const {
    if (type != "fluid" && type != "grain") fail(fmt::format("type = \"{}\" must be fluid or grain", type));
    return type == type_;
  }
  std::string_view cell(std::string_view name) const {
    return cells_[std::find(names_.begin(), names_.end(), name) - names_.begin()];
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw CaseError(fmt::format("{}:{}: {}", file_.string(), std::max<std::int64_t>(number_, 1), why));
  }

  /// The next line that is neither empty nor a remark.
  bool next_line() {
    while (at_ < text_.size()) {
      const auto end = std::min(text_.find('\n', at_), text_.size());
      line_ = trimmed(std::string_view(text_).substr(at_, end - at_));
      at_ = end + 1;
      ++number_;
      if (!line_.empty() && line_.front() != '#') return true;
    }
    return false;
  }

  void name_columns() {
    for (const auto& [mark, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}})
      if (line_.find(mark) != line_.npos)
        fail(fmt::format("has {} between its columns; they must be separated by commas", name));
    for (const std::string_view cell : cells_of(line_)) {
      const auto bracket = cell.find('[');
      const std::string name(trimmed(cell.substr(0, bracket)));
      if (has(name) && !name.empty()) fail(fmt::format("has two columns {}", name));
      names_.push_back(name);
      const std::string unit = name == "type"     ? "[-]"
                               : name == "volume" ? "[m3]"
                               : name[0] == 'v'   ? "[m/s]"
                               : name[0] == 'w'   ? "[rad/s]"
                                                  : "[m]";
      const bool ours = std::find(kNames.begin(), kNames.end(), name) != kNames.end();
      if (name == "id") continue;  // as exported; particles are numbered anew
      if (!ours)
        fail(fmt::format("has a column {}, which means nothing here; known are {}", name,
                         fmt::join(kNames, ", ")));
      if (bracket != cell.npos && cell.substr(bracket) != unit)
        fail(fmt::format("column {} must be in {}", cell, unit));
    }
    for (const char* name : {"x", "y", "z"}) need(name, "");
    if (has("vx") || has("vy") || has("vz"))
      for (const char* name : {"vx", "vy", "vz"}) need(name, " next to the other velocities");
    if (has("wx") || has("wy") || has("wz"))
      for (const char* name : {"wx", "wy", "wz"}) need(name, " next to the other spins");
    if (has("d") && has("radius")) fail("has both columns d and radius; one of them is enough");
  }
  void need(const char* name, const char* why) const {
    if (!has(name)) fail(fmt::format("has no column {}{}; it names {}", name, why, fmt::join(names_, ", ")));
  }

  bool has(std::string_view name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }

  double number(std::string_view name) const {
    const std::string_view cell = this->cell(name);
    double value = 0;
    const char* begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), value);
    if (cell.empty() || error != std::errc() || end != cell.data() + cell.size())
      fail(fmt::format("{} = \"{}\" must be a number", name, cell));
    if (!std::isfinite(value)) fail(fmt::format("{} = {} must be finite", name, cell));
    return value;
  }
  Vec3d vector(std::array<const char*, 3> names) const {
    return {number(names[0]), number(names[1]), number(names[2])};
  }
  double positive(const char* name) const {
    const double value = number(name);
    if (!(value > 0)) fail(fmt::format("{} = {} must be > 0", name, value));
    return value;
  }

  static constexpr std::array<std::string_view, 13> kNames{"x",  "y",  "z",  "d",  "radius", "volume", "vx",
                                                           "vy", "vz", "wx", "wy", "wz",     "type"};

  std::filesystem::path file_;
  std::string text_;
  std::string_view type_;
  std::size_t at_ = 0;
  std::int64_t number_ = 0;
  std::string_view line_;
  std::vector<std::string> names_;
  std::vector<std::string_view> cells_;
};

double component(const HostArray& a, std::size_t n) {
  return a.type == Scalar::f32 ? double(a.as<float>()[n]) : a.as<double>()[n];
}

std::vector<Vec3d> vectors(const HostArray& a) {
  std::vector<Vec3d> out;
  for (std::size_t n = 0; n < a.count(); ++n)
    out.push_back({component(a, 3 * n), component(a, 3 * n + 1), component(a, 3 * n + 2)});
  return out;
}

ParticleList read_frame(const std::filesystem::path& file, std::int64_t step) {
  const FrameFile frames(file);
  const auto count = std::int64_t(frames.times().size());
  if (step >= count || count == 0)
    throw CaseError(count == 0 ? fmt::format("{}: holds no frame", file.string())
                               : fmt::format("{}: has no frame {}; they are numbered 0 to {}", file.string(),
                                             step, count - 1));
  const HostStore store = frames.read(std::size_t(step < 0 ? count - 1 : step));
  if (store.lines) throw CaseError(fmt::format("{}: holds lines, not particles", file.string()));
  ParticleList list;
  list.file = file;
  list.x = vectors(store.arrays.at(0));
  if (const HostArray* v = store.find("velocity"); v && v->components == 3) list.v = vectors(*v);
  if (const HostArray* w = store.find("angular_velocity"); w && w->components == 3) list.omega = vectors(*w);
  if (const HostArray* r = store.find("radius"); r && r->components == 1)
    for (std::size_t n = 0; n < r->count(); ++n) list.d.push_back(2 * component(*r, n));
  if (const HostArray* v = store.find("volume"); v && v->components == 1)
    for (std::size_t n = 0; n < v->count(); ++n) list.volume.push_back(component(*v, n));
  if (list.x.empty()) throw CaseError(fmt::format("{}: holds no particles in that frame", file.string()));
  return list;
}

}  // namespace

std::string ParticleList::place(std::size_t n) const {
  return line.empty() ? file.string() : fmt::format("{}:{}", file.string(), line[n]);
}

bool lies_inside(const DomainConfig& domain, Vec3d& x) {
  for (int k = 0; k < 3; ++k) {
    const double lo = domain.min[k], hi = domain.max[k];
    const double slack = 1e-7 * std::max(std::abs(lo), std::abs(hi));
    if (x[k] < lo - slack || x[k] > hi + slack) return false;
    x[k] = std::clamp(x[k], lo, hi);
  }
  return true;
}

bool has_frames(const std::filesystem::path& file) { return file.extension() == ".vtkhdf"; }

ParticleList read_particles(const std::filesystem::path& file, std::int64_t step, std::string_view type) {
  return has_frames(file) ? read_frame(file, step) : ParticleTable(file, type).read();
}

ParticleList listed_grains(const GrainFill& fill, const DomainConfig& domain) {
  ParticleList list;
  if (fill.file.empty())
    list.x = fill.positions, list.v = fill.velocities, list.omega = fill.spins;
  else
    list = read_particles(fill.file, fill.step, "grain");
  if (!fill.relative) return list;
  for (Vec3d& x : list.x)
    for (int k = 0; k < 3; ++k) x[k] = domain.min[k] + x[k] * (domain.max[k] - domain.min[k]);
  return list;
}

}  // namespace bedload
