// Keys of grains and coupling against others.

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "bedload/case/contact_laws.hpp"
#include "bedload/case/grain_sizes.hpp"
#include "bedload/case/limits.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/case/particle_file.hpp"
#include "bedload/geometry/depth.hpp"
#include "checks.hpp"

namespace bedload {

void Checks::grains() const {
  constexpr double kMostSizeRatio = 1000;  // cells of the smallest would be too many
  const GrainConfig& g = c.grain;
  if (const double ratio = g.d_max / g.d_min; ratio > kMostSizeRatio * (1 + 1e-9))
    fail("grain.fill", fmt::format("{:.4g}..{:.4g} m", g.d_min, g.d_max),
         fmt::format("must span at most a factor of {} in diameter, not {:.4g}", kMostSizeRatio, ratio));
  for (std::size_t i = 0; i < g.fills.size(); ++i) grain_fill(fmt::format("grain.fill.{}", i), g.fills[i]);
  if (c.contact.k == 0 && c.contact.normal == NormalLaw::linear)
    missing("contact.k", "spring, N/m, with contact.normal = \"linear\"");
  if (g.settle && norm(c.gravity) == 0) fail("grain.settle", "true", "must be false without gravity");
  if (g.settle && g.fixed) fail("grain.settle", "true", "must be false with grain.fixed");
  for (const auto& [key, given] :
       {std::pair{"grain.settle_time", g.settle_time > 0}, {"grain.settle_mu", std::isfinite(g.settle_mu)}})
    if (given && !g.settle) warn("{}: not used, since grain.settle = false", key);
  if (!c.contact.cap_rolling && c.contact.rolling == RollingLaw::cdt)
    warn("contact.cap_rolling = false: resting grains will buzz and heaps creep");
  if (c.contact.he_damping) warn("paper.he_damping: the restitution reached is below grain.e");
  if (!c.fluid.present && c.drive.factor != DriveConfig().factor) drive();
  softness();
  if (coupled()) resolution();
  if (c.lubrication.acts()) lubrication();
  materials();
  clumps();
  if (!c.fluid.present && c.drive.on_fluid())
    fail("drive.on", quoted(c.drive.on.name()), "must be \"grains\" without [fluid]");
}

void Checks::grain_fill(const std::string& path, const GrainFill& fill) const {
  if (fill.file.empty())
    for (const Vec3d& x : listed_grains(fill, c.domain).x) inside_domain(path + ".positions", x);
  for (const auto& [key, list] : {std::pair{".velocities", &fill.velocities}, {".spins", &fill.spins}})
    if (!list->empty() && list->size() != fill.positions.size())
      fail(path + key, fmt::format("{} vectors", list->size()),
           fmt::format("must be as many as positions, {}", fill.positions.size()));
  if (fill.replaces_fluid && (!c.fluid.present || c.grain.settle))
    fail(path + ".replaces_fluid", "true", "must be false without [fluid], and with grain.settle");
  if (fill.rigid.present && fill.rigid.turn != BodyTurn::none && fill.positions.empty() && fill.file.empty())
    for (int k = 0; k < 3; ++k)
      if (c.domain.periodic[k] &&
          fill.max[k] - fill.min[k] > c.domain.max[k] - c.domain.min[k] - c.grain.largest())
        warn(
            "grain.fill.rigid: the group fills the period along {}, across which it hangs together; turn = "
            "\"none\" "
            "keeps it from turning against its images",
            "xyz"[k]);
  if (fill.rigid.present && (fill.spin != Vec3d{} || !fill.spins.empty() || !fill.velocities.empty()))
    fail(path + ".rigid", "[grain.fill.rigid]",
         "must be left out where grains have their own spins or velocities");
  if (!fill.every.empty()) {
    const bool whole =
        std::all_of(fill.every.begin(), fill.every.end(), [](double n) { return n == std::round(n); });
    if ((fill.every.size() != 3 && fill.every.size() != 1) || !whole)
      fail(path + ".every", fmt::format("[{}]", fmt::join(fill.every, ", ")),
           "must be one whole number, or three");
    if (!c.fluid.present)
      fail(path + ".every", "given", "must be left out without [fluid], whose lattice it counts");
  }
  if (!fill.positions.empty() || !fill.file.empty()) return;
  box(path, fill.min, fill.max);
  if (!fill.solid.shape) {
    inside_domain(path + ".min", fill.min);
    inside_domain(path + ".max", fill.max);
  }
  if (!fill.every.empty()) return;
  if ((fill.count > 0) + (fill.mass > 0) + (fill.packing_fraction > 0) != 1)
    throw CaseError(fmt::format("{}: grain.fill must have exactly one of count, mass and packing_fraction",
                                nearest_value(root_, path).place()));
  const double fraction = solid_volume(fill, c.grain.density(fill)) / fill_volume(fill);
  const double densest = densest_packing(fill.sizes);
  if (fraction <= densest) return;
  if (fill.packing_fraction > 0)
    fail(path + ".packing_fraction", fill.packing_fraction,
         fmt::format("must be <= {:.2g}, the densest random packing of these sizes", densest));
  const bool by_mass = fill.mass > 0;
  fail(path + (by_mass ? ".mass" : ".count"), fmt::format("{}", by_mass ? fill.mass : double(fill.count)),
       fmt::format(
           "must fit the space to fill; it takes {:.0f} % where {:.0f} % is the densest random packing "
           "of these sizes",
           100 * fraction, 100 * densest));
}

void Checks::clumps() const {
  constexpr double kFilled = 0.9;
  for (const ClumpConfig& clump : c.grain.clumps)
    if (clump.filled < kFilled)
      warn(
          "clump.count: the spheres of \"{}\" fill {:.0f} % of the volume of its shape, and weigh as much "
          "less; "
          "more of them fill more",
          clump.name, 100 * clump.filled);
  const auto check = [&](const std::string& path, const std::string& clump) {
    if (clump.empty()) return;
    const auto refuse = [&](bool given, const char* what) {
      if (given) fail(path + ".clump", quoted(clump), fmt::format("must be left out with {}", what));
    };
    refuse(c.domain.two_d, "domain.two_d: clumps turn in three dimensions");
    refuse(c.density.count_grains, "density.count_grains");
    refuse(c.couple.undisturbed, "couple.undisturbed");
    refuse(c.fluid.present && c.fluid.lattice(), "fluid.model = \"lattice\"");
  };
  for (std::size_t k = 0; k < c.grain.fills.size(); ++k)
    check(fmt::format("grain.fill.{}", k), c.grain.fills[k].clump);
  for (std::size_t k = 0; k < c.grain_inlets.size(); ++k)
    check(fmt::format("grain_inlet.{}", k), c.grain_inlets[k].clump);
}

void Checks::materials() const {
  std::set<std::string> names;
  std::string all;
  for (std::size_t k = 0; k < c.grain.materials.size(); ++k) {
    const std::string& name = c.grain.materials[k].name;
    if (!names.insert(name).second)
      fail(fmt::format("grain.material.{}.name", k), quoted(name), "must differ from other materials'");
    all += (all.empty() ? "" : ", ") + name;
  }
  const auto known = [&](const std::string& path, const std::string& name) {
    if (!name.empty() && !names.contains(name))
      fail(path + ".material", quoted(name),
           "must name a grain.material; this case has " + (all.empty() ? "none" : all));
  };
  for (std::size_t i = 0; i < c.grain.fills.size(); ++i)
    known(fmt::format("grain.fill.{}", i), c.grain.fills[i].material);
  for (std::size_t i = 0; i < c.grain_inlets.size(); ++i)
    known(fmt::format("grain_inlet.{}", i), c.grain_inlets[i].material);
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
    known(fmt::format("wall.body.{}", i), c.wall.bodies[i].material);
}

void Checks::grain_energy() const {
  if (!c.grain.present && c.out.contacts != ContactFrames::none)
    fail("out.contacts", '"' + c.out.contacts.name() + '"', "must be \"none\" without [grain]");
  for (const auto& [there, what] :
       {std::pair{!c.grain.present, "without [grain]"}, {c.grain.fixed, "with grain.fixed"}}) {
    if (!there) continue;
    for (const auto& [key, asked] : {std::pair{"out.energy", c.out.energy}, {"out.spectra", c.out.spectra}})
      if (asked) fail(key, "true", fmt::format("must be false {}", what));
    for (std::size_t b = 0; b < c.wall.bodies.size(); ++b)
      if (c.wall.bodies[b].wear != WearLaw::none)
        fail(fmt::format("wall.body.{}.wear", b), '"' + c.wall.bodies[b].wear.name() + '"',
             fmt::format("must be \"none\" {}", what));
  }
  constexpr std::size_t kMostSizes = 8;  // as in ContactSpectra
  if (const std::vector<double>& sizes = c.out.spectra_sizes;
      c.out.spectra &&
      (sizes.size() >= kMostSizes ||
       std::adjacent_find(sizes.begin(), sizes.end(), std::greater_equal<>()) != sizes.end()))
    fail("out.spectra_sizes", fmt::format("[{}]", fmt::join(sizes, ", ")),
         fmt::format("must be up to {} diameters in rising order", kMostSizes - 1));
  for (std::size_t b = 0; b < c.wall.bodies.size(); ++b) {
    const WallBody& body = c.wall.bodies[b];
    if (body.wear == WearLaw::none) continue;
    constexpr double kMost = 4e6;
    const WearPatches patches(body, c.domain, c.grain.largest());
    if (patches.number() > kMost)
      fail(fmt::format("wall.body.{}.wear_patch", b), fmt::format("{} m", patches.size),
           fmt::format("must be larger: the map of the body has {:.3g} patches, of at most {:.3g}",
                       patches.number(), kMost));
  }
}

void Checks::contact_pairs() const {
  const std::vector<ContactPair>& pairs = c.contact.pairs;
  std::map<std::string, int> materials, bodies;
  for (const GrainMaterial& m : c.grain.named_materials()) ++materials[name_in_pairs(m)];
  for (const WallBody& body : c.wall.bodies)
    if (body.stops_grains()) ++bodies[body.name];
  const auto refuse = [&](std::size_t k, const std::string& must) {
    const auto& of = pairs[k].of;
    fail(fmt::format("contact.pair.{}.of", k), fmt::format("[\"{}\"]", fmt::join(of, "\", \"")), must);
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ContactPair& pair = pairs[k];
    if (!c.grain.present) refuse(k, "must be left out without [grain]");
    if (pair.of.size() != 2) refuse(k, "must be two names");
    int of_grains = 0;
    for (const std::string& name : pair.of) {
      const int found = materials[name] + bodies[name];
      if (found == 0) {
        std::string all;
        for (const auto* names : {&materials, &bodies})
          for (const auto& [known, count] : *names)
            if (count > 0) all += (all.empty() ? "" : ", ") + known;
        refuse(k, fmt::format("must name materials of grains, or one and a wall.body that stops grains: {}",
                              all));
      }
      if (found > 1)
        refuse(k, fmt::format("must name one thing each; there is more than one {}", quoted(name)));
      of_grains += materials[name];
    }
    if (of_grains == 0) refuse(k, "must name at least one material of grains, not two wall bodies");
    if (!std::isfinite(pair.mu) && !std::isfinite(pair.mu_r) && pair.e == 0)
      refuse(k, "must come with mu, mu_r or e");
    for (std::size_t l = 0; l < k; ++l)
      if (pairs[l].joins(pair.of[0], pair.of[1])) refuse(k, "must differ from other pairs'");
  }
}

void Checks::softness() const {
  if (const double overlap = bed_overlap(c); overlap > kSoftBed)
    warn(
        "{0}: expected overlap at the bottom of the bed is {1:.2g} % of the radius; increase {0} for "
        "accuracy",
        takes_moduli(c.contact.normal) ? "grain.E" : "contact.k", 100 * overlap);
}

void Checks::resolution() const {
  const double dx = c.fluid.dx;
  const std::string too_large =
      fmt::format("too large for drag laws, which take what is up to {:g} times as large", kAveraged);
  const auto of_size = [&](const SizeClass& size) {
    const double d = size.kind == SizeKind::one_size ? size.d : size.d_max, times = d / dx;
    if (c.couple.between == BetweenSizes::refuse && times > kDragged * (1 + 1e-3) && times < kResolved)
      fail("couple.between", quoted("refuse"),
           fmt::format(
               "must be \"unresolved\" or \"resolved\" with grains of {:.4g} m, {:.3g} times fluid.dx: {}, "
               "and too small for the fluid to flow around them, as it does from {:g} times on",
               d, times, too_large, kResolved));
  };
  for (const GrainFill& fill : c.grain.fills)
    for (const SizeClass& size : fill.sizes) of_size(size);
  for (const GrainInletConfig& inlet : c.grain_inlets)
    for (const SizeClass& size : inlet.sizes) of_size(size);
  const double d = c.grain.d_max, times = d / dx;
  if (times <= kAveraged * (1 + 1e-3)) return;
  const std::string coarser = fmt::format("a fluid.dx of {:.3g} m or more", d / kAveraged);
  if (times < kResolved)
    warn(
        "grains of {:.4g} m are {:.3g} times fluid.dx: {}, and too small for the fluid to flow around them, "
        "as it "
        "does from {:g} times on: their volume does not displace the flow, and they have no wake; take {}, "
        "or {:.3g} "
        "m or less",
        d, times, too_large, kResolved, coarser, d / kResolved);
  else
    warn(
        "grains of {:.4g} m are {:.3g} times fluid.dx: {}; let the fluid flow around them (grain.resolve), "
        "or take {}",
        d, times, too_large, coarser);
}

void Checks::lubrication() const {
  const LubricationConfig& l = c.lubrication;
  const auto refuse = [&](const char* with) {
    fail("lubrication.forces", quoted(l.forces.name()), fmt::format("must be \"none\" {}", with));
  };
  if (!coupled() && !c.fluid.lattice()) refuse("without [fluid] to which grains are coupled");
  if (c.contact.normal == NormalLaw::none) refuse("with contact.normal = \"none\"");
  if (c.wall.free_bodies() > 0) refuse("with wall bodies that move freely");
  if (l.least_gap >= l.cut_off)
    fail("lubrication.least_gap", l.least_gap,
         fmt::format("must be below lubrication.cut_off = {}", l.cut_off));
}

void Checks::coupling() const {
  const double reach = c.farthest_average(), d = c.grain.d_max;
  if (c.couple.drag == DragLaw::table) drag_table();
  if (c.couple.S_wet <= c.couple.S_dry)
    fail("couple.S_wet", c.couple.S_wet, fmt::format("must be > couple.S_dry = {}", c.couple.S_dry));
  if (c.couple.suspension != SuspensionLaw::none) suspension_viscosity();
  if (c.couple.undisturbed) undisturbed();
  if (!coupled()) return;
  if (reach < 2 * d * (1 - 1e-9))
    fail("couple.hc", c.couple.hc,
         fmt::format("must be >= {}; unresolved coupling needs kappa h_c >= 2 d_max",
                     2 * d / c.fluid.kappa()));
  if (reach < 4 * d * (1 - 1e-9))
    warn(
        "couple.hc: kappa h_c is {:.3g} diameters of the largest grain; below 4 a grain's own wake reduces "
        "its drag",
        reach / d);
}

void Checks::suspension_viscosity() const {
  const bool thick = c.fluid.model->own_viscosity || c.visc.model == ViscosityModel::morris ||
                     c.visc.model == ViscosityModel::monaghan;
  for (const auto& [there, what] :
       {std::pair{!coupled() || c.couple.mode != CouplingMode::two_way, "without couple.mode = \"two_way\""},
        {!thick, "with visc.model = \"signal\" or \"none\""},
        {c.lubrication.acts(), "with lubrication.forces, of which it is the mean"},
        {c.time.integrator == TimeIntegrator::ab3, "with time.integrator = \"ab3\""},
        {c.fluid.variable_h, "with fluid.variable_h"}})
    if (there)
      fail("couple.suspension_viscosity", quoted(c.couple.suspension.name()),
           fmt::format("must be \"none\" {}", what));
}

void Checks::undisturbed() const {
  for (const auto& [there, what] :
       {std::pair{!coupled() || c.couple.mode != CouplingMode::two_way, "without couple.mode = \"two_way\""},
        {c.domain.two_d, "with domain.two_d"},
        {c.fluid.mu == 0, "with fluid.mu = 0"}})
    if (there) fail("couple.undisturbed", "true", fmt::format("must be false {}", what));
}

void Checks::drag_table() const {
  const DragTable& t = c.couple.table;
  const auto nodes = [&](const char* key, const std::vector<double>& list, std::size_t least) {
    const auto say = [&](const std::string& must) {
      fail(key, fmt::format("[{}]", fmt::join(list, ", ")), must);
    };
    if (list.size() < least || list.size() > 1000) say(fmt::format("must hold {} to 1000 numbers", least));
    if (std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) != list.end())
      say("must rise from each to the next");
  };
  nodes("drag.porosity", t.porosity, 1);
  nodes("drag.reynolds", t.reynolds, 2);
  if (t.reynolds.front() != 0) fail("drag.reynolds", t.reynolds.front(), "must begin with 0");
  if (t.factor.size() != t.porosity.size() * t.reynolds.size())
    fail("drag.factor", fmt::format("[...] of {}", t.factor.size()),
         fmt::format("must hold {} numbers, {} Reynolds numbers for each of {} porosities",
                     t.porosity.size() * t.reynolds.size(), t.reynolds.size(), t.porosity.size()));
}
}  // namespace bedload
