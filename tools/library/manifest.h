#pragma once

#include <string>
#include <vector>

#include "part.h"

namespace dowel::library {

/// The library as it was designed, `dowel-library/1` (JSON): every element with its role, sources,
/// dimensions and features, in the conventions of `dowel catalog show --json`. What a catalogue
/// recognises in the STEP files can be held against it.
std::string manifest_json(const std::vector<Part>& parts);

}  // namespace dowel::library
