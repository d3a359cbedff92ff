#pragma once
// What a case may be set up of: shapes, motions, openings, grain sizes, probes. As in choices.hpp each is
// written once: enumerator, name, meaning.

#include "bedload/case/chosen.hpp"

namespace bedload {

// -- shapes --------------------------------------------------------------------------------------

/// shape.kind
enum class ShapeKind {
  box,
  sphere,
  capsule,
  cylinder,
  cone,
  pipe,
  mesh,
  terrain,
  hollow,
  union_,
  difference
};
template <>
inline constexpr auto kNames<ShapeKind> = std::to_array<Named<ShapeKind>>({
    {ShapeKind::box, "box", "cuboid between two corners"},
    {ShapeKind::sphere, "sphere", "sphere about a centre"},
    {ShapeKind::capsule, "capsule", "all points within a radius of the line from a to b"},
    {ShapeKind::cylinder, "cylinder", "cylinder with flat ends at a and b"},
    {ShapeKind::cone, "cone", "truncated cone with flat ends at a and b, each with its radius"},
    {ShapeKind::pipe, "pipe", "hollow cylinder, open inside from a to b"},
    {ShapeKind::mesh, "mesh", "interior of a closed triangle mesh"},
    {ShapeKind::terrain, "terrain", "floor below a height map or an open triangle mesh"},
    {ShapeKind::hollow, "hollow", "shell around another shape (vessel)"},
    {ShapeKind::union_, "union", "union of several shapes"},
    {ShapeKind::difference, "difference", "the first shape without the others"},
});

/// shape.ends, of pipes
enum class PipeEnds { open, closed_a, closed_b, closed };
template <>
inline constexpr auto kNames<PipeEnds> = std::to_array<Named<PipeEnds>>({
    {PipeEnds::open, "open", "both ends open"},
    {PipeEnds::closed_a, "closed_a", "closed at a"},
    {PipeEnds::closed_b, "closed_b", "closed at b"},
    {PipeEnds::closed, "closed", "both ends closed"},
});

/// wall.body.shape
enum class WallShape { tank, box, plane };
template <>
inline constexpr auto kNames<WallShape> = std::to_array<Named<WallShape>>({
    {WallShape::tank, "tank", "box with the fluid inside; faces sets which sides exist"},
    {WallShape::box, "box", "solid box"},
    {WallShape::plane, "plane", "half-space behind a plane"},
});

// -- motions -------------------------------------------------------------------------------------

/// wall.body.motion.kind, frame.motion.kind and those of what is added to them
enum class MotionKind { fixed, velocity, oscillation, rotation, table, formula, piston, flap };
template <>
inline constexpr auto kNames<MotionKind> = std::to_array<Named<MotionKind>>({
    {MotionKind::fixed, "fixed", "at rest"},
    {MotionKind::velocity, "velocity", "translation at constant velocity"},
    {MotionKind::oscillation, "oscillation", "displacement amplitude sin(2 pi f t)"},
    {MotionKind::rotation, "rotation", "rotation about an axis"},
    {MotionKind::table, "table", "positions and rotations tabulated over time"},
    {MotionKind::formula, "formula", "displacement and rotation as formulas in t"},
    {MotionKind::piston, "piston", "wave maker that translates, for regular waves [schaffer96]"},
    {MotionKind::flap, "flap", "wave maker hinged at the floor, for regular waves [hughes93]"},
});

/// wall.body.motion.spline
enum class TableSpline { smooth, monotone };
template <>
inline constexpr auto kNames<TableSpline> = std::to_array<Named<TableSpline>>({
    {TableSpline::smooth, "smooth", "continuous acceleration; may overshoot the rows"},
    {TableSpline::monotone, "monotone", "continuous velocity; no overshoot"},
});

/// wall.body.free.move, grain.fill.rigid.move
enum class BodyMove : std::uint32_t { all, plane, axis, none };
template <>
inline constexpr auto kNames<BodyMove> = std::to_array<Named<BodyMove>>({
    {BodyMove::all, "all", "in all directions"},
    {BodyMove::plane, "plane", "normal to the axis"},
    {BodyMove::axis, "axis", "along the axis"},
    {BodyMove::none, "none", "no translation"},
});

/// wall.body.free.turn, grain.fill.rigid.turn
enum class BodyTurn : std::uint32_t { all, axis, none };
template <>
inline constexpr auto kNames<BodyTurn> = std::to_array<Named<BodyTurn>>({
    {BodyTurn::all, "all", "about all axes"},
    {BodyTurn::axis, "axis", "about the axis"},
    {BodyTurn::none, "none", "no rotation"},
});

/// wall.body.wear
enum class WearLaw { none, archard, finnie };
template <>
inline constexpr auto kNames<WearLaw> = std::to_array<Named<WearLaw>>({
    {WearLaw::none, "none", "no wear"},
    {WearLaw::archard, "archard", "volume k/H times normal force times sliding path [archard53]"},
    {WearLaw::finnie, "finnie", "cutting by impacts, by their energy and angle [finnie60]"},
});

// -- openings ------------------------------------------------------------------------------------

/// inlet.shape
enum class OrificeShape { disc, rectangle };
template <>
inline constexpr auto kNames<OrificeShape> = std::to_array<Named<OrificeShape>>({
    {OrificeShape::disc, "disc", "disc of a radius"},
    {OrificeShape::rectangle, "rectangle", "rectangle of sides 2 half_a and 2 half_b"},
});

/// outlet.phase
enum class OutletPhase { both, fluid, grains };
template <>
inline constexpr auto kNames<OutletPhase> = std::to_array<Named<OutletPhase>>({
    {OutletPhase::both, "both", "fluid and grains"},
    {OutletPhase::fluid, "fluid", "the fluid"},
    {OutletPhase::grains, "grains", "the grains"},
});

/// outlet.shape
enum class OutletShape { box, plane };
template <>
inline constexpr auto kNames<OutletShape> = std::to_array<Named<OutletShape>>({
    {OutletShape::box, "box", "inside a box"},
    {OutletShape::plane, "plane", "half-space beyond a plane"},
});

/// grain_inlet.shape
enum class GrainInletShape { box, disc };
template <>
inline constexpr auto kNames<GrainInletShape> = std::to_array<Named<GrainInletShape>>({
    {GrainInletShape::box, "box", "inside a box"},
    {GrainInletShape::disc, "disc", "on a disc"},
});

// -- grains --------------------------------------------------------------------------------------

/// clump.drag
enum class ClumpDrag { clump, members };
template <>
inline constexpr auto kNames<ClumpDrag> = std::to_array<Named<ClumpDrag>>({
    {ClumpDrag::clump, "clump",
     "that of the sphere of its volume, at the mean slip of its spheres and at its centre of mass"},
    {ClumpDrag::members, "members",
     "each sphere has its own, by its diameter and its slip: for porous blocks wider than couple.hc"},
});

/// grain.fill.sizes.kind, grain_inlet.sizes.kind
enum class SizeKind { one_size, uniform, log_normal, sieve };
template <>
inline constexpr auto kNames<SizeKind> = std::to_array<Named<SizeKind>>({
    {SizeKind::one_size, "class", "all grains of diameter d"},
    {SizeKind::uniform, "uniform", "diameters distributed uniformly by number from d_min to d_max"},
    {SizeKind::log_normal, "log_normal", "log-normal by number, truncated at d_min and d_max"},
    {SizeKind::sieve, "sieve", "sieve curve: mass fraction over mesh opening, log-linear in between"},
});

/// grain.resolve
enum class GrainResolve { by_size, none, all };
template <>
inline constexpr auto kNames<GrainResolve> = std::to_array<Named<GrainResolve>>({
    {GrainResolve::by_size, "auto", "those of eight fluid.dx or more, and others as couple.between says"},
    {GrainResolve::none, "none", "none: drag laws apply to all"},
    {GrainResolve::all, "all", "all, which must be of four fluid.dx or more"},
});

// -- output --------------------------------------------------------------------------------------

/// probe.type
enum class ProbeType { front, point, height, box, flux, force, wall_pressure, mixing, field };
template <>
inline constexpr auto kNames<ProbeType> = std::to_array<Named<ProbeType>>({
    {ProbeType::front, "front", "farthest position of a phase in a direction"},
    {ProbeType::point, "point", "fluid velocity and pressure at a point"},
    {ProbeType::height, "height",
     "height of the fluid surface at a point, and depth of connected fluid there"},
    {ProbeType::box, "box", "mass and momentum in a box"},
    {ProbeType::flux, "flux", "mass and volume that pass a section in unit time"},
    {ProbeType::force, "force", "force and torque on a wall body"},
    {ProbeType::wall_pressure, "wall_pressure",
     "force per area on patches of a wall body, as of pressure transducers"},
    {ProbeType::mixing, "mixing", "how well one kind of grains is mixed with the others [lacey54]"},
    {ProbeType::field, "field",
     "solid fraction, velocity, temperature, stress of grains at points [goldhirsch10]"},
});

/// probe.phase
enum class Phase { fluid, grains };
template <>
inline constexpr auto kNames<Phase> = std::to_array<Named<Phase>>({
    {Phase::fluid, "fluid", "the fluid"},
    {Phase::grains, "grains", "the grains"},
});

/// probe.sample, of forces
enum class ForceSample { mean, instant };
template <>
inline constexpr auto kNames<ForceSample> = std::to_array<Named<ForceSample>>({
    {ForceSample::mean, "mean",
     "mean since the row before over all steps and substeps; times the interval it gives impulse and work"},
    {ForceSample::instant, "instant", "instantaneous value"},
});

/// out.contacts
enum class ContactFrames { none, touching, all };
template <>
inline constexpr auto kNames<ContactFrames> = std::to_array<Named<ContactFrames>>({
    {ContactFrames::none, "none", "no frames of contacts"},
    {ContactFrames::touching, "touching", "contacts of grains with each other and with walls, as lines"},
    {ContactFrames::all, "all", "these, and grains and walls that are near each other without touching"},
});

/// out.bodies
enum class BodyTables { moving, all, none };
template <>
inline constexpr auto kNames<BodyTables> = std::to_array<Named<BodyTables>>({
    {BodyTables::moving, "moving", "moving bodies"},
    {BodyTables::all, "all", "all bodies"},
    {BodyTables::none, "none", "no tables"},
});

}  // namespace bedload
