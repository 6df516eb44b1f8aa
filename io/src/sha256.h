#pragma once

#include <filesystem>
#include <string>

namespace dowel {

/// SHA-256 of a file's content as 64 lower-case hex digits; reads it in pieces. Throws
/// Error{FileUnreadable}.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace dowel
