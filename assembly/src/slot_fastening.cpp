#include "slot_fastening.h"

#include <algorithm>
#include <cmath>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Depth at which the axis leaves the last part where its bore ends in a slot of its foot, as those
/// for keys do.
double past_key_slot(Session& session, const Eigen::Vector3d& start_W,
                     const Eigen::Vector3d& direction_W, double reached_mm) {
  for (const Instance* instance : session.state().in_order()) {
    for (const Feature& slot : session.element(instance->element).features) {
      if (slot.kind != FeatureKind::Slot || !slot.slot) continue;
      const PlacedFeature placed{&slot, instance->X_WI};
      if ((placed.direction_W() + direction_W).norm() > kCoaxial_rad) continue;
      const Eigen::Vector3d off_W = placed.origin_W() - start_W;
      const double mouth_mm = off_W.dot(direction_W);
      const Eigen::Vector3d run_W = instance->X_WI.rotation() * slot.slot->run;
      const Eigen::Vector3d beside_W = off_W - mouth_mm * direction_W;
      const double along_mm = run_W.dot(beside_W);
      if (std::abs(mouth_mm - slot.depth_mm - reached_mm) <= kOpenJoint_mm &&
          (beside_W - along_mm * run_W).norm() <= 0.5 * slot.diameter_mm &&
          std::abs(along_mm) <= 0.5 * slot.slot->length_mm) {
        return mouth_mm;
      }
    }
  }
  return reached_mm;
}

}  // namespace

std::optional<SlotBelow> slot_below(Session& session, const Eigen::Vector3d& start_W,
                                    const Eigen::Vector3d& direction_W, double reached_mm) {
  const double end_mm = past_key_slot(session, start_W, direction_W, reached_mm);
  for (const Instance* instance : session.state().in_order()) {
    for (const Feature& slot : session.element(instance->element).features) {
      if (slot.kind != FeatureKind::Slot || !slot.slot || slot.slot->type != SlotShape::Type::Tee) {
        continue;
      }
      const PlacedFeature placed{&slot, instance->X_WI};
      if ((placed.direction_W() - direction_W).norm() > kCoaxial_rad) continue;
      const Eigen::Vector3d off_W = placed.origin_W() - start_W;
      const double mouth_mm = off_W.dot(direction_W);
      const Eigen::Vector3d run_W = instance->X_WI.rotation() * slot.slot->run;
      const Eigen::Vector3d beside_W = off_W - mouth_mm * direction_W;
      const double along_mm = run_W.dot(beside_W);
      if (std::abs(mouth_mm - end_mm) > kOpenJoint_mm ||
          (beside_W - along_mm * run_W).norm() > kCoaxial_mm ||
          std::abs(along_mm) > 0.5 * slot.slot->length_mm) {
        continue;
      }
      return SlotBelow{{instance->name, slot.name}, placed, mouth_mm};
    }
  }
  return std::nullopt;
}

namespace {

/// Whether the foot goes into the undercut and the neck into the throat, and one of them keeps it
/// from turning.
bool goes_into(const Fastener& fastener, const SlotShape& slot) {
  return fastener.foot_width_mm <= slot.undercut_width_mm &&
         fastener.foot_height_mm <= slot.undercut_height_mm &&
         fastener.neck_height_mm <= slot.throat_depth_mm &&
         (fastener.neck_height_mm > kCoincident_mm ||
          fastener.foot_diagonal_mm > slot.undercut_width_mm);
}

/// The direction of the element that lies along a slot: of its neck, else of its foot.
Eigen::Vector3d run_of(const Element& element, const Fastener& fastener,
                       const PlacedFeature& slot) {
  MateFeatures key;
  key.kind = MateKind::KeyInSlot;
  key.moving_element = &element;
  key.moving = element.find_feature(key_feature(element, fastener));
  key.fixed = slot.feature;
  return mate_joints(key, Pose()).front().X_AF.rotation() * Eigen::Vector3d::UnitX();
}

}  // namespace

FasteningChoices choose_tee_nut(const Bore& bore, const SlotBelow& below,
                                std::span<const Fastener> fasteners,
                                const FasteningOptions& options) {
  const SlotShape& shape = *below.slot.feature->slot;
  FasteningChoices all;
  for (const Fastener& nut : fasteners) {
    if (nut.kind != Fastener::Kind::TeeNut || !goes_into(nut, shape)) continue;
    std::vector<BoreStretch> stretches = bore.stretches;
    const double top_mm = below.shoulder_mm() - nut.neck_height_mm;
    stretches.push_back({top_mm, below.mouth_mm + below.slot.feature->depth_mm,
                         nut.hole_diameter_mm, bore.holes.size()});
    std::vector<Fastener> fitting(fasteners.begin(), fasteners.end());
    std::erase_if(fitting, [&](const Fastener& other) {
      return other.kind == Fastener::Kind::Screw && other.nominal_mm != nut.nominal_mm;
    });
    FasteningOptions in_nut = options;
    in_nut.engagement_in_diameters = std::min(kTeeNutEngagement, nut.length_mm / nut.nominal_mm);
    FasteningChoices choices = choose_fastening(stretches, fitting, in_nut);
    for (Fastening& way : choices.ways) {
      if (way.nut || way.thread != bore.holes.size()) continue;
      way.tee_nut = nut;
      way.engagement_mm = std::min(way.engagement_mm, nut.length_mm);
      all.ways.push_back(std::move(way));
    }
    if (!choices.reason.empty()) {
      all.reason += (all.reason.empty() ? "" : "; ") + nut.element + ": " + choices.reason;
    }
  }
  // The thickest screw first: it is what the slot was made for.
  std::ranges::stable_sort(all.ways, [](const Fastening& a, const Fastening& b) {
    if (a.screw.nominal_mm != b.screw.nominal_mm) return a.screw.nominal_mm > b.screw.nominal_mm;
    return a.screw.length_mm < b.screw.length_mm;
  });
  if (all.ways.empty() && all.reason.empty())
    all.reason = "no T-nut fits slot " + below.name.text();
  return all;
}

FasteningChoices choose_bolt_in_slot(const Bore& bore, const SlotBelow& below,
                                     std::span<const Fastener> fasteners, double mouth_mm) {
  std::vector<Fastener> fitting(fasteners.begin(), fasteners.end());
  std::erase_if(fitting, [&](const Fastener& other) {
    return other.kind == Fastener::Kind::TeeBolt && !goes_into(other, *below.slot.feature->slot);
  });
  if (std::ranges::find(fitting, Fastener::Kind::TeeBolt, &Fastener::kind) == fitting.end()) {
    return {{}, "no T-bolt fits slot " + below.name.text()};
  }
  FasteningChoices choices =
      choose_tee_bolt(bore.stretches, fitting, below.shoulder_mm(), mouth_mm);
  for (Fastening& way : choices.ways) way.thread = bore.holes.size();
  return choices;
}

std::string key_feature(const Element& element, const Fastener& fastener) {
  if (fastener.kind != Fastener::Kind::TeeBolt) return fastener.feature;
  const Feature& shaft = *element.find_feature(fastener.feature);
  const Feature* bottom = nullptr;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face ||
        face.direction.dot(shaft.direction) > kCoaxial_rad - 1.0) {
      continue;
    }
    if (bottom == nullptr || face.direction.dot(face.origin - bottom->origin) > 0.0) bottom = &face;
  }
  DOWEL_EXPECTS(bottom != nullptr);  // its foot was measured by it
  return bottom->name;
}

Pose pose_in_slot(Session& session, const Fastener& fastener, const PlacedFeature& slot,
                  const Eigen::Vector3d& axis_W) {
  const Element& element = session.element(fastener.element);
  const Feature& axis = *element.find_feature(fastener.feature);
  const Eigen::Vector3d into_W = slot.direction_W();
  const Feature& key = *element.find_feature(key_feature(element, fastener));
  const Pose X_EF = frame_on_axis(axis.origin, key.direction, run_of(element, fastener, slot));
  const Eigen::Vector3d run_W = slot.X_WI.rotation() * slot.feature->slot->run;
  const double depth_mm = into_W.dot(slot.origin_W() - axis_W) +
                          slot.feature->slot->throat_depth_mm - fastener.neck_height_mm;
  return frame_on_axis(axis_W + depth_mm * into_W, into_W, run_W) * X_EF.inverse();
}

}  // namespace dowel
