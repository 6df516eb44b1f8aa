#pragma once

#include <array>
#include <string>

#include "dowel/io/scene_page.h"

namespace dowel {

using Colour = std::array<double, 3>;  ///< sRGB 0..1 unless a name says otherwise

/// What a part is drawn in: red where it collides, a touch of blue where it is in contact (touching
/// is how a fixture works, not an alarm), else its own colour.
Colour surface_colour(const Colour& own, DisplayState state);

/// What its edges are drawn in: dark enough to stand on any part.
Colour line_colour(DisplayState state);

/// Components out of 0..1, or not numbers, are brought into it.
Colour linear_from_srgb(const Colour& colour);

/// "#rrggbb".
std::string to_hex(const Colour& colour);

}  // namespace dowel
