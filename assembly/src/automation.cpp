#include "dowel/assembly/automation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "dowel/assembly/names.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "project_rows.h"

namespace dowel {
namespace {

/// Parts farther apart than this along an axis are not fastened together.
constexpr double kOpenJoint_mm = 0.1;

/// Ways that are offered.
constexpr std::size_t kMostWays = 4;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidInput, message);
}

/// Elements whose names give them one of the roles: of `family` where it has any, else all.
std::vector<std::string> elements_for(Session& session, const std::set<std::string>& roles,
                                      const std::string& family) {
  std::vector<std::string> all;
  std::vector<std::string> related;
  for (const std::string& name : session.element_names()) {
    if (!roles.contains(role_of(name))) continue;
    all.push_back(name);
    const std::size_t slash = name.rfind('/');
    if (slash != std::string::npos && name.substr(0, slash) == family) related.push_back(name);
  }
  return related.empty() ? all : related;
}

std::string family_of(Session& session, const std::string& instance) {
  const std::string& element = session.instance(instance).element;
  const std::size_t slash = element.rfind('/');
  return slash == std::string::npos ? std::string() : element.substr(0, slash);
}

/// Names for new instances of `elements`, all different.
std::vector<std::string> new_names(Session& session, const std::vector<std::string>& elements) {
  std::vector<std::string> names;
  names.reserve(elements.size());
  for (const std::string& element : elements) {
    names.push_back(free_name(element, [&](const std::string& name) {
      return session.state().find(name) != nullptr || std::ranges::count(names, name) > 0;
    }));
  }
  return names;
}

const PlacedFeature& expect_hole(const PlacedFeature& feature, const FeatureName& name) {
  if (feature.feature->kind == FeatureKind::Hole) return feature;
  refuse(name.text() + " is a " + std::string(to_string(feature.feature->kind)) +
         ", expected a hole");
}

/// A placement by one mate, and its pose.
Placement placed_by_mate(Session& session, const std::string& element, const std::string& name,
                         const std::string& feature, const FeatureName& fixed_name,
                         const PlacedFeature& fixed, double offset_mm) {
  const Feature* moving = session.element(element).find_feature(feature);
  DOWEL_EXPECTS(moving != nullptr);
  const MatePlacement to =
      place_by_mate({moving, fixed.X_WI}, fixed, std::nullopt, {.offset_mm = offset_mm});
  Mate mate;
  mate.kind = to.kind;
  mate.moving = {name, feature};
  mate.fixed = fixed_name;
  mate.offset_mm = offset_mm;
  return {element, name, to.X_WA, {mate}};
}

/// How deep the counterbore of a hole is, and how wide; 0 where it has none.
std::pair<double, double> counterbore(const Feature& hole) {
  const HoleSegment* first = nullptr;
  for (const HoleSegment& segment : hole.segments) {
    if (segment.type != HoleSegment::Type::Cylinder) continue;
    if (first != nullptr && segment.diameter_mm < first->diameter_mm - kCoincident_mm) {
      return {segment.from_mm, first->diameter_mm};
    }
    first = &segment;
  }
  return {0.0, 0.0};
}

/// The holes of all instances on one axis, as far as the parts follow each other.
struct Bore {
  std::vector<BoreStretch> stretches;
  std::vector<FeatureName> holes;
  double reached_mm = 0.0;  ///< depth at which the last part ends
};

/// A stretch of any hole on the axis; cones only tell that parts follow each other.
struct AxisStretch {
  BoreStretch bore;
  bool is_cone = false;
};

Bore bore_along(Session& session, const Eigen::Vector3d& start_W,
                const Eigen::Vector3d& direction_W) {
  Bore bore;
  std::vector<AxisStretch> stretches;
  for (const Instance* instance : session.state().in_order()) {
    for (const Feature& hole : session.element(instance->element).features) {
      if (hole.kind != FeatureKind::Hole) continue;
      const PlacedFeature placed{&hole, instance->X_WI};
      const Eigen::Vector3d off = placed.origin_W() - start_W;
      if (placed.direction_W().cross(direction_W).norm() > kCoaxial_rad ||
          off.cross(direction_W).norm() > kCoaxial_mm) {
        continue;
      }
      const double sense = placed.direction_W().dot(direction_W);
      for (const HoleSegment& segment : hole.segments) {
        const auto [from_mm, to_mm] = std::minmax({off.dot(direction_W) + sense * segment.from_mm,
                                                   off.dot(direction_W) + sense * segment.to_mm});
        if (to_mm <= kCoincident_mm) continue;
        stretches.push_back({{from_mm, to_mm, segment.diameter_mm, bore.holes.size()},
                             segment.type == HoleSegment::Type::Cone});
      }
      bore.holes.push_back({instance->name, hole.name});
    }
  }
  std::ranges::stable_sort(stretches, {}, [](const AxisStretch& s) { return s.bore.from_mm; });
  double reached_mm = 0.0;
  for (const AxisStretch& stretch : stretches) {
    if (stretch.bore.from_mm > reached_mm + kOpenJoint_mm) break;
    reached_mm = std::max(reached_mm, stretch.bore.to_mm);
    if (!stretch.is_cone) bore.stretches.push_back(stretch.bore);
  }
  bore.reached_mm = reached_mm;
  return bore;
}

std::vector<Fastener> fasteners_for(Session& session, const std::string& instance) {
  std::vector<Fastener> fasteners;
  // T-nuts apart: a slot system has its own, and screws of any other.
  for (const std::set<std::string>& roles :
       {std::set<std::string>{"SCREW", "WASHER", "NUT"}, std::set<std::string>{"TEE"}}) {
    for (const std::string& name : elements_for(session, roles, family_of(session, instance))) {
      if (const auto fastener = fastener_of(session.element(name))) fasteners.push_back(*fastener);
    }
  }
  return fasteners;
}

}  // namespace

namespace {

/// A T-slot below a bore.
struct SlotBelow {
  FeatureName name;
  PlacedFeature slot;
  double mouth_mm = 0.0;  ///< its depth along the bore
};

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

/// The slot whose mouth the axis meets where the last part ends, in its middle.
std::optional<SlotBelow> slot_below(Session& session, const Eigen::Vector3d& start_W,
                                    const Eigen::Vector3d& direction_W, double reached_mm) {
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
      if (std::abs(mouth_mm - reached_mm) > kOpenJoint_mm ||
          (beside_W - along_mm * run_W).norm() > kCoaxial_mm ||
          std::abs(along_mm) > 0.5 * slot.slot->length_mm) {
        continue;
      }
      return SlotBelow{{instance->name, slot.name}, placed, mouth_mm};
    }
  }
  return std::nullopt;
}

/// Full threads in a T-nut, in diameters: it is heat-treated (DIN 508), where a part need not be.
constexpr double kTeeNutEngagement = 0.9;

/// Ways with each T-nut that fits the slot; the screw may look out of it, short of the slot's
/// floor; their thread is the hole behind the last of the bore.
FasteningChoices choose_in_slot(const Bore& bore, const SlotBelow& below,
                                std::span<const Fastener> fasteners,
                                const FasteningOptions& options) {
  const SlotShape& shape = *below.slot.feature->slot;
  FasteningChoices all;
  for (const Fastener& nut : fasteners) {
    // Without a neck nothing keeps it from turning in the slot.
    const bool has_neck = nut.foot_height_mm < nut.length_mm - kCoincident_mm;
    if (nut.kind != Fastener::Kind::TeeNut || !has_neck ||
        nut.foot_width_mm > shape.undercut_width_mm ||
        nut.foot_height_mm > shape.undercut_height_mm ||
        nut.length_mm - nut.foot_height_mm > shape.throat_depth_mm) {
      continue;
    }
    const double shoulder_mm = below.mouth_mm + shape.throat_depth_mm;
    std::vector<BoreStretch> stretches = bore.stretches;
    const double top_mm = shoulder_mm - (nut.length_mm - nut.foot_height_mm);
    stretches.push_back({top_mm, below.mouth_mm + below.slot.feature->depth_mm,
                         nut.core_diameter_mm, bore.holes.size()});
    std::vector<Fastener> fitting(fasteners.begin(), fasteners.end());
    std::erase_if(fitting, [&](const Fastener& other) {
      return other.kind == Fastener::Kind::Screw && other.nominal_mm != nut.nominal_mm;
    });
    FasteningOptions in_nut = options;
    in_nut.engagement_in_diameters = kTeeNutEngagement;
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
  if (all.ways.empty() && all.reason.empty()) all.reason = "no T-nut with a neck fits the slot";
  return all;
}

/// A T-nut in its slot, its hole on the screw's axis and its foot drawn up under the throat.
Placement placed_tee_nut(Session& session, const Fastener& nut, const std::string& name,
                         const FeatureName& slot_name, const Eigen::Vector3d& axis_W) {
  const PlacedFeature slot = session.feature(slot_name);
  const Element& element = session.element(nut.element);
  MateFeatures key;
  key.kind = MateKind::KeyInSlot;
  key.moving_element = &element;
  key.moving = element.find_feature(nut.feature);
  key.fixed = slot.feature;
  const Joint joint = mate_joints(key, Pose()).front();
  // Turned as the key asks, then its hole to where the screw is.
  const Pose X_WN = place_by_joint(joint, slot.X_WI, slot.X_WI);
  const Eigen::Vector3d into_W = slot.direction_W();
  const Eigen::Vector3d off_W = axis_W - X_WN * key.moving->origin;
  const double top_mm = into_W.dot(slot.origin_W() - X_WN * key.moving->origin) +
                        slot.feature->slot->throat_depth_mm - (nut.length_mm - nut.foot_height_mm);
  const Eigen::Vector3d along_W = off_W - into_W.dot(off_W) * into_W;
  Mate mate;
  mate.kind = MateKind::KeyInSlot;
  mate.moving = {name, nut.feature};
  mate.fixed = slot_name;
  return {nut.element,
          name,
          Pose(X_WN.rotation(), X_WN.translation() + along_W + top_mm * into_W),
          {mate}};
}

}  // namespace

StackPlan plan_stack(Session& session, double height_mm, const FeatureName& on) {
  expect_hole(session.feature(on), on);
  std::vector<Spacer> spacers;
  std::string heights;
  for (const std::string& name :
       elements_for(session, {"SPACER"}, family_of(session, on.instance))) {
    const auto spacer = spacer_of(session.element(name));
    if (!spacer) continue;
    heights += (heights.empty() ? "" : ", ") + number_text(spacer->height_mm);
    spacers.push_back(*spacer);
  }
  StackPlan plan{on, height_mm, stack_choices(spacers, height_mm, kMostWays)};
  if (plan.ways.empty()) {
    refuse("no " + std::to_string(kMostStacked) + " spacers or fewer reach " +
           number_text(height_mm) + " mm; there are " +
           (heights.empty() ? "none" : "heights of " + heights + " mm"));
  }
  return plan;
}

std::vector<MoveReport> stack(Session& session, const StackPlan& plan, std::size_t way,
                              std::optional<std::string_view> command) {
  DOWEL_EXPECTS(way < plan.ways.size());
  std::vector<std::string> elements;
  for (const Spacer& spacer : plan.ways[way]) elements.push_back(spacer.element);
  const std::vector<std::string> names = new_names(session, elements);
  std::vector<Placement> placements;
  FeatureName below_name = plan.on;
  PlacedFeature below = session.feature(plan.on);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string& hole = plan.ways[way][i].hole;
    placements.push_back(
        placed_by_mate(session, elements[i], names[i], hole, below_name, below, 0.0));
    below_name = {names[i], hole};
    below = {session.element(elements[i]).find_feature(hole), placements.back().X_WI};
  }
  return session.place_all(placements, command);
}

FasteningPlan plan_fastening(Session& session, const FeatureName& hole) {
  const PlacedFeature at = session.feature(hole);
  expect_hole(at, hole);
  const std::vector<Fastener> all = fasteners_for(session, hole.instance);
  const auto [step_mm, width_mm] = counterbore(*at.feature);
  std::string reason;
  for (const bool in_counterbore : {true, false}) {
    if (in_counterbore && step_mm == 0.0) continue;
    // A head that does not go in stands on the face, if it is wider than the mouth.
    const double mouth_mm = width_mm > 0.0 ? width_mm : at.feature->diameter_mm;
    std::vector<Fastener> fitting = all;
    std::erase_if(fitting, [&, width = width_mm](const Fastener& fastener) {
      if (fastener.kind != Fastener::Kind::Screw) return false;
      return in_counterbore ? fastener.head_diameter_mm > width + kShaftExcess_mm
                            : fastener.head_diameter_mm <= mouth_mm;
    });
    FasteningPlan plan;
    plan.hole = hole;
    plan.seat_mm = in_counterbore ? step_mm : 0.0;
    const Eigen::Vector3d direction_W = at.direction_W().normalized();
    FasteningOptions options;
    options.needs_washer = !in_counterbore;
    const Eigen::Vector3d start_W = at.origin_W() + plan.seat_mm * direction_W;
    Bore bore = bore_along(session, start_W, direction_W);
    const double reached_mm = past_key_slot(session, start_W, direction_W, bore.reached_mm);
    const auto below = slot_below(session, start_W, direction_W, reached_mm);
    FasteningChoices choices = below ? choose_in_slot(bore, *below, fitting, options)
                                     : choose_fastening(bore.stretches, fitting, options);
    if (below) bore.holes.push_back(below->name);
    if (choices.ways.size() > kMostWays) choices.ways.resize(kMostWays);
    plan.holes = std::move(bore.holes);
    plan.ways = std::move(choices.ways);
    if (!plan.ways.empty()) return plan;
    reason += (reason.empty() ? "" : "; ") +
              std::string(in_counterbore ? "in its counterbore " : "on its face ") + choices.reason;
  }
  refuse("nothing fastens " + hole.text() + ": " + reason);
}

std::vector<MoveReport> fasten(Session& session, const FasteningPlan& plan, std::size_t way,
                               std::optional<std::string_view> command) {
  DOWEL_EXPECTS(way < plan.ways.size());
  const Fastening& chosen = plan.ways[way];
  std::vector<std::string> elements{chosen.screw.element};
  if (chosen.washer) elements.push_back(chosen.washer->element);
  if (chosen.nut) elements.push_back(chosen.nut->element);
  if (chosen.tee_nut) elements.push_back(chosen.tee_nut->element);
  const std::vector<std::string> names = new_names(session, elements);
  const PlacedFeature hole = session.feature(plan.hole);
  std::vector<Placement> placements;
  double lift_mm = -plan.seat_mm;
  if (chosen.washer) {
    placements.push_back(placed_by_mate(session, elements[1], names[1], chosen.washer->feature,
                                        plan.hole, hole, lift_mm));
    lift_mm += chosen.washer->length_mm;
  }
  placements.push_back(placed_by_mate(session, elements[0], names[0], chosen.screw.feature,
                                      plan.hole, hole, lift_mm));
  if (chosen.tee_nut) {
    // First, as it is brought in: it slides along its slot.
    placements.insert(placements.begin(),
                      placed_tee_nut(session, *chosen.tee_nut, names.back(),
                                     plan.holes.at(chosen.thread), hole.origin_W()));
  }
  placements.back().mates.front().thread = !chosen.nut && plan.holes.at(chosen.thread) == plan.hole;
  if (chosen.nut) {
    const PlacedFeature shaft{session.element(elements[0]).find_feature(chosen.screw.feature),
                              placements.back().X_WI};
    placements.push_back(placed_by_mate(session, elements.back(), names.back(), chosen.nut->feature,
                                        {names[0], chosen.screw.feature}, shaft, chosen.grip_mm));
    placements.back().mates.front().thread = true;
  }
  return session.place_all(placements, command);
}

}  // namespace dowel
