// Where an element can go in a whole project, and the mates that parts already stand in.

#include <algorithm>
#include <cmath>

#include "dowel/assembly/pattern.h"
#include "dowel/assembly/snap.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "snap_fit.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

bool is_same_place(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() <= kCoaxial_mm &&
         a.rotation().angularDistance(b.rotation()) <= kCoaxial_rad;
}

Mate mate_of(MateKind kind, const std::string& moving_feature, const FeatureName& fixed) {
  Mate mate;
  mate.kind = kind;
  mate.moving.feature = moving_feature;
  mate.fixed = fixed;
  return mate;
}

/// Its shafts in holes of placed parts.
std::vector<SnapOffer> places_by_shafts(Session& session, const Element& element) {
  std::vector<SnapOffer> offers;
  for (const Instance* placed : session.state().in_order()) {
    FeatureIndex index;
    index.add(placed->name, session.element(placed->element), placed->X_WI);
    for (const Feature& shaft : element.features) {
      if (shaft.kind != FeatureKind::Shaft) continue;
      for (const std::size_t i : index.anywhere(shaft)) {
        const FeatureIndex::Entry& entry = index.entries()[i];
        if (entry.feature->kind != FeatureKind::Hole) continue;
        SnapOffer offer;
        offer.match = *match_of(shaft, *entry.feature);
        const auto place = fitted_place({&shaft, entry.X_WI}, {entry.feature, entry.X_WI});
        if (!place) continue;
        offer.X_WI = place->placement.X_WA;
        offer.mates.push_back(
            mate_of(MateKind::ShaftInHole, shaft.name, {placed->name, entry.feature->name}));
        offer.mates.back().offset_mm = place->offset_mm;
        offer.mates.back().thread = offer.match == FeatureMatch::Thread;
        offers.push_back(std::move(offer));
      }
    }
  }
  return offers;
}

/// All holes that it stands on, on holes of placed parts that they go with.
std::vector<SnapOffer> places_by_feet(Session& session, const Element& element) {
  std::vector<SnapOffer> offers;
  for (const Instance* placed : session.state().in_order()) {
    const Element& part = session.element(placed->element);
    for (const Feature& hole : part.features) {
      if (hole.kind != FeatureKind::Hole) continue;
      for (const PatternWay& way : pattern_ways(element, part, hole)) {
        const bool goes = std::ranges::all_of(way.pairs, [&](const FeaturePair& pair) {
          return match_of(*element.find_feature(pair.moving), *part.find_feature(pair.fixed))
              .has_value();
        });
        if (!goes) continue;
        SnapOffer offer;
        offer.match = FeatureMatch::Bore;
        offer.X_WI = placed->X_WI * way.X_BE;
        offer.turn_rad = way.turn_rad;
        // The pattern begun at another of its holes.
        const bool is_known = std::ranges::any_of(
            offers, [&](const SnapOffer& other) { return is_same_place(other.X_WI, offer.X_WI); });
        if (is_known) continue;
        const FeaturePair& first = way.pairs.front();
        offer.mates.push_back(
            mate_of(mate_kind(*element.find_feature(first.moving), *part.find_feature(first.fixed)),
                    first.moving, {placed->name, first.fixed}));
        offers.push_back(std::move(offer));
      }
    }
  }
  return offers;
}

/// As a key in the slots of placed parts, in the middle of each.
std::vector<SnapOffer> places_by_key(Session& session, const Element& element) {
  std::vector<SnapOffer> offers;
  for (const Instance* placed : session.state().in_order()) {
    for (const Feature& slot : session.element(placed->element).features) {
      if (slot.kind != FeatureKind::Slot) continue;
      for (const Feature& feature : element.features) {
        MateFeatures key;
        key.kind = MateKind::KeyInSlot;
        key.moving_element = &element;
        key.moving = &feature;
        key.fixed = &slot;
        SnapOffer offer;
        try {
          const Pose X_BA = Pose::from_translation(slot.origin - feature.origin);
          const Joint joint = mate_joints(key, X_BA).front();
          offer.X_WI = placed->X_WI * place_by_joint(joint, X_BA, Pose());
        } catch (const Error&) {
          continue;  // no key
        }
        offer.match = FeatureMatch::Fit;
        offer.mates.push_back(
            mate_of(MateKind::KeyInSlot, feature.name, {placed->name, slot.name}));
        offers.push_back(std::move(offer));
      }
    }
  }
  return offers;
}

bool has(const Element& element, FeatureKind kind) {
  return std::ranges::any_of(element.features,
                             [=](const Feature& feature) { return feature.kind == kind; });
}

/// Two faces in one plane that look at each other and overlap as seen by their sizes.
bool is_seated(const Feature& moving, const Pose& X_BA, const Feature& fixed) {
  if (moving.kind != FeatureKind::Face || fixed.kind != FeatureKind::Face) return false;
  const Vector3d normal = X_BA.rotation() * moving.direction;
  if ((normal + fixed.direction).norm() > kCoaxial_rad) return false;
  const Vector3d off = X_BA * moving.origin - fixed.origin;
  if (std::abs(off.dot(fixed.direction)) > kCoaxial_mm) return false;
  const double apart_mm = (off - off.dot(fixed.direction) * fixed.direction).norm();
  return apart_mm <= 0.5 * (std::sqrt(moving.area_mm2) + std::sqrt(fixed.area_mm2));
}

/// On one axis, fitting, wherever along it.
bool is_aligned(const Feature& moving, const Pose& X_BA, const Feature& fixed) {
  using enum FeatureKind;
  const bool is_pair = (moving.kind == Shaft && fixed.kind == Hole) ||
                       (moving.kind == Hole && (fixed.kind == Hole || fixed.kind == Shaft));
  if (!is_pair || !match_of(moving, fixed)) return false;
  const Vector3d direction = X_BA.rotation() * moving.direction;
  if (direction.cross(fixed.direction).norm() > kCoaxial_rad) return false;
  const Vector3d off = X_BA * moving.origin - fixed.origin;
  if ((off - off.dot(fixed.direction) * fixed.direction).norm() > kCoaxial_mm) return false;
  // They reach each other.
  const double start_mm = off.dot(fixed.direction);
  const double end_mm = start_mm + direction.dot(fixed.direction) * moving.depth_mm;
  return std::min(start_mm, end_mm) <= fixed.depth_mm + kCoaxial_mm &&
         std::max(start_mm, end_mm) >= -kCoaxial_mm;
}

}  // namespace

std::vector<SnapOffer> places_for(Session& session, std::string_view element_name) {
  const Element element = session.element(element_name);
  std::vector<SnapOffer> offers;
  if (has(element, FeatureKind::Shaft)) offers = places_by_shafts(session, element);
  if (offers.empty()) offers = places_by_feet(session, element);
  if (offers.empty()) offers = places_by_key(session, element);
  std::vector<SnapOffer> free;
  for (SnapOffer& offer : offers) {
    const Placement placement{element.name, {}, offer.X_WI, {}};
    const MoveReport there = session.place_all({&placement, 1}, std::nullopt).front();
    offer.verdict = there.verdict;
    if (there.verdict != Verdict::Interference) free.push_back(std::move(offer));
  }
  std::ranges::stable_sort(free, {}, &SnapOffer::match);
  return free;
}

std::vector<Mate> recognise_mates(Session& session) {
  std::vector<Mate> found;
  const std::vector<const Instance*> placed = session.state().in_order();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Element& moving_element = session.element(placed[i]->element);
    for (std::size_t j = 0; j < i; ++j) {
      const Element& fixed_element = session.element(placed[j]->element);
      const Pose X_BA = placed[j]->X_WI.inverse() * placed[i]->X_WI;
      for (const Feature& moving : moving_element.features) {
        for (const Feature& fixed : fixed_element.features) {
          Mate mate;
          mate.moving = {placed[i]->name, moving.name};
          mate.fixed = {placed[j]->name, fixed.name};
          if (is_seated(moving, X_BA, fixed)) {
            mate.kind = MateKind::FaceOnFace;
          } else if (is_aligned(moving, X_BA, fixed)) {
            mate.kind = MateKind::Align;
            mate.flip = (X_BA.rotation() * moving.direction).dot(fixed.direction) < 0.0;
            mate.thread = match_of(moving, fixed) == FeatureMatch::Thread;
          } else {
            continue;
          }
          const bool is_made = std::ranges::any_of(session.state().mates, [&](const auto& entry) {
            return entry.second.moving == mate.moving && entry.second.fixed == mate.fixed;
          });
          if (!is_made) found.push_back(std::move(mate));
        }
      }
    }
  }
  return found;
}

}  // namespace dowel
