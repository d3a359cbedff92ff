#include "src/output/image_frames.hpp"

#include <algorithm>
#include <numeric>

#include "bedload/output/h5_table.hpp"

namespace bedload::image {
namespace {

using h5::check;
using h5::Handle;
using h5::open_dataset;

constexpr std::size_t kChunk = 1 << 20;  // bytes
constexpr hsize_t kSmallChunk = 256;     // rows

template <class T>
void write_numbers(hid_t object, const char* name, hid_t file_type, hid_t memory_type,
                   const std::vector<T>& values) {
  const hsize_t n = values.size();
  const Handle space(H5Screate_simple(1, &n, nullptr));
  const Handle attribute(H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT));
  check(H5Awrite(attribute, memory_type, values.data()));
}

template <class T>
std::vector<T> read_numbers(hid_t object, const char* name, hid_t memory_type, std::size_t count) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT));
  const Handle space(H5Aget_space(attribute));
  if (check(H5Sget_simple_extent_npoints(space)) != hssize_t(count))
    throw h5::Error(std::string("attribute '") + name + "' has another number of values");
  std::vector<T> values(count);
  check(H5Aread(attribute, memory_type, values.data()));
  return values;
}

std::vector<hsize_t> extents(const HostArray& a, const HostGrid& grid) {
  std::vector<hsize_t> n{0, grid.count[2], grid.count[1], grid.count[0]};
  if (a.components > 1) n.push_back(hsize_t(a.components));
  return n;
}

void create_array(hid_t parent, const HostArray& a, const HostGrid& grid, int deflate) {
  const std::vector<hsize_t> now = extents(a, grid);
  std::vector<hsize_t> most = now, chunk = now;
  most[0] = H5S_UNLIMITED, chunk[0] = 1;
  const std::size_t layer = grid.count[0] * grid.count[1] * size_of(a.type) * std::size_t(a.components);
  chunk[1] = std::clamp<hsize_t>(kChunk / std::max<std::size_t>(layer, 1), 1, now[1]);
  const int rank = int(now.size());
  const Handle space(H5Screate_simple(rank, now.data(), most.data()));
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_chunk(creation, rank, chunk.data()));
  check(H5Pset_obj_track_times(creation, false));
  if (deflate > 0) check(H5Pset_deflate(creation, unsigned(deflate)));
  const Handle table(
      H5Dcreate2(parent, a.name.c_str(), h5::file_type(a.type), space, H5P_DEFAULT, creation, H5P_DEFAULT));
  h5::write_text(table, "unit", a.unit);
}

std::size_t frames_in(hid_t root) {
  return std::size_t(h5::read_integer(h5::open_group(root, "Steps"), "NSteps"));
}

/// The frame of the file that holds each frame's values.
std::vector<std::int64_t> offsets_of(hid_t root, const std::string& array, std::size_t frames) {
  return h5::read_integers(h5::open_group(root, "Steps/PointDataOffsets"), array, frames);
}

}  // namespace

bool is_image(hid_t root) { return h5::read_text(root, "Type") == "ImageData"; }

HostGrid grid_of(hid_t root) {
  const auto extent = read_numbers<std::int64_t>(root, "WholeExtent", H5T_NATIVE_INT64, 6);
  const auto origin = read_numbers<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3);
  HostGrid grid{.first = {origin[0], origin[1], origin[2]},
                .spacing = read_numbers<double>(root, "Spacing", H5T_NATIVE_DOUBLE, 3)[0]};
  for (std::size_t k = 0; k < 3; ++k) {
    if (extent[2 * k] != 0 || extent[2 * k + 1] < 0) throw h5::Error("the extent of the image is not valid");
    grid.count[k] = std::size_t(extent[2 * k + 1]) + 1;
  }
  return grid;
}

void create_layout(hid_t root, const HostStore& store, int deflate) {
  const HostGrid& grid = *store.grid;
  write_numbers<int>(root, "Version", H5T_STD_I32LE, H5T_NATIVE_INT, {2, 0});
  h5::write_text(root, "Type", "ImageData");
  std::vector<std::int64_t> extent;
  for (const std::size_t n : grid.count) extent.insert(extent.end(), {0, std::int64_t(n) - 1});
  write_numbers(root, "WholeExtent", H5T_STD_I64LE, H5T_NATIVE_INT64, extent);
  const auto numbers = [&](const char* name, const std::vector<double>& values) {
    write_numbers(root, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values);
  };
  numbers("Origin", {grid.first.x, grid.first.y, grid.first.z});
  numbers("Spacing", std::vector<double>(3, grid.spacing));
  numbers("Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  const Handle data = h5::create_group(root, "PointData");
  const Handle steps = h5::create_group(root, "Steps");
  h5::write_integer(steps, "NSteps", 0);
  const Handle times = h5::create_table(steps, "Values", H5T_IEEE_F64LE, 1, kSmallChunk);
  h5::write_text(times, "unit", "s");
  const Handle offsets = h5::create_group(steps, "PointDataOffsets");
  for (std::size_t k = 1; k < store.arrays.size(); ++k) {
    create_array(data, store.arrays[k], grid, deflate);
    h5::create_table(offsets, store.arrays[k].name, H5T_STD_I64LE, 1, kSmallChunk);
  }
}

void expect(hid_t root, const HostStore& store) {
  if (!store.grid || !(grid_of(root) == *store.grid))
    throw h5::Error("its places are not those of this run; give the restart another --out");
  const Handle data = h5::open_group(root, "PointData");
  for (std::size_t k = 1; k < store.arrays.size(); ++k) {
    const HostArray& a = store.arrays[k];
    const Handle table = open_dataset(data, a.name);
    auto n = h5::extent(table), wanted = extents(a, *store.grid);
    if (!n.empty()) wanted[0] = n[0];
    if (h5::scalar_of(table) != a.type || n != wanted)
      throw h5::Error("array '" + a.name +
                      "' has a number type or extents that this run does not write; give the restart another "
                      "--out");
  }
}

void append(hid_t root, const HostStore& store, double time) {
  expect(root, store);
  const Handle data = h5::open_group(root, "PointData");
  const Handle steps = h5::open_group(root, "Steps");
  const Handle offsets = h5::open_group(steps, "PointDataOffsets");
  const std::size_t frames = frames_in(root);
  for (std::size_t k = 1; k < store.arrays.size(); ++k) {
    const HostArray& a = store.arrays[k];
    const Handle table = open_dataset(data, a.name);
    std::int64_t at = frames > 0 ? offsets_of(root, a.name, frames).back() : -1;
    if (at < 0 || !h5::rows_equal(table, a.type, hsize_t(at), 1, a.bytes.data(), a.bytes.size())) {
      at = std::int64_t(h5::extent(table)[0]);
      h5::append_rows(table, h5::memory_type(a.type), a.bytes.data(), 1);
    }
    h5::append_integers(offsets, a.name, {at}, 1);
  }
  h5::append_rows(open_dataset(steps, "Values"), H5T_NATIVE_DOUBLE, &time, 1);
  h5::write_integer(steps, "NSteps", std::int64_t(frames) + 1);
}

HostStore read(hid_t root, const std::string& name, std::size_t frame) {
  if (frame >= frames_in(root)) throw h5::Error("no such frame");
  const HostGrid grid = grid_of(root);
  HostStore store{name, grid.count[0] * grid.count[1] * grid.count[2], {}, grid};
  HostArray x{.name = "position", .unit = "m", .type = Scalar::f64, .components = 3, .bytes = {}};
  x.bytes.resize(store.count * sizeof(Vec3d));
  auto* at = reinterpret_cast<double*>(x.bytes.data());
  for (std::size_t k = 0; k < grid.count[2]; ++k)
    for (std::size_t j = 0; j < grid.count[1]; ++j)
      for (std::size_t i = 0; i < grid.count[0]; ++i) {
        *at++ = grid.first.x + double(i) * grid.spacing;
        *at++ = grid.first.y + double(j) * grid.spacing;
        *at++ = grid.first.z + double(k) * grid.spacing;
      }
  store.arrays.push_back(std::move(x));
  const Handle data = h5::open_group(root, "PointData");
  for (const auto& array : h5::members(data)) {
    const Handle table = open_dataset(data, array);
    const auto n = h5::stored_extent(table);
    const std::int64_t row = offsets_of(root, array, frame + 1).back();
    if (n.size() < 4 || row < 0 || hsize_t(row) >= n[0] || n[1] * n[2] * n[3] != store.count)
      throw h5::Error("array '" + array + "' is shorter than its frames");
    HostArray a{.name = array,
                .unit = h5::has_attribute(table, "unit") ? h5::read_text(table, "unit") : "-",
                .type = h5::scalar_of(table),
                .components = n.size() > 4 ? int(n[4]) : 1,
                .bytes = {}};
    a.bytes.resize(store.count * std::size_t(a.components) * size_of(a.type));
    h5::read_rows(table, h5::memory_type(a.type), hsize_t(row), 1, a.bytes.data());
    store.arrays.push_back(std::move(a));
  }
  return store;
}

void truncate(hid_t root, std::size_t frames) {
  const Handle data = h5::open_group(root, "PointData");
  const Handle steps = h5::open_group(root, "Steps");
  const Handle offsets = h5::open_group(steps, "PointDataOffsets");
  for (const auto& name : h5::members(data)) {
    const auto rows = offsets_of(root, name, frames);
    h5::resize(open_dataset(data, name), hsize_t(*std::max_element(rows.begin(), rows.end()) + 1));
    h5::resize(open_dataset(offsets, name), frames);
  }
  h5::resize(open_dataset(steps, "Values"), frames);
  h5::write_integer(steps, "NSteps", std::int64_t(frames));
}

}  // namespace bedload::image
