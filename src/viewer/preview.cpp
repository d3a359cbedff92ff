#include "src/viewer/preview.hpp"

#include <fmt/format.h>

#include <numeric>

#include "bedload/core/error.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "picture.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

template <class T>
HostArray array_of(const char* name, const char* unit, Scalar type, int components,
                   const std::vector<T>& values) {
  HostArray a{name, unit, type, components, {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  a.bytes.assign(bytes, bytes + values.size() * sizeof(T));
  return a;
}

HostArray vectors(const char* name, const char* unit, const std::vector<Vec3d>& values) {
  return array_of(name, unit, Scalar::f64, 3, values);
}

HostArray ids(std::size_t count) {
  std::vector<std::uint32_t> id(count);
  std::iota(id.begin(), id.end(), 0u);
  return array_of("id", "-", Scalar::u32, 1, id);
}

struct Writer {
  const fs::path& folder;
  bool doubles;

  void operator()(const HostStore& store) const {
    const FrameFile file(folder / (store.name + ".vtkhdf"), doubles);
    file.keep(0);
    std::error_code not_there;
    fs::remove(folder / (store.name + ".xdmf"), not_there);
    if (store.count == 0) return;
    file.append(store, 0);
    file.write_xdmf();
  }

  /// Particles with velocities and one scalar field more.
  template <class Particles>
  void operator()(const char* store, const Particles& p, const char* field, const char* unit,
                  const std::vector<double>& values) const {
    (*this)({store,
             p.x.size(),
             {vectors("position", "m", p.x), vectors("velocity", "m/s", p.v),
              array_of(field, unit, Scalar::f64, 1, values), ids(p.x.size())}});
  }
};

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / "case.resolved.toml", error))
    throw FileError(folder.string() + ": holds a run; choose another folder for --preview");
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw FileError(fmt::format("{}: cannot write the preview: {}", folder.string(),
                                error ? error.message() : "Not a directory"));
}

}  // namespace

void write_preview(const fs::path& folder, const Config& config, const Setup& setup) {
  make_folder(folder);
  const Setup::Walls walls = config.fluid.lattice() ? wall_surfaces(config, config.fluid.dx)
                             : config.fluid.present ? setup.walls
                                                    : wall_surfaces(config, config.grain.d_min);
  const Writer write{folder, config.precision == Precision::fp64};
  write("fluid", setup.fluid, "mass", "kg", setup.fluid.mass);
  write("grains", setup.grains, "radius", "m", setup.grains.radius);
  write({"walls",
         walls.x.size(),
         {vectors("position", "m", walls.x), array_of("body", "-", Scalar::u32, 1, walls.body),
          ids(walls.x.size())}});
  picture_of(config, setup).write_png(folder / "preview.png");
}

}  // namespace bedload
