#pragma once

#include <optional>
#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/catalog/metric_thread.h"
#include "dowel/collision/scene.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// How a shaft goes with a hole on the same axis, where both are placed.
struct AxisFit {
  bool thread = false;  ///< the shaft reaches a stretch that is its thread's core hole
  /// First stretch of the bore, by depth, that the shaft is in and is too thick for (by more than
  /// kShaftExcess_mm, and not its thread); nothing where the shaft fits.
  const HoleSegment* obstacle = nullptr;
};

/// `shaft`, an element's feature at X_WS, in `hole`, another's at X_WH. A shaft that stands clear
/// of the bore is measured against its opening. Cones are no obstacle: a chamfer or drill point is
/// a matter of collision. `obstacle` points into `hole`.
/// Expects: a shaft and a hole, coaxial.
AxisFit fit_on_axis(const Feature& shaft, const Pose& X_WS, const Feature& hole, const Pose& X_WH);

/// A stretch of depth along a hole.
struct DepthRange {
  double from_mm = 0.0;
  double to_mm = 0.0;

  double length_mm() const { return to_mm > from_mm ? to_mm - from_mm : 0.0; }
};

/// Where in the hole, by depth, its first core hole for a thread of `nominal_mm` is; nothing where
/// there is none.
std::optional<DepthRange> core_hole(const Feature& hole, double nominal_mm);

/// Length over which shaft and hole are in thread with each other; 0 where they form none.
/// Expects: a shaft and a hole, coaxial.
double engagement_mm(const Feature& shaft, const Pose& X_WS, const Feature& hole, const Pose& X_WH);

/// Threads that the shafts of one element form with the holes of another where they are coaxial
/// (within kCoaxial_mm and kCoaxial_rad), as cylinders in the frame of `tapped`. A relief spans its
/// whole core hole with the chamfers at its mouths, so that it holds while the screw turns in.
std::vector<ThreadRelief> thread_reliefs(const Element& tapped, const Pose& X_WT,
                                         const Element& screw, const Pose& X_WS);

/// True where `thread_reliefs` could find any, wherever the two are placed.
bool may_form_thread(const Element& tapped, const Element& screw);

}  // namespace dowel
