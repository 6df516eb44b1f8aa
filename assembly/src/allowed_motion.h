#pragma once

// The motion nearest to one asked for among those that are free. Internal to Session.

#include <optional>
#include <vector>

#include "dowel/assembly/freedom.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// A turn about a line with a slide along it: of a screw, or, without a slide, of a hinge.
struct ScrewMotion {
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< unit
  double slide_mm_per_rad = 0.0;
};

/// The part of a slide that the freedoms leave.
Eigen::Vector3d allowed_slide(const std::vector<Freedom>& freedoms, const Eigen::Vector3d& by_mm_W);

/// The free turn about `axis_W`, about a line as near to `point_W` as can be; nothing where no turn
/// about such an axis is free.
std::optional<ScrewMotion> allowed_turn(const std::vector<Freedom>& freedoms,
                                        const Eigen::Vector3d& axis_W,
                                        const Eigen::Vector3d& point_W);

/// Frames through which a screw motion takes a part at `center_W`, in legs that a sweep can follow:
/// the first and the last are the ends.
std::vector<Pose> screw_path(const ScrewMotion& screw, double angle_rad,
                             const Eigen::Vector3d& center_W);

}  // namespace dowel
