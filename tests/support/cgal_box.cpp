#include "cgal_box.h"

#include <array>
#include <cmath>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/optimal_bounding_box.h>

namespace dowel::testing {

double cgal_box_volume_mm3(std::span<const Eigen::Vector3d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::get_default_random() = CGAL::Random(1);  // the search is a random one
  std::vector<Kernel::Point_3> cloud;
  cloud.reserve(points.size());
  for (const Eigen::Vector3d& p : points) cloud.emplace_back(p.x(), p.y(), p.z());
  std::array<Kernel::Point_3, 8> corners;
  CGAL::oriented_bounding_box(cloud, corners, CGAL::parameters::use_convex_hull(true));
  return std::sqrt((corners[1] - corners[0]).squared_length() *
                   (corners[3] - corners[0]).squared_length() *
                   (corners[5] - corners[0]).squared_length());
}

}  // namespace dowel::testing
