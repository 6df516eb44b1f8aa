#pragma once

#include <span>

#include <Eigen/Core>

namespace dowel::testing {

/// Volume of the smallest box around `points` that CGAL finds.
double cgal_box_volume_mm3(std::span<const Eigen::Vector3d> points);

}  // namespace dowel::testing
