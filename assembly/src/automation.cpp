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
  return bore;
}

std::vector<Fastener> fasteners_for(Session& session, const std::string& instance) {
  std::vector<Fastener> fasteners;
  for (const std::string& name :
       elements_for(session, {"SCREW", "WASHER", "NUT"}, family_of(session, instance))) {
    if (const auto fastener = fastener_of(session.element(name))) fasteners.push_back(*fastener);
  }
  return fasteners;
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
    Bore bore = bore_along(session, at.origin_W() + plan.seat_mm * direction_W, direction_W);
    FasteningOptions options;
    options.needs_washer = !in_counterbore;
    FasteningChoices choices = choose_fastening(bore.stretches, fitting, options);
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
