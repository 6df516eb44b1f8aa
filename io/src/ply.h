#pragma once

#include <string_view>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// The polygons of a PLY file (ascii, binary of either byte order) as triangles in `vertices` and
/// `triangles`; nothing else is set. Elements and properties other than the position of "vertex"
/// and the index list of "face" are skipped. Throws Error{FileMalformed}: a damaged header, data
/// that ends early, a number that is not finite, an index without a vertex. Source: Turk, "The PLY
/// Polygon File Format", 1994.
FacetedSolid parse_ply(std::string_view content);

/// The triangles of a binary STL file. Expects: its length fits its count of triangles.
FacetedSolid parse_binary_stl(std::string_view content);

/// True where the length of `content` is what a binary STL says of itself. Its free header may
/// begin with "solid" like a text.
bool is_binary_stl(std::string_view content);

}  // namespace dowel
