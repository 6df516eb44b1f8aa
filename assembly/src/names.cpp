#include "dowel/assembly/names.h"

#include <algorithm>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr std::size_t kLongestName = 64;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_ascii(char c) {
  return static_cast<unsigned char>(c) < 0x80;
}

/// Length of the UTF-8 sequence that starts `text`, 0 where there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t length = 1;
  if (byte(0) >= 0xF0 && byte(0) <= 0xF4) {
    length = 4;
  } else if (byte(0) >= 0xE0) {
    length = 3;
  } else if (byte(0) >= 0xC2) {
    length = 2;
  } else if (byte(0) >= 0x80) {
    return 0;
  }
  if (byte(0) > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  // Overlong forms, surrogates, and what lies beyond the last code point.
  if (length > 2) {
    const unsigned lead = (static_cast<unsigned>(byte(0)) << 8U) | byte(1);
    if (lead < 0xE0A0U || (lead >= 0xEDA0U && lead < 0xEE80U)) return 0;
    if ((lead >= 0xF000U && lead < 0xF090U) || lead > 0xF48FU) return 0;
  }
  return length;
}

}  // namespace

std::optional<std::string> instance_name_defect(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestName) {
    return "has " + std::to_string(name.size()) + " bytes, more than " +
           std::to_string(kLongestName);
  }
  if (name.front() == '#') return "starts with '#', which begins a comment";
  for (std::size_t i = 0; i < name.size();) {
    const char c = name[i];
    const std::string where = " at byte " + std::to_string(i + 1);
    if (c == '.') return "has a dot" + where + ", which stands before a feature";
    if (c == '"' || c == '\'') return "has a quote" + where;
    if (is_ascii(c) && (c <= ' ' || c == 0x7F)) return "has white space" + where;
    const std::size_t length = utf8_length(name.substr(i));
    if (length == 0) return "is not UTF-8" + where;
    i += length;
  }
  return std::nullopt;
}

std::string role_of(std::string_view element_name) {
  const std::string_view last = element_name.substr(element_name.rfind('/') + 1);
  for (std::size_t start = 0; start < last.size();) {
    std::size_t end = start;
    while (end < last.size() && (is_letter(last[end]) || is_digit(last[end]))) ++end;
    const std::string_view word = last.substr(start, end - start);
    if (word.size() >= 2 && word.size() <= kLongestName / 2 &&
        std::ranges::all_of(word, is_letter)) {
      std::string role(word);
      for (char& c : role) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      }
      return role;
    }
    start = end + 1;
  }
  return "PART";
}

std::string free_name(std::string_view element_name,
                      const std::function<bool(const std::string&)>& is_taken) {
  const std::string role = role_of(element_name);
  for (std::size_t number = 1;; ++number) {
    std::string name = role + std::to_string(number);
    if (!is_taken(name)) return name;
  }
}

bool is_tolerance(double tolerance_mm) {
  return tolerance_mm >= kMinTolerance_mm && tolerance_mm <= kMaxTolerance_mm;
}

}  // namespace dowel
