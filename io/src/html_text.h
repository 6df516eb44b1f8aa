#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace dowel {

/// `text` as the content of an HTML element or of a quoted attribute. What is not well-formed UTF-8
/// becomes U+FFFD, control characters become blanks.
std::string escaped_html(std::string_view text);

/// Source: RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes);

}  // namespace dowel
