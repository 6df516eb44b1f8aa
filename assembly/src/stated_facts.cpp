// Facts that the project states of single parts, and what locators' and clamps' pads bear.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dowel/kernel/tolerance.h"
#include "fact_source.h"

namespace dowel {
namespace {

FactRows stated_rows(FactSource& source) {
  FactRows rows;
  for (const auto& [key, stated] : source.state().design.stated) {
    rows.push_back({key.second, key.first, stated.value, stated.reason});
  }
  return rows;
}

/// The planar face of an instance in which a point is, that looks along `normal_W`; the largest.
const Feature* face_at(const Element& element, const Pose& X_WI, const Eigen::Vector3d& at_W,
                       const Eigen::Vector3d& normal_W) {
  const Feature* best = nullptr;
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Face) continue;
    const Eigen::Vector3d face_normal_W = X_WI.rotation() * feature.direction;
    if (face_normal_W.dot(normal_W) < 1.0 - kCoaxial_rad ||
        std::abs(normal_W.dot(X_WI * feature.origin - at_W)) > kCoaxial_mm) {
      continue;
    }
    if (best == nullptr || feature.area_mm2 > best->area_mm2) best = &feature;
  }
  return best;
}

FactValue name_of(const Feature* feature) {
  return feature == nullptr ? FactValue() : FactValue(feature->name);
}

FactRows pads(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    const Instance& workpiece = *source.state().find(model.workpiece);
    for (const WorkpieceContact& contact : model.contacts) {
      if (contact.area_mm2 <= 0.0) continue;
      const Instance& part = *source.state().find(contact.instance);
      const Feature* pad = face_at(source.element(part), part.X_WI, contact.at, contact.normal);
      const Feature* face =
          face_at(source.element(workpiece), workpiece.X_WI, contact.at, -contact.normal);
      rows.push_back({contact.instance, model.workpiece, std::string(to_string(contact.role)),
                      name_of(pad), name_of(face), contact.area_mm2,
                      pad != nullptr ? FactValue(pad->area_mm2) : FactValue()});
    }
  }
  return rows;
}

FactRows pins(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const WorkpiecePin& pin : model.pins) {
      rows.push_back({model.workpiece, pin.instance, pin.shaft, pin.hole, truth(pin.is_diamond),
                      pin.hole_mm, pin.pin_mm, pin.hole_mm - pin.pin_mm, pin.length_mm,
                      pin.engagement_mm, pin.at.x(), pin.at.y(), pin.at.z(), pin.axis.x(),
                      pin.axis.y(), pin.axis.z()});
    }
  }
  return rows;
}

/// A strap: what presses the workpiece down with one end, stands on something with the other, and
/// has a screw through it in between.
struct Lever {
  std::string heel;
  std::string screw;
  double heel_mm = 0.0;
  double nose_mm = 0.0;
  double tilt_rad = 0.0;
};

/// A screw in a bore or slotted hole of the strap; the axes may be tilted to each other.
struct ScrewThrough {
  std::string screw;
  Eigen::Vector3d at_W;  ///< on the screw's axis, in the middle of the bore
  double tilt_rad = 0.0;
};

/// A strap that is tilted by more is none.
constexpr double kMostTilt_rad = 0.3;

std::optional<ScrewThrough> through(const Instance& screw, const Feature& shaft,
                                    const Instance& strap, const Feature& bore) {
  const Eigen::Vector3d axis_W = screw.X_WI.rotation() * shaft.direction;
  const Eigen::Vector3d bore_W = strap.X_WI.rotation() * bore.direction;
  const double tilt_rad = std::asin(std::min(1.0, axis_W.cross(bore_W).norm()));
  if (tilt_rad > kMostTilt_rad || std::abs(axis_W.z()) < std::sqrt(0.5)) return std::nullopt;
  const Eigen::Vector3d middle_W =
      strap.X_WI * (bore.origin + 0.5 * bore.depth_mm * bore.direction);
  const Eigen::Vector3d from_W = screw.X_WI * shaft.origin;
  const double along_mm = axis_W.dot(middle_W - from_W);
  const Eigen::Vector3d at_W = from_W + along_mm * axis_W;
  const double reach_mm = bore.slot ? 0.5 * bore.slot->length_mm : 0.5 * bore.diameter_mm;
  if (along_mm < 0.0 || along_mm > shaft.depth_mm || (at_W - middle_W).norm() > reach_mm) {
    return std::nullopt;
  }
  return ScrewThrough{screw.name, at_W, tilt_rad};
}

/// The first by name; threads of the strap hold no screw that pulls it.
std::optional<ScrewThrough> screw_through(FactSource& source, const Instance& strap) {
  const Element& element = source.element(strap);
  const Eigen::AlignedBox3d box_W = box_around(strap, element);
  for (const auto& [name, screw] : source.state().instances) {
    const Element& other = source.element(screw);
    if (source.role(screw) != Role::Fastener || !box_W.intersects(box_around(screw, other))) {
      continue;
    }
    for (const Feature& shaft : other.features) {
      if (shaft.kind != FeatureKind::Shaft) continue;
      for (const Feature& bore : element.features) {
        const bool is_bore = bore.kind == FeatureKind::Hole || bore.kind == FeatureKind::Slot;
        if (!is_bore || !bore.through || bore.diameter_mm < shaft.diameter_mm) continue;
        if (auto found = through(screw, shaft, strap, bore)) return found;
      }
    }
  }
  return std::nullopt;
}

/// Nothing where the clamp is no strap.
std::optional<Lever> lever_of(FactSource& source, const FixtureModel& model,
                              const WorkpieceContact& nose) {
  const Instance& strap = *source.state().find(nose.instance);
  if (nose.normal.z() > -std::sqrt(0.5)) return std::nullopt;
  const auto screw = screw_through(source, strap);
  if (!screw) return std::nullopt;
  const double middle_mm = box_around(strap, source.element(strap)).center().z();
  const Eigen::Vector2d to_nose = (nose.at - screw->at_W).head<2>();
  std::optional<Lever> best;
  for (const Touch& touch : source.touches()) {
    const bool is_first = touch.instance == nose.instance;
    if (!is_first && touch.with != nose.instance) continue;
    const std::string& other = is_first ? touch.with : touch.instance;
    if (other == model.workpiece || touch.pair.verdict != Verdict::Contact) continue;
    const auto& planes = source.shared_planes(touch);
    const Eigen::Vector3d at_W = planes.empty() ? touch.pair.witness_W : planes.front().at_W;
    const Eigen::Vector2d to_heel = (at_W - screw->at_W).head<2>();
    // Behind the screw, seen from the nose, and below the strap.
    if (to_heel.dot(to_nose) >= 0.0 || to_heel.norm() < kCoaxial_mm || at_W.z() > middle_mm ||
        (best && best->heel_mm >= to_heel.norm())) {
      continue;
    }
    best = {other, screw->screw, to_heel.norm(), to_nose.norm(), screw->tilt_rad};
  }
  return best;
}

FactRows straps(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const WorkpieceContact& contact : model.contacts) {
      if (contact.role != Role::Clamp) continue;
      const auto lever = lever_of(source, model, contact);
      if (!lever) continue;
      constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
      const auto force = source.state().design.clamp_forces_N.find(contact.instance);
      const double share = lever->heel_mm / (lever->heel_mm + lever->nose_mm);
      rows.push_back({contact.instance, model.workpiece, lever->screw, lever->heel, lever->heel_mm,
                      lever->nose_mm, share, kDegrees_per_rad * lever->tilt_rad,
                      force == source.state().design.clamp_forces_N.end()
                          ? FactValue()
                          : FactValue(force->second / share)});
    }
  }
  return rows;
}

constexpr unsigned kFromFixture = FromParts | FromDesign | FromTolerance;

}  // namespace

std::vector<FactTable> stated_facts() {
  return {
      {"pads",
       "Planes by which parts and the workpiece bear on each other, and the faces they belong to.",
       {{"instance", "part"},
        {"workpiece", "instance"},
        {"role", "of the part"},
        {"pad", "its face; NULL where its element names none there"},
        {"face", "of the workpiece; NULL as before"},
        {"area_mm2", "that bears"},
        {"pad_mm2", "area of the part's face"}},
       kFromFixture,
       pads},
      {"pins",
       "Pins of locators in holes of the workpiece.",
       {{"workpiece", "instance"},
        {"instance", "locator"},
        {"pin", "its feature"},
        {"hole", "feature of the workpiece"},
        {"diamond", "1: flattened, it stops one way alone"},
        {"hole_mm", "diameter"},
        {"pin_mm", "diameter where it stops the hole"},
        {"play_mm", "hole less pin, as drawn"},
        {"length_mm", "of the pin"},
        {"engagement_mm", "of it in the hole"},
        {"x_mm", "middle of that"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"dx", "into the workpiece's hole; unit"},
        {"dy", ""},
        {"dz", ""}},
       kFromFixture,
       pins},
      {"stated",
       "What `design` states of single parts, features, elements and points.",
       {{"subject", "INSTANCE, INSTANCE.FEATURE, ELEMENT or POINT"},
        {"quantity", "ends in its unit"},
        {"value", "as stated"},
        {"reason", "by what"}},
       FromDesign,
       stated_rows},
      {"straps",
       "Clamps that press down with one end, stand with the other and are pulled by a screw in "
       "between.",
       {{"instance", "clamp"},
        {"workpiece", "instance"},
        {"screw", "instance that goes through it"},
        {"heel", "instance that it stands on"},
        {"heel_length_mm", "from the screw to the heel, seen from above"},
        {"nose_length_mm", "from the screw to the workpiece"},
        {"share", "of the screw's force that the workpiece gets: heel over heel and nose"},
        {"tilt_deg", "of its bore against the screw"},
        {"screw_force_N", "that gives the clamp's force; NULL where `force` does not say"}},
       kFromFixture,
       straps},
  };
}

}  // namespace dowel
