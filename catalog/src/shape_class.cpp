#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "axis.h"
#include "dowel/catalog/recognition.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/mass_properties.h"

namespace dowel {
namespace {

/// Part of the outer area that must be of the class's own faces: chamfers, fillets and engraved
/// grooves take up the rest.
constexpr double kMostOfArea = 0.9;

/// A block with its holes filled takes up this part of its box: plates with T-slots do, angles do
/// not.
constexpr double kBlockFill = 0.7;

/// Volume of the segments of a hole.
double hole_volume_mm3(const Feature& hole) {
  double volume = 0.0;
  for (const HoleSegment& s : hole.segments) {
    const double a = 0.5 * s.diameter_mm;
    const double b = 0.5 * s.diameter_end_mm;
    volume += std::numbers::pi / 3.0 * (a * a + a * b + b * b) * (s.to_mm - s.from_mm);
  }
  return volume;
}

const Feature* largest(const std::vector<const Feature*>& features) {
  const auto found = std::max_element(
      features.begin(), features.end(),
      [](const Feature* a, const Feature* b) { return a->area_mm2 < b->area_mm2; });
  return found == features.end() ? nullptr : *found;
}

/// Frame of the largest planar face and the largest one square to it.
std::optional<Eigen::Matrix3d> block_frame(const std::vector<const Feature*>& planes) {
  const Feature* first = largest(planes);
  if (first == nullptr) return std::nullopt;
  std::vector<const Feature*> square;
  for (const Feature* plane : planes) {
    if (std::abs(plane->direction.dot(first->direction)) <= kCoaxial_rad) square.push_back(plane);
  }
  const Feature* second = largest(square);
  if (second == nullptr) return std::nullopt;
  Eigen::Matrix3d frame;
  frame.col(0) = first->direction;
  frame.col(2) = first->direction.cross(second->direction).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

double box_volume_mm3(const FacetedSolid& solid, const Eigen::Matrix3d& frame) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : solid.vertices) {
    const Eigen::Vector3d q = frame.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return (high - low).prod();
}

bool is_block(const FacetedSolid& solid, const std::vector<Feature>& features,
              const std::vector<const Feature*>& planes, double outer_area_mm2) {
  const std::optional<Eigen::Matrix3d> frame = block_frame(planes);
  if (!frame) return false;
  double area_mm2 = 0.0;
  for (const Feature* plane : planes) {
    const double along = (frame->transpose() * plane->direction).cwiseAbs().maxCoeff();
    if (std::acos(std::min(1.0, along)) <= kCoaxial_rad) area_mm2 += plane->area_mm2;
  }
  if (area_mm2 < kMostOfArea * outer_area_mm2) return false;
  double volume_mm3 = mass_properties(solid).volume_mm3;
  for (const Feature& feature : features) {
    if (feature.kind == FeatureKind::Hole) volume_mm3 += hole_volume_mm3(feature);
  }
  return volume_mm3 >= kBlockFill * box_volume_mm3(solid, *frame);
}

/// Outer area of the shafts about `axis`, and of the planes square to it and the cones, tori and
/// spheres about it.
double revolved_area_mm2(const FacetedSolid& solid, const std::vector<Feature>& features,
                         const std::vector<bool>& is_in_hole, const Axis& axis) {
  double area_mm2 = 0.0;
  for (const Feature& feature : features) {
    if (feature.kind == FeatureKind::Face && axis.is_parallel(feature.direction)) {
      area_mm2 += feature.area_mm2;
    }
    if (feature.kind == FeatureKind::Shaft && axis.is_parallel(feature.direction) &&
        axis.distance_mm(feature.origin) <= kSameFeature_mm) {
      for (const std::uint32_t face : feature.faces) area_mm2 += solid.faces[face].area_mm2;
    }
  }
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (is_in_hole[f]) continue;
    const Surface& surface = solid.faces[f].surface;
    bool is_about = false;
    if (const auto* cone = std::get_if<ConeSurface>(&surface)) {
      is_about = axis.is_parallel(cone->axis) && axis.distance_mm(cone->apex) <= kSameFeature_mm;
    } else if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
      is_about =
          axis.is_parallel(torus->axis) && axis.distance_mm(torus->center) <= kSameFeature_mm;
    } else if (const auto* sphere = std::get_if<SphereSurface>(&surface)) {
      is_about = axis.distance_mm(sphere->center) <= kSameFeature_mm;
    }
    if (is_about) area_mm2 += solid.faces[f].area_mm2;
  }
  return area_mm2;
}

/// A plane along the axis that looks towards it.
bool faces_axis(const Feature& plane, const Axis& axis) {
  const Eigen::Vector3d out = plane.origin - axis.at(axis.height_mm(plane.origin));
  return plane.direction.dot(out) < 0.0;
}

}  // namespace

ShapeClass classify_shape(const FacetedSolid& solid, const std::vector<Feature>& features) {
  std::vector<bool> is_in_hole(solid.faces.size(), false);
  std::vector<const Feature*> planes;
  const Feature* main_shaft = nullptr;
  double main_area_mm2 = 0.0;
  for (const Feature& feature : features) {
    for (const std::uint32_t face : feature.faces) DOWEL_EXPECTS(face < solid.faces.size());
    if (feature.kind == FeatureKind::Hole) {
      for (const std::uint32_t face : feature.faces) is_in_hole[face] = true;
    } else if (feature.kind == FeatureKind::Face) {
      planes.push_back(&feature);
    } else if (feature.kind == FeatureKind::Shaft) {
      const double area_mm2 = feature.diameter_mm * feature.depth_mm;
      if (area_mm2 > main_area_mm2) {
        main_area_mm2 = area_mm2;
        main_shaft = &feature;
      }
    }
  }
  double outer_area_mm2 = 0.0;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (!is_in_hole[f]) outer_area_mm2 += solid.faces[f].area_mm2;
  }
  if (main_shaft == nullptr) {
    return is_block(solid, features, planes, outer_area_mm2) ? ShapeClass::Block
                                                             : ShapeClass::Compound;
  }
  const Axis axis{main_shaft->origin, main_shaft->direction};
  const double revolved_mm2 = revolved_area_mm2(solid, features, is_in_hole, axis);
  double prismatic_mm2 = 0.0;
  for (const Feature* plane : planes) {
    if (axis.is_parallel(plane->direction)) continue;
    if (faces_axis(*plane, axis)) {
      outer_area_mm2 -= plane->area_mm2;  // a socket's flank is no outer face
    } else {
      prismatic_mm2 += plane->area_mm2;
    }
  }
  if (revolved_mm2 >= kMostOfArea * outer_area_mm2) return ShapeClass::Cylinder;
  return revolved_mm2 + prismatic_mm2 >= kMostOfArea * outer_area_mm2 ? ShapeClass::BlockCylinder
                                                                      : ShapeClass::Compound;
}

}  // namespace dowel
