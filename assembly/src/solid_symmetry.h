#pragma once

// Whether a solid looks the same when it is turned. Internal to the fixture analysis.

#include "dowel/collision/scene.h"

namespace dowel {

/// Whether the solid, moved by `X_SS`, covers itself: each facet's corners and middle are on its
/// boundary, within `within_mm`.
bool covers_itself(const CollisionElement& element, const Pose& X_SS, double within_mm);

}  // namespace dowel
