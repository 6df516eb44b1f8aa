#include "facet_geometry.h"

#include <algorithm>

namespace dowel {

double ordered_sum(std::vector<double> terms) {
  std::sort(terms.begin(), terms.end());
  double sum = 0.0;
  for (const double term : terms) sum += term;
  return sum;
}

Eigen::Vector3d ordered_sum(const std::vector<Eigen::Vector3d>& terms) {
  Eigen::Vector3d sum;
  std::vector<double> column(terms.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::transform(terms.begin(), terms.end(), column.begin(),
                   [axis](const Eigen::Vector3d& term) { return term[axis]; });
    sum[axis] = ordered_sum(column);
  }
  return sum;
}

bool less_by_coordinates(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

std::array<Eigen::Vector3d, 3> canonical_corners(const FacetedSolid& solid,
                                                 std::uint32_t triangle) {
  std::array<Eigen::Vector3d, 3> corners = solid.corners(triangle);
  std::rotate(corners.begin(),
              std::min_element(corners.begin(), corners.end(), less_by_coordinates), corners.end());
  return corners;
}

Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& direction) {
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  return direction.cross(Eigen::Vector3d::Unit(smallest)).normalized();
}

}  // namespace dowel
