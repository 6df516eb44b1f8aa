#pragma once

#include <string_view>

namespace dowel {

/// The 3D page with two places to fill in, `@TITLE@` and `@SCENE@`, each there exactly once. Its
/// definition is generated from io/viewer.
std::string_view page_template();

}  // namespace dowel
