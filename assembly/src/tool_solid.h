#pragma once

// Room that a tool takes. Internal to the rule engine.

#include <memory>

#include "dowel/collision/scene.h"

namespace dowel {

/// A cylinder on z = 0 about the z axis, with its exact faces.
std::shared_ptr<const CollisionElement> cylinder_model(double diameter_mm, double length_mm);

}  // namespace dowel
