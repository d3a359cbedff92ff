#pragma once
// The laws and models that a case may name. Each is written here once: enumerator, name, meaning. Reader,
// `bedload list` and messages take them from here, and code asks for enumerators: a name that nobody listed
// does not compile, or is a CaseError where it comes as text. `switch` over an enumeration must know all of
// it. Shapes, motions, probes and the like are in setup_choices.hpp.

#include "bedload/case/chosen.hpp"

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
enum class FluidModel { wcsph, sdpd, sdpd_a };
template <>
inline constexpr auto kNames<FluidModel> = std::to_array<Named<FluidModel>>({
    {FluidModel::wcsph, "wcsph", "weakly compressible SPH, with stabilising terms"},
    {FluidModel::sdpd, "sdpd",
     "smoothed dissipative particle dynamics: viscous friction and thermal noise [espanol03]"},
    {FluidModel::sdpd_a, "sdpd_a", "SDPD with spin of the particles, conserves angular momentum [mueller15]"},
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
inline constexpr auto kNames<WallType> = std::to_array<Named<WallType>>({
    {WallType::adami, "adami",
     "layers of wall particles with pressure extrapolated from the fluid [adami12]"},
    {WallType::mdbc, "mdbc",
     "layers of wall particles with the density at their mirror points in the fluid [english22]"},
    {WallType::frozen, "frozen",
     "wall particles treated as fluid at rest relative to the wall; the first layer has its own density"},
    {WallType::single_layer, "single_layer",
     "one layer of particles on the surface that repel the fluid; for thin shells"},
    {WallType::grains_only, "grains_only", "stops grains; fluid passes through"},
    {WallType::fluid_only, "fluid_only", "as adami for the fluid; grains pass through"},
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

static_assert(all_named<NormalLaw, NormalLaw::none> && all_named<SlidingLaw, SlidingLaw::none> &&
              all_named<RollingLaw, RollingLaw::none> && all_named<FluidModel, FluidModel::sdpd_a> &&
              all_named<DensityMethod, DensityMethod::summation> && all_named<NoiseForm, NoiseForm::tensor> &&
              all_named<LubricationForces, LubricationForces::all> &&
              all_named<DriveMode, DriveMode::particle> && all_named<DrivenPhase, DrivenPhase::both> &&
              all_named<DriveReversal, DriveReversal::z> &&
              all_named<CouplingKernel, CouplingKernel::top_hat> &&
              all_named<KernelFunction, KernelFunction::lucy> && all_named<EosType, EosType::democritus> &&
              all_named<ViscosityModel, ViscosityModel::none> && all_named<WallType, WallType::fluid_only> &&
              all_named<WallSlip, WallSlip::slip> && all_named<LayerForce, LayerForce::monaghan> &&
              all_named<CouplingMode, CouplingMode::off> && all_named<DragSlip, DragSlip::local> &&
              all_named<SuspensionLaw, SuspensionLaw::maron_pierce> && all_named<DragLaw, DragLaw::table> &&
              all_named<DragIntegrator, DragIntegrator::explicit_steps> &&
              all_named<TimeIntegrator, TimeIntegrator::euler> && all_named<Preset, Preset::robinson2014> &&
              all_named<Precision, Precision::fp64> && all_named<Simd, Simd::avx2>);

}  // namespace bedload
