// Outputs of the stores: what frames, Python and the viscometer get. Fields declare theirs; what is computed
// is listed here.

#include <algorithm>
#include <functional>
#include <utility>

#include "bedload/parallel/loops.hpp"
#include "kernels/coupling/fluid_records.hpp"
#include "kernels/stress/coarse_fields.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
namespace {

template <class P>
struct PointPass {
  Frame frame;
  Span<const P> x;
  Span<Real3> out;
  BL_HD void operator()(Index i) const { out[i] = Real3(coordinates(frame, x[i])); }
};
template <class State>
struct PressurePass {
  Span<const State> state;
  Span<Real> out;
  BL_HD void operator()(Index i) const { out[i] = state[i].pressure(); }
};
struct VolumePass {
  Span<const EosState<>> eos_state;
  Span<Real> out;
  BL_HD void operator()(Index a) const { out[a] = mixture_volume(eos_state[a]); }
};
struct DrivingForce {
  Real3 gravity;  ///< m/s2
  Drive drive;
  Span<const Real> mass;
  Span<const EosState<>> eos_state;
  Span<Real3> out;
  BL_HD void operator()(Index a) const { out[a] = mass[a] * (gravity + drive(a, eos_state[a])); }
};
struct GrainTotal {
  PerR3 per_r3;
  Span<const Real> radius;
  Span<Real> out;
  BL_HD void operator()(Index i) const { out[i] = Real(per_r3(i)) * cube(radius[i]); }
};
struct GrainDrivingForce {
  Real3 gravity;  ///< m/s2
  MassPerR3 mass_per_r3;
  Span<const Real> radius;
  Span<const Real3> drive;  ///< N; empty: none
  Span<Real3> out;
  BL_HD void operator()(Index i) const {
    out[i] = Real(mass_per_r3(i)) * cube(radius[i]) * gravity;
    if (drive) out[i] += drive[i];
  }
};

/// Some scalars of each entry, closely packed.
template <class T>
struct PartPass {
  const T* from;
  Index stride, components;
  Span<T> out;
  BL_HD void operator()(Index k) const {
    out[k] = from[std::size_t(k / components) * stride + k % components];
  }
};

/// n entries of T, by compute(entries, out), which writes out[i] for those entries. On a GPU they are there
/// once `copies` have been made; without, or where it has no room, at once, piece by piece, which takes
/// little of its memory.
template <class T, class Compute>
HostArray array_of(HostCopies* copies, const std::string& name, const std::string& unit, std::size_t n,
                   int components, const Compute& compute) {
  HostArray a{name, unit, FileType<T>::scalar, components, {}};
  a.bytes.resize(n * sizeof(T));
  T* const out = a.as<T>();
#if BL_CUDA
  if (T* const there = copies && n > 0 ? copies->room<T>(n, out) : nullptr) {
    compute(Range{0, Index(n)}, Span<T>{there, Index(n)});
    return a;
  }
  constexpr std::size_t most = 1 << 20;
  const Context& context = Context::current();
  Buffer<T>& piece = Context::current().scratch<T>();
  for (std::size_t begin = 0; begin < n; begin += most) {
    const std::size_t end = std::min(n, begin + most);
    piece.reserve_and_resize(end - begin);
    compute(Range{Index(begin), Index(end)}, Span<T>{piece.data() - begin, Index(end)});
    check_cuda(cudaMemcpyAsync(out + begin, piece.data(), (end - begin) * sizeof(T), cudaMemcpyDeviceToHost,
                               context.stream()),
               "copy from the GPU");
  }
  context.wait();
#else
  (void)copies;
  compute(Range{0, Index(n)}, Span<T>{out, Index(n)});
#endif
  return a;
}

HostArray moments(const char* name, const Buffer<PairMoment<>>& buffer) {
  HostArray a{name, "J", FileType<Real>::scalar, 9, {}};
  a.bytes.resize(buffer.size() * sizeof(PairMoment<>));
  copy_to_host(a.bytes.data(), buffer.data(), a.bytes.size());
  return a;
}

// --- outputs of fields -----------------------------------------------------------------------

/// What of a field is written, of the entries that its store owns.
FieldView view_of(const FieldBase& field, const Store& store) {
  const Output& output = *field.output;
  FieldView view = field.view();
  if (output.name) view.name = output.name;
  if (output.unit) view.unit = output.unit;
  view.count = store.owned().size();
  if (output.components == 0) return view;
  view.components = output.components;
  if (view.data) view.data = static_cast<const std::byte*>(view.data) + output.first * size_of(view.type);
  return view;
}

template <class T>
HostArray part_of(HostCopies* copies, const FieldView& view) {
  return array_of<T>(copies, view.name, view.unit, view.count * view.components, view.components,
                     [&](Range scalars, Span<T> out) {
                       for_each(scalars,
                                PartPass<T>{static_cast<const T*>(view.data), Index(view.stride / sizeof(T)),
                                            Index(view.components), out});
                     });
}

HostArray copy_of(HostCopies* copies, const FieldView& view) {
  if (view.stride > view.components * size_of(view.type))
    return view.type == Scalar::f64 ? part_of<double>(copies, view) : part_of<float>(copies, view);
  HostArray whole{view.name, view.unit, view.type, view.components, {}};
  whole.bytes.resize(view.count * view.stride);
  std::byte* const out = whole.bytes.data();
  if (std::byte* const there =
          copies && view.data ? copies->room<std::byte>(whole.bytes.size(), out) : nullptr)
    copy_on_device(there, view.data, whole.bytes.size());
  else
    copy_to_host(out, view.data, whole.bytes.size());
  return whole;
}

// --- computed outputs ------------------------------------------------------------------------

/// The arrays of a store as they are made, in their order.
struct Arrays {
  std::vector<HostArray>& list;
  HostCopies* copies;  ///< null: all are there at once

  void push_back(HostArray a) { list.push_back(std::move(a)); }
  void copy(const FieldView& view) { list.push_back(copy_of(copies, view)); }
  /// By Pass{args..., out}.
  template <class T, class Pass, class... Args>
  void make(const char* name, const char* unit, const Store& store, Args... args) {
    list.push_back(array_of<T>(copies, name, unit, store.owned().size(), FileType<T>::components,
                               [&](Range entries, Span<T> out) {
                                 for_each(entries, Pass{args..., out});
                               }));
  }
};

/// One or several outputs of a store that are made when they are asked for, or copied from a field.
struct Made {
  int order;      ///< as in Output
  unsigned uses;  ///< likewise
  std::function<void(Arrays&)> make;
};

std::vector<Made> computed_of_fluid(State& state, Stepper& stepper, FluidMoments& scratch) {
  FluidStore& f = state.fluid;
  const unsigned where_it_varies = stepper.fluid().lengths() ? kFrames : kNobody;
  return {
      {0, kFrames | kRheology,
       [&](Arrays& out) {
         out.make<Real3, PointPass<FluidPosition>>("position", "m", f, state.frame,
                                                   std::as_const(f.x).span());
       }},
      {3, kFrames,
       [&](Arrays& out) {
         out.make<Real, PressurePass<EosState<>>>("pressure", "Pa", f, std::as_const(f.eos_state).span());
       }},
      {7, kRheology | where_it_varies,
       [&](Arrays& out) {
         out.make<Real, VolumePass>("volume", "m3", f, std::as_const(f.eos_state).span());
       }},
      {8, kRheology,
       [&](Arrays& out) {
         out.make<Real3, DrivingForce>("drive", "N", f, Real3{state.gravity.at(state.clock.time)},
                                       stepper.fluid().drive(f, stepper.moment()),
                                       std::as_const(f.mass).span(), std::as_const(f.eos_state).span());
       }},
      {9, kRheology,
       [&](Arrays& out) {
         stepper.fluid().moments(f, state.walls, stepper.moment(), state.clock.last_dt, scratch);
         out.push_back(moments("stress_pressure", scratch.pressure));
         out.push_back(moments("stress_friction", scratch.friction));
         if (scratch.noise.size() > 0) out.push_back(moments("stress_noise", scratch.noise));
       }},
  };
}

constexpr const char* kStress = "contact_stress";  // evaluates all contacts: only if out.fields names it

std::vector<Made> computed_of_grains(const Config& c, State& state, Stepper& stepper,
                                     Buffer<PairMoment<>>& scratch) {
  GrainStore& g = state.grains;
  const std::vector<std::string>& named = c.out.fields;
  const bool stress = std::find(named.begin(), named.end(), kStress) != named.end() &&
                      !std::as_const(stepper).solids().clumps().any() && !c.domain.sheared();
  return {
      {0, kFrames | kRheology,
       [&](Arrays& out) {
         out.make<Real3, PointPass<Vec3d>>("position", "m", g, state.frame, std::as_const(g.x).span());
       }},
      {5, kRheology,
       [&](Arrays& out) {
         out.make<Real, GrainTotal>("mass", "kg", g, state.matter.of(g), std::as_const(g.radius).span());
       }},
      {6, kRheology,
       [&](Arrays& out) {
         out.make<Real, GrainTotal>("volume", "m3", g, state.matter.volume_of(g),
                                    std::as_const(g.radius).span());
       }},
      {7, kRheology,
       [&](Arrays& out) {
         out.make<Real3, GrainDrivingForce>("drive", "N", g, Real3{state.gravity.at(state.clock.time)},
                                            state.matter.of(g), std::as_const(g.radius).span(),
                                            stepper.drive_grains());
       }},
      {8, std::as_const(stepper).solids().clumps().any() ? unsigned(kFrames) : unsigned(kNobody),
       [&](Arrays& out) {
         const Clumps& clumps = std::as_const(stepper).solids().clumps();
         out.make<Id, ClumpIds>("clump", "-", g, clumps.of_grains(), clumps.store().id.span());
       }},
      {8, stress ? unsigned(kFrames) : unsigned(kNobody),
       [&](Arrays& out) {
         stepper.share_all();
         out.make<GrainStress, GrainStressPass>(
             kStress, "Pa", g, stepper.solids().actions(g, state.poses_now()), state.matter.volume_of(g));
       }},
      {8, kRheology,
       [&](Arrays& out) {
         stepper.solids().contact_moments(g, scratch);
         out.push_back(moments("stress_contact", scratch));
         if (!stepper.solids().lubricates()) return;
         stepper.solids().film_moments(g, scratch);
         out.push_back(moments("stress_lubrication", scratch));
       }},
  };
}

struct ClumpPoint {
  Frame frame;
  Span<const Vec3d> x;
  Span<Real3> out;
  BL_HD void operator()(Index c) const { out[c] = Real3(frame.wrap(x[c])); }
};
struct ClumpSpin {
  ClumpView clumps;
  Span<Real3> out;
  BL_HD void operator()(Index c) const { out[c] = Real3(clumps.omega(c)); }
};

std::vector<Made> computed_of_clumps(State& state, Stepper& stepper) {
  const Clumps& clumps = stepper.solids().clumps();
  return {
      {0, kFrames,
       [&](Arrays& out) {
         out.make<Real3, ClumpPoint>("position", "m", clumps.store(), state.frame, clumps.store().x.span());
       }},
      {2, kFrames,
       [&](Arrays& out) {
         out.make<Real3, ClumpSpin>("angular_velocity", "rad/s", clumps.store(), clumps.view());
       }},
  };
}

std::vector<Made> computed_of_walls(State& state) {
  WallStore& w = state.walls;
  return {
      {0, kFrames,
       [&](Arrays& out) {
         out.make<Real3, PointPass<Vec3d>>("position", "m", w, state.frame, std::as_const(w.x).span());
       }},
      {2, kFrames,
       [&](Arrays& out) {
         out.make<Real, PressurePass<WallState<>>>("pressure", "Pa", w, std::as_const(w.state).span());
       }},
  };
}

/// Takes away the particles of wall bodies that are gone.
void leave_out(const std::vector<bool>& removed, HostStore& walls) {
  if (walls.count == 0 || removed.empty()) return;
  const HostBytes bytes = walls.find("body")->bytes;
  const auto* body = reinterpret_cast<const std::uint32_t*>(bytes.data());
  walls.keep_where([&](std::size_t k) { return body[k] >= removed.size() || !removed[body[k]]; });
}

#if BL_CUDA
/// A store that is on its way.
struct Coming {
  explicit Coming(HostStore s) : store(std::move(s)) {}
  ~Coming() {
    try {
      if (there) there->wait();  // its memory must not serve others before
    } catch (const DeviceError&) {
    }
  }
  HostStore take() {
    std::exchange(there, nullptr)->wait();
    leave_out(removed, store);
    if (store.name == "clumps") order_by_id(store);
    return std::move(store);
  }

  HostStore store;
  std::shared_ptr<const Moment> there = nullptr;
  std::vector<bool> removed = {};
};
#endif

}  // namespace

const Store* CoupledSimulation::store_named(const std::string& name) const {
  if (name == "fluid" && state_.has_fluid) return &state_.fluid;
  if (name == "grains" && state_.has_grains) return &state_.grains;
  if (name == "clumps" && state_.has_grains && std::as_const(stepper_).solids().clumps().any())
    return &std::as_const(stepper_).solids().clumps().store();
  if (name == "walls" && state_.walls.everywhere() > 0) return &state_.walls;
  return nullptr;
}

std::vector<const FieldBase*> CoupledSimulation::written(const Store& store, Use by) const {
  std::vector<const FieldBase*> out;
  for (const FieldBase* f : store.fields())
    if (f->used() && f->output && (f->output->uses & by) && (state_.coupled || !f->output->coupled))
      out.push_back(f);
  return out;
}

HostStore CoupledSimulation::outputs(const std::string& name, Use by, HostCopies* copies) {
  HostStore out{name, 0, {}};
  const Store* const store = store_named(name);
  if (!store) return out;
  out.count = store->owned().size();
  std::vector<Made> all = store == &state_.fluid ? computed_of_fluid(state_, stepper_, fluid_moments_)
                          : store == &state_.grains
                              ? computed_of_grains(config_, state_, stepper_, contact_moments_)
                          : store == &state_.walls ? computed_of_walls(state_)
                                                   : computed_of_clumps(state_, stepper_);
  for (const FieldBase* f : written(*store, by))
    all.push_back({f->output->order, by, [=](Arrays& arrays) { arrays.copy(view_of(*f, *store)); }});
  std::stable_sort(all.begin(), all.end(), [](const Made& a, const Made& b) { return a.order < b.order; });
  Arrays arrays{out.arrays, copies};
  for (const Made& each : all)
    if (each.uses & by) each.make(arrays);
  add_blocks(out);
  return out;
}

void CoupledSimulation::add_blocks(HostStore& out) {
  if (!Context::current().several()) return;
  if (out.name == "grains") out.arrays.push_back(stepper_.blocks_of_grains());
  if (out.name == "fluid") out.arrays.push_back(stepper_.fluid().blocks(state_.fluid));
  if (out.name == "walls" || out.name == "mirrors")
    out.arrays.push_back(stepper_.fluid().blocks(state_.walls));
}

HostStore CoupledSimulation::snapshot(const std::string& name) {
  if (name.starts_with("wear/") && state_.has_grains) {
    const int body = wall_named(name.substr(5));
    return stepper_.solids().wear()->frame(body, name, state_.motion.pose(body, state_.clock.time));
  }
  if (name == "contacts" && state_.has_grains) return stepper_.solids().contact_lines(state_.grains);
  HostStore out = outputs(name, kFrames, nullptr);
  if (name == "walls") leave_out(removed_walls(), out);
  if (name == "clumps" && out.count > 0) order_by_id(out);
  return out;
}

std::vector<bool> CoupledSimulation::removed_walls() const {
  if (!state_.motion.any_removed()) return {};
  std::vector<bool> removed(std::size_t(state_.motion.walls()));
  for (std::size_t b = 0; b < removed.size(); ++b) removed[b] = state_.motion.removed(int(b));
  return removed;
}

Later<HostStore> CoupledSimulation::snapshot_later(const std::string& name) {
#if BL_CUDA
  if (store_named(name) && !Context::current().several()) {
    HostCopies& copies = copies_[name];
    copies.begin();
    auto coming = std::make_shared<Coming>(outputs(name, kFrames, &copies));
    coming->there = copies.end();
    if (name == "walls") coming->removed = removed_walls();
    return [coming] { return coming->take(); };
  }
#endif
  return Simulation::snapshot_later(name);
}

HostStore CoupledSimulation::rheology(const std::string& name) {
  stepper_.share_all();
  return outputs(name, kRheology, nullptr);
}

std::vector<FieldView> CoupledSimulation::fields(const std::string& name) {
  Context::current().wait();
  std::vector<FieldView> out;
  const Store* const store = store_named(name);
  if (!store) return out;
  for (const FieldBase* f : written(*store, kViews)) out.push_back(view_of(*f, *store));
  return out;
}

ParticleBytes CoupledSimulation::field_bytes() const {
  const std::vector<WallBody>& walls = config_.wall.bodies;
  const bool mirrored = std::any_of(
      walls.begin(), walls.end(), [](const WallBody& body) { return body.type->kind == WallKind::mirrored; });
  return {state_.fluid.entry_bytes(),
          state_.walls.entry_bytes() + (mirrored ? state_.walls.mirrors.entry_bytes() : 0),
          state_.grains.entry_bytes()};
}

}  // namespace BL_SOLVER
