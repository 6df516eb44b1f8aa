#include "step_text.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace dowel {
namespace {

constexpr char32_t kNoCharacter = 0xFFFD;

/// The character at the start of `text` and the number of bytes it takes. A byte that starts no
/// well-formed sequence counts as one replacement character.
std::pair<char32_t, std::size_t> decode_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  std::size_t length = 0;
  char32_t character = 0;
  char32_t smallest = 0;
  if (lead >= 0xC0 && lead < 0xE0) {
    length = 2, character = lead & 0x1FU, smallest = 0x80;
  } else if (lead >= 0xE0 && lead < 0xF0) {
    length = 3, character = lead & 0x0FU, smallest = 0x800;
  } else if (lead >= 0xF0 && lead < 0xF8) {
    length = 4, character = lead & 0x07U, smallest = 0x10000;
  }
  if (length == 0 || length > text.size()) return {kNoCharacter, 1};
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {kNoCharacter, 1};
    character = (character << 6U) | (byte(i) & 0x3FU);
  }
  const bool surrogate = character >= 0xD800 && character < 0xE000;
  if (character < smallest || character > 0x10FFFF || surrogate) return {kNoCharacter, 1};
  return {character, length};
}

void append_hex(std::string& out, char32_t value, int digits) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
    out += kDigits[(value >> static_cast<unsigned>(shift)) & 0xFU];
  }
}

/// Appends the character outside ASCII at the start of `text`; returns the number of bytes read.
std::size_t append_directive(std::string& out, std::string_view text) {
  const auto [character, length] = decode_utf8(text);
  const bool wide = character > 0xFFFF;
  out += wide ? "\\X4\\" : "\\X2\\";
  append_hex(out, character, wide ? 8 : 4);
  out += "\\X0\\";
  return length;
}

/// Appends the number at the start of `text`; returns the number of bytes read.
std::size_t append_number(std::string& out, std::string_view text) {
  const std::string_view number = text.substr(0, text.find_first_not_of("+-.0123456789E"));
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) {
    out += number;
    return number.size();
  }
  const std::size_t exponent = std::min(number.find('E'), number.size());
  const std::size_t last = std::max(point, number.find_last_not_of('0', exponent - 1));
  const std::string_view mantissa = number.substr(0, last + 1);
  const std::string_view power = number.substr(exponent);
  if (mantissa == "-0.") {
    out += "0.";
  } else {
    out += mantissa;
    if (power != "E+00") out += power;
  }
  return number.size();
}

bool starts_number(char c) {
  return c == '-' || (c >= '0' && c <= '9');
}

}  // namespace

std::string tidy_step_text(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  bool in_string = false;  // a doubled apostrophe leaves and enters again at once
  char before = '\0';      // last character that is not blank: numbers follow '(' or ','
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (static_cast<std::uint8_t>(c) >= 0x80) {
      i += append_directive(out, text.substr(i));
      continue;
    }
    if (!in_string && (before == '(' || before == ',') && starts_number(c)) {
      i += append_number(out, text.substr(i));
      before = '0';
      continue;
    }
    if (c == '\'') in_string = !in_string;
    const bool line_break = c == '\n' || c == '\r';
    // Two strings never follow each other: a break between two apostrophes splits a doubled one.
    const bool splits_pair = line_break && !out.empty() && out.back() == '\'' &&
                             i + 1 < text.size() && text[i + 1] == '\'';
    if (!line_break && c != ' ') before = c;
    if (!line_break || !(in_string || splits_pair)) out += c;
    ++i;
  }
  return out;
}

}  // namespace dowel
