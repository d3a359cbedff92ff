// Frames of a run as extended XYZ or as a LAMMPS dump, for OVITO and whatever reads these.

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "bedload/core/error.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "convert.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

double entry(const HostArray& a, std::size_t k) {
  switch (a.type) {
    case Scalar::f32:
      return a.as<float>()[k];
    case Scalar::f64:
      return a.as<double>()[k];
    case Scalar::u32:
      return a.as<std::uint32_t>()[k];
    case Scalar::u64:
      return double(a.as<std::uint64_t>()[k]);
  }
  return 0;
}
bool is_whole(const HostArray& a) { return a.type == Scalar::u32 || a.type == Scalar::u64; }

/// A column of the output: a field, of which some stores may have none.
struct Column {
  std::string name;
  int components = 1;
  bool whole = false;
};

/// One store of a results folder.
struct Source {
  std::string type;  ///< fluid, grains
  FrameFile file;
  std::vector<double> times;
};

std::vector<Source> sources(const fs::path& from) {
  std::vector<Source> out;
  const auto take = [&](const fs::path& path) {
    FrameFile file(path);
    std::vector<double> times = file.times();
    if (!times.empty()) out.push_back({path.stem().string(), std::move(file), std::move(times)});
  };
  if (fs::is_directory(from)) {
    for (const char* name : {"fluid.vtkhdf", "grains.vtkhdf"})
      if (fs::exists(from / name)) take(from / name);
  } else {
    if (!fs::exists(from)) throw FileError(from.string() + ": cannot read: no such file or folder");
    take(from);
  }
  if (out.empty())
    throw FileError(from.string() + ": has no frames of fluid or grains (fluid.vtkhdf, grains.vtkhdf)");
  return out;
}

/// Fields of all stores, in the order in which they come; the position is none.
std::vector<Column> columns_of(const std::vector<HostStore>& stores) {
  std::vector<Column> out;
  for (const HostStore& store : stores)
    for (std::size_t k = 1; k < store.arrays.size(); ++k) {
      const HostArray& a = store.arrays[k];
      const auto same =
          std::find_if(out.begin(), out.end(), [&](const Column& c) { return c.name == a.name; });
      if (same == out.end())
        out.push_back({a.name, a.components, is_whole(a)});
      else if (same->components != a.components)
        throw FileError(fmt::format(
            "field {} of fluid and grains differs in its number of components; convert one file", a.name));
      else
        same->whole = same->whole && is_whole(a);
    }
  return out;
}

struct Box {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
};
Box around(const std::vector<HostStore>& stores) {
  Box box;
  for (const HostStore& store : stores)
    for (std::size_t k = 0; k < 3 * store.count; ++k) {
      const double x = entry(store.arrays[0], k);
      box.lo[k % 3] = std::min(box.lo[k % 3], x), box.hi[k % 3] = std::max(box.hi[k % 3], x);
    }
  for (int k = 0; k < 3; ++k)
    if (box.lo[k] > box.hi[k]) box.lo[k] = 0, box.hi[k] = 0;
  return box;
}

void write_values(fmt::ostream& out, const HostStore& store, std::size_t i,
                  const std::vector<Column>& columns) {
  for (const Column& c : columns) {
    const HostArray* a = store.find(c.name);
    const double missing = c.whole || c.name == "radius" ? 0 : std::nan("");  // OVITO draws by the radius
    for (int k = 0; k < c.components; ++k) {
      const double value = a ? entry(*a, i * c.components + k) : missing;
      if (c.whole)
        out.print(" {}", std::uint64_t(value));
      else
        out.print(" {:.7g}", value);
    }
  }
}
void write_position(fmt::ostream& out, const HostStore& store, std::size_t i) {
  const HostArray& x = store.arrays[0];
  out.print(" {:.9g} {:.9g} {:.9g}", entry(x, 3 * i), entry(x, 3 * i + 1), entry(x, 3 * i + 2));
}

/// Names that OVITO knows by themselves.
std::string extxyz_name(const std::string& name) {
  static const std::map<std::string, std::string> kKnown = {{"velocity", "velo"}, {"force", "forces"}};
  const auto found = kKnown.find(name);
  return found == kKnown.end() ? name : found->second;
}

void write_extxyz(fmt::ostream& out, const std::vector<HostStore>& stores, double time, const Box& box,
                  const std::vector<Column>& columns) {
  std::size_t count = 0;
  for (const HostStore& store : stores) count += store.count;
  out.print(
      "{}\nLattice=\"{} 0 0 0 {} 0 0 0 {}\" Origin=\"{} {} {}\" pbc=\"F F F\" Time={} "
      "Properties=species:S:1:pos:R:3",
      count, box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2], box.lo[0], box.lo[1],
      box.lo[2], time);
  for (const Column& c : columns)
    out.print(":{}:{}:{}", extxyz_name(c.name), c.whole ? 'I' : 'R', c.components);
  out.print("\n");
  for (const HostStore& store : stores)
    for (std::size_t i = 0; i < store.count; ++i) {
      out.print("{}", store.name);
      write_position(out, store, i);
      write_values(out, store, i, columns);
      out.print("\n");
    }
}

/// vx, vy, vz and the like, as LAMMPS calls them.
std::vector<std::string> lammps_names(const Column& c) {
  static const std::map<std::string, std::string> kKnown = {
      {"velocity", "v"}, {"force", "f"}, {"angular_velocity", "omega"}};
  if (c.components == 1) return {c.name};
  std::vector<std::string> out;
  const auto known = kKnown.find(c.name);
  for (int k = 0; k < c.components; ++k)
    out.push_back(c.components == 3 ? (known == kKnown.end() ? c.name + '_' : known->second) + "xyz"[k]
                                    : fmt::format("{}_{}", c.name, k));
  return out;
}

void write_lammps(fmt::ostream& out, const std::vector<HostStore>& stores, std::size_t frame, double time,
                  const Box& box, std::vector<Column> columns) {
  std::size_t count = 0;
  bool ids = true;
  for (const HostStore& store : stores) count += store.count, ids = ids && store.find("id");
  out.print("ITEM: TIME\n{}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n",
            time, frame, count);
  for (int k = 0; k < 3; ++k) out.print("{:.9g} {:.9g}\n", box.lo[k], box.hi[k]);
  std::erase_if(columns, [](const Column& c) { return c.name == "id"; });
  out.print("ITEM: ATOMS id type x y z");
  for (const Column& c : columns)
    for (const std::string& name : lammps_names(c)) out.print(" {}", name);
  out.print("\n");
  std::uint64_t before = 0;  // ids of fluid and of grains both begin at 0
  for (std::size_t s = 0; s < stores.size(); ++s) {
    const HostStore& store = stores[s];
    const HostArray* id = store.find("id");
    std::uint64_t most = 0;
    for (std::size_t i = 0; i < store.count; ++i) {
      const std::uint64_t own = ids ? std::uint64_t(entry(*id, i)) : i;
      most = std::max(most, own + 1);
      out.print("{} {}", before + own + 1, store.name == "grains" ? 2 : 1);
      write_position(out, store, i);
      write_values(out, store, i, columns);
      out.print("\n");
    }
    before += most;
  }
}

}  // namespace

std::size_t convert_frames(const fs::path& from, FrameFormat format, const fs::path& to) {
  const std::vector<Source> all = sources(from);
  const std::size_t frames = std::max_element(all.begin(), all.end(), [](const Source& a, const Source& b) {
                               return a.times.size() < b.times.size();
                             })->times.size();
  std::optional<fmt::ostream> out;
  try {
    out.emplace(fmt::output_file(to.string()));
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("{}: cannot write: {}", to.string(), error.code().message()));
  }
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::vector<HostStore> stores;
    double time = 0;
    for (const Source& source : all) {
      if (frame >= source.times.size()) continue;
      time = source.times[frame];
      stores.push_back(source.file.read(frame));
      if (stores.back().lines)
        throw FileError(source.file.path().string() +
                        ": holds lines, which these formats cannot; use ParaView");
      stores.back().name = source.type;
    }
    const Box box = around(stores);
    const std::vector<Column> columns = columns_of(stores);
    if (format == FrameFormat::extxyz)
      write_extxyz(*out, stores, time, box, columns);
    else
      write_lammps(*out, stores, frame, time, box, columns);
  }
  try {
    out->close();
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("{}: cannot write: {}", to.string(), error.code().message()));
  }
  return frames;
}

}  // namespace bedload
