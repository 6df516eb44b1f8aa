#pragma once

// Where two placed solids touch each other. Internal to the rule engine and fixture analysis.

#include <vector>

#include <Eigen/Core>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// A stretch of plane that two solids share, or a point where they touch.
struct ContactPatch {
  Eigen::Vector3d at_W = Eigen::Vector3d::Zero();       ///< centroid
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< out of A, into B; unit
  double area_mm2 = 0.0;                   ///< 0: they touch along a line or at a point
  std::vector<Eigen::Vector3d> corners_W;  ///< of the hull of a plane patch
};

/// Patches of all pairs of planar faces that lie on each other within `tolerance_mm`, largest
/// first; those of one plane are one patch.
std::vector<ContactPatch> plane_patches(const FacetedSolid& a, const Pose& X_WA,
                                        const FacetedSolid& b, const Pose& X_WB,
                                        double tolerance_mm);

/// The same; where there is none, the point `witness_W`, with the normal of the faces there.
std::vector<ContactPatch> contact_patches(const FacetedSolid& a, const Pose& X_WA,
                                          const FacetedSolid& b, const Pose& X_WB,
                                          double tolerance_mm, const Eigen::Vector3d& witness_W);

}  // namespace dowel
