#include "part_names.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>

namespace dowel {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

void append_utf8(std::string& out, char32_t code) {
  if (code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) code = kReplacement;
  const auto tail = [&](unsigned shift) {
    out += static_cast<char>(0x80U | ((code >> shift) & 0x3FU));
  };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0U | (code >> 6U));
    tail(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0U | (code >> 12U));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xF0U | (code >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

/// Length of the valid UTF-8 sequence that `text` begins with; 0 where it begins with none.
/// Source: Unicode Standard, table 3-7 (no surrogates, no overlong forms, up to U+10FFFF).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : lead >= 0xE0 && lead <= 0xEF ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  if (length == 0 || text.size() < length) return 0;
  const std::uint8_t low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const std::uint8_t high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  return length;
}

/// Windows-1252 differs from ISO 8859-1 in 0x80..0x9F. Source: Unicode's CP1252.TXT.
char32_t from_windows_1252(std::uint8_t byte) {
  static constexpr std::array<char16_t, 32> kUpper{
      0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};
  return byte >= 0x80 && byte < 0xA0 ? kUpper[byte - 0x80U] : byte;
}

std::optional<char32_t> parse_hex(std::string_view digits) {
  char32_t value = 0;
  for (const char c : digits) {
    const char32_t digit = c >= '0' && c <= '9'   ? static_cast<char32_t>(c - '0')
                           : c >= 'A' && c <= 'F' ? static_cast<char32_t>(c - 'A' + 10)
                           : c >= 'a' && c <= 'f' ? static_cast<char32_t>(c - 'a' + 10)
                                                  : 16;
    if (digit == 16) return std::nullopt;
    value = value * 16 + digit;
  }
  return value;
}

/// Decodes the hexadecimal body of \X2\ (width 4) or \X4\ (width 8).
std::optional<std::string> decode_wide(std::string_view body, std::size_t width) {
  if (body.size() % width != 0) return std::nullopt;
  std::string out;
  for (std::size_t i = 0; i < body.size(); i += width) {
    const auto code = parse_hex(body.substr(i, width));
    if (!code) return std::nullopt;
    char32_t whole = *code;
    if (width == 4 && whole >= 0xD800 && whole < 0xDC00 && i + 8 <= body.size()) {
      const auto low = parse_hex(body.substr(i + 4, 4));
      if (low && *low >= 0xDC00 && *low < 0xE000) {
        whole = 0x10000 + ((whole - 0xD800) << 10U) + (*low - 0xDC00);
        i += 4;
      }
    }
    append_utf8(out, whole);
  }
  return out;
}

/// Decodes the escape that `text` begins with into `out`; returns how many bytes it took, or 0.
std::size_t decode_escape(std::string_view text, std::string& out) {
  for (const std::size_t width : {std::size_t{4}, std::size_t{8}}) {
    if (!text.starts_with(width == 4 ? "\\X2\\" : "\\X4\\")) continue;
    const std::size_t end = text.find("\\X0\\", 4);
    if (end == std::string_view::npos) return 0;
    const auto decoded = decode_wide(text.substr(4, end - 4), width);
    if (!decoded) return 0;
    out += *decoded;
    return end + 4;
  }
  if (text.starts_with("\\X\\") && text.size() >= 5) {
    const auto code = parse_hex(text.substr(3, 2));
    if (!code) return 0;
    append_utf8(out, *code);
    return 5;
  }
  if (text.starts_with("\\S\\") && text.size() >= 4 && static_cast<std::uint8_t>(text[3]) < 0x80) {
    append_utf8(out, static_cast<std::uint8_t>(text[3]) + 0x80U);
    return 4;
  }
  if (text.starts_with("\\\\")) {
    out += '\\';
    return 2;
  }
  return 0;
}

/// Lower case, without the digits, brackets and separators at the end.
std::string reduced(std::string_view name) {
  std::string word(name);
  const auto is_tail = [](char c) {
    return (c >= '0' && c <= '9') || c == ' ' || c == '_' || c == '-' || c == '.' || c == '(' ||
           c == ')' || c == '#' || c == ':';
  };
  while (!word.empty() && is_tail(word.back())) word.pop_back();
  std::transform(word.begin(), word.end(), word.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return word;
}

}  // namespace

std::string clean_text(std::string_view text) {
  std::string out;
  bool gap = false;
  while (!text.empty()) {
    std::size_t length = utf8_length(text);
    std::string character(text.substr(0, length));
    if (length == 0) {
      length = 1;
      append_utf8(character, from_windows_1252(static_cast<std::uint8_t>(text.front())));
    }
    text.remove_prefix(length);
    const auto first = static_cast<std::uint8_t>(character.front());
    const bool is_c1 = first == 0xC2 && static_cast<std::uint8_t>(character.back()) < 0xA0;
    if (first <= 0x20 || first == 0x7F || is_c1) {
      gap = !out.empty();
      continue;
    }
    if (out.size() + character.size() + (gap ? 1 : 0) > kMaxNameBytes) break;
    if (gap) out += ' ';
    gap = false;
    out += character;
  }
  return out;
}

std::string decode_step_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t taken = text.front() == '\\' ? decode_escape(text, out) : 0;
    if (taken == 0) out += text.front();
    text.remove_prefix(std::max<std::size_t>(taken, 1));
  }
  return out;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool is_usable_name(std::string_view name) {
  static constexpr std::array<std::string_view, 24> kGeneric{
      "",        "solid",   "shell",    "compound", "compsolid", "assembly",
      "shape",   "part",    "body",     "face",     "product",   "model",
      "default", "unnamed", "none",     "null",     "unknown",   "untitled",
      "no name", "noname",  "new part", "document", "root",      "part__feature"};
  const std::string word = reduced(name);
  if (word.starts_with("open cascade step translator")) return false;
  if (word.starts_with("open cascade shape model")) return false;
  return std::find(kGeneric.begin(), kGeneric.end(), word) == kGeneric.end();
}

std::vector<std::string> part_names(const std::vector<std::string>& found,
                                    const std::string& stem) {
  std::map<std::string, std::size_t> used;  // how often each name was asked for
  std::vector<std::string> names;
  for (const std::string& own : found) {
    const std::string base = is_usable_name(own) ? own : stem;
    std::string name = base;
    while (used.contains(name)) name = base + "-" + std::to_string(++used[base]);
    used.emplace(name, 1);
    names.push_back(name);
  }
  return names;
}

}  // namespace dowel
