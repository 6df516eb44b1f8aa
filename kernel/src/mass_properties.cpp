#include "dowel/kernel/mass_properties.h"

#include <Eigen/Geometry>

#include "dowel/kernel/box.h"

namespace dowel {

MassProperties mass_properties(const FacetedSolid& solid) {
  MassProperties result;
  if (solid.triangles.empty()) return result;

  const Eigen::Vector3d origin = bounds(solid.vertices).center();
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   // integral of x over the volume
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of x x^T
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    const std::array<Eigen::Vector3d, 3> corners = solid.corners(i);
    const Eigen::Vector3d a = corners[0] - origin;
    const Eigen::Vector3d b = corners[1] - origin;
    const Eigen::Vector3d c = corners[2] - origin;
    result.surface_mm2 += 0.5 * (b - a).cross(c - a).norm();

    // The tetrahedron from the origin; its moments follow from its corners.
    const double volume_mm3 = a.dot(b.cross(c)) / 6.0;
    const Eigen::Vector3d sum = a + b + c;
    result.volume_mm3 += volume_mm3;
    first += volume_mm3 / 4.0 * sum;
    second += volume_mm3 / 20.0 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }

  result.center_of_mass = origin;
  if (result.volume_mm3 == 0.0) return result;
  const Eigen::Vector3d offset = first / result.volume_mm3;
  result.center_of_mass += offset;
  const Eigen::Matrix3d central = second - result.volume_mm3 * offset * offset.transpose();
  result.inertia_mm5 = central.trace() * Eigen::Matrix3d::Identity() - central;
  return result;
}

}  // namespace dowel
