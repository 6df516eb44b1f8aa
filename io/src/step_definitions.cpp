#include "step_definitions.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <vector>

namespace dowel {
namespace {

/// The number after '#' at `at`, and where it ends; `at` itself where there is none.
std::size_t read_number(std::string_view text, std::size_t at, std::uint64_t& number) {
  const char* const first = text.data() + at;
  const auto [end, problem] = std::from_chars(first, text.data() + text.size(), number);
  return problem == std::errc() ? at + static_cast<std::size_t>(end - first) : at;
}

/// End of the entity that begins at `at`: its semicolon, not one in a string.
std::size_t end_of_entity(std::string_view text, std::size_t at) {
  bool in_string = false;
  for (; at < text.size(); ++at) {
    if (text[at] == '\'') in_string = !in_string;
    if (text[at] == ';' && !in_string) return at;
  }
  return at;
}

bool is_definition(std::string_view body) {
  if (body.starts_with("NEXT_ASSEMBLY_USAGE_OCCURRENCE(")) return true;
  if (body.starts_with("PRODUCT_DEFINITION_SHAPE(")) return true;
  return body.starts_with('(') &&
         body.find("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(") != std::string_view::npos;
}

}  // namespace

std::size_t unused_definitions(std::string_view compact) {
  std::vector<std::uint64_t> definitions;
  std::vector<std::uint64_t> used;
  std::size_t at = compact.find("DATA;");
  if (at == std::string_view::npos) return 0;
  at += std::string_view("DATA;").size();
  while (at < compact.size()) {
    const std::size_t end = end_of_entity(compact, at);
    const std::string_view entity = compact.substr(at, end - at);
    std::uint64_t number = 0;
    std::size_t body = 0;
    if (entity.starts_with('#')) body = read_number(entity, 1, number);
    if (body > 1 && is_definition(entity.substr(std::min(body + 1, entity.size())))) {
      definitions.push_back(number);
    }
    for (std::size_t i = entity.find('#', body); i != std::string_view::npos;
         i = entity.find('#', i + 1)) {
      std::uint64_t reference = 0;
      if (read_number(entity, i + 1, reference) > i + 1) used.push_back(reference);
    }
    at = end + 1;
  }
  std::sort(used.begin(), used.end());
  return static_cast<std::size_t>(std::ranges::count_if(definitions, [&used](std::uint64_t number) {
    return !std::binary_search(used.begin(), used.end(), number);
  }));
}

}  // namespace dowel
