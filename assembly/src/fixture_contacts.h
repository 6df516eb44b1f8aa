#pragma once

// The contacts of the workpiece. Internal to fixture analysis and the rule engine.

#include <functional>
#include <vector>

#include "contact_patch.h"
#include "dowel/assembly/fixture_analysis.h"
#include "dowel/assembly/session.h"

namespace dowel {

struct FixtureInput {
  const ProjectState& state;
  std::function<const Element&(const std::string&)> element;
  std::function<std::shared_ptr<const FacetedSolid>(const std::string&)> solid;
  /// Planes that the two share, normals out of the first.
  std::function<const std::vector<ContactPatch>&(const Touch&)> shared_planes;
  const std::vector<Touch>& touches;  ///< all that is not clear
};

/// Instances that are workpieces, by order of placing.
std::vector<const Instance*> workpieces(const FixtureInput& input);

FixtureModel fixture_model(const FixtureInput& input, const Instance& workpiece);

}  // namespace dowel
