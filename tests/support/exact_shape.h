#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dowel/collision/scene.h"
#include "outlined_solids.h"
#include "solids.h"

namespace dowel::testing {

/// A solid of which two things are known that know nothing of each other: facets with the exact
/// surfaces behind them, which dowel works on, and its exact distance from any point, by the
/// outlines it is made of.
struct ExactShape {
  /// Negative inside. Exact everywhere, hence no steeper than 1.
  using SignedDistance = std::function<double(const Eigen::Vector3d&)>;

  std::string name;
  FacetedSolid solid;
  SignedDistance signed_distance_mm;
  Aabb box;  ///< contains the exact solid

  Obb obb() const { return {box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()}; }
};

inline std::shared_ptr<const CollisionElement> collision_element(const ExactShape& shape) {
  auto solid = std::make_shared<const FacetedSolid>(shape.solid);
  return std::make_shared<const CollisionElement>(shape.obb(), [solid] { return solid; });
}

/// Body of revolution about z; `profile` as for `revolved_outline`.
inline ExactShape revolved_shape(std::string name, const Outline& profile, const Facets& facets) {
  const OutlinedArea area({profile}, OutlinedArea::Plane::RightOfAxis);
  return {std::move(name),
          revolved_outline(profile, facets),
          [area](const Eigen::Vector3d& p) {
            return area.signed_distance_mm({p.head<2>().norm(), p.z()});
          },
          {{-area.max().x(), -area.max().x(), area.min().y()},
           {area.max().x(), area.max().x(), area.max().y()}}};
}

/// `outlines` as for `extruded`.
inline ExactShape extruded_shape(std::string name, const std::vector<Outline>& outlines,
                                 double height_mm, const Facets& facets) {
  const OutlinedArea area(outlines);
  return {std::move(name),
          extruded(outlines, height_mm, facets.per_turn),
          [area, height_mm](const Eigen::Vector3d& p) {
            const double across = area.signed_distance_mm(p.head<2>());
            const double along = std::max(-p.z(), p.z() - height_mm);
            if (across > 0.0 && along > 0.0) return std::hypot(across, along);
            return std::max(across, along);
          },
          {{area.min().x(), area.min().y(), 0.0}, {area.max().x(), area.max().y(), height_mm}}};
}

inline ExactShape transformed(const Pose& X_WB, const ExactShape& shape) {
  return {shape.name, transformed(X_WB, shape.solid),
          [distance = shape.signed_distance_mm, X_BW = X_WB.inverse()](const Eigen::Vector3d& p_W) {
            return distance(X_BW * p_W);
          },
          bounds(transformed(X_WB, shape.obb()))};
}

/// `outer` with a closed cavity. Expects: `inner` lies inside it.
inline ExactShape hollowed(const ExactShape& outer, const ExactShape& inner) {
  return {outer.name + " hollowed by " + inner.name, hollowed(outer.solid, inner.solid),
          [solid = outer.signed_distance_mm, cavity = inner.signed_distance_mm](
              const Eigen::Vector3d& p) { return std::max(solid(p), -cavity(p)); },
          outer.box};
}

/// Expects: the two are apart.
inline ExactShape merged(const ExactShape& a, const ExactShape& b) {
  Aabb box = a.box;
  box.extend(b.box);
  return {a.name + " and " + b.name, merged(a.solid, b.solid),
          [a = a.signed_distance_mm, b = b.signed_distance_mm](const Eigen::Vector3d& p) {
            return std::min(a(p), b(p));
          },
          box};
}

}  // namespace dowel::testing
