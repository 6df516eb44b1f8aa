#pragma once

// The room that tools take around a fastener. Internal to the rule engine.

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dowel/kernel/pose.h"
#include "turning_tool.h"

namespace dowel {

/// A cylinder that the room of a tool, of its lever or of a screw on its way in is taken for.
struct ToolRoom {
  Pose X_WT;  ///< z along its axis, from the origin
  double diameter_mm = 0.0;
  double length_mm = 0.0;
};

/// Around the cylinder, along the world's axes.
Eigen::AlignedBox3d box_of(const ToolRoom& room);

/// A wrench on a fastener: its head, and its lever at angles so close that it sweeps all between.
struct WrenchRoom {
  TurningTool wrench;
  ToolRoom head;
  std::vector<ToolRoom> levers;
};

struct FastenerRooms {
  std::vector<WrenchRoom> wrenches;          ///< best first
  std::optional<ToolRoom> way_in;            ///< of a screw's head; nuts come over their screw
  std::vector<Eigen::AlignedBox3d> boxes_W;  ///< around all of them

  bool may_be_in(const Eigen::AlignedBox3d& box_W) const;
};

FastenerRooms rooms_around(const Drive& drive, const Pose& X_WI);

}  // namespace dowel
