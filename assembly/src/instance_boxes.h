#pragma once

// Boxes of placed instances, and which of them are near each other. Internal to the rule engine.

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "dowel/assembly/project.h"

namespace dowel {

using ElementOf = std::function<const Element&(const Instance&)>;

/// Along the world's axes, around the element's smallest box.
Eigen::AlignedBox3d box_around(const Instance& instance, const Element& element);

/// Pairs whose boxes are no farther apart than `gap_mm`, sorted, each with the first by name first.
/// Where `of` is given, only pairs of at least one of these.
std::vector<std::pair<const Instance*, const Instance*>> near_pairs(
    const ProjectState& state, const ElementOf& element_of, double gap_mm,
    const std::set<std::string>* of);

}  // namespace dowel
