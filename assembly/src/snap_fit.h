#pragma once

// Where a feature that goes with another ends up. Internal to snapping.

#include <optional>

#include "dowel/assembly/mate.h"

namespace dowel {

struct FittedPlace {
  MatePlacement placement;
  double offset_mm = 0.0;  ///< of the mate
};

/// As `insert` places it. A shaft that is longer than the stretch of the bore that it fits stands
/// on the step below; nothing where it does not fit at all.
std::optional<FittedPlace> fitted_place(const PlacedFeature& moving, const PlacedFeature& fixed);

}  // namespace dowel
