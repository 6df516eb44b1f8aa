#include "tool_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dowel {
namespace {

using Eigen::Vector3d;

/// World pose of a frame on the drive's axis, z along it.
Pose axis_frame(const Drive& drive, double sense, const Pose& X_WI) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), sense * drive.axis);
  return X_WI * Pose(turn, drive.axis_origin);
}

Pose lifted(const Pose& X_WA, double by_mm) {
  return X_WA * Pose::from_translation({0, 0, by_mm});
}

ToolRoom head_room(const Drive& drive, const TurningTool& wrench, const Pose& X_WI) {
  return {lifted(axis_frame(drive, wrench.sense, X_WI), wrench.from_mm), wrench.head_mm,
          wrench.to_mm - wrench.from_mm};
}

std::vector<ToolRoom> lever_rooms(const Drive& drive, const TurningTool& wrench, const Pose& X_WI) {
  const Pose X_WA = lifted(axis_frame(drive, wrench.sense, X_WI), wrench.lever_at_mm);
  const double step_rad = std::asin(std::min(1.0, wrench.lever_diameter_mm / wrench.lever_mm));
  const int steps = static_cast<int>(std::ceil(2.0 * std::numbers::pi / step_rad));
  std::vector<ToolRoom> rooms;
  for (int i = 0; i < steps; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / steps;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
    rooms.push_back(
        {X_WA * Pose(turn, Vector3d::Zero()), wrench.lever_diameter_mm, wrench.lever_mm});
  }
  return rooms;
}

std::optional<ToolRoom> way_in(const Drive& drive, const Pose& X_WI) {
  if (drive.is_nut) return std::nullopt;
  const double from_mm = drive.seat_mm + kOffSeat_mm;
  const double to_mm = drive.high_mm + drive.seat_mm - drive.low_mm;
  return ToolRoom{lifted(axis_frame(drive, 1.0, X_WI), from_mm), 2.0 * drive.radius_mm,
                  to_mm - from_mm};
}

}  // namespace

Eigen::AlignedBox3d box_of(const ToolRoom& room) {
  const Vector3d axis_W = room.X_WT.rotation() * Vector3d::UnitZ();
  const Vector3d reach_mm =
      0.5 * room.diameter_mm * (Vector3d::Ones() - axis_W.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  Eigen::AlignedBox3d box(room.X_WT.translation());
  box.extend(Vector3d(room.X_WT.translation() + room.length_mm * axis_W));
  box.min() -= reach_mm;
  box.max() += reach_mm;
  return box;
}

bool FastenerRooms::may_be_in(const Eigen::AlignedBox3d& box_W) const {
  return std::ranges::any_of(boxes_W,
                             [&](const Eigen::AlignedBox3d& box) { return box.intersects(box_W); });
}

FastenerRooms rooms_around(const Drive& drive, const Pose& X_WI) {
  FastenerRooms rooms;
  for (const TurningTool& wrench : wrenches_for(drive)) {
    const WrenchRoom& room = rooms.wrenches.emplace_back(
        WrenchRoom{wrench, head_room(drive, wrench, X_WI), lever_rooms(drive, wrench, X_WI)});
    rooms.boxes_W.push_back(box_of(room.head));
    Eigen::AlignedBox3d& swept_W = rooms.boxes_W.emplace_back();
    for (const ToolRoom& lever : room.levers) swept_W.extend(box_of(lever));
  }
  rooms.way_in = way_in(drive, X_WI);
  if (rooms.way_in) rooms.boxes_W.push_back(box_of(*rooms.way_in));
  return rooms;
}

}  // namespace dowel
