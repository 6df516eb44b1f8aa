#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dowel {

/// `text` as valid UTF-8 on one line: bytes that are not UTF-8 are read as Windows-1252 (what
/// old CAD systems write), control characters and runs of white space become one space, both ends
/// are trimmed, at most `kMaxNameBytes` bytes are kept.
std::string clean_text(std::string_view text);

/// `text` with the escapes of ISO 10303-21 for characters outside ASCII replaced by UTF-8:
/// \X2\ (UTF-16), \X4\ (UTF-32), \X\ and \S\ (ISO 8859-1), \\ . Malformed escapes stay as they are.
std::string decode_step_text(std::string_view text);

/// True where every byte of `text` belongs to valid UTF-8.
bool is_utf8(std::string_view text);

/// False for the empty name and for those that translators write where the designer gave none
/// ("Open CASCADE STEP translator 7.6 1", "SOLID", "Part_2", "1234").
bool is_usable_name(std::string_view name);

/// A name for each part: its own where usable, else `stem`; where a name is already taken, with
/// "-2", "-3" and so on behind it.
std::vector<std::string> part_names(const std::vector<std::string>& found, const std::string& stem);

inline constexpr std::size_t kMaxNameBytes = 200;

}  // namespace dowel
