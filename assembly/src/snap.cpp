#include "dowel/assembly/snap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "dowel/assembly/pattern.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "snap_fit.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// What a looser match counts, as a way: a bore of the right size is taken over a wider one that is
/// up to this much nearer.
double looseness_mm(FeatureMatch match) {
  switch (match) {
    case FeatureMatch::Thread:
    case FeatureMatch::Fit:
      return 0.0;
    case FeatureMatch::Clearance:
    case FeatureMatch::Bore:
      return 2.0;
    case FeatureMatch::Seat:
      return 10.0;
  }
  return 0.0;
}

double cost_mm(const SnapOffer& offer) {
  return offer.travel_mm + kMateArm_mm * offer.turn_rad + looseness_mm(offer.match) -
         (offer.mates.size() > 1 ? 1.0 : 0.0);
}

std::optional<double> clearance_mm(const Feature& moving, const Feature& fixed) {
  using enum FeatureKind;
  const bool shaft_moves = moving.kind == Shaft && fixed.kind == Hole;
  if (!shaft_moves && !(moving.kind == Hole && fixed.kind == Shaft)) return std::nullopt;
  const Feature& shaft = shaft_moves ? moving : fixed;
  const Feature& hole = shaft_moves ? fixed : moving;
  double most_mm = 0.0;
  for (const HoleSegment& segment : hole.segments) {
    if (segment.type == HoleSegment::Type::Cylinder) {
      most_mm = std::max(most_mm, segment.diameter_mm);
    }
  }
  // The tightest stretch that it goes into.
  for (const HoleSegment& segment : hole.segments) {
    if (segment.type == HoleSegment::Type::Cylinder &&
        segment.diameter_mm + kShaftExcess_mm >= shaft.diameter_mm) {
      most_mm = std::min(most_mm, segment.diameter_mm);
    }
  }
  return most_mm - shaft.diameter_mm;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

/// A part that looks for a place among others.
struct Seeker {
  std::string name;  ///< of its instance; mates carry it
  const Element* element = nullptr;
  Pose X_WI;
};

/// Two faces meet where their middles, seen along the normal, are no further apart than they are
/// large: as squares of their areas.
bool faces_meet(const Feature& moving, const Pose& X_WI, const Feature& fixed, const Pose& X_WF) {
  const Vector3d normal_W = X_WF.rotation() * fixed.direction;
  const Vector3d off_W = X_WI * moving.origin - X_WF * fixed.origin;
  const double apart_mm = (off_W - off_W.dot(normal_W) * normal_W).norm();
  return apart_mm <= 0.5 * (std::sqrt(moving.area_mm2) + std::sqrt(fixed.area_mm2));
}

/// The offer of one pair of features; nothing where the part is too far from it or does not fit.
std::optional<SnapOffer> offer_of(const Seeker& part, const Feature& moving,
                                  const FeatureIndex::Entry& entry, const SnapReach& reach) {
  const auto match = match_of(moving, *entry.feature);
  if (!match) return std::nullopt;
  const PlacedFeature moving_W{&moving, part.X_WI};
  const PlacedFeature fixed_W{entry.feature, entry.X_WI};
  const auto place = fitted_place(moving_W, fixed_W);
  if (!place) return std::nullopt;
  SnapOffer offer;
  offer.match = *match;
  offer.X_WI = place->placement.X_WA;
  offer.turn_rad = angle_between(part.X_WI.rotation(), offer.X_WI.rotation());
  const Vector3d center = part.element->obb.center;
  offer.travel_mm = (offer.X_WI * center - part.X_WI * center).norm();
  if (offer.turn_rad > reach.reach_rad || offer.travel_mm > 2.0 * reach.reach_mm) {
    return std::nullopt;
  }
  if (*match == FeatureMatch::Seat && !faces_meet(moving, offer.X_WI, *entry.feature, entry.X_WI)) {
    return std::nullopt;
  }
  Mate mate;
  mate.kind = place->placement.kind;
  mate.offset_mm = place->offset_mm;
  mate.moving = {part.name, moving.name};
  mate.fixed = {entry.instance, entry.feature->name};
  mate.thread = *match == FeatureMatch::Thread;
  offer.mates.push_back(std::move(mate));
  offer.clearance_mm = clearance_mm(moving, *entry.feature);
  return offer;
}

/// Where a feature can meet its match: a through hole at either end.
std::vector<Vector3d> ends_of(const Feature& feature) {
  std::vector<Vector3d> ends{feature.origin};
  if (feature.kind == FeatureKind::Hole && feature.through) {
    ends.emplace_back(feature.origin + feature.depth_mm * feature.direction);
  }
  return ends;
}

/// What `near(end in the world)` finds at any end of the feature; ascending.
template <class Near>
std::vector<std::size_t> near_ends(const Feature& feature, const Pose& X_WI, Near&& near) {
  std::vector<std::size_t> found;
  for (const Vector3d& end : ends_of(feature)) {
    const std::vector<std::size_t> there = near(Vector3d(X_WI * end));
    found.insert(found.end(), there.begin(), there.end());
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Turns the part of `offer` about its first mate's axis so that a second of its holes or shafts
/// goes with one of the same placed part: the farthest one that can.
void turn_onto_second(SnapOffer& offer, const Seeker& part, const FeatureIndex& index,
                      const SnapReach& reach) {
  const Mate& first_mate = offer.mates.front();
  const Feature& first = *part.element->find_feature(first_mate.moving.feature);
  if (first.kind == FeatureKind::Face) return;
  const Vector3d pivot_W = offer.X_WI * first.origin;
  const Vector3d axis_W = (offer.X_WI.rotation() * first.direction).normalized();
  const auto arm = [&](const Vector3d& point_W) {
    const Vector3d off_W = point_W - pivot_W;
    return Vector3d(off_W - off_W.dot(axis_W) * axis_W);
  };
  double longest_mm = kCoaxial_mm;
  SnapOffer best = offer;
  for (const Feature& second : part.element->features) {
    if (second.kind != FeatureKind::Hole && second.kind != FeatureKind::Shaft) continue;
    if (second.direction.cross(first.direction).norm() > kCoaxial_rad) continue;
    const Vector3d arm_W = arm(offer.X_WI * second.origin);
    if (arm_W.norm() <= longest_mm) continue;
    const auto near = [&, &feature = second](const Vector3d& end_W) {
      return index.near(feature, end_W, reach.reach_mm);
    };
    for (const std::size_t i : near_ends(second, offer.X_WI, near)) {
      const FeatureIndex::Entry& entry = index.entries()[i];
      if (entry.instance != first_mate.fixed.instance) continue;
      const Vector3d goal_W = arm(entry.X_WI * entry.feature->origin);
      if (std::abs(goal_W.norm() - arm_W.norm()) > kCoaxial_mm) continue;
      const double turn_rad = std::atan2(axis_W.dot(arm_W.cross(goal_W)), arm_W.dot(goal_W));
      const Pose X_WI = Pose::about_axis(pivot_W, axis_W, turn_rad) * offer.X_WI;
      MateFeatures align;
      align.kind = MateKind::Align;
      align.moving = &second;
      align.fixed = entry.feature;
      const Pose X_BA = entry.X_WI.inverse() * X_WI;
      Mate mate;
      mate.kind = MateKind::Align;
      mate.moving = {part.name, second.name};
      mate.fixed = {entry.instance, entry.feature->name};
      mate.flip = nearest_flip(align, X_BA);
      align.flip = mate.flip;
      const MateResidual off = mate_residual(mate_joints(align, X_BA), X_BA, Pose(), Pose());
      if (off.axis_mm > kCoaxial_mm || off.angle_rad > kCoaxial_rad) continue;
      longest_mm = arm_W.norm();
      best = offer;
      best.X_WI = X_WI;
      best.turn_rad = angle_between(part.X_WI.rotation(), X_WI.rotation());
      best.mates.push_back(std::move(mate));
    }
  }
  offer = std::move(best);
}

/// Of offers at one place only the first stays: they are the same pattern, begun elsewhere.
void keep_places(std::vector<SnapOffer>& offers) {
  std::vector<SnapOffer> kept;
  for (SnapOffer& offer : offers) {
    const bool is_known = std::ranges::any_of(kept, [&](const SnapOffer& other) {
      return (other.X_WI.translation() - offer.X_WI.translation()).norm() <= kCoaxial_mm &&
             angle_between(other.X_WI.rotation(), offer.X_WI.rotation()) <= kCoaxial_rad;
    });
    if (!is_known) kept.push_back(std::move(offer));
  }
  offers = std::move(kept);
}

void sort_by_cost(std::vector<SnapOffer>& offers) {
  // In steps of a nanometre, so that rounding does not settle who is first of equals.
  const auto steps = [](double length_mm) {
    return std::llround(length_mm * kFeatureSteps_per_mm);
  };
  std::ranges::stable_sort(offers, {}, [&](const SnapOffer& offer) {
    return std::pair(steps(cost_mm(offer)), offer.match);
  });
}

/// An index of all instances but those of `without`.
FeatureIndex index_of(Session& session, const std::set<std::string>& without) {
  FeatureIndex index;
  for (const Instance* placed : session.state().in_order()) {
    if (without.contains(placed->name)) continue;
    index.add(placed->name, session.element(placed->element), placed->X_WI);
  }
  return index;
}

/// The part as a key in a slot, by its first hole, shaft or bottom face that has a key around it.
void add_slots(std::vector<SnapOffer>& offers, const Seeker& part, const FeatureIndex& index,
               const SnapReach& reach) {
  const Vector3d center_W = part.X_WI * part.element->obb.center;
  for (std::size_t i = 0; i < index.entries().size(); ++i) {
    const FeatureIndex::Entry& entry = index.entries()[i];
    if (entry.feature->kind != FeatureKind::Slot) continue;
    std::optional<SnapOffer> best;
    for (const Feature& feature : part.element->features) {
      MateFeatures key;
      key.kind = MateKind::KeyInSlot;
      key.moving_element = part.element;
      key.moving = &feature;
      key.fixed = entry.feature;
      const Pose X_BA = entry.X_WI.inverse() * part.X_WI;
      SnapOffer offer;
      Mate mate;
      try {
        key.flip = mate.flip = nearest_flip(key, X_BA);
        offer.X_WI = place_by_joint(mate_joints(key, X_BA).front(), part.X_WI, entry.X_WI);
      } catch (const Error&) {
        continue;  // no key
      }
      offer.match = FeatureMatch::Fit;
      offer.turn_rad = angle_between(part.X_WI.rotation(), offer.X_WI.rotation());
      offer.travel_mm = (offer.X_WI * part.element->obb.center - center_W).norm();
      if (offer.turn_rad > reach.reach_rad || offer.travel_mm > reach.reach_mm) continue;
      mate.kind = MateKind::KeyInSlot;
      mate.moving = {part.name, feature.name};
      mate.fixed = {entry.instance, entry.feature->name};
      offer.mates.push_back(std::move(mate));
      // A face settles the height, too.
      const bool is_better =
          !best || (feature.kind == FeatureKind::Face && best->travel_mm > offer.travel_mm);
      if (is_better) best = std::move(offer);
    }
    if (best) offers.push_back(std::move(*best));
  }
}

template <class Near>
std::vector<SnapOffer> offers_by(const Seeker& part, const FeatureIndex& index,
                                 const SnapReach& reach, Near&& near) {
  std::vector<SnapOffer> offers;
  for (const Feature& moving : part.element->features) {
    for (const std::size_t i : near(moving)) {
      if (auto offer = offer_of(part, moving, index.entries()[i], reach)) {
        turn_onto_second(*offer, part, index, reach);
        offers.push_back(std::move(*offer));
      }
    }
  }
  add_slots(offers, part, index, reach);
  sort_by_cost(offers);
  keep_places(offers);
  return offers;
}

Seeker seeker_of(Session& session, std::string_view instance) {
  const Instance& placed = session.instance(instance);
  return {placed.name, &session.element(placed.element), placed.X_WI};
}

FeatureIndex index_around(Session& session, const std::string& name) {
  const std::vector<std::string> own = session.sub_assembly(name);
  return index_of(session, {own.begin(), own.end()});
}

}  // namespace

std::vector<SnapOffer> snap_offers(Session& session, std::string_view instance,
                                   const SnapReach& reach) {
  const Seeker part = seeker_of(session, instance);
  const FeatureIndex index = index_around(session, part.name);
  return offers_by(part, index, reach, [&](const Feature& moving) {
    return near_ends(moving, part.X_WI, [&](const Vector3d& end_W) {
      return index.near(moving, end_W, reach.reach_mm);
    });
  });
}

std::vector<SnapOffer> snap_offers_brute_force(Session& session, std::string_view instance,
                                               const SnapReach& reach) {
  const Seeker part = seeker_of(session, instance);
  const FeatureIndex index = index_around(session, part.name);
  return offers_by(part, index, reach, [&](const Feature& moving) {
    return near_ends(moving, part.X_WI, [&](const Vector3d& end_W) {
      return index.near_brute_force(moving, end_W, reach.reach_mm);
    });
  });
}

}  // namespace dowel
