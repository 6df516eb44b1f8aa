#pragma once

#include <string>

#include <Eigen/Core>

#include "dimensions.h"
#include "part.h"

/// The holes of the system, as features that `drilled` cuts and the manifest lists.
namespace dowel::library {

/// Where a hole opens and which way it goes into the material.
struct HolePlace {
  std::string name;
  Eigen::Vector3d origin;
  Eigen::Vector3d direction{0.0, 0.0, -1.0};
};

/// Cylindrical hole; blind ends are flat.
DesignedFeature plain_hole(const HolePlace& place, double diameter_mm, double depth_mm,
                           bool through);

/// A node of the system: locating bore over a coaxial thread that goes `depth_mm` deep. Blind ends
/// have the point of a 118 degree drill beyond that depth.
DesignedFeature node_hole(const HolePlace& place, double depth_mm, bool through);

/// Counterbored hole for the screw that holds an element on a node, from the top of a body
/// `height_mm` high. With `located` its last 12 mm are 12H7, for the shank of a fit screw.
DesignedFeature screw_hole(const HolePlace& place, double height_mm, double counterbore_depth_mm,
                           bool located);

}  // namespace dowel::library
