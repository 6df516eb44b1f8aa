#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"

namespace dowel {

/// An element that lifts what stands on it: flat bottom and top, and one hole from one to the
/// other.
struct Spacer {
  std::string element;
  double height_mm = 0.0;
  std::string hole;  ///< feature by which it stands, and carries the next

  bool operator==(const Spacer&) const = default;
};

/// The spacer that `element` is; nothing where it has no such faces and hole.
std::optional<Spacer> spacer_of(const Element& element);

/// Ways of reaching `height_mm` (within kCoincident_mm) with `spacers`, each as often as need be:
/// the fewest pieces first, then by height of the tallest, of the next and so on. At most `count`
/// ways of at most kMostStacked pieces; in each, the tallest stands below.
std::vector<std::vector<Spacer>> stack_choices(std::span<const Spacer> spacers, double height_mm,
                                               std::size_t count);

/// More than anybody would pile up.
inline constexpr std::size_t kMostStacked = 8;

}  // namespace dowel
