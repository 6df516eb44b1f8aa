#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

namespace dowel::testing {

/// Two bodies, and where the first has a wanted depth in the second (negative: gap).
struct ContactCase {
  std::string name;
  FacetedSolid a;
  FacetedSolid b;
  std::function<Pose(double)> X_BA;  ///< places A in B for a given depth (> 0) or gap (< 0)
  bool has_gap = false;              ///< it does so for gaps, too
};

/// How far a tip is below a plane when the largest ball in it has diameter `depth_mm`; a gap stays
/// as it is.
double tip_height_mm(double depth_mm, double half_angle_rad);

/// How parts of fixtures touch: flat, along edges, in corners and tips, in slots and bores. All
/// have rest at depth 0.
std::vector<ContactCase> contact_suite();

}  // namespace dowel::testing
