#include "src/solids/wear_books.hpp"

#include <algorithm>
#include <cstring>

#include "bedload/core/error.hpp"
#include "bedload/parallel/ranks.hpp"
#include "bedload/particles/field.hpp"

namespace BL_SOLVER {
namespace {

template <class T>
HostArray array_of(const char* name, const char* unit, const std::vector<T>& values) {
  HostArray a{name, unit, FileType<T>::scalar, FileType<T>::components, {}};
  a.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(a.bytes.data(), values.data(), a.bytes.size());
  return a;
}

/// Of all ranks.
std::vector<WearSums> everywhere(const Buffer<WearSums>& own) {
  std::vector<WearSums> sums = own.to_host();
  all_reduce(sums, [](WearSums& into, const WearSums& more) { into.add(more); });
  return sums;
}

bool any(const WideSum& sum) { return (sum.low | sum.high) != 0; }

}  // namespace

WearBooks::WearBooks(const SolidParameters& p) : grids_(p.wear), sums_(p.wear.size()) {
  double heaviest = 0;
  for (const GrainMaterial& m : p.materials) heaviest = std::max(heaviest, m.rho * cube(p.d_max));
  unit_ = 1e-16 * heaviest;  // of the energy at 1 m/s, so that single substeps are counted
  for (std::size_t b = 0; b < grids_.size(); ++b) {
    const WearGrid& grid = grids_[b];
    WearMap map{.lo = grid.lo, .size = grid.size, .count = {grid.count[0], grid.count[1], grid.count[2]}};
    if (grid.wears()) sums_[b].resize(std::size_t(map.patches())), map.sums = sums_[b].data();
    maps_.push_back(map);
  }
  device_maps_.assign(maps_);
}

void WearBooks::forget() {
  for (Buffer<WearSums>& sums : sums_) sums.zero();
}

HostStore WearBooks::frame(int body, const std::string& name, const RigidMotion& pose) const {
  const WearGrid& grid = grids_[std::size_t(body)];
  const WearMap& map = maps_[std::size_t(body)];
  const std::vector<WearSums> sums = everywhere(sums_[std::size_t(body)]);
  std::vector<Vec3d> position;
  std::vector<std::uint32_t> id;
  std::vector<double> path, normal, shear, time, cut, volume, depth;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (!any(sums[k].path) && !any(sums[k].normal) && !any(sums[k].shear) && !any(sums[k].time) &&
        !any(sums[k].cut))
      continue;
    position.push_back(pose.place(map.middle(int(k))));
    id.push_back(std::uint32_t(k));
    path.push_back(sums[k].path.value() * unit_);
    normal.push_back(sums[k].normal.value() * unit_);
    shear.push_back(sums[k].shear.value() * unit_);
    time.push_back(sums[k].time.value() * WallWear::kTime);
    cut.push_back(sums[k].cut.value() * unit_);
    volume.push_back(grid.k_over_H * (grid.law == WearLaw::finnie ? cut : path).back());
    depth.push_back(volume.back() / square(grid.size));
  }
  return {name,
          id.size(),
          {array_of("position", "m", position), array_of("id", "-", id), array_of("force_path", "N m", path),
           array_of("normal_energy", "J", normal), array_of("shear_energy", "J", shear),
           array_of("contact_time", "s", time), array_of("cutting_energy", "J", cut),
           array_of("wear_volume", "m3", volume), array_of("wear_depth", "m", depth)}};
}

void WearBooks::save(std::vector<HostStore>& stores) const {
  std::vector<WearSums> all;
  for (const Buffer<WearSums>& sums : sums_) {
    const std::vector<WearSums> here = everywhere(sums);
    all.insert(all.end(), here.begin(), here.end());
  }
  stores.push_back({"wear", all.size(), {array_of("sums", "-", all)}});
}

void WearBooks::load(const std::vector<HostStore>& stores) {
  forget();
  const auto store =
      std::find_if(stores.begin(), stores.end(), [](const HostStore& s) { return s.name == "wear"; });
  if (store == stores.end()) return;
  std::size_t wanted = 0, done = 0;
  for (const Buffer<WearSums>& sums : sums_) wanted += sums.size();
  const HostArray* const a = store->find("sums");
  if (!a || a->type != FileType<WearSums>::scalar || a->components != FileType<WearSums>::components ||
      store->count != wanted || a->count() != wanted)
    throw FileError("checkpoint: the patches of walls that wear are others than in this case");
  if (Context::current().rank() > 0) return;  // the first rank has what was before
  for (Buffer<WearSums>& sums : sums_) {
    const auto* const first = reinterpret_cast<const WearSums*>(a->bytes.data()) + done;
    done += sums.size();
    sums.assign(std::vector<WearSums>(first, first + sums.size()));
  }
}

}  // namespace BL_SOLVER
