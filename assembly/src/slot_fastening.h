#pragma once

// Fastening over T-slots: what goes into the slot, and how it is placed. Internal to automation.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dowel/assembly/fastening.h"
#include "dowel/assembly/session.h"

namespace dowel {

/// Parts farther apart than this along an axis are not fastened together.
inline constexpr double kOpenJoint_mm = 0.1;

/// Full threads in a T-nut, in diameters: it is heat-treated (DIN 508), where a part need not be.
inline constexpr double kTeeNutEngagement = 0.9;

/// The holes of all instances on one axis, as far as the parts follow each other.
struct Bore {
  std::vector<BoreStretch> stretches;
  std::vector<FeatureName> holes;
  double reached_mm = 0.0;  ///< depth at which the last part ends
};

/// A T-slot below a bore.
struct SlotBelow {
  FeatureName name;
  PlacedFeature slot;
  double mouth_mm = 0.0;  ///< its depth along the bore

  /// Depth at which the undercut begins.
  double shoulder_mm() const { return mouth_mm + slot.feature->slot->throat_depth_mm; }
};

/// The T-slot that the axis of a bore meets where the last part ends, over the slot's middle; the
/// bore may end in a key slot of that part's foot.
std::optional<SlotBelow> slot_below(Session& session, const Eigen::Vector3d& start_W,
                                    const Eigen::Vector3d& direction_W, double reached_mm);

/// Ways with screws and each T-nut that goes into the slot and does not turn there; the screw may
/// look out of it, short of the slot's floor. It holds by 0.9 d, or by the whole nut where that is
/// lower. Their thread is the hole behind the last of the bore: the slot.
FasteningChoices choose_tee_nut(const Bore& bore, const SlotBelow& below,
                                std::span<const Fastener> fasteners,
                                const FasteningOptions& options);

/// Ways with each T-bolt that goes into the slot and does not turn there; see `choose_tee_bolt`.
FasteningChoices choose_bolt_in_slot(const Bore& bore, const SlotBelow& below,
                                     std::span<const Fastener> fasteners, double mouth_mm);

/// The feature that leads a T-nut or T-bolt into its slot, for a mate: hole of the nut, bottom of
/// the bolt.
std::string key_feature(const Element& element, const Fastener& fastener);

/// The pose of a T-nut or T-bolt with its foot along the slot and drawn up under the throat, on the
/// screw's axis through `axis_W`.
Pose pose_in_slot(Session& session, const Fastener& fastener, const PlacedFeature& slot,
                  const Eigen::Vector3d& axis_W);

}  // namespace dowel
