#pragma once

#include <string>

#include "dowel/assembly/fixture_analysis.h"

namespace dowel::tools {

/// The fixture from above, as SVG: outlines of the parts' boxes, locators, clamps and loads with
/// their forces, the polygon of the supports and the centre of mass.
std::string analysis_drawing(Session& session, const FixtureAnalysis& analysis);

}  // namespace dowel::tools
