#include "dowel/catalog/element.h"

#include <algorithm>

namespace dowel {

const Feature* Element::find_feature(std::string_view feature_name) const {
  const auto found = std::ranges::find(features, feature_name, &Feature::name);
  return found == features.end() ? nullptr : &*found;
}

}  // namespace dowel
