#pragma once

#include <memory>
#include <utility>

#include "dowel/collision/scene.h"

namespace dowel::testing {

/// Box along the axes that contains the exact solid, not only its facets: a side on which no flat
/// face lies may be curved, and then stands off the facets.
inline Obb box_of(const FacetedSolid& solid) {
  Aabb box = bounds(solid.vertices);
  double error_mm = 0.0;
  for (const Face& face : solid.faces) error_mm = std::max(error_mm, face.facet_error_mm);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(error_mm);
  Eigen::Vector3d high = low;
  for (const Face& face : solid.faces) {
    const auto* plane = std::get_if<PlaneSurface>(&face.surface);
    for (Eigen::Index axis = 0; plane != nullptr && axis < 3; ++axis) {
      if (plane->normal[axis] > 1.0 - 1e-12 && plane->origin[axis] >= box.max[axis] - 1e-9) {
        high[axis] = 0.0;
      }
      if (plane->normal[axis] < -1.0 + 1e-12 && plane->origin[axis] <= box.min[axis] + 1e-9) {
        low[axis] = 0.0;
      }
    }
  }
  box.min -= low;
  box.max += high;
  return {box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
}

inline std::shared_ptr<const CollisionElement> collision_element(FacetedSolid solid) {
  const Obb obb = box_of(solid);
  auto shared = std::make_shared<const FacetedSolid>(std::move(solid));
  return std::make_shared<const CollisionElement>(obb, [shared] { return shared; });
}

}  // namespace dowel::testing
