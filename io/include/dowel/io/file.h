#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace dowel {

/// Content of a file. Throws Error{FileUnreadable} naming it (missing, a folder, larger than
/// `max_bytes`).
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes = 1UL << 31U);

/// Writes to a temporary file beside `file`, flushes it to disk and renames it: `file` has its old
/// content or the new one, whatever happens. Throws Error{FileUnwritable} and leaves no leftovers.
void write_file(const std::filesystem::path& file, std::string_view content);
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);

}  // namespace dowel
