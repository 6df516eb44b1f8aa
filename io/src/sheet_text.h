#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dowel/catalog/element.h"

namespace dowel {

/// "12.5", with up to six digits.
std::string sheet_number(double value);

/// Title and value of what is known of an element: size, mass, material, ...
std::vector<std::pair<std::string, std::string>> element_facts(const Element& element);

/// Features that differ only in their place, and how their kind is described.
struct FeatureGroup {
  std::string description;           ///< "hole ⌀12 H7, M12, through 40"
  std::vector<std::size_t> members;  ///< indices into the element's features
};

/// The element's features but for its planar faces, equal ones together, in their order.
std::vector<FeatureGroup> feature_groups(const Element& element);

/// "cb1 cb2 cb3"; of many the first and the last, "A1 … H10".
std::string member_names(const Element& element, const FeatureGroup& group);

}  // namespace dowel
