#pragma once

#include <cstddef>
#include <string_view>

namespace dowel {

/// How many placements, uses and shapes of products stand in a STEP file that no other entity
/// refers to: the reader passes them by without a word, and a part is in the wrong place or
/// missing. `compact`: the file's text without blanks. O(text log text).
std::size_t unused_definitions(std::string_view compact);

}  // namespace dowel
