#pragma once

// A screw that a wrench gets onto.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fixture_elements.h"

namespace dowel::testing {

/// M12 with a hexagon head of 18 across flats, 8 high, its tip at z = 0.
inline ProjectElement hexagon_screw(int length_mm = 65) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 6; ++i) {
    const double angle_rad = std::numbers::pi / 3.0 * i;
    corners.emplace_back(18.0 / std::sqrt(3.0) * std::cos(angle_rad),
                         18.0 / std::sqrt(3.0) * std::sin(angle_rad));
  }
  ProjectElement screw = element_of(
      "T/hex-screw-M12x" + std::to_string(length_mm),
      merged(cylinder(6.0, length_mm - 0.01, 24),
             transformed(Pose::from_translation({0, 0, 1.0 * length_mm}), prism(corners, 8))),
      {shaft_feature("pin1", {0.0, 0.0, 1.0 * length_mm}, -Eigen::Vector3d::UnitZ(), 12.0,
                     length_mm)});
  screw.element.role = "fastener";
  screw.element.features[0].thread = "M12";
  return screw;
}

}  // namespace dowel::testing
