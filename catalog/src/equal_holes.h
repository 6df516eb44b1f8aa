#pragma once

#include "dowel/catalog/feature.h"

namespace dowel {

/// Same shape, same direction, same opening plane.
bool are_equal_holes(const Feature& a, const Feature& b);

}  // namespace dowel
