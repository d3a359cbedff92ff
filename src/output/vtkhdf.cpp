#include "bedload/output/vtkhdf.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "bedload/core/cores.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/h5_table.hpp"
#include "src/output/image_frames.hpp"

namespace bedload {
namespace {

using h5::append_integers;
using h5::append_rows;
using h5::check;
using h5::create_table;
using h5::Handle;
using h5::open_dataset;
using h5::read_integers;

constexpr std::array kTopologies{"Vertices", "Lines", "Polygons", "Strips"};
/// What the entries of a store are in its file.
struct Cells {
  std::size_t topology;       ///< in kTopologies
  std::int64_t points;        ///< of each
  const char *data, *starts;  ///< groups of the arrays, and of where they start in each frame
};
constexpr Cells kVertices{0, 1, "PointData", "PointDataOffsets"}, kLines{1, 2, "CellData", "CellDataOffsets"};
constexpr std::size_t kSmallChunk = 256;      // rows, tables of steps and parts
constexpr std::size_t kLargestChunk = 65536;  // rows, arrays of particles

void append_integer(hid_t parent, const std::string& name, std::int64_t value) {
  append_integers(parent, name, {value}, 1);
}

const Cells& cells_of(const HostStore& store) { return store.lines ? kLines : kVertices; }
const Cells& cells_of(hid_t root) {
  return h5::has_member(root, kLines.data) && !h5::has_member(root, kVertices.data) ? kLines : kVertices;
}

/// Points as they are stored: in fp32 unless the file keeps doubles; of lines both ends.
class StoredPoints {
 public:
  StoredPoints(const HostArray& x, bool double_points) {
    const bool single = !double_points && x.type == Scalar::f64;
    if (!single && x.components == 3) {
      stored_ = &x;  // a copy of millions takes as long as writing half of them
      return;
    }
    own_ = {
        .name = x.name, .unit = x.unit, .type = single ? Scalar::f32 : x.type, .components = 3, .bytes = {}};
    if (!single) {
      own_.bytes = x.bytes;
      return;
    }
    const std::size_t n = x.bytes.size() / sizeof(double);
    own_.bytes.resize(n * sizeof(float));
    in_stretches(n, [&](std::size_t begin, std::size_t end) {
      std::transform(x.as<double>() + begin, x.as<double>() + end, own_.as<float>() + begin,
                     [](double v) { return float(v); });
    });
  }
  StoredPoints(const StoredPoints&) = delete;
  operator const HostArray&() const { return *stored_; }

 private:
  HostArray own_;
  const HostArray* stored_ = &own_;
};

hsize_t chunk_of(std::size_t count) {
  return std::clamp(count, kSmallChunk, kLargestChunk);  // the store may grow
}

void create_array(hid_t parent, const std::string& name, const HostArray& a, hsize_t chunk, int deflate) {
  const Handle table =
      create_table(parent, name, h5::file_type(a.type), hsize_t(a.components), chunk, deflate);
  h5::write_text(table, "unit", a.unit);
}

void create_layout(const std::filesystem::path& path, const HostStore& store, const HostArray& points,
                   int deflate) {
  const Handle file = h5::open_file(path, h5::Mode::create);
  const Handle root = h5::create_group(file, "VTKHDF");
  const int version[2] = {2, 0};
  const hsize_t two = 2;
  const Handle pair(H5Screate_simple(1, &two, nullptr));
  const Handle attribute(H5Acreate2(root, "Version", H5T_STD_I32LE, pair, H5P_DEFAULT, H5P_DEFAULT));
  check(H5Awrite(attribute, H5T_NATIVE_INT, version));
  h5::write_text(root, "Type", "PolyData");

  const auto integers = [](hid_t parent, const std::string& name, hsize_t columns, hsize_t chunk_rows) {
    return create_table(parent, name, H5T_STD_I64LE, columns, chunk_rows);
  };
  const Cells& cells = cells_of(store);
  const hsize_t chunk = chunk_of(store.count);
  integers(root, "NumberOfPoints", 1, kSmallChunk);
  create_array(root, "Points", points, chunk, deflate);
  for (const char* name : kTopologies) {
    const Handle topology = h5::create_group(root, name);
    const bool used = name == kTopologies[cells.topology];
    integers(topology, "NumberOfCells", 1, kSmallChunk);
    integers(topology, "NumberOfConnectivityIds", 1, kSmallChunk);
    integers(topology, "Connectivity", 1, used ? chunk : kSmallChunk);
    integers(topology, "Offsets", 1, used ? chunk : kSmallChunk);
  }
  const Handle data = h5::create_group(root, cells.data);
  const Handle steps = h5::create_group(root, "Steps");
  h5::write_integer(steps, "NSteps", 0);
  const Handle times = create_table(steps, "Values", H5T_IEEE_F64LE, 1, kSmallChunk);
  h5::write_text(times, "unit", "s");
  for (const char* name : {"PartOffsets", "NumberOfParts", "PointOffsets"})
    integers(steps, name, 1, kSmallChunk);
  for (const char* name : {"CellOffsets", "ConnectivityIdOffsets"})
    integers(steps, name, kTopologies.size(), kSmallChunk);
  const Handle offsets = h5::create_group(steps, cells.starts);
  for (std::size_t k = 1; k < store.arrays.size(); ++k) {
    create_array(data, store.arrays[k].name, store.arrays[k], chunk, deflate);
    integers(offsets, store.arrays[k].name, 1, kSmallChunk);
  }
}

/// Which rows of the file make up each frame.
struct FrameIndex {
  std::vector<std::int64_t> parts, points;  // per frame: part, first point
  std::vector<std::int64_t> counts;         // per part: entries in it
  const Cells& cells;

  explicit FrameIndex(hid_t root) : cells(cells_of(root)) {
    const Handle steps = h5::open_group(root, "Steps");
    const auto n = hsize_t(h5::read_integer(steps, "NSteps"));
    parts = read_integers(steps, "PartOffsets", n);
    points = read_integers(steps, "PointOffsets", n);
    const auto known = n == 0 ? 0 : *std::max_element(parts.begin(), parts.end()) + 1;
    counts = read_integers(root, "NumberOfPoints", hsize_t(known));
    for (std::int64_t& count : counts) count /= cells.points;
  }
  std::size_t frames() const { return parts.size(); }
  std::int64_t count(std::size_t frame) const { return counts[parts[frame]]; }
};

/// Adds the cells of one more number of entries, of the points 0, 1, ...
void append_part(hid_t root, const Cells& cells, std::int64_t n) {
  append_integer(root, "NumberOfPoints", n * cells.points);
  for (const char* name : kTopologies) {
    const Handle topology = h5::open_group(root, name);
    const std::int64_t here = name == kTopologies[cells.topology] ? n : 0, points = here * cells.points;
    std::vector<std::int64_t> ids(points), ends(here + 1);
    std::iota(ids.begin(), ids.end(), 0);
    for (std::int64_t k = 0; k <= here; ++k) ends[k] = k * cells.points;
    append_integer(topology, "NumberOfCells", here);
    append_integer(topology, "NumberOfConnectivityIds", points);
    append_integers(topology, "Connectivity", ids, hsize_t(points));
    append_integers(topology, "Offsets", ends, hsize_t(here) + 1);
  }
}

/// Of each topology, where only that of the cells has any.
std::vector<std::int64_t> at_topology(const Cells& cells, std::int64_t start) {
  std::vector<std::int64_t> starts(kTopologies.size(), 0);
  starts[cells.topology] = start;
  return starts;
}

/// Appends an array to its table; returns the row where it starts.
std::int64_t append_array(hid_t table, const HostArray& a) {
  const auto start = std::int64_t(h5::extent(table)[0]);
  append_rows(table, h5::memory_type(a.type), a.bytes.data(), a.count());
  return start;
}

/// Whether the table has the array from this row on.
bool has_array(hid_t table, const HostArray& a, std::int64_t first) {
  return h5::rows_equal(table, a.type, hsize_t(first), a.count(), a.bytes.data(),
                        size_of(a.type) * std::size_t(a.components));
}

/// One number of a row.
std::int64_t integer_of(hid_t parent, const std::string& name, hsize_t row, std::size_t column = 0) {
  const Handle table = open_dataset(parent, name);
  const auto n = h5::extent(table);
  std::vector<std::int64_t> values(n.size() > 1 ? n[1] : 1);
  h5::read_rows(table, H5T_NATIVE_INT64, row, 1, values.data());
  return values.at(column);
}
std::int64_t last_of(hid_t parent, const std::string& name, std::size_t frames, std::size_t column = 0) {
  return frames == 0 ? 0 : integer_of(parent, name, frames - 1, column);
}

/// Rows [first, first + count) of a stored array.
HostArray read_array(hid_t parent, const std::string& name, std::int64_t first, std::int64_t count) {
  const Handle table = open_dataset(parent, name);
  const auto n = h5::stored_extent(table);
  if (n.empty() || first < 0 || count < 0 || double(first) + double(count) > double(n[0]))
    throw h5::Error("array '" + name + "' is shorter than its frames");
  HostArray a{.name = name,
              .unit = h5::has_attribute(table, "unit") ? h5::read_text(table, "unit") : "-",
              .type = h5::scalar_of(table),
              .components = n.size() > 1 ? int(n[1]) : 1,
              .bytes = {}};
  a.bytes.resize(std::size_t(count) * a.components * size_of(a.type));
  h5::read_rows(table, h5::memory_type(a.type), hsize_t(first), hsize_t(count), a.bytes.data());
  return a;
}

void truncate(hid_t root, std::size_t frames) {
  const FrameIndex index(root);
  const auto cut = [&](hid_t parent, const std::string& name, std::int64_t rows) {
    h5::resize(open_dataset(parent, name), hsize_t(rows));
  };
  const auto end_of = [&](const std::vector<std::int64_t>& starts) {
    std::int64_t end = 0;
    for (std::size_t k = 0; k < frames; ++k) end = std::max(end, starts[k] + index.count(k));
    return end;
  };
  const auto parts = *std::max_element(index.parts.begin(), index.parts.begin() + frames) + 1;
  const auto entries = std::accumulate(index.counts.begin(), index.counts.begin() + parts, std::int64_t{0});
  const Cells& cells = index.cells;

  cut(root, "NumberOfPoints", parts);
  std::int64_t points = 0;
  for (std::size_t k = 0; k < frames; ++k)
    points = std::max(points, index.points[k] + cells.points * index.count(k));
  cut(root, "Points", points);
  for (const char* name : kTopologies) {
    const Handle topology = h5::open_group(root, name);
    const std::int64_t here = name == kTopologies[cells.topology] ? entries : 0;
    cut(topology, "NumberOfCells", parts);
    cut(topology, "NumberOfConnectivityIds", parts);
    cut(topology, "Connectivity", here * cells.points);
    cut(topology, "Offsets", here + parts);
  }
  const Handle data = h5::open_group(root, cells.data);
  const Handle steps = h5::open_group(root, "Steps");
  const Handle offsets = h5::open_group(steps, cells.starts);
  for (const auto& name : h5::members(data)) {
    cut(data, name, end_of(read_integers(offsets, name, frames)));
    cut(offsets, name, frames);
  }
  for (const char* name :
       {"Values", "PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"})
    cut(steps, name, frames);
  h5::write_integer(steps, "NSteps", frames);
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_array(hid_t parent, const std::string& name, const HostArray& a) {
  const Handle table = open_dataset(parent, name);
  const auto n = h5::extent(table);
  if (h5::scalar_of(table) != a.type || (n.size() > 1 ? n[1] : 1) != hsize_t(a.components))
    throw h5::Error("array '" + name +
                    "' has a number type or number of components that this run does not write; give the "
                    "restart another --out");
}

/// Throws unless frames of these arrays can follow those in the file. Either may lack some.
void check_arrays(hid_t root, const HostArray& points, const HostStore& store) {
  check_array(root, "Points", points);
  const Handle data = h5::open_group(root, cells_of(store).data);
  const auto names = h5::members(data);
  for (std::size_t k = 1; k < store.arrays.size(); ++k)
    if (contains(names, store.arrays[k].name)) check_array(data, store.arrays[k].name, store.arrays[k]);
}

/// Throws unless the entries of file and store are of one kind.
void check_kind(hid_t root, const HostStore& store) {
  const bool nodes = image::is_image(root), lines = !nodes && &cells_of(root) == &kLines;
  if (nodes != store.grid.has_value() || lines != store.lines)
    throw h5::Error(std::string("it has frames of ") +
                    (nodes   ? "nodes"
                     : lines ? "lines"
                             : "particles") +
                    "; give the restart another --out");
}

/// Values where a frame has none: NaN, 0 of whole numbers.
HostArray absent(const std::string& name, const std::string& unit, Scalar type, int components,
                 std::size_t count) {
  HostArray a{.name = name, .unit = unit, .type = type, .components = components, .bytes = {}};
  const std::size_t n = count * std::size_t(components);
  a.bytes.assign(n * size_of(type), std::byte{});
  if (type == Scalar::f32) std::fill_n(a.as<float>(), n, std::numeric_limits<float>::quiet_NaN());
  if (type == Scalar::f64) std::fill_n(a.as<double>(), n, std::numeric_limits<double>::quiet_NaN());
  return a;
}

/// Adds the arrays that the file lacks. Its frames share as many absent values as the longest of them needs.
void add_arrays(hid_t root, const HostStore& store, std::size_t frames, int deflate) {
  const Handle data = h5::open_group(root, cells_of(store).data);
  const auto names = h5::members(data);
  const Handle offsets = h5::open_group(root, std::string("Steps/") + cells_of(store).starts);
  for (std::size_t k = 1; k < store.arrays.size(); ++k) {
    const HostArray& a = store.arrays[k];
    if (contains(names, a.name)) continue;
    const FrameIndex index(root);
    std::int64_t longest = 0;
    for (std::size_t frame = 0; frame < frames; ++frame) longest = std::max(longest, index.count(frame));
    create_array(data, a.name, a, chunk_of(store.count), deflate);
    const HostArray none = absent(a.name, a.unit, a.type, a.components, std::size_t(longest));
    append_rows(open_dataset(data, a.name), h5::memory_type(a.type), none.bytes.data(), hsize_t(longest));
    create_table(offsets, a.name, H5T_STD_I64LE, 1, kSmallChunk);
    append_integers(offsets, a.name, std::vector<std::int64_t>(frames, 0), frames);
  }
}

/// The arrays of a store that are as in the last frame.
std::vector<const HostArray*> unchanged(hid_t root, const HostArray& points, const HostStore& store,
                                        std::size_t frames) {
  std::vector<const HostArray*> out;
  const Cells& cells = cells_of(store);
  const Handle data = h5::open_group(root, cells.data), steps = h5::open_group(root, "Steps"),
               offsets = h5::open_group(steps, cells.starts);
  if (has_array(open_dataset(root, "Points"), points, last_of(steps, "PointOffsets", frames)))
    out.push_back(&points);
  for (const auto& name : h5::members(data))
    if (const HostArray* const a = store.find(name);
        a && has_array(open_dataset(data, name), *a, last_of(offsets, name, frames)))
      out.push_back(a);
  return out;
}

/// For an array of the file that the store lacks.
HostArray absent(hid_t table, const std::string& name, std::size_t count) {
  const auto n = h5::extent(table);
  return absent(name, "-", h5::scalar_of(table), n.size() > 1 ? int(n[1]) : 1, count);
}

}  // namespace

void FrameFile::append(const HostStore& store, double time, bool begun) const {
  std::size_t bytes = 1 << 20;
  for (const auto& a : store.arrays) bytes += a.bytes.size();
  if (begun) must_be_there(path_);
  const bool first = !begun && !std::filesystem::exists(path_);
  if (first || store.grid) need_space(path_, bytes);
  const auto write_image = [&] {
    Handle file = h5::open_file(path_, first ? h5::Mode::create : h5::Mode::append);
    {
      const Handle root = first ? h5::create_group(file, "VTKHDF") : h5::open_group(file, "VTKHDF");
      if (first) image::create_layout(root, store, deflate_);
      check_kind(root, store);
      image::append(root, store, time);
    }
    file.close();
  };
  const auto write = [&] {
    if (store.grid) return write_image();
    const Cells& cells = cells_of(store);
    const StoredPoints points(store.arrays.at(0), double_points_);
    if (first) create_layout(path_, store, points, deflate_);
    Handle file = h5::open_file(path_, h5::Mode::append);
    {
      const Handle root = h5::open_group(file, "VTKHDF");
      check_kind(root, store);
      const Handle data = h5::open_group(root, cells.data);
      const Handle steps = h5::open_group(root, "Steps");
      const Handle offsets = h5::open_group(steps, cells.starts);
      const auto frames = std::size_t(h5::read_integer(steps, "NSteps"));
      const std::int64_t last_part = last_of(steps, "PartOffsets", frames),
                         last_cell = last_of(steps, "CellOffsets", frames, cells.topology),
                         last_count =
                             frames > 0 ? integer_of(root, "NumberOfPoints", last_part) / cells.points : -1;
      const bool same_count = last_count == std::int64_t(store.count);
      check_arrays(root, points, store);
      std::vector<const HostArray*> same;
      if (same_count) same = unchanged(root, points, store, frames);
      for (const HostArray* a : same) bytes -= a->bytes.size();
      if (!first) need_space(path_, bytes);  // memory file systems take as long to reserve as to write
      add_arrays(root, store, frames, deflate_);

      std::int64_t part = last_part, first_cell = last_cell;
      if (frames > 0 && !same_count) part += 1, first_cell += last_count;
      // After a part without cells a cell that no frame shows: VTK 9.7 finds a part by the cells before it.
      if (last_count == 0 && !same_count) {
        append_part(root, cells, 1);
        part += 1, first_cell += 1;
      }
      if (!same_count) append_part(root, cells, std::int64_t(store.count));
      append_integer(steps, "PartOffsets", part);
      append_integer(steps, "NumberOfParts", 1);
      append_integers(steps, "CellOffsets", at_topology(cells, first_cell), 1);
      append_integers(steps, "ConnectivityIdOffsets", at_topology(cells, first_cell * cells.points), 1);
      const auto place = [&](hid_t starts, const std::string& name, const Handle& table, const HostArray& a,
                             bool there) {
        append_integer(starts, name, there ? last_of(starts, name, frames) : append_array(table, a));
      };
      const auto is_same = [&](const HostArray& a) {
        return std::find(same.begin(), same.end(), &a) != same.end();
      };
      place(steps, "PointOffsets", open_dataset(root, "Points"), points, is_same(points));
      for (const auto& name : h5::members(data)) {
        const Handle table = open_dataset(data, name);
        if (const HostArray* const a = store.find(name)) {
          place(offsets, name, table, *a, is_same(*a));
          continue;
        }
        const HostArray none = absent(table, name, store.count);
        place(offsets, name, table, none,
              same_count && has_array(table, none, last_of(offsets, name, frames)));
      }
      append_rows(open_dataset(steps, "Values"), H5T_NATIVE_DOUBLE, &time, 1);
      h5::write_integer(steps, "NSteps", std::int64_t(frames) + 1);
    }
    file.close();
  };
  try {
    h5::with_file_errors(path_, "write", write);
  } catch (const FileError&) {
    std::error_code not_there;
    if (first) std::filesystem::remove(path_, not_there);  // it has no frame
    throw;
  }
  free_reserve(path_);
}

void FrameFile::expect(const HostStore& store) const {
  if (!std::filesystem::exists(path_)) return;
  h5::with_file_errors(path_, "write", [&] {
    const Handle file = h5::open_file(path_, h5::Mode::read);
    const Handle root = h5::open_group(file, "VTKHDF");
    check_kind(root, store);
    if (store.grid) return image::expect(root, store);
    const FrameIndex index(root);
    check_arrays(root, StoredPoints(store.arrays.at(0), double_points_), store);
  });
}

std::vector<double> FrameFile::times() const {
  if (!std::filesystem::exists(path_)) return {};
  return h5::with_file_errors(path_, "read", [&] {
    const Handle file = h5::open_file(path_, h5::Mode::read);
    const Handle steps = h5::open_group(file, "VTKHDF/Steps");
    std::vector<double> values(h5::read_integer(steps, "NSteps"));
    h5::read_rows(open_dataset(steps, "Values"), H5T_NATIVE_DOUBLE, 0, values.size(), values.data());
    return values;
  });
}

HostStore FrameFile::read(std::size_t frame) const {
  return h5::with_file_errors(path_, "read", [&] {
    const Handle file = h5::open_file(path_, h5::Mode::read);
    const Handle root = h5::open_group(file, "VTKHDF");
    if (image::is_image(root)) return image::read(root, path_.stem().string(), frame);
    const FrameIndex index(root);
    if (frame >= index.frames()) throw h5::Error("no such frame");
    const std::int64_t count = index.count(frame);
    const Cells& cells = index.cells;
    HostStore store{path_.stem().string(), std::size_t(count), {}};
    store.lines = &cells == &kLines;
    store.arrays.push_back(read_array(root, "Points", index.points[frame], count * cells.points));
    store.arrays.back().name = store.lines ? "ends" : "position";
    store.arrays.back().components *= int(cells.points);
    const Handle data = h5::open_group(root, cells.data);
    const Handle offsets = h5::open_group(root, std::string("Steps/") + cells.starts);
    for (const auto& name : h5::members(data))
      store.arrays.push_back(read_array(data, name, read_integers(offsets, name, frame + 1).back(), count));
    return store;
  });
}

void FrameFile::keep(std::size_t count) const {
  if (count == 0) {
    remove_file(path_);
    remove_file(xdmf_path());
    return;
  }
  h5::with_file_errors(path_, "write", [&] {
    Handle file = h5::open_file(path_, h5::Mode::append);
    {
      const Handle root = h5::open_group(file, "VTKHDF");
      image::is_image(root) ? image::truncate(root, count) : truncate(root, count);
    }
    file.close();
  });
}

}  // namespace bedload
