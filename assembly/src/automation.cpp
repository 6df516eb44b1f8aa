#include "dowel/assembly/automation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "dowel/assembly/names.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "project_rows.h"
#include "slot_fastening.h"

namespace dowel {
namespace {

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

/// What something is mated with.
struct NamedFeature {
  FeatureName name;
  PlacedFeature placed;
};

/// A placement by one mate, turned as little as can be against `X_WA_near`, else the fixed part.
Placement placed_by_mate(Session& session, const std::string& element, const FeatureName& name,
                         const NamedFeature& fixed, const MateOptions& options,
                         const std::optional<Pose>& X_WA_near = std::nullopt) {
  const Feature* moving = session.element(element).find_feature(name.feature);
  DOWEL_EXPECTS(moving != nullptr);
  const MatePlacement to = place_by_mate({moving, X_WA_near.value_or(fixed.placed.X_WI)},
                                         fixed.placed, std::nullopt, options);
  Mate mate;
  mate.kind = to.kind;
  mate.moving = name;
  mate.fixed = fixed.name;
  mate.offset_mm = options.offset_mm;
  mate.flip = options.flip;
  return {element, name.instance, to.X_WA, {mate}};
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

/// Each kind of the part's family where it has any: a slot system has its own T-nuts, and screws
/// and washers of any other.
std::vector<Fastener> fasteners_for(Session& session, const std::string& instance) {
  std::vector<Fastener> fasteners;
  for (const std::set<std::string>& roles :
       {std::set<std::string>{"SCREW"}, std::set<std::string>{"WASHER"},
        std::set<std::string>{"NUT", "COLLAR"}, std::set<std::string>{"TEE"},
        std::set<std::string>{"SPHERICAL", "CONICAL", "WIDE"}}) {
    for (const std::string& name : elements_for(session, roles, family_of(session, instance))) {
      if (const auto fastener = fastener_of(session.element(name))) fasteners.push_back(*fastener);
    }
  }
  return fasteners;
}

/// Ways with screws whose heads go into the counterbore, or are wider than the mouth.
FasteningChoices choose_screws(Session& session, const PlacedFeature& at, bool in_counterbore,
                               const std::vector<Fastener>& all) {
  const auto [step_mm, width_mm] = counterbore(*at.feature);
  const double mouth_mm = width_mm > 0.0 ? width_mm : at.feature->diameter_mm;
  std::vector<Fastener> fitting = all;
  std::erase_if(fitting, [&](const Fastener& fastener) {
    if (fastener.kind != Fastener::Kind::Screw) return false;
    return in_counterbore ? fastener.head_diameter_mm > mouth_mm + kShaftExcess_mm
                          : fastener.head_diameter_mm <= mouth_mm;
  });
  const double seat_mm = in_counterbore ? step_mm : 0.0;
  const Eigen::Vector3d direction_W = at.direction_W().normalized();
  const Eigen::Vector3d start_W = at.origin_W() + seat_mm * direction_W;
  FasteningOptions options;
  options.needs_washer = !in_counterbore;
  const Bore bore = bore_along(session, start_W, direction_W);
  const auto below = slot_below(session, start_W, direction_W, bore.reached_mm);
  FasteningChoices choices = below ? choose_tee_nut(bore, *below, fitting, options)
                                   : choose_fastening(bore.stretches, fitting, options);
  if (choices.ways.size() > kMostWays) choices.ways.resize(kMostWays);
  for (Fastening& way : choices.ways) way.seat_mm = seat_mm;
  return choices;
}

}  // namespace

StackPlan plan_stack(Session& session, double height_mm, const FeatureName& on) {
  expect_hole(session.feature(on), on);
  std::vector<Spacer> spacers;
  for (const std::string& name :
       elements_for(session, {"SPACER"}, family_of(session, on.instance))) {
    const auto spacer = spacer_of(session.element(name));
    if (!spacer) continue;
    spacers.push_back(*spacer);
  }
  std::ranges::stable_sort(spacers, {}, &Spacer::height_mm);
  std::string heights;
  for (const Spacer& spacer : spacers) {
    heights += (heights.empty() ? "" : ", ") + number_text(spacer.height_mm);
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
  NamedFeature below{plan.on, session.feature(plan.on)};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string& hole = plan.ways[way][i].hole;
    placements.push_back(placed_by_mate(session, elements[i], {names[i], hole}, below, {}));
    below = {{names[i], hole},
             {session.element(elements[i]).find_feature(hole), placements.back().X_WI}};
  }
  return session.place_all(placements, command);
}

FasteningPlan plan_fastening(Session& session, const FeatureName& hole) {
  const PlacedFeature at = session.feature(hole);
  expect_hole(at, hole);
  const std::vector<Fastener> all = fasteners_for(session, hole.instance);
  const auto [step_mm, width_mm] = counterbore(*at.feature);
  FasteningPlan plan;
  plan.hole = hole;
  std::string reason;
  const auto told = [&](const char* where, const std::string& why) {
    reason += (reason.empty() ? "" : "; ") + std::string(where) + why;
  };
  for (const bool in_counterbore : {true, false}) {
    if (!plan.ways.empty() || (in_counterbore && step_mm == 0.0)) continue;
    FasteningChoices choices = choose_screws(session, at, in_counterbore, all);
    told(in_counterbore ? "in its counterbore " : "on its face ", choices.reason);
    plan.ways = std::move(choices.ways);
  }
  const Eigen::Vector3d direction_W = at.direction_W().normalized();
  Bore bore = bore_along(session, at.origin_W(), direction_W);
  if (const auto below = slot_below(session, at.origin_W(), direction_W, bore.reached_mm)) {
    FasteningChoices bolts =
        choose_bolt_in_slot(bore, *below, all, width_mm > 0.0 ? width_mm : at.feature->diameter_mm);
    told("from the slot ", bolts.reason);
    plan.ways.insert(plan.ways.end(), bolts.ways.begin(), bolts.ways.end());
    // What holds by a whole nut before what holds by a low one.
    std::stable_partition(plan.ways.begin(), plan.ways.end(), [](const Fastening& way) {
      return way.engagement_mm >= kTeeNutEngagement * way.screw.nominal_mm - kCoincident_mm;
    });
    bore.holes.push_back(below->name);
  }
  plan.holes = std::move(bore.holes);
  if (plan.ways.empty()) refuse("nothing fastens " + hole.text() + ": " + reason);
  return plan;
}

namespace {

/// Places the parts of a fastening one after the other.
class Fastened {
 public:
  Fastened(Session& session, const FasteningPlan& plan, const Fastening& chosen)
      : session_(session),
        plan_(plan),
        chosen_(chosen),
        hole_{plan.hole, session.feature(plan.hole)} {
    std::vector<std::string> elements;
    for (const Fastener* part : parts()) elements.push_back(part->element);
    const std::vector<std::string> names = new_names(session, elements);
    for (std::size_t i = 0; i < names.size(); ++i) names_[parts()[i]] = names[i];
  }

  std::vector<Placement> placements() {
    const bool is_bolt = chosen_.screw.kind == Fastener::Kind::TeeBolt;
    // What is in the slot comes first: it slides along it.
    if (is_bolt) put_tee_bolt();
    if (chosen_.tee_nut) put_tee_nut();
    const double under_head_mm = chosen_.lift_mm() - chosen_.seat_mm;
    if (chosen_.conical_seat) put_on_hole(*chosen_.conical_seat, -chosen_.seat_mm);
    if (chosen_.washer) put_on_hole(*chosen_.washer, under_head_mm - chosen_.washer->length_mm);
    if (!is_bolt) {
      put_on_hole(chosen_.screw, under_head_mm);
      placements_.back().mates.front().thread =
          !chosen_.nut && plan_.holes.at(chosen_.thread) == plan_.hole;
    }
    if (chosen_.nut) put_nut(*chosen_.nut);
    return std::move(placements_);
  }

 private:
  /// In the order of their names.
  std::vector<const Fastener*> parts() const {
    std::vector<const Fastener*> parts{&chosen_.screw};
    for (const auto* part :
         {&chosen_.conical_seat, &chosen_.washer, &chosen_.nut, &chosen_.tee_nut}) {
      if (*part) parts.push_back(&**part);
    }
    return parts;
  }

  FeatureName name(const Fastener& part) const { return {names_.at(&part), part.feature}; }

  PlacedFeature slot() const { return session_.feature(plan_.holes.at(chosen_.thread)); }

  void put_on_hole(const Fastener& part, double offset_mm) {
    placements_.push_back(placed_by_mate(session_, part.element, name(part), hole_,
                                         {.offset_mm = offset_mm, .flip = part.flip}));
    if (&part == &chosen_.screw) X_WS_ = placements_.back().X_WI;
  }

  /// A key in the slot, by what leads it in.
  Mate mate_with_slot(const Fastener& part) const {
    Mate mate;
    mate.kind = MateKind::KeyInSlot;
    mate.moving = {names_.at(&part), key_feature(session_.element(part.element), part)};
    mate.fixed = plan_.holes.at(chosen_.thread);
    return mate;
  }

  void put_tee_bolt() {
    const Fastener& bolt = chosen_.screw;
    X_WS_ = pose_in_slot(session_, bolt, slot(), hole_.placed.origin_W());
    Mate key = mate_with_slot(bolt);
    const SlotShape& shape = *slot().feature->slot;
    key.offset_mm = shape.undercut_height_mm - bolt.foot_height_mm;  // off the slot's floor
    Mate align;
    align.kind = MateKind::Align;
    align.moving = name(bolt);
    align.fixed = plan_.hole;
    align.flip = true;
    placements_.push_back({bolt.element, names_.at(&bolt), X_WS_, {key, align}});
  }

  void put_tee_nut() {
    const Fastener& nut = *chosen_.tee_nut;
    const Pose X_WN = pose_in_slot(session_, nut, slot(), hole_.placed.origin_W());
    placements_.push_back({nut.element, names_.at(&nut), X_WN, {mate_with_slot(nut)}});
  }

  /// On the thread of the screw; a collar towards the parts.
  void put_nut(const Fastener& nut) {
    const Fastener& screw = chosen_.screw;
    const NamedFeature shaft{name(screw),
                             {session_.element(screw.element).find_feature(screw.feature), X_WS_}};
    const Feature& hole = *session_.element(nut.element).find_feature(nut.feature);
    const double sense = nut.flip ? 1.0 : -1.0;
    const Pose X_WN(
        nearest_rotation(X_WS_.rotation(), hole.direction, sense * shaft.placed.direction_W()),
        X_WS_.translation());
    placements_.push_back(placed_by_mate(session_, nut.element, name(nut), shaft,
                                         {.offset_mm = chosen_.grip_mm - screw.neck_height_mm},
                                         X_WN));
    placements_.back().mates.front().thread = true;
  }

  Session& session_;
  const FasteningPlan& plan_;
  const Fastening& chosen_;
  NamedFeature hole_;
  std::map<const Fastener*, std::string> names_;
  Pose X_WS_;
  std::vector<Placement> placements_;
};

}  // namespace

std::vector<MoveReport> fasten(Session& session, const FasteningPlan& plan, std::size_t way,
                               std::optional<std::string_view> command) {
  DOWEL_EXPECTS(way < plan.ways.size());
  return session.place_all(Fastened(session, plan, plan.ways[way]).placements(), command);
}

}  // namespace dowel
