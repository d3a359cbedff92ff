#pragma once
// A case as the solver sees it: every parameter with its default, checked and
// resolved. Written by src/case, read by everybody. Knows nothing of precision
// or device. Keys, bounds and defaults: `bedload list parameters`.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bedload/case/choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

/// Sides of the domain at which what crosses them is put back, in the order of kFaces.
struct ReflectConfig {
  std::array<bool, 6> slip{}, no_slip{};
  bool any() const { return *this != ReflectConfig{}; }
  bool operator==(const ReflectConfig&) const = default;
};

struct DomainConfig {
  Vec3d min, max;                              ///< m
  std::array<bool, 3> periodic{false, false, false};
  ReflectConfig reflect{};
  bool two_d = false;                          ///< flow in the plane of x and z, the same at every y
  double shear_rate = 0;                       ///< of Lees-Edwards boundaries, dv_x / dz, 1/s; 0: none
  double thickness() const { return two_d ? max.y - min.y : 0; }  ///< of the plane flow, m; 0 in 3-D
  double middle() const { return 0.5 * (min.y + max.y); }         ///< y of the plane, m
  bool flat(int k) const { return two_d && k == 1; }              ///< whether nothing changes along axis k
  bool sheared() const { return shear_rate != 0; }
  /// Spacing of a lattice along axis k: a plane flow has one layer.
  double spacing_along(int k, double spacing) const { return flat(k) ? thickness() : spacing; }
  /// What a particle of a lattice of that spacing stands for, m3.
  double cell_volume(double spacing) const { return spacing * spacing * spacing_along(1, spacing); }
  bool operator==(const DomainConfig&) const = default;
};

class Shape;

/// The solid that a name stands for, built when a case is resolved. No part of what makes two cases equal.
struct Solid {
  std::shared_ptr<const Shape> shape;
  bool operator==(const Solid&) const { return true; }
};

/// A solid with a name: walls are made of it, fluid and grains fill it.
struct ShapeConfig {
  std::string name;
  std::string kind = "box";                    ///< see describe_shapes.cpp
  Vec3d min, max;                              ///< box: m
  Vec3d centre;                                ///< sphere: m
  Vec3d a, b;                                  ///< ends of the axis of capsule, cylinder, cone, pipe: m
  double radius = 0;                           ///< m; pipe: of the bore
  double radius_a = 0, radius_b = 0;           ///< cone: m
  double thickness = 0;                        ///< wall of pipe and hollow, m
  std::string ends = "open";                   ///< pipe: open, closed_a, closed_b, closed
  std::string file;                            ///< mesh: STL, OBJ or PLY
  std::string digest;                          ///< of the file, hexadecimal; checked where it is given
  bool repair = false;                         ///< mesh
  std::vector<std::string> of;                 ///< hollow, union, difference: shapes listed before
  double facet = 0;                            ///< difference: width of its triangles, m; 0: by its size
  double scale = 1;
  Vec3d turn_axis{0, 0, 1};
  double turn_angle = 0;                       ///< deg
  Vec3d translate;                             ///< m
  std::int64_t pieces = 1;                     ///< primitives in it, each as often as it is named (resolved)
  Solid solid;                                 ///< resolved
  bool operator==(const ShapeConfig&) const = default;
};

/// A block of fluid, placed on a lattice of spacing fluid.dx, or the particles of a file.
struct FluidFill {
  Vec3d min, max;                              ///< box, m; of a shape or a file: around what is filled (resolved)
  std::array<std::string, 3> velocity{"0", "0", "0"};  ///< formulas in x, y, z, m/s
  std::string shape = {};                      ///< name of a shape to fill instead of a box
  double level = std::numeric_limits<double>::infinity();  ///< shape: filled up to this height, m
  Solid solid = {};                            ///< resolved
  std::string file{};                          ///< particles instead of a lattice; absolute (resolved)
  std::int64_t step = -1;                      ///< frame of a .vtkhdf file; -1: the last
  std::string species{};                       ///< which of fluid.species it is of; empty: the first
  bool operator==(const FluidFill&) const = default;
};

/// One of several fluids that differ in viscosity alone.
struct FluidSpecies {
  std::string name;
  double mu = 0;                               ///< Pa s
  bool operator==(const FluidSpecies&) const = default;
};

struct FluidConfig {
  bool present = false;
  double dx = 0;                               ///< particle spacing, m
  double h_over_dx = 1.5;
  bool variable_h = false;                     ///< each particle's smoothing length follows its volume
  double sigma_h = 1.5;                        ///< variable_h: smoothing length / cube root of the volume
  Chosen<FluidModel> model = FluidModel::wcsph;
  Chosen<KernelFunction> kernel = KernelFunction::wendland_c2;
  double rho0 = 1000;                          ///< kg/m3
  double mu = 1e-3;                            ///< Pa s
  double zeta = std::numeric_limits<double>::infinity();  ///< bulk viscosity of SDPD, Pa s (default 20 mu / 21)
  double vmax = 0;                             ///< m/s; 0: sqrt(2 g H)
  double c_factor = 10;                        ///< sound speed / vmax
  double c = 0;                                ///< numerical sound speed, m/s (resolved)
  double depth = 0;                            ///< H: height of the initial fluid along gravity, m (resolved)
  std::vector<FluidFill> fills;
  std::vector<FluidSpecies> species;           ///< none: the fluid is one; else mu is the largest of theirs (resolved)
  /// Place in `species`; the first for a name that is none.
  std::uint32_t species_of(const FluidFill& fill) const {
    for (std::size_t k = 0; k < species.size(); ++k)
      if (species[k].name == fill.species) return std::uint32_t(k);
    return 0;
  }
  /// Smoothing length, m; with variable_h that of a particle of volume dx^3.
  double h() const { return (variable_h ? sigma_h : h_over_dx) * dx; }
  double h_least() const { return variable_h ? 0.5 * h() : h(); }  ///< m
  double h_most() const { return variable_h ? 2 * h() : h(); }     ///< m
  double reach() const { return kappa() * h_most(); }              ///< farthest that particles act, m
  double kappa() const { return kernel == KernelFunction::lucy ? 1 : 2; }  ///< support / h
  bool sdpd() const { return model != FluidModel::wcsph; }
  bool operator==(const FluidConfig&) const = default;
};

/// What drives fluid and grains besides gravity.
struct DriveConfig {
  Vec3d f{0, 0, 0};                            ///< force per volume of space, N/m3; per mass, m/s2; per particle, N
  std::string factor = "1";                    ///< of f; formula in x, y, z, t
  Chosen<DriveMode> mode = DriveMode::volume;
  Chosen<DrivenPhase> on = DrivenPhase::fluid;
  Chosen<DriveReversal> opposed = DriveReversal::none;
  Vec3d rate{0, 0, 0};                         ///< pulls towards the centre: acceleration -rate^2 (r - centre), 1/s
  Vec3d centre{0, 0, 0};                       ///< m
  bool pulls() const { return rate != Vec3d{}; }
  bool on_fluid() const { return f != Vec3d{} && on != DrivenPhase::grains; }
  bool on_grains() const { return f != Vec3d{} && on != DrivenPhase::fluid; }
  bool operator==(const DriveConfig&) const = default;
};

struct EosConfig {
  Chosen<EosType> type = EosType::tait;
  double gamma = 7;
  double p0 = 100, alpha = 7, beta = 100;      ///< democritus: Pa, -, Pa
  double background = 0;                       ///< tait: pressure at rho0, Pa
  bool clip_negative = false;
  bool filter = false;                         ///< pressure averaged over neighbours
  bool operator==(const EosConfig&) const = default;
};

struct DensityConfig {
  double delta = 0.1;                          ///< density diffusion
  double void_relaxation = 3;                  ///< how fast pressure fades in fluid with voids in it, c/h
  double cavitation_limit = 0.001;             ///< the fluid cavitates below rho/rho0 - 1 = minus this
  Chosen<DensityMethod> method = DensityMethod::continuity;
  std::int64_t reinit_every = 0;               ///< steps; 0: never
  bool count_grains = false;                   ///< summation takes in grains as fluid of their volume
  bool operator==(const DensityConfig&) const = default;
};

struct ViscosityConfig {
  Chosen<ViscosityModel> model = ViscosityModel::morris;
  double alpha = 0, beta = 0;                  ///< artificial viscosity
  bool collision = false;                      ///< fluid particles that come too near collide
  double collision_range = 0.5;                ///< / fluid.dx
  double collision_restitution = 0.2;
  bool operator==(const ViscosityConfig&) const = default;
};

/// Smoothed dissipative particle dynamics: what it adds to the fluid.
struct SdpdConfig {
  double kT = 0;                               ///< energy of fluctuations, k_B T, J
  double kI = 0.1;                             ///< moment of inertia of a particle / m dx^2
  Chosen<NoiseForm> noise = NoiseForm::vector;
  std::vector<double> force_scale{1, 1, 1, 1}; ///< of pressure, friction, its part by spin, noise
  bool operator==(const SdpdConfig&) const = default;
};

/// A row of a motion table: t (s), x, y, z (m), rotation vector (deg).
using MotionRow = std::array<double, 7>;

/// One part of a motion. Its t counts from start.
struct MotionPart {
  std::string kind = "fixed";                  ///< fixed, velocity, oscillation, rotation, table, formula
  Vec3d velocity;                              ///< velocity: m/s
  Vec3d amplitude;                             ///< oscillation: displacement amplitude, m
  double frequency = 0;                        ///< oscillation: Hz
  Vec3d axis, centre;                          ///< rotation: unit axis; centre of any turning, m
  double rate = 0;                             ///< rotation: rad/s
  std::string file;                            ///< table: CSV file; its rows replace it when the case is read
  std::vector<MotionRow> rows;                 ///< table
  std::string spline = "smooth";               ///< table: smooth, monotone
  std::array<std::string, 3> displacement{"0", "0", "0"};  ///< formula: in t, m
  std::array<std::string, 3> rotation{"0", "0", "0"};      ///< formula: in t, rotation vector, deg
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  bool operator==(const MotionPart&) const = default;
};

/// How a body moves: by its own part and those added. Evaluated on the host into one pose and velocity.
struct MotionConfig : MotionPart {
  bool remove_when_clear = false;              ///< deleted once above all fluid and grains
  std::vector<MotionPart> add;                 ///< translations add, rotations follow in this order
  bool moves() const { return kind != "fixed" || !add.empty(); }
  bool operator==(const MotionConfig&) const = default;
};

/// How the domain itself moves: translation only. The effective gravity is then g - a_frame.
struct FrameConfig {
  MotionConfig motion;
  double acceleration = 0;                     ///< largest, m/s2 (resolved)
  bool operator==(const FrameConfig&) const = default;
};

/// Mass of a solid about its centre, in the axes of the case.
struct MassProperties {
  double mass = 0;                             ///< kg
  Vec3d centre;                                ///< of mass, m
  std::array<double, 6> inertia{};             ///< Ixx, Iyy, Izz, Ixy, Ixz, Iyz (products with their minus), kg m2
  bool operator==(const MassProperties&) const = default;
};

/// Ball by which a free body touches others.
struct BodyBall {
  Vec3d centre;                                ///< at t = 0, m
  double radius = 0;                           ///< m
  bool operator==(const BodyBall&) const = default;
};

/// A wall body that moves by the forces on it.
struct FreeConfig {
  bool present = false;
  double density = 0;                          ///< kg/m3; or mass
  double mass = 0;                             ///< kg
  std::vector<double> centre_of_mass;          ///< m; empty: of the shape
  std::vector<double> inertia;                 ///< about the centre of mass, kg m2; empty: of the shape
  Vec3d velocity;                              ///< of the centre of mass at the start, m/s
  Vec3d spin;                                  ///< rad/s
  double release_time = 0;                     ///< held until then, s
  std::string move = "all";                    ///< all, plane (across axis), axis (along it), none
  std::string turn = "all";                    ///< all, axis, none
  Vec3d axis{0, 0, 1};                         ///< unit (resolved)
  std::vector<double> point;                   ///< move = none: stays where it is, m; empty: centre of mass
  bool fluid = true;                           ///< the fluid acts on it
  bool contacts = true;                        ///< touches other bodies
  double E = 0, e = 0;                         ///< Pa, - (default grain.*)
  double nu = std::numeric_limits<double>::infinity();  ///< (default grain.nu)
  double mu = std::numeric_limits<double>::infinity();  ///< (default grain.mu)
  double mu_r = 0;                             ///< rolling friction
  double contact_spacing = 0;                  ///< of sampled balls, m (resolved; 0: balls are given)
  double contact_radius = 0;                   ///< R* of contacts, m; 0: the ball's own radius
  std::vector<BodyBall> balls;                 ///< instead of sampled ones
  MassProperties solid;                        ///< resolved
  bool operator==(const FreeConfig&) const = default;
};

/// One wall body: a shape, how fluid meets it, how it moves.
struct WallBody {
  std::string name;
  std::string shape = "box";                   ///< box (solid), tank (seen from inside), plane, or a name
  Vec3d min, max;                              ///< box, tank: m; of a shape: around it (resolved)
  std::array<bool, 6> faces{true, true, true, true, true, true};  ///< tank: x-, x+, y-, y+, z-, z+
  Vec3d point, normal;                         ///< plane: normal points into the flow
  Chosen<WallType> type = WallType::adami;
  Chosen<WallSlip> slip = WallSlip::noslip;
  bool no_penetration = true;                  ///< what comes too near is stopped
  bool repulsion = false;                      ///< Monaghan repulsion beside the wall's pressure
  Vec3d surface_velocity;                      ///< of the surface in its own plane, as of a belt, in the body's axes, m/s
  Chosen<LayerForce> force = LayerForce::kajtar;  ///< of a single layer
  double dx = 0;                               ///< spacing of its particles, m; 0: wall.dx
  double mu = std::numeric_limits<double>::infinity();    ///< sliding friction of grains on it (default grain.mu)
  double mu_r = std::numeric_limits<double>::infinity();  ///< rolling friction (default grain.mu_r)
  double e = 0;                                ///< restitution; 0: grain.e
  double E = 0;                                ///< Young's modulus, Pa; 0: grain.E
  double nu = std::numeric_limits<double>::infinity();    ///< Poisson's ratio (default grain.nu)
  MotionConfig motion;
  FreeConfig free;                             ///< instead of a motion
  Solid solid;                                 ///< of a named shape (resolved)
  bool stops_fluid() const { return type != WallType::grains_only; }
  /// Frozen walls, whose pressure does not follow the fluid's, need it.
  bool repels() const { return stops_fluid() && !single_layer() && (repulsion || type == WallType::frozen); }
  bool single_layer() const { return type == WallType::single_layer; }
  bool stops_grains() const { return type != WallType::fluid_only; }
  bool moves() const { return motion.moves() || free.present; }
  bool operator==(const WallBody&) const = default;
};

struct WallConfig {
  Chosen<WallType> type = WallType::adami;     ///< default of the bodies, as what follows
  Chosen<WallSlip> slip = WallSlip::noslip;
  Chosen<LayerForce> force = LayerForce::kajtar;
  bool no_penetration = true;
  bool repulsion = false;
  double dx = 0;                               ///< spacing of wall particles, m (default fluid.dx)
  double rep_D = 0;                            ///< m2/s2 (default 5 g H)
  double rep_r0 = 0;                           ///< m (default 0.5 dx)
  double layer_r0 = 0;                         ///< reach of the Monaghan force of single layers, m (default dx)
  std::vector<WallBody> bodies;
  int free_bodies() const {
    int n = 0;
    for (const WallBody& body : bodies) n += body.free.present;
    return n;
  }
  double spacing(const WallBody& body) const { return body.dx > 0 ? body.dx : dx; }  ///< m
  bool operator==(const WallConfig&) const = default;
};

/// Grain sizes: one of several entries, each with a number fraction; one diameter or a distribution.
struct SizeClass {
  double d = 0;                                ///< class: diameter, m
  double number_fraction = 1;                  ///< of the grains, relative to the other entries
  std::string kind = "class";                  ///< class, uniform, log_normal, sieve
  double d_min = 0, d_max = 0;                 ///< uniform, log_normal: ends, m
  double median = 0;                           ///< log_normal: m
  double sigma = 0;                            ///< log_normal: standard deviation of ln d
  std::vector<double> openings{};              ///< sieve: of its meshes, m
  std::vector<double> passing{};               ///< sieve: fraction of the mass that each lets through
  bool operator==(const SizeClass&) const = default;
};

/// Grains that keep their places among each other and move as one body.
struct RigidConfig {
  bool present = false;
  std::string move = "all";                    ///< all, plane (across axis), axis (along it), none
  std::string turn = "all";                    ///< all, axis, none
  Vec3d axis{0, 0, 1};                         ///< unit (resolved)
  bool operator==(const RigidConfig&) const = default;
};

/// Where grains come from: thrown at random into a box or a shape, then settled; or given one by one.
struct GrainFill {
  Vec3d min, max;                              ///< m; of a shape or a file: around it (resolved)
  std::string shape;                           ///< name of a shape to fill instead of a box
  Solid solid;                                 ///< resolved
  std::int64_t count = 0;                      ///< exactly one of count, mass, packing_fraction
  double mass = 0;                             ///< kg
  double packing_fraction = 0;
  std::vector<SizeClass> sizes;                ///< default: one class, grain.d
  std::vector<Vec3d> positions;                ///< explicit centres instead of random ones, m
  Vec3d velocity;                              ///< m/s
  Vec3d spin{};                                ///< rad/s
  std::vector<Vec3d> velocities{}, spins{};    ///< of `positions`, one each: m/s, rad/s
  std::vector<double> every{};                 ///< x, y, z: each so many sites of the fluid's lattice carry a grain; empty: not on the lattice
  bool relative = false;                       ///< positions, also those of a file, are fractions of the domain
  bool replaces_fluid = false;                 ///< each grain takes the place of the nearest fluid particle
  std::string material{};                      ///< which of grain.material; empty: grain.*
  std::string file{};                          ///< grains instead of a box; absolute (resolved)
  std::int64_t step = -1;                      ///< frame of a .vtkhdf file; -1: the last
  RigidConfig rigid{};
  bool operator==(const GrainFill&) const = default;
};

/// What grains of a fill are made of; 0 and infinity: as grain.* (until resolved).
struct GrainMaterial {
  std::string name;
  double rho = 0;                              ///< kg/m3
  double E = 0;                                ///< Pa
  double nu = std::numeric_limits<double>::infinity();
  double mu = std::numeric_limits<double>::infinity();
  bool operator==(const GrainMaterial&) const = default;
};

struct GrainConfig {
  bool present = false;
  double d = 0;                                ///< m
  double rho = 2500;                           ///< kg/m3
  double E = 1e8;                              ///< Pa
  double nu = 0.3;
  double mu = 0.3;                             ///< sliding friction
  double mu_r = 0.01;                          ///< rolling friction
  double e = 0.9;                              ///< restitution
  std::uint64_t seed = 1;
  bool settle = false;                         ///< settle before t = 0
  double settle_time = 0;                      ///< longest settling, s (0: 20 sqrt(2 H / g))
  double settle_mu = std::numeric_limits<double>::infinity();  ///< sliding friction meanwhile (default mu)
  double release_time = 0;                     ///< grains are held until then, s
  bool fixed = false;                          ///< grains never move
  double d_max = 0, d_min = 0;                 ///< m (resolved)
  std::vector<GrainFill> fills;
  std::vector<GrainMaterial> materials;        ///< beside that of grain.*
  /// All of them as they are numbered: first that of grain.*.
  std::vector<GrainMaterial> all_materials() const {
    std::vector<GrainMaterial> all{{"", rho, E, nu, mu}};
    all.insert(all.end(), materials.begin(), materials.end());
    return all;
  }
  /// Its number; that of grain.* for a name that is none.
  std::uint32_t material(const std::string& name) const {
    for (std::size_t k = 0; k < materials.size(); ++k)
      if (materials[k].name == name) return std::uint32_t(k + 1);
    return 0;
  }
  /// Of the fills that move as one body each, their places.
  std::vector<int> rigid_fills() const {
    std::vector<int> all;
    for (std::size_t k = 0; k < fills.size(); ++k)
      if (fills[k].rigid.present) all.push_back(int(k));
    return all;
  }
  bool operator==(const GrainConfig&) const = default;
};

struct ContactConfig {
  Chosen<NormalLaw> normal = NormalLaw::hertz;
  Chosen<SlidingLaw> tangential = SlidingLaw::mindlin;
  Chosen<RollingLaw> rolling = RollingLaw::epsd;
  double k = 0;                                ///< N/m, linear only
  double kt_ratio = 2.0 / 7.0;
  double tangential_damping = 1;               ///< fraction of c_n sqrt(S_t/S_n) that damps friction's spring
  double eta_r = 0.3;
  bool clip_tension = true;
  bool he_damping = false;                     ///< paper.he_damping: sqrt(6) prefactor of He et al. (20b)
  bool cap_rolling = true;                     ///< the stabilising cap on cdt; off only for tests
  bool operator==(const ContactConfig&) const = default;
};

/// Forces of the fluid that grains squeeze out from between them.
struct LubricationConfig {
  Chosen<LubricationForces> forces = LubricationForces::none;
  double cut_off = 1;                          ///< gap beyond which there is none / R*
  double least_gap = 0.01;                     ///< gap below which it grows no further / R*
  bool acts() const { return forces != LubricationForces::none; }
  bool operator==(const LubricationConfig&) const = default;
};

/// drag.law = table: drag on a grain over its Stokes drag, by porosity and superficial Reynolds number.
struct DragTable {
  std::vector<double> porosity, reynolds;      ///< rising; reynolds from 0
  std::vector<double> factor;                  ///< K / (3 pi mu d), a row over reynolds for each porosity
  bool operator==(const DragTable&) const = default;
};

struct CouplingConfig {
  Chosen<CouplingMode> mode = CouplingMode::two_way;
  double hc = 0;                               ///< m (default max(h, 2 d_max 2/kappa))
  double eps_min = 0.25;
  Chosen<CouplingKernel> kernel = CouplingKernel::fluid;  ///< by which grains and fluid weigh each other
  bool wall_normalise = true;                  ///< a grain's volume lies in the kernel's fraction that walls leave free
  double spreading = 0.01;                     ///< how fast fluid that overfills its volume grows denser, c/h
  double S_dry = 0.05, S_wet = 0.95;
  bool torque = true;
  bool angmom = true;
  Chosen<DragSlip> slip = DragSlip::mean;      ///< that drag follows
  Chosen<DragLaw> drag = DragLaw::di_felice;
  DragTable table;                             ///< of law = table
  Chosen<DragIntegrator> integrator = DragIntegrator::exponential;
  bool operator==(const CouplingConfig&) const = default;
};

struct TimeConfig {
  double end = 0;                              ///< s
  double dt = 0;                               ///< s; 0: adaptive
  double dt_dem = 0;                           ///< s; 0: adaptive
  double cfl = 0.25, visc = 0.125, body = 0.25, drag = 0.5, rayleigh = 0.2, contact = 0.04;
  double friction = 0.025;                     ///< of SDPD
  Chosen<TimeIntegrator> integrator = TimeIntegrator::kdk;
  bool force_dt = false;
  bool operator==(const TimeConfig&) const = default;
};

/// A plane orifice through which fluid comes in.
struct InletConfig {
  std::string name;
  std::string shape = "disc";                  ///< disc, rectangle
  Vec3d centre, direction;                     ///< m; unit, into the flow
  double radius = 0;                           ///< disc: m
  Vec3d half_a, half_b;                        ///< rectangle: from its centre to the middles of two sides, m
  double rate = 0;                             ///< m3/s; exactly one of rate and velocity
  double velocity = 0;                         ///< m/s
  std::string factor = "1";                    ///< of either; formula in t
  double ramp = 0;                             ///< opening and closing take this long, s (default 10 h/c)
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  bool operator==(const InletConfig&) const = default;
};

/// Where fluid or grains are taken out.
struct OutletConfig {
  std::string name;
  std::string phase = "both";                  ///< fluid, grains, both
  std::string shape = "box";                   ///< box, plane (half-space beyond it), or a name
  Vec3d min, max;                              ///< box: m; of a shape: around it (resolved)
  Vec3d point, normal;                         ///< plane: normal points out of the flow
  Solid solid;                                 ///< of a named shape (resolved)
  bool takes(const char* what) const { return phase == "both" || phase == what; }
  bool operator==(const OutletConfig&) const = default;
};

/// Where grains are dropped in one by one.
struct GrainInletConfig {
  std::string name;
  std::string shape = "box";                   ///< box, disc
  Vec3d min, max;                              ///< box: m, grains lie inside
  Vec3d centre, direction;                     ///< disc: m, normal; centres of grains lie on it
  double radius = 0;                           ///< disc: m, grains lie inside
  double rate = 0;                             ///< grains/s; exactly one of rate and mass_rate
  double mass_rate = 0;                        ///< kg/s
  Vec3d velocity;                              ///< m/s
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  std::vector<SizeClass> sizes;                ///< default: one class, grain.d
  std::string material;                        ///< which of grain.material; empty: grain.*
  bool operator==(const GrainInletConfig&) const = default;
};

/// What is measured along the way; one CSV file each under probes/.
struct ProbeConfig {
  std::string name;
  std::string type;                            ///< front, point, height, box, force, wall_pressure
  std::string phase = "fluid";                 ///< front, box: fluid, grains
  int axis = 0;                                ///< front: 0, 1, 2
  int sign = 1;                                ///< front: +1 largest coordinate, -1 smallest
  Vec3d at;                                    ///< point, height, wall_pressure: at t = 0, m
  Vec3d min, max;                              ///< box: m
  std::string body;                            ///< force, wall_pressure: wall body; point: that carries it
  double radius = 0;                           ///< wall_pressure: of a disc, m; 0: a rectangle
  std::vector<double> size;                    ///< wall_pressure: sides of the rectangle, m
  std::vector<double> count;                   ///< wall_pressure: patches along them; empty: one
  Vec3d normal;                                ///< wall_pressure: unit, into the fluid (resolved)
  Vec3d along;                                 ///< wall_pressure: unit, of the first side (resolved)
  Vec3d about;                                 ///< force: torque about this point, m
  double every = 0;                            ///< s; 0: out.every
  bool operator==(const ProbeConfig&) const = default;
};

struct OutputConfig {
  double every = 0;                            ///< s
  double diagnostics_every = 0;                ///< s (default out.every)
  double checkpoint_every = 0;                 ///< s; 0: only at the end
  bool walls = true;                           ///< write walls.vtkhdf
  std::string bodies = "moving";               ///< bodies/*.csv of moving, all, none
  std::vector<ProbeConfig> probes;
  bool operator==(const OutputConfig&) const = default;
};

struct Config {
  std::string title;
  std::string preset = "default";              ///< default, he2018, democritus, robinson2014
  std::string file;                            ///< where it came from
  Vec3d gravity{0, 0, -9.81};                  ///< m/s2
  DriveConfig drive;
  double xsph = 0;
  double shift = 200;                          ///< factor A of particle shifting
  double tensile = 0;                          ///< 0 off; 1 switches the Monaghan 2000 term on
  bool tensile_one_sign = false;               ///< he2018: 0.01 for both signs of P
  DomainConfig domain;
  std::vector<ShapeConfig> shapes;
  FrameConfig frame;
  FluidConfig fluid;
  EosConfig eos;
  DensityConfig density;
  ViscosityConfig visc;
  SdpdConfig sdpd;
  WallConfig wall;
  std::vector<InletConfig> inlets;
  std::vector<OutletConfig> outlets;
  GrainConfig grain;
  std::vector<GrainInletConfig> grain_inlets;
  ContactConfig contact;
  LubricationConfig lubrication;
  CouplingConfig couple;
  TimeConfig time;
  OutputConfig out;
  std::string precision = "mixed";             ///< single, mixed, double
  std::string simd = "auto";                   ///< auto, baseline, avx2
  std::uint64_t seed = 1;
  double max_lost = 1e-3;                      ///< fraction of fluid or grains that may leave the domain unasked
  double skin_fluid = 0.3;                     ///< neighbour skin / fluid.dx
  double skin_grain = 0.2;                     ///< neighbour skin / grain.d_min
  bool operator==(const Config&) const = default;
};

}  // namespace bedload
