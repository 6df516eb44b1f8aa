#include "solid_symmetry.h"

#include <algorithm>

#include "dowel/collision/model.h"

namespace dowel {

bool covers_itself(const CollisionElement& element, const Pose& X_SS, double within_mm) {
  const CollisionModel& model = element.model();
  const auto is_on_boundary = [&](const Eigen::Vector3d& point) {
    return model.nearest(X_SS * point).distance_mm <= within_mm;
  };
  // The middles tell a hole's wall from the plane that its rim lies on.
  return std::ranges::all_of(model.triangles(), [&](const ModelTriangle& t) {
    return is_on_boundary((t.corners[0] + t.corners[1] + t.corners[2]) / 3.0) &&
           std::ranges::all_of(t.corners, is_on_boundary);
  });
}

}  // namespace dowel
