#pragma once

// What a wrench gets hold of. Internal to the rule engine.

#include <optional>

#include <Eigen/Core>

#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// A hexagon of a screw or nut, by its six flats. Element's frame.
struct Drive {
  enum class Kind { Socket, Hexagon };  ///< inside, outside
  Kind kind = Kind::Socket;
  bool is_nut = false;
  Eigen::Vector3d axis_origin = Eigen::Vector3d::Zero();
  /// Unit. Screw: from the tip to the head. Nut: either way along its thread.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double across_flats_mm = 0.0;
  double from_mm = 0.0;  ///< of the flats, along the axis from its origin
  double to_mm = 0.0;
  double low_mm = 0.0;  ///< of the whole part
  double high_mm = 0.0;
  double seat_mm = 0.0;    ///< where it becomes wider than its thread
  double radius_mm = 0.0;  ///< of the part about the axis, at its widest
};

/// Nothing for what has no thread or no hexagon about it: studs, washers, knurled nuts.
std::optional<Drive> drive_of(const Element& element, const FacetedSolid& solid);

}  // namespace dowel
