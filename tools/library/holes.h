#pragma once

#include <string>

#include <Eigen/Core>

#include "part.h"
#include "systems.h"

/// The holes and slots of the systems, as features that solids are cut by and the manifest lists.
namespace dowel::library {

/// Where a hole opens and which way it goes into the material.
struct HolePlace {
  std::string use;
  Eigen::Vector3d origin;
  Eigen::Vector3d direction{0.0, 0.0, -1.0};
};

/// Cylindrical hole; blind ends are flat.
Feature plain_hole(const HolePlace& place, double diameter_mm, double depth_mm, bool through);

/// Tapped hole, as wide as the thread's minor diameter. A blind one is `depth_mm` deep and ends in
/// the point of a 118 degree drill beyond that.
Feature tapped_hole(const HolePlace& place, const ThreadSize& thread, double depth_mm,
                    bool through);

/// A node of a hole system: locating bore over a coaxial thread that goes `depth_mm` deep, blind
/// ends as those of `tapped_hole`. Expects: the system has nodes.
Feature node_hole(const System& system, const HolePlace& place, double depth_mm, bool through);

/// What elements of the system carry on their top: a node, or a tapped hole where there are none.
Feature top_hole(const System& system, const HolePlace& place);

/// Counterbored hole for the screw that holds an element, from the top of a body `height_mm` high.
/// With `located` its last stretch, as long as wide, fits the shank of a fit screw.
Feature screw_hole(const System& system, const HolePlace& place, double height_mm,
                   double counterbore_depth_mm, bool located);

/// What a slot is and how it lies: `origin` in the middle of its mouth.
Feature straight_slot(std::string use, SlotShape::Type type, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction, double width_mm, double depth_mm,
                      double length_mm);

/// A T-slot that leaves the part at both ends.
Feature tee_slot(std::string use, const TeeSlotSize& size, const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& run, double length_mm);

/// The open slot below an element that a key aligns it by. Expects: the system has keys.
Feature key_slot(const System& system, const Eigen::Vector3d& run, double length_mm);

}  // namespace dowel::library
