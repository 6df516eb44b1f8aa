#include "facet_geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace dowel {

double ordered_sum(std::span<const double> terms) {
  double largest = 0.0;
  for (const double term : terms) largest = std::max(largest, std::abs(term));
  if (largest == 0.0 || !std::isfinite(largest)) return largest;
  // Whole numbers, whose sum knows no order: as fine as fits so many of them into 63 bits.
  constexpr int kSmallest = -900;  // so that the scale is finite, too
  int exponent = 0;
  std::frexp(largest, &exponent);
  const int bits = 62 - static_cast<int>(std::bit_width(terms.size()));
  const double scale = std::ldexp(1.0, bits - std::max(exponent, kSmallest));
  std::int64_t sum = 0;
  for (const double term : terms) sum += std::llrint(term * scale);
  return static_cast<double>(sum) / scale;
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
