#pragma once

#include <string_view>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// The polygons of a text mesh as triangles in `vertices` and `triangles`; nothing else is set.
/// Numbers are read to the last bit: a library that keeps single precision moves vertices by
/// micrometres at 10 m and makes flat polygons uneven. Concave polygons are cut by ears.
/// Throws Error{FileMalformed} naming the line: a number that is missing or not finite, an index
/// without a vertex, fewer elements than announced.
FacetedSolid parse_obj(std::string_view text);
FacetedSolid parse_off(std::string_view text);
FacetedSolid parse_ascii_stl(std::string_view text);

}  // namespace dowel
