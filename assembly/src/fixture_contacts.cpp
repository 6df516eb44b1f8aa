#include "fixture_contacts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>

#include "contact_patch.h"
#include "dowel/kernel/error.h"

namespace dowel {
namespace {

/// An area that reaches farther than this share of the workpiece's half diagonal from its middle
/// stops it from tilting, too.
constexpr double kWideShare = 0.5;

struct Farthest {
  std::size_t first = 0;
  std::size_t second = 0;
  double distance_mm = 0.0;
};

Farthest farthest_pair(const std::vector<Eigen::Vector3d>& corners) {
  Farthest best;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = i + 1; k < corners.size(); ++k) {
      const double distance_mm = (corners[i] - corners[k]).norm();
      if (distance_mm > best.distance_mm) best = {i, k, distance_mm};
    }
  }
  return best;
}

/// The points that stand for a contact: its middle, or the ends of an area that is wide.
std::vector<Eigen::Vector3d> points_of(const WorkpieceContact& contact, double length_mm) {
  const Farthest ends = farthest_pair(contact.corners);
  const double wide_mm = kWideShare * length_mm;
  if (ends.distance_mm <= wide_mm) return {contact.at};
  const Eigen::Vector3d& from = contact.corners[ends.first];
  const Eigen::Vector3d& to = contact.corners[ends.second];
  std::vector<Eigen::Vector3d> points{from, to};
  const Eigen::Vector3d way = (to - from).normalized();
  double farthest_mm = 0.0;
  Eigen::Vector3d third = from;
  for (const Eigen::Vector3d& corner : contact.corners) {
    const double off_mm = (corner - from).cross(way).norm();
    if (off_mm <= farthest_mm) continue;
    farthest_mm = off_mm;
    third = corner;
  }
  if (farthest_mm > wide_mm) points.push_back(third);
  return points;
}

/// Play of a pin in the hole that it locates: beyond, it is in the hole for another reason.
constexpr double kMostPlay_mm = 0.2;

/// Flattened pins give way along the shorter side of their box, which is as long across it as their
/// diameter. Recognition sees no shaft in them but their shank.
bool is_diamond(const Element& element) {
  return element.name.find("diamond") != std::string::npos;
}

std::optional<WorkpiecePin> pin_in(const Instance& pin, const Element& element,
                                   const Feature& shaft, const Instance& workpiece,
                                   const Feature& hole) {
  const Eigen::Vector3d hole_axis_W = workpiece.X_WI.rotation() * hole.direction;
  const Eigen::Vector3d axis_W = pin.X_WI.rotation() * shaft.direction;
  const Eigen::Vector3d opening_W = workpiece.X_WI * hole.origin;
  const Eigen::Vector3d to_pin = pin.X_WI * shaft.origin - opening_W;
  const Eigen::Vector3d across = to_pin - hole_axis_W.dot(to_pin) * hole_axis_W;
  if (hole_axis_W.cross(axis_W).norm() > kCoaxial_rad) return std::nullopt;
  WorkpiecePin place;
  place.instance = pin.name;
  place.shaft = shaft.name;
  place.hole = hole.name;
  place.is_diamond = is_diamond(element);
  place.axis = hole_axis_W;
  double diameter_mm = shaft.diameter_mm;
  const Eigen::Vector3d x_W = hole_axis_W.unitOrthogonal();
  place.normals = {x_W, hole_axis_W.cross(x_W)};
  double from_mm = hole_axis_W.dot(to_pin);
  double to_mm =
      hole_axis_W.dot(pin.X_WI * (shaft.origin + shaft.depth_mm * shaft.direction) - opening_W);
  if (place.is_diamond) {
    int widest = -1;
    for (int i = 0; i < 3; ++i) {
      const bool is_across =
          std::abs(shaft.direction.dot(element.obb.axes.col(i))) < std::sqrt(0.5);
      if (is_across &&
          (widest < 0 || element.obb.half_extents_mm[i] > element.obb.half_extents_mm[widest])) {
        widest = i;
      }
    }
    diameter_mm = 2.0 * element.obb.half_extents_mm[widest];
    place.normals = {pin.X_WI.rotation() * element.obb.axes.col(widest)};
    const double middle_mm = hole_axis_W.dot(pin.X_WI * element.obb.center - opening_W);
    const double half_mm = (element.obb.axes.transpose() * shaft.direction)
                               .cwiseAbs()
                               .dot(element.obb.half_extents_mm);
    from_mm = middle_mm - half_mm;
    to_mm = middle_mm + half_mm;
  }
  const double play_mm = hole.diameter_mm - diameter_mm;
  const double begin_mm = std::max(0.0, std::min(from_mm, to_mm));
  const double end_mm = std::min(hole.depth_mm, std::max(from_mm, to_mm));
  if (play_mm < 0.0 || play_mm > kMostPlay_mm || end_mm <= begin_mm ||
      across.norm() > kCoaxial_mm + 0.5 * play_mm) {
    return std::nullopt;
  }
  place.hole_mm = hole.diameter_mm;
  place.pin_mm = diameter_mm;
  place.length_mm = std::abs(to_mm - from_mm);
  place.engagement_mm = end_mm - begin_mm;
  place.at = opening_W + 0.5 * (begin_mm + end_mm) * hole_axis_W;
  return place;
}

/// The pins of one locator, each in the first hole of the workpiece that it goes with.
std::vector<WorkpiecePin> pins_of(const Instance& locator, const Element& element,
                                  const Instance& workpiece, const Element& work) {
  std::vector<WorkpiecePin> places;
  for (const Feature& shaft : element.features) {
    if (shaft.kind != FeatureKind::Shaft) continue;
    for (const Feature& hole : work.features) {
      if (hole.kind != FeatureKind::Hole) continue;
      const auto place = pin_in(locator, element, shaft, workpiece, hole);
      const bool is_known = place && std::ranges::any_of(places, [&](const WorkpiecePin& other) {
                              return (other.at - place->at).cross(other.axis).norm() < kMostPlay_mm;
                            });
      if (place && !is_known) places.push_back(*place);
    }
  }
  return places;
}

}  // namespace

Role fixture_role(const ProjectState& state, const Instance& instance, const Element& element) {
  const auto given = state.design.roles.find(instance.name);
  if (given != state.design.roles.end()) return given->second;
  return role_from(element.role).value_or(Role::Other);
}

bool is_locating(Role role) {
  return role != Role::Clamp && role != Role::AdjustableSupport && role != Role::Fastener &&
         role != Role::Workpiece;
}

std::vector<const Instance*> workpieces(const FixtureInput& input) {
  std::vector<const Instance*> found;
  for (const Instance* instance : input.state.in_order()) {
    if (fixture_role(input.state, *instance, input.element(instance->element)) == Role::Workpiece) {
      found.push_back(instance);
    }
  }
  return found;
}

FixtureModel fixture_model(const FixtureInput& input, const Instance& workpiece) {
  const Element& element = input.element(workpiece.element);
  FixtureModel model;
  model.workpiece = workpiece.name;
  model.frame.reference = workpiece.X_WI * element.obb.center;
  model.frame.length_mm = element.obb.half_extents_mm.norm();
  model.mass_kg = element.mass_kg();
  model.center_of_mass = workpiece.X_WI * element.center_of_mass;
  const auto solid = input.solid(workpiece.element);
  for (const auto& [name, instance] : input.state.instances) {
    const Element& other = input.element(instance.element);
    if (name == workpiece.name || fixture_role(input.state, instance, other) != Role::Locator) {
      continue;
    }
    for (WorkpiecePin& pin : pins_of(instance, other, workpiece, element)) {
      model.pins.push_back(std::move(pin));
    }
  }
  for (const Touch& touch : input.touches) {
    if (touch.instance != workpiece.name && touch.with != workpiece.name) continue;
    const std::string& name = touch.instance == workpiece.name ? touch.with : touch.instance;
    const Instance& other = *input.state.find(name);
    const Role role = fixture_role(input.state, other, input.element(other.element));
    std::vector<ContactPatch> patches = input.shared_planes(touch);
    if (touch.instance == workpiece.name) {
      for (ContactPatch& patch : patches) patch.normal_W = -patch.normal_W;
    }
    // The wall of a hole touches its pin somewhere; the pin stops it all around.
    if (patches.empty() &&
        std::ranges::find(model.pins, name, &WorkpiecePin::instance) == model.pins.end()) {
      patches = contact_patches(*input.solid(other.element), other.X_WI, *solid, workpiece.X_WI,
                                input.state.tolerance_mm, touch.pair.witness_W);
    }
    for (const ContactPatch& patch : patches) {
      model.contacts.push_back(
          {name, role, patch.at_W, patch.normal_W, patch.area_mm2, patch.corners_W});
    }
  }
  std::ranges::stable_sort(model.contacts, {}, &WorkpieceContact::instance);
  const FixtureDesign& design = input.state.design;
  const auto error_of = [&](const std::string& name) {
    const auto given = design.locator_errors_mm.find(name);
    return given != design.locator_errors_mm.end() ? given->second
                                                   : design.limit("locator_error_mm");
  };
  for (const WorkpieceContact& contact : model.contacts) {
    if (!is_locating(contact.role)) continue;
    const double error_mm = error_of(contact.instance);
    for (const Eigen::Vector3d& point : points_of(contact, model.frame.length_mm)) {
      model.locators.push_back({contact.instance, point, contact.normal, error_mm, false});
    }
  }
  for (const WorkpiecePin& pin : model.pins) {
    const double error_mm = error_of(pin.instance) + 0.5 * (pin.hole_mm - pin.pin_mm);
    for (const Eigen::Vector3d& normal : pin.normals) {
      model.locators.push_back({pin.instance, pin.at, normal, error_mm, true});
    }
  }
  return model;
}

Wrench weight_of(const FixtureModel& model) {
  const double weight_N = model.mass_kg.value_or(0.0) * kGravity_m_per_s2;
  return wrench_of(-weight_N * Eigen::Vector3d::UnitZ(), model.center_of_mass, model.frame);
}

std::vector<FrictionContact> friction_contacts(const FixtureModel& model,
                                               const FixtureDesign& design) {
  std::vector<FrictionContact> result;
  const double friction = design.limit("friction");
  for (const LocatingPoint& point : model.locators) {
    result.push_back({point.at, point.normal, friction, std::nullopt});
    if (point.two_sided) result.push_back({point.at, -point.normal, friction, std::nullopt});
  }
  for (const WorkpieceContact& contact : model.contacts) {
    const auto force = design.clamp_forces_N.find(contact.instance);
    if (contact.role != Role::Clamp || force == design.clamp_forces_N.end()) continue;
    const auto shares =
        std::ranges::count(model.contacts, contact.instance, &WorkpieceContact::instance);
    result.push_back(
        {contact.at, contact.normal, friction, force->second / static_cast<double>(shares)});
  }
  return result;
}

Wrench clamping_of(const FixtureModel& model, const FixtureDesign& design) {
  Wrench sum = Wrench::Zero();
  for (const FrictionContact& contact : friction_contacts(model, design)) {
    if (contact.preload_N) {
      sum += wrench_of(*contact.preload_N * contact.normal, contact.at, model.frame);
    }
  }
  return sum;
}

std::vector<Eigen::Vector2d> support_points(const FixtureModel& model) {
  const double up = std::sqrt(0.5);
  std::vector<Eigen::Vector2d> points;
  for (const WorkpieceContact& contact : model.contacts) {
    if (!is_locating(contact.role) || contact.normal.z() < up) continue;
    if (contact.corners.empty()) points.emplace_back(contact.at.head<2>());
    for (const Eigen::Vector3d& corner : contact.corners) points.emplace_back(corner.head<2>());
  }
  return points;
}

}  // namespace dowel
