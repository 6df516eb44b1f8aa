#pragma once

// Wrenches for hexagons. Internal to the rule engine.

#include <string>
#include <vector>

#include "drive.h"

namespace dowel {

/// A tool does not scrape along what the fastener stands on.
inline constexpr double kOffSeat_mm = 0.5;

/// A tool on a drive: a cylinder about the axis and a lever square to it. Heights along the axis.
struct TurningTool {
  std::string name;
  double sense = 1.0;  ///< along the drive's axis, or against it
  double head_mm = 0.0;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double lever_at_mm = 0.0;
  double lever_diameter_mm = 0.0;
  double lever_mm = 0.0;
};

/// Best first; none for a hexagon that no tool is known for.
std::vector<TurningTool> wrenches_for(const Drive& drive);

}  // namespace dowel
