// Every choice has a row for each of its enumerators.

#include "bedload/case/choices.hpp"

#include "bedload/case/setup_choices.hpp"

namespace bedload {
namespace {

/// Whether E has an enumerator of that value: compilers write it by its name, and any other as a cast,
/// "(E)3".
template <class E, E value>
constexpr bool enumerated() {
  constexpr std::string_view self = __PRETTY_FUNCTION__, is = "value = ";
  return self[self.rfind(is) + is.size()] != '(';
}

/// At its place, one row each.
template <class E>
constexpr bool all_named() {
  constexpr std::size_t rows = kNames<E>.size();
  for (std::size_t k = 0; k < rows; ++k)
    if (std::size_t(kNames<E>[k].value) != k) return false;
  return enumerated<E, E(rows - 1)>() && !enumerated<E, E(rows)>();
}

template <class... E>
constexpr bool kAllNamed = (all_named<E>() && ...);

static_assert(kAllNamed<NormalLaw, SlidingLaw, RollingLaw, LubricationForces>, "a contact law has no row");
static_assert(kAllNamed<FluidModel, LatticeCollision, DensityMethod, NoiseForm, DriveMode, DrivenPhase,
                        DriveReversal, KernelFunction, EosType, ViscosityModel>,
              "a choice of the fluid has no row");
static_assert(kAllNamed<WallType, WallSlip, LayerForce>, "a choice of the walls has no row");
static_assert(
    kAllNamed<CouplingMode, BetweenSizes, CouplingKernel, DragSlip, SuspensionLaw, DragLaw, DragIntegrator>,
    "a choice of the coupling has no row");
static_assert(kAllNamed<TimeIntegrator, Preset, Precision, Simd>, "a choice of the run has no row");
static_assert(kAllNamed<ShapeKind, PipeEnds, WallShape, MotionKind, TableSpline, BodyMove, BodyTurn,
                        OrificeShape, OutletPhase, OutletShape, GrainInletShape, SizeKind, ClumpDrag,
                        GrainResolve, ProbeType, Phase, ForceSample, ContactFrames, BodyTables, WearLaw>,
              "a choice of shapes, openings or outputs has no row");

}  // namespace
}  // namespace bedload
