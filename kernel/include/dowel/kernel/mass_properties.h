#pragma once

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Volume, surface and first and second moments of a closed mesh of unit density.
struct MassProperties {
  double volume_mm3 = 0.0;  ///< positive where the mesh is outward
  double surface_mm2 = 0.0;
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  /// About the centre of mass, in mm^5 (multiply by density for kg mm^2).
  Eigen::Matrix3d inertia_mm5 = Eigen::Matrix3d::Zero();
};

/// Of the facets, not of the exact faces. Sums about the box centre, so that a part far from the
/// origin loses no digits. Source: Mirtich, "Fast and Accurate Computation of Polyhedral Mass
/// Properties", 1996 (by signed tetrahedra instead of projections).
MassProperties mass_properties(const FacetedSolid& solid);

}  // namespace dowel
