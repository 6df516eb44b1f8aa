#pragma once

#include <optional>
#include <string>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// First value of `solid` that is out of its range (an index, a coordinate, a parameter of a
/// surface), as a sentence; nothing where all values make sense one by one. O(n). What remains for
/// `find_defect` is how the triangles fit together.
std::optional<std::string> find_bad_value(const FacetedSolid& solid);

}  // namespace dowel
