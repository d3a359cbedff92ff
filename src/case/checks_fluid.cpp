// Keys of the fluid against others.

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bedload/case/formula.hpp"
#include "bedload/geometry/depth.hpp"
#include "checks.hpp"
#include "units.hpp"

namespace bedload {

void Checks::fluid() const {
  const FluidConfig& f = c.fluid;
  double particles = 0;
  for (std::size_t i = 0; i < f.fills.size(); ++i) {
    const std::string path = fmt::format("fluid.fill.{}", i);
    if (!f.fills[i].file.empty()) continue;  // its particles are checked one by one
    box(path, f.fills[i].min, f.fills[i].max);
    if (!f.fills[i].solid.shape) {
      inside_domain(path + ".min", f.fills[i].min);
      inside_domain(path + ".max", f.fills[i].max);
    }
    const Vec3d side = f.fills[i].max - f.fills[i].min;
    particles += side.x * side.y * side.z / c.domain.cell_volume(f.dx);
    initial_speed(f.fills[i]);
  }
  if (particles >= 2147483648.0)
    fail("fluid.dx", f.dx,
         fmt::format("must be larger; it makes {:.3g} fluid particles of at most 2147483647", particles));
  const double fall = height(std::vector<DomainConfig>{c.domain}, c.gravity);
  if (const double v = std::sqrt(2 * norm(c.gravity) * fall); !c.inlets.empty() && v > f.vmax * (1 + 1e-9))
    warn(
        "fluid.vmax = {:.3g} m/s sets the sound speed; fluid from an inlet that stands or falls as high as "
        "the domain, {:.3g} m, reaches {:.3g} m/s",
        f.vmax, fall, v);
  falling_grains();
  if (const double v = given("fluid.vmax", "m/s"); v < f.vmax * (1 - 1e-9))
    warn(
        "fluid.vmax = {:.3g} m/s: not used, since a fall through the fluid's height, a wall or an inlet "
        "reaches {:.3g} m/s",
        v, f.vmax);
  if (unsupported()) warn("no wall.body stops the fluid, which leaves the domain along gravity");
  if (f.c < 10 * f.vmax * (1 - 1e-9))
    warn(
        "fluid.c_factor: sound is only {:.3g} times as fast as the flow (Mach {:.2g}); density will vary "
        "by more "
        "than 1 %",
        f.c / f.vmax, f.vmax / f.c);
  if (const double stiffness = f.rho0 * f.c * f.c; !(stiffness < 1e30))
    fail("fluid.vmax", f.vmax,
         fmt::format("must be lower; with it rho0 c^2 is {:.3g} Pa, which must stay below 1e30", stiffness));
  if (coupled() && f.mu == 0) fail("fluid.mu", f.mu, "must be > 0 with grains; drag needs mu");
  model();
  if (!f.species.empty()) species();
  if (c.visc.collision && c.sdpd.kT > 0)
    fail("visc.collision", "true",
         "must be false with sdpd.kT > 0, since collisions take out what noise brings");
  if (c.drive.factor != DriveConfig().factor) drive();
  if (!c.grain.present && c.drive.on != DrivenPhase::fluid)
    fail("drive.on", quoted(c.drive.on.name()), "must be \"fluid\" without [grain]");
  if (f.variable_h) variable_h();
}

double Checks::given(const char* path, const char* unit) const {
  const Value& value = nearest_value(root_, path);
  if (const auto* number = value.get<double>()) return *number;
  if (const auto* whole = value.get<std::int64_t>()) return double(*whole);
  const auto* text = value.get<std::string>();
  return text ? quantity(*text, unit) : std::numeric_limits<double>::infinity();
}

bool Checks::unsupported() const {
  const ReflectConfig& r = c.domain.reflect;
  for (int k = 0; k < 3; ++k) {
    const std::size_t below = 2 * std::size_t(k) + (c.gravity[k] > 0);
    if (c.gravity[k] != 0 && (c.domain.periodic[k] || r.slip[below] || r.no_slip[below])) return false;
  }
  return norm(c.gravity) > 0 && std::none_of(c.wall.bodies.begin(), c.wall.bodies.end(),
                                             [](const WallBody& body) { return body.stops_fluid(); });
}

void Checks::species() const {
  const FluidConfig& f = c.fluid;
  std::set<std::string> names;
  std::string all;
  for (std::size_t k = 0; k < f.species.size(); ++k) {
    if (!names.insert(f.species[k].name).second)
      fail(fmt::format("fluid.species.{}.name", k), quoted(f.species[k].name),
           "must differ from other species'");
    all += (all.empty() ? "" : ", ") + f.species[k].name;
  }
  for (std::size_t i = 0; i < f.fills.size(); ++i)
    if (const std::string& name = f.fills[i].species; !name.empty() && !names.contains(name))
      fail(fmt::format("fluid.fill.{}.species", i), quoted(name),
           "must name a fluid.species; this case has " + all);
  for (const auto& [there, what] : {std::pair{coupled(), "grains that the fluid acts on"},
                                    {!c.inlets.empty(), "[[inlet]]"},
                                    {c.time.integrator == TimeIntegrator::ab3, "time.integrator = \"ab3\""}})
    if (there)
      fail("fluid.species", fmt::format("{} fluids", f.species.size()),
           fmt::format("must be none with {}", what));
}

void Checks::drive() const {
  const Formula factor = [&] {
    try {
      return Formula(c.drive.factor, "xyzt");
    } catch (const CaseError& error) {
      fail("drive.factor", quoted(c.drive.factor),
           fmt::format("must be a formula in x, y, z, t: {}", error.what()));
    }
  }();
  const Vec3d side = c.domain.max - c.domain.min;
  for (int n = 0; n < 1000; ++n) {
    const double t = c.time.end * (n / 125) / 7.0;
    const Vec3d s{(n % 5) / 4.0, (n / 5 % 5) / 4.0, (n / 25 % 5) / 4.0};
    const Vec3d x{c.domain.min.x + s.x * side.x, c.domain.min.y + s.y * side.y,
                  c.domain.min.z + s.z * side.z};
    if (!std::isfinite(factor(x, t)))
      fail("drive.factor", quoted(c.drive.factor),
           fmt::format("must be finite; it is not at {} m, t = {:.4g} s", to_text(x), t));
  }
}

void Checks::variable_h() const {
  const std::string with = "with fluid.variable_h";
  if (!c.fluid.model->variable_h)
    fail("fluid.model", quoted(c.fluid.model.name()),
         "must be \"" + names_with(&Named<FluidModel>::variable_h) + "\" " + with);
  if (c.fluid.kernel == KernelFunction::lucy)
    fail("fluid.kernel", "\"lucy\"", "must be wendland_c2 or cubic " + with);
  if (c.time.integrator == TimeIntegrator::ab3)
    fail("time.integrator", "\"ab3\"", "must be \"kdk\" or \"euler\" " + with);
  for (const auto& [key, value] : {std::pair{"shift.A", c.shift}, {"xsph", c.xsph}, {"tensile", c.tensile}})
    if (value != 0) fail(key, value, "must be 0 " + with);
  if (c.pressure.linear_exact) fail("pressure.linear_exact", "true", "must be false " + with);
  if (!c.fluid.species.empty())
    fail("fluid.species", fmt::format("{} fluids", c.fluid.species.size()), "must be none " + with);
  if (c.visc.collision) fail("visc.collision", "true", "must be false " + with);
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
    if (const WallBody& body = c.wall.bodies[i]; !body.type->variable_h)
      fail(fmt::format("wall.body.{}.type", i), quoted(body.type.name()),
           "must be " + names_with(&Named<WallType>::variable_h) + " " + with);
}

void Checks::model() const {
  const Chosen<FluidModel> model = c.fluid.model;
  const std::string with = fmt::format("with fluid.model = \"{}\"", model.name());
  if (c.domain.two_d && !model->plane) fail("domain.two_d", "true", "must be false " + with);
  if (!model->smoothed) smoothing(with);
  if (c.visc.model != ViscosityModel::none && model->own_viscosity)
    fail("visc.model", quoted(c.visc.model.name()),
         fmt::format("must be \"none\" {}, which brings its own viscosity", with));
  if (c.time.integrator != TimeIntegrator::kdk && !model->integrators)
    fail("time.integrator", quoted(c.time.integrator.name()), "must be \"kdk\" " + with);
  if (model->thermal) thermal(with);
  if (model->own_viscosity) bulk_viscosity();
  if (model->summation) summation();
}

void Checks::smoothing(const std::string& with) const {
  for (const auto& [key, value] : {std::pair{"shift.A", c.shift},
                                   {"xsph", c.xsph},
                                   {"tensile", c.tensile},
                                   {"pressure.damper", c.pressure.damper},
                                   {"density.delta", c.density.delta},
                                   {"density.void_relaxation", c.density.void_relaxation},
                                   {"visc.alpha", c.visc.alpha},
                                   {"visc.beta", c.visc.beta}})
    if (value != 0)
      fail(key, value,
           "must be 0 " + with + (c.fluid.model->thermal ? "; thermal noise would trigger it" : ""));
  if (c.pressure.linear_exact) fail("pressure.linear_exact", "true", "must be false " + with);
}

void Checks::thermal(const std::string& with) const {
  const FluidConfig& f = c.fluid;
  const SdpdConfig& s = c.sdpd;
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    const WallBody& body = c.wall.bodies[i];
    const std::string key = fmt::format("wall.body.{}.type", i);
    if (!body.type->thermal)
      fail(key, quoted(body.type.name()), "must be " + names_with(&Named<WallType>::thermal) + " " + with);
    if (body.type->kind == WallKind::frozen && body.free.present && f.model->spins)
      fail(key, quoted(body.type.name()),
           "must be \"adami\" for a free body " + with + ", since frozen particles take up couples");
  }
  if (s.force_scale.size() != 4)
    fail("sdpd.force_scale", fmt::format("[{}]", fmt::join(s.force_scale, ", ")),
         "must be four numbers: pressure, friction, friction of spins, noise");
  const double thermal = std::sqrt(3 * s.kT / (f.rho0 * c.domain.cell_volume(f.dx)));
  if (thermal > 0.3 * f.c)
    warn("sdpd.kT: particles move at {:.3g} m/s by heat alone, sound at {:.3g}; density will vary widely",
         thermal, f.c);
}

void Checks::bulk_viscosity() const {
  const FluidConfig& f = c.fluid;
  const bool tensor = c.sdpd.noise == NoiseForm::tensor && f.model->spins && c.sdpd.kT > 0;
  const double most = 5.0 / 3 * f.mu, least = tensor ? 40.0 / 51 * f.mu : 0;
  if (f.zeta > most * (1 + 1e-9) || f.zeta < least * (1 - 1e-9))
    fail("fluid.zeta", f.zeta,
         fmt::format("must be within {:.6g}..{:.6g}, {}..5/3 of fluid.mu{}", least, most,
                     tensor ? "40/51" : "0", tensor ? " with sdpd.noise = \"tensor\"" : ""));
}

void Checks::summation() const {
  if (c.density.reinit_every > 0 && c.density.method != DensityMethod::continuity)
    fail("density.reinit_every", c.density.reinit_every, "must be 0 unless density.method = \"continuity\"");
  if (!c.density.count_grains || !c.grain.present) return;
  const auto counting = [&](bool fits, const std::string& must) {
    if (!fits) fail("density.count_grains", "true", "must be false unless " + must);
  };
  counting(c.density.method == DensityMethod::summation, "density.method = \"summation\"");
  counting(c.couple.mode == CouplingMode::two_way, "couple.mode = \"two_way\"");
  counting(c.couple.hc >= c.fluid.h() * (1 - 1e-9),
           fmt::format("couple.hc is at least the smoothing length, {:.6g} m", c.fluid.h()));
}

void Checks::falling_grains() const {
  if (!c.grain.present || c.grain.settle || c.grain.fixed) return;
  std::vector<DomainConfig> all;
  for (const FluidFill& fill : c.fluid.fills) all.push_back({.min = fill.min, .max = fill.max});
  const std::size_t fluid = all.size();
  for (const GrainFill& fill : c.grain.fills)
    if (fill.file.empty() && fill.positions.empty()) all.push_back({.min = fill.min, .max = fill.max});
  if (fluid == 0 || all.size() == fluid) return;
  const double fall = height(all, c.gravity), v = std::sqrt(2 * norm(c.gravity) * fall);
  if (v > c.fluid.vmax * (1 + 1e-9))
    warn(
        "fluid.vmax = {:.3g} m/s sets the sound speed; grains that fall {:.3g} m into the fluid reach "
        "{:.3g} m/s",
        c.fluid.vmax, fall, v);
}

void Checks::initial_speed(const FluidFill& fill) const {
  const Formula u(fill.velocity[0]), v(fill.velocity[1]), w(fill.velocity[2]);
  double fastest = 0;
  for (int i = 0; i < 125; ++i) {
    const Vec3d s{(i % 5) / 4.0, (i / 5 % 5) / 4.0, (i / 25) / 4.0}, side = fill.max - fill.min;
    const Vec3d x{fill.min.x + s.x * side.x, fill.min.y + s.y * side.y, fill.min.z + s.z * side.z};
    fastest = std::max(fastest, norm(Vec3d{u(x), v(x), w(x)}));
  }
  if (fastest > c.fluid.vmax * (1 + 1e-9))
    warn(
        "fluid.fill.velocity reaches {:.3g} m/s, above fluid.vmax = {:.3g}, from which the sound speed "
        "follows",
        fastest, c.fluid.vmax);
}
}  // namespace bedload
