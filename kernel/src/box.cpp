#include "dowel/kernel/box.h"

namespace dowel {

std::array<Eigen::Vector3d, 8> Obb::corners() const {
  std::array<Eigen::Vector3d, 8> result;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                                (i & 4U) != 0 ? 1.0 : -1.0);
    result[i] = center + axes * signs.cwiseProduct(half_extents_mm);
  }
  return result;
}

Obb transformed(const Pose& X_WB, const Obb& box_B) {
  return {X_WB * box_B.center, X_WB.rotation_matrix() * box_B.axes, box_B.half_extents_mm};
}

Aabb bounds(const Obb& box) {
  const Eigen::Vector3d reach = box.axes.cwiseAbs() * box.half_extents_mm;
  return {box.center - reach, box.center + reach};
}

Aabb bounds(std::span<const Eigen::Vector3d> points) {
  Aabb box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box;
}

}  // namespace dowel
