#pragma once

#include <cstdint>
#include <vector>

namespace dowel {

/// The element that stands for the set of `i`, where each element names another of its set, or
/// itself. Shortens the way for the next time.
inline std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

}  // namespace dowel
