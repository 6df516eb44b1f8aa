#pragma once

#include "exact_shape.h"
#include "random_geometry.h"

namespace dowel::testing {

/// Pins, rings, sockets, blocks, slots, nuts: faces of all exact kinds that meet in rims, convex,
/// concave and smooth, faceted coarsely to finely; one in seven has a cavity or a second shell.
/// `size_mm`: about what it measures from its middle outwards.
ExactShape random_shape(RandomGeometry& random, double size_mm);

}  // namespace dowel::testing
