#pragma once

#include <cstdint>
#include <cstdlib>
#include <sstream>

namespace dowel::testing {

struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t count = 0;
};

/// `otherwise`, or what the environment variable DOWEL_SEEDS says: "1000 20" for twenty seeds from
/// 1000 on, "1023 1" to see again what failed with seed 1023. For tests that run by name only.
inline SeedRange seeds_or(SeedRange otherwise) {
  const char* text = std::getenv("DOWEL_SEEDS");
  if (text == nullptr) return otherwise;
  std::istringstream words(text);
  SeedRange range;
  words >> range.first >> range.count;
  return range;
}

}  // namespace dowel::testing
