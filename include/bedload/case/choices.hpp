#pragma once
// The laws and models that a case may name. Each is written here once: enumerator, name, meaning, traits.
// Reader, `bedload list` and messages take them from here, and code asks for enumerators: a name that nobody
// listed does not compile, or is a CaseError where it comes as text. Where code asks for what several have in
// common it asks for a trait, `model->spins`, so that a new one answers by its row. `switch` over an
// enumeration must know all of it. Shapes, motions, probes and the like are in setup_choices.hpp.

#include "bedload/case/chosen.hpp"
#include "bedload/core/wall_kind.hpp"

namespace bedload {

// -- contact -------------------------------------------------------------------------------------

/// contact.normal
enum class NormalLaw : std::uint32_t { hertz, linear, democritus, none };
template <>
inline constexpr auto kNames<NormalLaw> = std::to_array<Named<NormalLaw>>({
    {NormalLaw::hertz, "hertz", "Hertz spring, damping that gives exactly e"},
    {NormalLaw::linear, "linear", "linear spring and dashpot"},
    {NormalLaw::democritus, "democritus", "Hertz spring, overdamped, ignores grain.e [tsuzuki]"},
    {NormalLaw::none, "none", "no contacts: grains pass through each other"},
});

/// contact.tangential
enum class SlidingLaw : std::uint32_t { mindlin, mindlin_deresiewicz, linear, democritus, none };
template <>
inline constexpr auto kNames<SlidingLaw> = std::to_array<Named<SlidingLaw>>({
    {SlidingLaw::mindlin, "mindlin", "Mindlin spring, rescaled on unloading"},
    {SlidingLaw::mindlin_deresiewicz, "mindlin_deresiewicz", "Mindlin-Deresiewicz spring with micro-slip"},
    {SlidingLaw::linear, "linear", "linear spring of stiffness kt_ratio k"},
    {SlidingLaw::democritus, "democritus",
     "Mindlin spring with 1/(2 + 2 nu) of the normal stiffness [tsuzuki]"},
    {SlidingLaw::none, "none", "frictionless"},
});

/// contact.rolling
enum class RollingLaw : std::uint32_t { epsd, cdt, none };
template <>
inline constexpr auto kNames<RollingLaw> = std::to_array<Named<RollingLaw>>({
    {RollingLaw::epsd, "epsd", "elastic-plastic spring-dashpot, so that grains rest on slopes [ai11]"},
    {RollingLaw::cdt, "cdt", "constant directional torque"},
    {RollingLaw::none, "none", "no rolling resistance"},
});

/// lubrication.forces
enum class LubricationForces : std::uint32_t { none, normal, all };
template <>
inline constexpr auto kNames<LubricationForces> = std::to_array<Named<LubricationForces>>({
    {LubricationForces::none, "none", "no lubrication"},
    {LubricationForces::normal, "normal", "against approach and separation"},
    {LubricationForces::all, "all", "also against sliding and rolling [jeffrey84]"},
});

// -- fluid ---------------------------------------------------------------------------------------

/// fluid.model
enum class FluidModel { wcsph, sdpd, sdpd_a, lattice };
template <>
struct Named<FluidModel> {
  FluidModel value;
  std::string_view name, meaning;
  Trait smoothed;  ///< has what keeps particles in order: shifting, density diffusion, damper, cavitation
  Trait own_viscosity;  ///< its pairs make up fluid.mu and fluid.zeta: no visc.model
  Trait thermal;        ///< may have thermal noise, sdpd.kT
  Trait spins;          ///< particles have an angular velocity
  Trait summation;      ///< density may be summed up, density.method
  Trait wall_work;      ///< the work of wall pressure is accounted for, wall.energy_consistent
  Trait integrators;    ///< any time.integrator, not kdk alone
  Trait plane;          ///< domain.two_d
  Trait variable_h;     ///< fluid.variable_h
  Trait nodes;          ///< on nodes of a lattice, not by particles
};
template <>
inline constexpr auto kNames<FluidModel> = std::to_array<Named<FluidModel>>({
    {.value = FluidModel::wcsph,
     .name = "wcsph",
     .meaning = "weakly compressible SPH, with stabilising terms",
     .smoothed = true,
     .own_viscosity = false,
     .thermal = false,
     .spins = false,
     .summation = false,
     .wall_work = true,
     .integrators = true,
     .plane = true,
     .variable_h = true,
     .nodes = false},
    {.value = FluidModel::sdpd,
     .name = "sdpd",
     .meaning = "smoothed dissipative particle dynamics: viscous friction and thermal noise [espanol03]",
     .smoothed = false,
     .own_viscosity = true,
     .thermal = true,
     .spins = false,
     .summation = true,
     .wall_work = false,
     .integrators = false,
     .plane = false,
     .variable_h = false,
     .nodes = false},
    {.value = FluidModel::sdpd_a,
     .name = "sdpd_a",
     .meaning = "SDPD with spin of the particles, conserves angular momentum [mueller15]",
     .smoothed = false,
     .own_viscosity = true,
     .thermal = true,
     .spins = true,
     .summation = true,
     .wall_work = false,
     .integrators = false,
     .plane = false,
     .variable_h = false,
     .nodes = false},
    {.value = FluidModel::lattice,
     .name = "lattice",
     .meaning =
         "lattice Boltzmann, D3Q19: nodes fixed in space fill the domain between walls; without grains",
     .smoothed = false,
     .own_viscosity = false,
     .thermal = false,
     .spins = false,
     .summation = false,
     .wall_work = false,
     .integrators = false,
     .plane = false,
     .variable_h = false,
     .nodes = true},
});

/// lattice.collision
enum class LatticeCollision { trt, bgk };
template <>
inline constexpr auto kNames<LatticeCollision> = std::to_array<Named<LatticeCollision>>({
    {LatticeCollision::trt, "trt",
     "two relaxation times: where walls lie does not depend on the viscosity [ginzburg08]"},
    {LatticeCollision::bgk, "bgk", "one relaxation time; walls shift with the viscosity"},
});

/// density.method, of SDPD
enum class DensityMethod { continuity, summation };
template <>
inline constexpr auto kNames<DensityMethod> = std::to_array<Named<DensityMethod>>({
    {DensityMethod::continuity, "continuity",
     "integrated in time from the velocity divergence; drifts with noise"},
    {DensityMethod::summation, "summation", "summed over the neighbours"},
});

/// sdpd.noise
enum class NoiseForm { vector, tensor };
template <>
inline constexpr auto kNames<NoiseForm> = std::to_array<Named<NoiseForm>>({
    {NoiseForm::vector, "vector", "three random numbers per pair"},
    {NoiseForm::tensor, "tensor", "nine random numbers per pair, with the same covariance [tsuzuki]"},
});

/// drive.mode
enum class DriveMode { volume, mass, particle };
template <>
inline constexpr auto kNames<DriveMode> = std::to_array<Named<DriveMode>>({
    {DriveMode::volume, "volume", "per volume of space, N/m3"},
    {DriveMode::mass, "mass", "per mass, m/s2; numbers without a unit"},
    {DriveMode::particle, "particle", "on each fluid particle and grain, N; numbers without a unit"},
});

/// drive.on
enum class DrivenPhase { fluid, grains, both };
template <>
inline constexpr auto kNames<DrivenPhase> = std::to_array<Named<DrivenPhase>>({
    {DrivenPhase::fluid, "fluid", "the fluid"},
    {DrivenPhase::grains, "grains", "the grains"},
    {DrivenPhase::both, "both", "fluid and grains"},
});

/// drive.opposed
enum class DriveReversal { none, x, y, z };
template <>
inline constexpr auto kNames<DriveReversal> = std::to_array<Named<DriveReversal>>({
    {DriveReversal::none, "none", "no reversal"},
    {DriveReversal::x, "x", "reversed in the upper half along x"},
    {DriveReversal::y, "y", "reversed in the upper half along y"},
    {DriveReversal::z, "z", "reversed in the upper half along z"},
});

/// fluid.kernel
enum class KernelFunction { wendland_c2, cubic, lucy };
template <>
inline constexpr auto kNames<KernelFunction> = std::to_array<Named<KernelFunction>>({
    {KernelFunction::wendland_c2, "wendland_c2", "Wendland C2, support 2 h"},
    {KernelFunction::cubic, "cubic", "cubic spline, support 2 h"},
    {KernelFunction::lucy, "lucy", "Lucy, support h"},
});

/// eos.type
enum class EosType { tait, democritus };
template <>
inline constexpr auto kNames<EosType> = std::to_array<Named<EosType>>({
    {EosType::tait, "tait", "B [(rho/rho0)^gamma - 1], B = c^2 rho0 / gamma"},
    {EosType::democritus, "democritus", "p0 (rho/rho0)^alpha - beta, c = sqrt(alpha p0 / rho0)"},
});

/// visc.model
enum class ViscosityModel { morris, monaghan, signal, none };
template <>
inline constexpr auto kNames<ViscosityModel> = std::to_array<Named<ViscosityModel>>({
    {ViscosityModel::morris, "morris", "Laplacian of the velocity, conserves linear momentum [morris97]"},
    {ViscosityModel::monaghan, "monaghan",
     "divergence of the stress, correct at free surfaces, conserves linear and angular momentum "
     "[monaghan05]"},
    {ViscosityModel::signal, "signal",
     "along the line of centres, with the signal speed, conserves linear and angular momentum [harting14]"},
    {ViscosityModel::none, "none", "inviscid"},
});

// -- walls ---------------------------------------------------------------------------------------

/// wall.type
enum class WallType { adami, mdbc, frozen, single_layer, grains_only, fluid_only };
template <>
struct Named<WallType> {
  WallType value;
  std::string_view name, meaning;
  Stated<WallKind> kind;
  Trait stops_fluid, stops_grains;
  Trait single_layer;     ///< one layer of particles on its surface, not as many as the kernel reaches
  Trait repels;           ///< with Monaghan repulsion always: its pressure does not follow the fluid's
  Trait wall_work;        ///< the work of its pressure can be accounted for, wall.energy_consistent
  Trait thermal;          ///< meets fluid with thermal noise
  Trait variable_h;       ///< and with fluid.variable_h
  Trait one_pass;         ///< and with time.integrator = "ab3"
  Stated<int> bed_error;  ///< by which the buoyancy of a thin bed on it is too low, %; 0: below 1
};
template <>
inline constexpr auto kNames<WallType> = std::to_array<Named<WallType>>({
    {.value = WallType::adami,
     .name = "adami",
     .meaning = "layers of wall particles with pressure extrapolated from the fluid [adami12]",
     .kind = WallKind::extrapolated,
     .stops_fluid = true,
     .stops_grains = true,
     .single_layer = false,
     .repels = false,
     .wall_work = true,
     .thermal = true,
     .variable_h = true,
     .one_pass = true,
     .bed_error = 0},
    {.value = WallType::mdbc,
     .name = "mdbc",
     .meaning = "layers of wall particles with the density at their mirror points in the fluid [english22]",
     .kind = WallKind::mirrored,
     .stops_fluid = true,
     .stops_grains = true,
     .single_layer = false,
     .repels = false,
     .wall_work = false,
     .thermal = false,
     .variable_h = false,
     .one_pass = true,
     .bed_error = 0},
    {.value = WallType::frozen,
     .name = "frozen",
     .meaning =
         "wall particles treated as fluid at rest relative to the wall; the first layer has its own density",
     .kind = WallKind::frozen,
     .stops_fluid = true,
     .stops_grains = true,
     .single_layer = false,
     .repels = true,
     .wall_work = true,
     .thermal = true,
     .variable_h = false,
     .one_pass = false,
     .bed_error = 13},
    {.value = WallType::single_layer,
     .name = "single_layer",
     .meaning = "one layer of particles on the surface that repel the fluid; for thin shells",
     .kind = WallKind::single_layer,
     .stops_fluid = true,
     .stops_grains = true,
     .single_layer = true,
     .repels = false,
     .wall_work = false,
     .thermal = false,
     .variable_h = true,
     .one_pass = true,
     .bed_error = 11},
    {.value = WallType::grains_only,
     .name = "grains_only",
     .meaning = "stops grains; fluid passes through",
     .kind = WallKind::extrapolated,
     .stops_fluid = false,
     .stops_grains = true,
     .single_layer = false,
     .repels = false,
     .wall_work = true,
     .thermal = true,
     .variable_h = true,
     .one_pass = true,
     .bed_error = 0},
    {.value = WallType::fluid_only,
     .name = "fluid_only",
     .meaning = "as adami for the fluid; grains pass through",
     .kind = WallKind::extrapolated,
     .stops_fluid = true,
     .stops_grains = false,
     .single_layer = false,
     .repels = false,
     .wall_work = true,
     .thermal = false,
     .variable_h = true,
     .one_pass = true,
     .bed_error = 0},
});

/// wall.slip
enum class WallSlip { noslip, slip };
template <>
inline constexpr auto kNames<WallSlip> = std::to_array<Named<WallSlip>>({
    {WallSlip::noslip, "noslip", "the fluid has the velocity of the wall at its surface"},
    {WallSlip::slip, "slip", "no viscous force between fluid and wall"},
});

/// wall.force, of single layers
enum class LayerForce { kajtar, monaghan };
template <>
inline constexpr auto kNames<LayerForce> = std::to_array<Named<LayerForce>>({
    {LayerForce::kajtar, "kajtar", "soft, within the kernel's support [monaghan09]"},
    {LayerForce::monaghan, "monaghan", "steep, within wall.layer_r0 [monaghan94]"},
});

// -- coupling ------------------------------------------------------------------------------------

/// couple.mode
enum class CouplingMode { two_way, one_way, off };
template <>
inline constexpr auto kNames<CouplingMode> = std::to_array<Named<CouplingMode>>({
    {CouplingMode::two_way, "two_way", "fluid and grains act on each other"},
    {CouplingMode::one_way, "one_way", "the fluid acts on the grains only"},
    {CouplingMode::off, "off", "no coupling"},
});

/// couple.between
enum class BetweenSizes { refuse, unresolved, resolved };
template <>
inline constexpr auto kNames<BetweenSizes> = std::to_array<Named<BetweenSizes>>({
    {BetweenSizes::refuse, "refuse", "such a case is refused"},
    {BetweenSizes::unresolved, "unresolved", "drag laws apply to them, outside their range"},
    {BetweenSizes::resolved, "resolved", "the fluid flows around them, at a low resolution"},
});

/// couple.kernel
enum class CouplingKernel { fluid, top_hat };
template <>
inline constexpr auto kNames<CouplingKernel> = std::to_array<Named<CouplingKernel>>({
    {CouplingKernel::fluid, "fluid", "as fluid.kernel"},
    {CouplingKernel::top_hat, "top_hat", "constant within kappa h_c; noisy [tsuzuki]"},
});

/// couple.slip
enum class DragSlip { mean, local };
template <>
inline constexpr auto kNames<DragSlip> = std::to_array<Named<DragSlip>>({
    {DragSlip::mean, "mean", "relative to the mean velocity of the fluid around the grain"},
    {DragSlip::local, "local",
     "relative to each fluid particle: a jet drives grains, and is slowed, by its own speed; but grains also "
     "resist shear of the fluid over h_c"},
});

/// couple.suspension_viscosity
enum class SuspensionLaw { none, krieger_dougherty, maron_pierce };
template <>
inline constexpr auto kNames<SuspensionLaw> = std::to_array<Named<SuspensionLaw>>({
    {SuspensionLaw::none, "none", "viscosity of the fluid alone"},
    {SuspensionLaw::krieger_dougherty, "krieger_dougherty", "(1 - phi/phi_max)^(-2.5 phi_max) [krieger59]"},
    {SuspensionLaw::maron_pierce, "maron_pierce", "(1 - phi/phi_max)^-2 [maron56]"},
});

/// drag.law
enum class DragLaw { di_felice, gidaspow, gidaspow_blend, ergun, wen_yu, schiller_naumann, stokes, table };
template <>
inline constexpr auto kNames<DragLaw> = std::to_array<Named<DragLaw>>({
    {DragLaw::di_felice, "di_felice", "one smooth law from single grain to packed bed [difelice94]"},
    {DragLaw::gidaspow, "gidaspow",
     "Ergun up to porosity 0.8, Wen-Yu above; discontinuous there [gidaspow94]"},
    {DragLaw::gidaspow_blend, "gidaspow_blend", "Ergun and Wen-Yu, blended around porosity 0.8 [huilin03]"},
    {DragLaw::ergun, "ergun", "packed beds [ergun52]"},
    {DragLaw::wen_yu, "wen_yu", "suspensions [wen66]"},
    {DragLaw::schiller_naumann, "schiller_naumann", "single sphere"},
    {DragLaw::stokes, "stokes", "single sphere in creeping flow"},
    {DragLaw::table, "table", "user-defined: drag.factor as a function of drag.porosity and drag.reynolds"},
});

/// drag.integrator
enum class DragIntegrator { exponential, explicit_steps };
template <>
inline constexpr auto kNames<DragIntegrator> = std::to_array<Named<DragIntegrator>>({
    {DragIntegrator::exponential, "exponential", "exact for constant slip velocity, stable for any drag"},
    {DragIntegrator::explicit_steps, "explicit", "explicit steps, which limit the substep"},
});

// -- time ----------------------------------------------------------------------------------------

/// time.integrator
enum class TimeIntegrator { kdk, ab3, euler };
template <>
inline constexpr auto kNames<TimeIntegrator> = std::to_array<Named<TimeIntegrator>>({
    {TimeIntegrator::kdk, "kdk", "kick-drift-kick, second order; two pair loops per step"},
    {TimeIntegrator::ab3, "ab3", "kick-drift-kick with density by Adams-Bashforth; one pair loop per step"},
    {TimeIntegrator::euler, "euler",
     "symplectic Euler: velocity first, then position and density; first order"},
});

// -- the whole case ------------------------------------------------------------------------------

/// preset
enum class Preset { standard, he2018, democritus, robinson2014 };
template <>
inline constexpr auto kNames<Preset> = std::to_array<Named<Preset>>({
    {Preset::standard, "default",
     "Wendland C2, h/dx 1.5, density diffusion, EPSD rolling, Di Felice, kick-drift-kick"},
    {Preset::he2018, "he2018", "He et al. 2018: h/dx 1.3, XSPH, Mindlin-Deresiewicz, CDT, Gidaspow, Euler"},
    {Preset::democritus, "democritus",
     "Tsuzuki's DEMocritus: SDPD with spin, Lucy, pressure filter and clip, Gidaspow, top-hat porosity"},
    {Preset::robinson2014, "robinson2014",
     "Robinson et al. 2014: cubic spline, variable h, signal viscosity, linear frictionless contacts, single "
     "layers"},
});

/// run.precision
enum class Precision { mixed, fp32, fp64 };
template <>
inline constexpr auto kNames<Precision> = std::to_array<Named<Precision>>({
    {Precision::mixed, "mixed", "fp64 positions, fp32 velocities and pair forces"},
    {Precision::fp32, "single", "fp32, cell-relative positions"},
    {Precision::fp64, "double", "fp64 throughout"},
});

/// run.simd
enum class Simd { automatic, baseline, avx2 };
template <>
inline constexpr auto kNames<Simd> = std::to_array<Named<Simd>>({
    {Simd::automatic, "auto", "avx2 if the CPU supports it"},
    {Simd::baseline, "baseline", "instructions of every x86-64 CPU"},
    {Simd::avx2, "avx2", "AVX2 and FMA"},
});

}  // namespace bedload
