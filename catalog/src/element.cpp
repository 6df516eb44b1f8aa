#include "dowel/catalog/element.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

bool is_unit(const Eigen::Vector3d& vector) {
  // Written so that NaN is not of unit length.
  return std::abs(vector.norm() - 1.0) <= kStoredAxisSlack;
}

bool is_rotation(const Eigen::Matrix3d& axes) {
  const double error =
      (axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return error <= kStoredAxisSlack && axes.determinant() > 0.0;
}

bool are_sizes(std::initializer_list<double> values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v) && v >= 0.0; });
}

std::optional<std::string> find_defect(const HoleSegment& segment) {
  if (!are_sizes({segment.diameter_mm, segment.diameter_end_mm})) {
    return "a segment's diameter is not a finite size";
  }
  if (!std::isfinite(segment.from_mm) || !std::isfinite(segment.to_mm) ||
      segment.to_mm < segment.from_mm) {
    return "a segment does not end below its start";
  }
  return std::nullopt;
}

std::optional<std::string> find_defect(const SlotShape& slot, const Feature& feature) {
  if (feature.kind != FeatureKind::Slot) return "it has the shape of a slot but is none";
  if (!is_unit(slot.run)) return "its run is not of unit length";
  if (std::abs(slot.run.dot(feature.direction)) > kStoredAxisSlack) {
    return "its run is not square to its direction";
  }
  if (!are_sizes({slot.length_mm, slot.throat_depth_mm, slot.undercut_width_mm,
                  slot.undercut_height_mm})) {
    return "its length, throat or undercut is not a finite size";
  }
  return std::nullopt;
}

std::optional<std::string> find_defect(const Feature& feature) {
  if (!feature.origin.allFinite()) return "its origin is not finite";
  if (!is_unit(feature.direction)) return "its direction is not of unit length";
  if (!are_sizes({feature.diameter_mm, feature.depth_mm, feature.area_mm2})) {
    return "its diameter, depth or area is not a finite size";
  }
  for (const HoleSegment& segment : feature.segments) {
    if (auto defect = find_defect(segment)) return defect;
  }
  if (feature.slot) return find_defect(*feature.slot, feature);
  return std::nullopt;
}

std::optional<std::string> find_defect(const BoltCircle& circle, const Element& element) {
  if (!circle.center.allFinite()) return "its centre is not finite";
  if (!is_unit(circle.direction)) return "its direction is not of unit length";
  if (!are_sizes({circle.diameter_mm, circle.hole_diameter_mm})) {
    return "its diameter is not a finite size";
  }
  for (const std::string& name : circle.holes) {
    const Feature* const hole = element.find_feature(name);
    if (hole == nullptr || hole->kind != FeatureKind::Hole) {
      return "there is no hole \"" + name + "\"";
    }
  }
  return std::nullopt;
}

}  // namespace

const Feature* Element::find_feature(std::string_view feature_name) const {
  const auto found = std::ranges::find(features, feature_name, &Feature::name);
  return found == features.end() ? nullptr : &*found;
}

std::optional<double> Element::mass_kg() const {
  constexpr double kCubicMetres_per_mm3 = 1.0e-9;
  if (density_kg_per_m3 == 0.0) return std::nullopt;
  return volume_mm3 * kCubicMetres_per_mm3 * density_kg_per_m3;
}

std::string_view to_string(ShapeClass shape) {
  switch (shape) {
    case ShapeClass::Block:
      return "block";
    case ShapeClass::Cylinder:
      return "cylinder";
    case ShapeClass::BlockCylinder:
      return "block-cylinder";
    case ShapeClass::Compound:
      return "compound";
  }
  DOWEL_EXPECTS(false && "a known shape class");
  return {};
}

std::string_view to_string(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::Hole:
      return "hole";
    case FeatureKind::Shaft:
      return "shaft";
    case FeatureKind::Face:
      return "face";
    case FeatureKind::Slot:
      return "slot";
  }
  DOWEL_EXPECTS(false && "a known feature kind");
  return {};
}

std::string_view to_string(HoleSegment::Type type) {
  return type == HoleSegment::Type::Cylinder ? "cylinder" : "cone";
}

std::string_view to_string(SlotShape::Type type) {
  switch (type) {
    case SlotShape::Type::Plain:
      return "plain";
    case SlotShape::Type::Tee:
      return "tee";
    case SlotShape::Type::Through:
      return "through";
  }
  DOWEL_EXPECTS(false && "a known type of slot");
  return {};
}

std::string_view to_string(SlotShape::End end) {
  switch (end) {
    case SlotShape::End::Open:
      return "open";
    case SlotShape::End::Flat:
      return "flat";
    case SlotShape::End::Round:
      return "round";
  }
  DOWEL_EXPECTS(false && "a known end of a slot");
  return {};
}

std::optional<std::string> find_defect(const Element& element) {
  if (element.name.empty()) return "its name is empty";
  if (!are_sizes({element.volume_mm3, element.surface_mm2, element.facet_error_mm,
                  element.density_kg_per_m3})) {
    return "its volume, surface, facet error or density is not a finite size";
  }
  if (!element.center_of_mass.allFinite()) return "its centre of mass is not finite";
  if (!element.obb.center.allFinite()) return "its box is not at a finite place";
  if (!is_rotation(element.obb.axes)) return "its box has axes that are not orthonormal";
  const Eigen::Vector3d& half = element.obb.half_extents_mm;
  if (!are_sizes({half.x(), half.y(), half.z()})) return "its box has no finite size";
  if (element.colour &&
      !are_sizes({(*element.colour)[0], (*element.colour)[1], (*element.colour)[2]})) {
    return "its colour is not finite";
  }
  std::set<std::string_view> names;
  for (const Feature& feature : element.features) {
    if (feature.name.empty()) return "a feature has no name";
    if (!names.insert(feature.name).second) {
      return "two features are called \"" + feature.name + "\"";
    }
    if (auto defect = find_defect(feature)) return "feature \"" + feature.name + "\": " + *defect;
  }
  for (const BoltCircle& circle : element.bolt_circles) {
    if (auto defect = find_defect(circle, element)) return "a bolt circle: " + *defect;
  }
  return std::nullopt;
}

}  // namespace dowel
