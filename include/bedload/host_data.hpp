#pragma once
// Plain host copies: what starts a simulation and what comes out of it. Writers
// and readers work on these alone and know neither precision nor device.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bedload/core/host_memory.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

enum class Scalar { f32, f64, u32, u64 };

constexpr std::size_t size_of(Scalar t) { return t == Scalar::f32 || t == Scalar::u32 ? 4 : 8; }

/// One named array of `count` tuples of `components` scalars.
struct HostArray {
  std::string name;
  std::string unit;  ///< "m/s"; "-" for a pure number
  Scalar type = Scalar::f64;
  int components = 1;
  HostBytes bytes;

  std::size_t count() const { return bytes.size() / (size_of(type) * components); }
  template <class T>
  const T* as() const {
    return reinterpret_cast<const T*>(bytes.data());
  }
  template <class T>
  T* as() {
    return reinterpret_cast<T*>(bytes.data());
  }
};

/// Places at equal distances, x fastest.
struct HostGrid {
  std::array<std::size_t, 3> count{};  ///< along x, y, z
  Vec3d first;                         ///< m
  double spacing = 0;                  ///< m
  bool operator==(const HostGrid&) const = default;
};

/// All arrays of one store ("fluid", "grains", "walls"), equally long.
struct HostStore {
  std::string name;
  std::size_t count = 0;
  std::vector<HostArray> arrays;
  std::optional<HostGrid> grid =
      {};              ///< of a store whose places are one; the positions are among its arrays, too
  bool lines = false;  ///< each entry is a line: the first array has its two ends in place of a position

  const HostArray* find(const std::string& array) const {
    for (const auto& a : arrays)
      if (a.name == array) return &a;
    return nullptr;
  }

  /// Keeps the entries k for which keep(k) holds.
  template <class Keep>
  void keep_where(Keep keep) {
    std::vector<bool> kept(count);
    for (std::size_t k = 0; k < count; ++k) kept[k] = keep(k);
    const std::size_t before = count;
    for (HostArray& a : arrays) {
      const std::size_t size = before > 0 ? a.bytes.size() / before : 0;
      std::size_t to = 0;
      for (std::size_t k = 0; k < before; ++k)
        if (kept[k]) std::memmove(a.bytes.data() + size * to++, a.bytes.data() + size * k, size);
      a.bytes.resize(size * to);
      count = to;
    }
  }
};

/// One named array where the solver keeps it, host or device memory: `components` scalars of each particle,
/// `stride` bytes from one particle to the next. Right until the next step; `memory` keeps it from being
/// freed even then.
struct FieldView {
  std::string name, unit;
  Scalar type = Scalar::f64;
  int components = 1;
  const void* data = nullptr;
  std::size_t count = 0, stride = 0;
  std::shared_ptr<const void> memory;
};

/// Bytes of one particle of each kind.
struct ParticleBytes {
  std::size_t fluid = 0, walls = 0, grains = 0;
  std::size_t near_grains = 0;  ///< of a pair in the list of near grains, as each of the two has it
  std::size_t near_walls = 0;   ///< of a grain near walls, more than of others

  ParticleBytes& operator+=(const ParticleBytes& o) {
    fluid += o.fluid, walls += o.walls, grains += o.grains, near_grains += o.near_grains;
    near_walls += o.near_walls;
    return *this;
  }
};

/// A number that reaches the user, with its unit.
struct Quantity {
  std::string name;
  std::string unit;
  double value = 0;
};

/// The kept state, to the last bit: `stores` hold arrays, `scalars` clock and totals.
struct SavedState {
  std::vector<HostStore> stores;
  std::vector<Quantity> scalars;
};

/// Initial particles, in double precision, in the order of their ids.
struct Setup {
  struct Fluid {
    std::vector<Vec3d> x, v;          ///< m, m/s
    std::vector<double> mass;         ///< kg
    std::vector<std::uint32_t> fill;  ///< index in FluidConfig::fills
  } fluid;
  struct Walls {
    std::vector<Vec3d> x;             ///< m, at t = 0
    std::vector<std::uint32_t> body;  ///< index in Config::wall.bodies
    std::vector<std::uint8_t> outer;  ///< 1: keeps rho0 (frozen walls, behind their first layer)
    std::vector<Vec3d> mirror;  ///< images in the fluid, m; empty without mdbc walls, else x for all others
  } walls;
  struct Grains {
    std::vector<Vec3d> x, v;          ///< m, m/s
    std::vector<Vec3d> omega;         ///< rad/s; empty: none spins
    std::vector<double> radius;       ///< m
    std::vector<std::uint32_t> fill;  ///< index in GrainConfig::fills
    struct Clump {
      std::uint32_t fill;
      double d;        ///< of the sphere of its volume, m
      Vec3d x;         ///< of its centre of mass, m
      Vec3d v, omega;  ///< m/s, rad/s
      Quat<double> rotation;
    };
    std::vector<Clump> clumps;
    std::vector<std::uint32_t>
        clump;  ///< of each grain 1 + its clump, 0: none; those of one in its spheres' order
  } grains;
  /// With fluid.model = "lattice", instead of fluid and walls.
  struct Nodes {
    static constexpr std::uint32_t kOutside = 0xffffffffu;
    std::array<std::uint32_t, 3> count{};  ///< along x, y, z; x is the fastest
    Vec3d first;                           ///< place of the first node, m
    std::vector<std::uint32_t> solid;      ///< 0: fluid; else index in Config::wall.bodies + 1, or kOutside
    std::vector<Vec3d> v;                  ///< m/s; empty: at rest
    /// From fluid to solid nodes, in the order of bodies.
    struct Links {
      std::vector<std::uint32_t> node, direction, body;  ///< of the fluid; velocity of D3Q19; as above
      std::vector<double> fraction;                      ///< of the link to the surface
    } links;
  } nodes;
};

}  // namespace bedload
