// Checkpoints: the state for a restart in HDF5, and the numbers that show whether it fits a case.
//
//   /           attributes "format", "precision"; dataset "case": the resolved case
//   /setup      attributes: the numbers that define the particles
//   /scalars    attributes: clock and totals, "<name>" and "<name>:unit"
//   /stores/..  attribute "count"; one dataset per array with "unit"
//
// The seal of files.hpp follows the HDF5 data. It is checked before HDF5 opens the file, since a flipped bit
// can make HDF5 misbehave.

#include <fmt/format.h>

#include <algorithm>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/h5_table.hpp"
#include "bedload/output/output.hpp"

namespace bedload {
namespace {

using h5::check;
using h5::Handle;

constexpr std::int64_t kFormat = 8;

/// The numbers that define the particles; a state fits a case only if these agree.
std::vector<Quantity> particle_setup(const Config& c) {
  std::vector<Quantity> all;
  const auto add = [&](const std::string& name, double value) { all.push_back({name, "", value}); };
  const auto add_box = [&](const std::string& name, const Vec3d& min, const Vec3d& max) {
    for (int k = 0; k < 3; ++k) {
      add(fmt::format("{}.min[{}]", name, k), min[k]);
      add(fmt::format("{}.max[{}]", name, k), max[k]);
    }
  };
  add_box("domain", c.domain.min, c.domain.max);
  if (c.fluid.present) {
    add("fluid.dx", c.fluid.dx);
    add("wall.dx", c.wall.dx);
    for (std::size_t k = 0; k < c.fluid.fills.size(); ++k)
      add_box(fmt::format("fluid.fill.{}", k), c.fluid.fills[k].min, c.fluid.fills[k].max);
  }
  // the fields of the particles depend on these and on the wall types; the default model goes without saying
  if (c.fluid.model != FluidConfig().model) add(fmt::format("fluid.model = \"{}\"", c.fluid.model.name()), 1);
  if (c.fluid.present && c.grain.present && c.couple.mode != CouplingMode::off)
    add(fmt::format("couple.mode = \"{}\"", c.couple.mode.name()), 1);
  for (const WallBody& body : c.wall.bodies) {
    add_box(fmt::format("wall.{}", body.name), body.min, body.max);
    if (body.dx > 0) add(fmt::format("wall.{}.dx", body.name), body.dx);
    if (c.fluid.present && body.stops_fluid())
      add(fmt::format("wall.{}.type = \"{}\"", body.name, body.type.name()), 1);
  }
  for (const InletConfig& inlet : c.inlets) {
    for (int k = 0; k < 3; ++k) {
      add(fmt::format("inlet.{}.centre[{}]", inlet.name, k), inlet.centre[k]);
      add(fmt::format("inlet.{}.direction[{}]", inlet.name, k), inlet.direction[k]);
    }
    add(fmt::format("inlet.{}.points", inlet.name),
        double(orifice_layer(inlet, c.fluid.dx, c.domain).points.size()));
  }
  if (c.grain.present) {
    for (std::size_t k = 0; k < c.grain.fills.size(); ++k) {
      const auto& fill = c.grain.fills[k];
      const std::string name = fmt::format("grain.fill.{}", k);
      add_box(name, fill.min, fill.max);
      add(name + ".count", double(fill.count));
      add(name + ".mass", fill.mass);
      add(name + ".packing_fraction", fill.packing_fraction);
      add(name + ".positions", double(fill.positions.size()));
      if (fill.rigid.present) add(name + ".rigid", 1);
      if (!fill.clump.empty()) add(fmt::format("{}.clump = \"{}\"", name, fill.clump), 1);
    }
    add("grain.d_min", c.grain.d_min);
    add("grain.d_max", c.grain.d_max);
  }
  return all;
}

/// A contiguous dataset of fixed size.
Handle create_array(hid_t parent, const std::string& name, hid_t type, int rank, const hsize_t* n) {
  const Handle space(H5Screate_simple(rank, n, nullptr));
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_obj_track_times(creation, false));
  return Handle(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
}

void write_array(hid_t group, const HostArray& a) {
  const hsize_t n[2] = {a.count(), hsize_t(a.components)};
  const Handle table = create_array(group, a.name, h5::file_type(a.type), 2, n);
  check(H5Dwrite(table, h5::memory_type(a.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, a.bytes.data()));
  h5::write_text(table, "unit", a.unit);
}

HostArray read_array(hid_t group, const std::string& store, const std::string& name) {
  const Handle table = h5::open_dataset(group, name);
  const auto n = h5::stored_extent(table);
  if (n.size() != 2 || n[1] == 0) throw h5::Error(fmt::format("{}/{} has an unknown shape", store, name));
  HostArray a{.name = name,
              .unit = h5::read_text(table, "unit"),
              .type = h5::scalar_of(table),
              .components = int(n[1]),
              .bytes = {}};
  a.bytes.resize(n[0] * n[1] * size_of(a.type));
  check(H5Dread(table, h5::memory_type(a.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, a.bytes.data()));
  return a;
}

void write_case_text(hid_t file, const std::string& text) {
  const hsize_t n = text.size();
  const Handle table = create_array(file, "case", H5T_STD_U8LE, 1, &n);
  check(H5Dwrite(table, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
}

void check_fits(hid_t file, const Config& config) {
  if (!h5::has_attribute(file, "format") || !h5::has_attribute(file, "precision"))
    throw h5::Error("it is not a Bedload checkpoint");
  if (const auto format = h5::read_integer(file, "format"); format != kFormat)
    throw h5::Error(fmt::format("it has checkpoint format {}, this version reads {}", format, kFormat));
  if (const auto precision = h5::read_text(file, "precision"); precision != config.precision.name())
    throw h5::Error(
        fmt::format("it has run.precision = {}, but this case has {}", precision, config.precision.name()));
  const Handle setup = h5::open_group(file, "setup");
  const auto expected = particle_setup(config);
  for (const auto& q : expected) {
    if (!h5::has_attribute(setup, q.name.c_str()))
      throw h5::Error(fmt::format("its particles differ: it was written without {}", q.name));
    if (const double found = h5::read_number(setup, q.name.c_str()); found != q.value)
      throw h5::Error(fmt::format("its particles differ: it was written with {} = {}, but this case has {}",
                                  q.name, found, q.value));
  }
  if (const auto stored = h5::attributes(setup); stored.size() != expected.size())
    for (const auto& name : stored)
      if (std::none_of(expected.begin(), expected.end(), [&](const auto& q) { return q.name == name; }))
        throw h5::Error(
            fmt::format("its particles differ: it was written with {}, which this case has not", name));
}

void write_all(hid_t file, const SavedState& state, const Config& config) {
  h5::write_integer(file, "format", kFormat);
  h5::write_text(file, "precision", config.precision.name());
  write_case_text(file, resolved_toml(config));
  const Handle setup = h5::create_group(file, "setup");
  for (const auto& q : particle_setup(config)) h5::write_number(setup, q.name.c_str(), q.value);
  const Handle scalars = h5::create_group(file, "scalars");
  for (const auto& q : state.scalars) {
    h5::write_number(scalars, q.name.c_str(), q.value);
    h5::write_text(scalars, (q.name + ":unit").c_str(), q.unit);
  }
  const Handle stores = h5::create_group(file, "stores");
  for (const auto& store : state.stores) {
    const Handle group = h5::create_group(stores, store.name);
    h5::write_integer(group, "count", std::int64_t(store.count));
    for (const auto& a : store.arrays) write_array(group, a);
  }
}

}  // namespace

void write_state(const std::filesystem::path& path, const SavedState& state, const Config& config) {
  std::size_t bytes = 1 << 20;
  for (const auto& store : state.stores)
    for (const auto& a : store.arrays) bytes += a.bytes.size();
  need_space(path, bytes);

  const auto part = part_of(path);
  try {
    h5::with_file_errors(path, "write", [&] {
      Handle file = h5::open_file(part, h5::Mode::create);
      write_all(file, state, config);
      file.close();
      seal_file(part);
    });
    commit_file(part, path);
  } catch (const FileError&) {
    std::error_code not_there;
    std::filesystem::remove(part, not_there);
    throw;
  }
}

namespace {

/// f(file) on an intact checkpoint.
template <class F>
auto on_checkpoint(const std::filesystem::path& path, F f) {
  if (!std::filesystem::is_regular_file(path)) throw FileError(path.string() + ": cannot read: no such file");
  return h5::with_file_errors(path, "restart from this", [&] {
    if (!h5::is_hdf5(path)) throw h5::Error("it is not an HDF5 file");
    const Seal seal = seal_of(path);
    if (seal == Seal::missing)
      throw h5::Error(
          "no checksum at its end: it is truncated, of an older version or not a Bedload checkpoint");
    if (seal == Seal::broken) throw h5::Error("it is damaged (wrong checksum)");
    const Handle file = h5::open_file(path, h5::Mode::read);
    if (!h5::has_attribute(file, "format")) throw h5::Error("it is not a Bedload checkpoint");
    return f(hid_t(file));
  });
}

}  // namespace

std::map<std::string, double> checkpoint_setup(const std::filesystem::path& path) {
  return on_checkpoint(path, [](hid_t file) {
    const Handle setup = h5::open_group(file, "setup");
    std::map<std::string, double> numbers;
    for (const auto& name : h5::attributes(setup)) numbers[name] = h5::read_number(setup, name.c_str());
    return numbers;
  });
}

std::string checkpoint_case(const std::filesystem::path& path) {
  return on_checkpoint(path, [](hid_t file) {
    const Handle table = h5::open_dataset(file, "case");
    const auto length = h5::stored_extent(table);
    if (length.size() != 1) throw h5::Error("its case is not text");
    std::string text(length[0], ' ');
    check(H5Dread(table, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
    return text;
  });
}

SavedState read_checkpoint(const std::filesystem::path& path, const Config& config) {
  return on_checkpoint(path, [&](hid_t file) {
    check_fits(file, config);
    SavedState state;
    const Handle scalars = h5::open_group(file, "scalars");
    for (const auto& name : h5::attributes(scalars))
      if (!name.ends_with(":unit"))
        state.scalars.push_back(
            {name, h5::read_text(scalars, (name + ":unit").c_str()), h5::read_number(scalars, name.c_str())});
    const Handle stores = h5::open_group(file, "stores");
    for (const auto& name : h5::members(stores)) {
      const Handle group = h5::open_group(stores, name);
      HostStore store{name, std::size_t(h5::read_integer(group, "count")), {}};
      for (const auto& array : h5::members(group)) store.arrays.push_back(read_array(group, name, array));
      state.stores.push_back(std::move(store));
    }
    return state;
  });
}

}  // namespace bedload
