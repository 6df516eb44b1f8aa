#pragma once

// The rules of the folder `rules`, as the build puts them into the library. Internal to rules.

#include <span>

namespace dowel {

struct ShippedRule {
  const char* family;
  const char* file;
  const char* text;
};

extern const std::span<const ShippedRule> kShippedRules;

}  // namespace dowel
