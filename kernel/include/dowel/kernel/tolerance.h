#pragma once

namespace dowel {

/// Coordinates beyond this are rejected at the door: 100 m keeps one double ulp below 1.5e-11 mm.
inline constexpr double kMaxCoordinate_mm = 1.0e5;

/// Bodies are placed no further from the origin than this: 10 km keeps the rounding of a placed
/// point below 2e-9 mm, far below every tolerance.
inline constexpr double kMaxPlace_mm = 1.0e7;

/// Two axes, points or radii closer than this are the same when features are recognised. A tenth
/// of a micrometre: well under what a fixture is machined to, well over rounding and over the 7
/// digits that some STEP writers keep.
inline constexpr double kCoincident_mm = 1.0e-4;

/// Directions closer than this are parallel when features are recognised: 0.1 um over 1 m.
inline constexpr double kParallel_rad = 1.0e-7;

/// Unit vectors of surfaces may miss unit length by this much: at the 100 m of kMaxCoordinate_mm
/// that is 0.1 um, what kCoincident_mm forgives.
inline constexpr double kUnitVectorSlack = 1.0e-9;

/// Boxes whose volumes differ by less than this part are equally large, and the better aligned one
/// is taken: well over the rounding of a volume, well under what anybody would call smaller.
inline constexpr double kEqualVolumes = 1.0e-9;

/// A quaternion read from outside may miss unit length by this much (FORMATS: scene files).
inline constexpr double kUnitQuaternionSlack = 1.0e-6;

/// A direction or box axis read from a catalogue may miss unit length, and a right angle, by this
/// much (a ratio): rounding of any writer, far below what shows on a part.
inline constexpr double kStoredAxisSlack = 1.0e-6;

/// A vertex may miss the exact face of its triangle by this much besides the facet error: the
/// coarsest edges that CAD systems leave; more is another face.
inline constexpr double kStrayFacet_mm = 0.1;

/// Recognition: axes, radii, planes and rims closer than this belong to one feature, and a
/// free-form face that misses a plane, cylinder or cone by no more is one: a micrometre, what
/// exporters that write B-splines only leave, and a third of the tightest clearance in a fixture.
inline constexpr double kSameFeature_mm = 1.0e-3;

/// Recognition: iterations stop at, and components of directions are zero below, this ratio: a few
/// thousand ulp, ten orders below what a fixture shows.
inline constexpr double kRounding = 1.0e-12;

/// Recognition: lengths of features are rounded to a picometre, so that 30 reads 30 whatever pose
/// the exporter wrote. Steps in a millimetre, because a quotient by it is the nearest double.
inline constexpr double kFeatureSteps_per_mm = 1.0e9;

/// Default tolerance between contact and interference, and between clear and contact.
inline constexpr double kDefaultTolerance_mm = 0.01;

/// Smallest tolerance accepted: a thousand times the rounding of a pose at 10 m.
inline constexpr double kMinTolerance_mm = 1.0e-6;

/// Largest tolerance accepted: beyond it whole parts would count as touching.
inline constexpr double kMaxTolerance_mm = 10.0;

/// Pictures: faces that meet at less than this run into each other without a visible edge. A
/// degree, as for Convexity::Smooth.
inline constexpr double kTangent_rad = 0.0175;

/// Pictures: neighbouring facets of one free-form face that turn more than this meet at a crease.
/// 40 degrees: more than the facets of a curved face turn (up to 0.5 rad), less than any bevel.
inline constexpr double kCrease_rad = 0.7;

static_assert(kTangent_rad < kCrease_rad);
/// Two placed axes are one where they miss each other by no more than this: what a screw in its
/// clearance never notices, and far less than half the difference of two thread sizes.
inline constexpr double kCoaxial_mm = 0.02;

/// Placed directions closer than this are parallel: 0.01 mm over 100 mm.
inline constexpr double kCoaxial_rad = 1.0e-4;

/// A shaft may be thicker than its hole by this much, a micrometre: files carry nominal sizes.
inline constexpr double kShaftExcess_mm = 1.0e-3;

/// A cylinder this close to a nominal diameter stands for its thread; a ground pin (g6: 6 um and
/// more below nominal) does not.
inline constexpr double kThreadNominalSlack_mm = 5.0e-3;

/// A bore may miss the range from minor diameter to tap drill by this much and be a core hole.
inline constexpr double kTapDrillSlack_mm = 0.05;

/// A catalogue's box contains its element within this: a micrometre, well under any tolerance of a
/// verdict, and a share of the part's size for the rounding of the box's axes.
inline constexpr double kBoxSlack_mm = 1.0e-3;
inline constexpr double kBoxSlackRatio = 1.0e-9;

/// An element's exact volume and the volume of its facets may differ by this share of it besides
/// what the facet error explains: CAD kernels integrate free-form faces no better.
inline constexpr double kVolumeSlackRatio = 1.0e-3;

/// Import: facets of STEP parts deviate by a thousandth of the part's diagonal, but no less than 5
/// um (twice what matters at the default tolerance, halved again by the mesher) and no more than
/// 0.1 mm.
inline constexpr double kMinDeflection_mm = 0.005;
inline constexpr double kMaxDeflection_mm = 0.1;

/// Import: faces whose edges are closer than this are sewn when a solid has to be healed. What CAD
/// systems call coincident in their coarsest setting.
inline constexpr double kSewing_mm = 1.0e-3;

/// Import: touching solids of one part are told apart by moving shared vertices this far, or two
/// ulp where that is more. Far below every tolerance.
inline constexpr double kTouchingSolids_mm = 1.0e-12;

/// Import: neighbouring triangles of a mesh file are one planar face where no corner leaves the
/// plane by more than this part of the mesh's size: rounding of decimal numbers, nothing drawn.
inline constexpr double kCoplanarRatio = 1.0e-9;

static_assert(kCoincident_mm * 10 <= kSameFeature_mm);
static_assert(kCoincident_mm * kFeatureSteps_per_mm >= 100);
/// Import: relative error asked of the integration over spline faces.
inline constexpr double kIntegrationRatio = 1.0e-6;

static_assert(kTouchingSolids_mm * 1.0e6 <= kMinTolerance_mm);
static_assert(kMinTolerance_mm * 100 <= kCoincident_mm * 1.0);
static_assert(kCoincident_mm * 100 <= kDefaultTolerance_mm * 1.0);

}  // namespace dowel
