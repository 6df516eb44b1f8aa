#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dowel/kernel/pose.h"

namespace dowel {

class CollisionModel;
struct ThreadRelief;

/// A stretch of an axis and a radius about it, which changes evenly from end to end: a chamfer's.
struct ProfileStep {
  double from_mm = 0.0;  ///< along the axis, from < to
  double to_mm = 0.0;
  double from_radius_mm = 0.0;
  double to_radius_mm = 0.0;
  /// A cylinder about the axis goes all the way round at this radius, over the whole stretch.
  bool is_round = false;

  double most_radius_mm() const { return std::max(from_radius_mm, to_radius_mm); }
  double least_radius_mm() const { return std::min(from_radius_mm, to_radius_mm); }
  /// Change of the radius with the height.
  double slope() const { return (to_radius_mm - from_radius_mm) / (to_mm - from_mm); }
  double radius_at(double height_mm) const {
    return from_radius_mm + slope() * (height_mm - from_mm);
  }
};

/// A body as one of its own axes sees it, in steps along that axis. Of a shaft: a radius that no
/// material passes (the pin, its collar, the head of a screw). Of a bore: a radius within which
/// there is no material (the hole, its counterbore, the air before its mouth); where no step is,
/// nothing is beside the axis.
struct AxisProfile {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  std::vector<ProfileStep> steps;  ///< ascending
};

/// Profiles about the axes of all cylinders of the model, and of its cones, outer ones and bores.
struct AxisProfiles {
  std::vector<AxisProfile> shafts;
  std::vector<AxisProfile> bores;

  std::size_t memory_bytes() const;
};

AxisProfiles find_axis_profiles(const CollisionModel& model);

/// What two profiles say of a shaft in a bore. Conservative: says nothing it is not sure of.
struct Fit {
  /// No ball of diameter tolerance fits into both bodies.
  bool is_free = false;
  /// Lower bound of the distance of the bodies, where they are free; may be negative.
  double gap_mm = -std::numeric_limits<double>::infinity();
  /// Two round cylinders that face each other are no further apart than the tolerance.
  bool gap_is_met = false;
  /// Where shaft and bore come nearest, on the wall of the bore, or overlap most, in the middle of
  /// the overlap; in the frame of the bore's body.
  Eigen::Vector3d place_V = Eigen::Vector3d::Zero();
};

/// Judges the shaft at `X_VS` against the bore, each in its body's frame, at the tolerance.
/// `reliefs_V`: threads that they may overlap in. `travel_mm`: the shaft is judged for all places
/// on the way this far along the bore's direction (or against it) at once.
///
/// A point of the shaft's body at radius r about the shaft's axis has a radius of at most r plus
/// the distance of the axes there about the bore's axis, and that distance is largest at one of the
/// ends of a stretch: so the steps are compared without sampling, exactly for parallel axes and
/// cylinders, to second order in the tilt otherwise.
Fit fit(const AxisProfile& shaft, const AxisProfile& bore, const Pose& X_VS, double tolerance_mm,
        std::span<const ThreadRelief> reliefs_V, double travel_mm = 0.0);

}  // namespace dowel
