#pragma once

namespace dowel {

/// Coordinates beyond this are rejected at the door: 100 m keeps one double ulp below 1.5e-11 mm.
inline constexpr double kMaxCoordinate_mm = 1.0e5;

/// Two axes, points or radii closer than this are the same when features are recognised. A tenth
/// of a micrometre: well under what a fixture is machined to, well over rounding and over the 7
/// digits that some STEP writers keep.
inline constexpr double kCoincident_mm = 1.0e-4;

/// Directions closer than this are parallel when features are recognised: 0.1 um over 1 m.
inline constexpr double kParallel_rad = 1.0e-7;

/// A quaternion read from outside may miss unit length by this much (FORMATS: scene files).
inline constexpr double kUnitQuaternionSlack = 1.0e-6;

/// Default tolerance between contact and interference, and between clear and contact.
inline constexpr double kDefaultTolerance_mm = 0.01;

/// Smallest tolerance accepted: a thousand times the rounding of a pose at 10 m.
inline constexpr double kMinTolerance_mm = 1.0e-6;

static_assert(kMinTolerance_mm * 100 <= kCoincident_mm * 1.0);
static_assert(kCoincident_mm * 100 <= kDefaultTolerance_mm * 1.0);

}  // namespace dowel
