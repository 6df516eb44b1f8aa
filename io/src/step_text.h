#pragma once

#include <string>
#include <string_view>

namespace dowel {

/// The text of a STEP file as every reader understands it and every eye likes it. In strings,
/// characters outside ASCII, given as UTF-8, become control directives of ISO 10303-21
/// (\X2\00E9\X0\), bytes that are not UTF-8 become U+FFFD, and line breaks, which mean nothing
/// there, go. Elsewhere reals lose zeros that carry nothing: 1.50000E+00 becomes 1.5 and -0.0
/// becomes 0.
std::string tidy_step_text(std::string_view text);

}  // namespace dowel
