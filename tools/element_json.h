#pragma once

#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/catalog/face_outline.h"
#include "json.h"

namespace dowel::tools {

/// All that is known of an element but its facets: what `catalog show --json` prints.
/// `outlines`: of its planar faces, in their order; without them the faces have none.
Json to_json(const Element& element, const std::vector<FaceOutline>& outlines = {});

/// One line of a list: name, sizes, numbers of features.
Json to_summary_json(const Element& element);

/// Edge lengths of the element's box in mm, along its axes.
Eigen::Vector3d box_size_mm(const Element& element);

/// How many features of a kind an element has.
std::size_t count_features(const Element& element, FeatureKind kind);

}  // namespace dowel::tools
