#pragma once

// A few elements of a modular system, with facets, exact faces and features worked out by hand.

#include <memory>
#include <string>
#include <vector>

#include "dowel/assembly/project.h"
#include "dowel/catalog/catalog.h"
#include "dowel/kernel/box.h"
#include "solids.h"

namespace dowel::testing {

/// What rounding alone may move.
inline constexpr double kExact_mm = 1e-9;

inline Feature face_feature(const std::string& name, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& normal, double area_mm2) {
  Feature face;
  face.name = name;
  face.kind = FeatureKind::Face;
  face.origin = origin;
  face.direction = normal;
  face.area_mm2 = area_mm2;
  return face;
}

inline Feature shaft_feature(const std::string& name, const Eigen::Vector3d& shoulder,
                             const Eigen::Vector3d& direction, double diameter_mm,
                             double length_mm) {
  Feature shaft;
  shaft.name = name;
  shaft.kind = FeatureKind::Shaft;
  shaft.origin = shoulder;
  shaft.direction = direction;
  shaft.diameter_mm = diameter_mm;
  shaft.depth_mm = length_mm;
  return shaft;
}

/// `steps`: diameter and length of each cylinder, from the opening.
inline Feature hole_feature(const std::string& name, const Eigen::Vector3d& opening,
                            const Eigen::Vector3d& direction,
                            const std::vector<std::pair<double, double>>& steps, bool through) {
  Feature hole;
  hole.name = name;
  hole.kind = FeatureKind::Hole;
  hole.origin = opening;
  hole.direction = direction;
  hole.through = through;
  hole.diameter_mm = steps.front().first;
  for (const auto& [diameter_mm, length_mm] : steps) {
    hole.diameter_mm = std::min(hole.diameter_mm, diameter_mm);
    hole.segments.push_back({HoleSegment::Type::Cylinder, diameter_mm, diameter_mm, hole.depth_mm,
                             hole.depth_mm + length_mm});
    hole.depth_mm += length_mm;
  }
  return hole;
}

inline ProjectElement element_of(const std::string& name, FacetedSolid solid,
                                 std::vector<Feature> features) {
  Element element;
  element.name = name;
  element.family = name.substr(0, name.rfind('/') == std::string::npos ? 0 : name.rfind('/'));
  element.source = name + ".step";
  element.unit_in_file = "mm";
  element.shape = ShapeClass::Block;
  element.solids = solid.solid_count;
  const Aabb box = bounds(solid.vertices);
  element.obb.center = box.center();
  element.obb.half_extents_mm = 0.5 * box.size();
  element.volume_mm3 = element.obb.volume_mm3();
  element.triangles.total = static_cast<std::uint32_t>(solid.triangles.size());
  element.triangles.other = element.triangles.total;
  element.features = std::move(features);
  return {std::move(element), std::make_shared<const FacetedSolid>(std::move(solid)), {}};
}

/// 240 x 160 x 40, top at z = 40. Holes A1 to C5, 40 mm apart, row A at y = -40, column 1 at
/// x = -80: a 12 mm bore 15 deep over an M12 core hole (10.106) to the bottom.
inline ProjectElement plate_element() {
  std::vector<DrilledHole> holes = hole_grid(5, 3, 40.0, 5.053);
  for (DrilledHole& hole : holes) {
    hole.counterbore_radius_mm = 6.0;
    hole.counterbore_depth_mm = 15.0;
  }
  std::vector<Feature> features;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 5; ++column) {
      features.push_back(
          hole_feature(std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1),
                       {40.0 * (column - 2), 40.0 * (row - 1), 40.0}, -Eigen::Vector3d::UnitZ(),
                       {{12.0, 15.0}, {10.106, 25.0}}, true));
    }
  }
  features.push_back(face_feature("top", {0, 0, 40}, Eigen::Vector3d::UnitZ(), 36000.0));
  features.push_back(face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), 36000.0));
  return element_of("T/plate-5x3", plate_with_holes({240, 160, 40}, holes, 24), features);
}

/// 60 x 60 x 40 with a clearance hole h1 of 13 mm through its middle.
inline ProjectElement riser_element() {
  DrilledHole hole;
  hole.radius_mm = 6.5;
  return element_of(
      "T/riser-60x60x40", plate_with_holes({60, 60, 40}, {hole}, 24),
      {hole_feature("h1", {0, 0, 40}, -Eigen::Vector3d::UnitZ(), {{13.0, 40.0}}, true),
       face_feature("top", {0, 0, 40}, Eigen::Vector3d::UnitZ(), 3467.0),
       face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), 3467.0),
       face_feature("right", {30, 0, 20}, Eigen::Vector3d::UnitX(), 2400.0)});
}

/// 30 long, 11.98 mm thick, stands on z = 0; pin1 points down.
inline ProjectElement pin_element() {
  return element_of("T/pin-12", cylinder(5.99, 30.0, 24),
                    {shaft_feature("pin1", {0, 0, 30}, -Eigen::Vector3d::UnitZ(), 11.98, 30.0),
                     face_feature("top", {0, 0, 30}, Eigen::Vector3d::UnitZ(), 112.0),
                     face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), 112.0)});
}

/// M12, 65 long under the head; the head stands on the face "seat" at z = 65.
inline ProjectElement screw_element() {
  return element_of("T/screw-M12x65", stepped_pin({{6.0, 65.0}, {9.0, 12.0}}, 24),
                    {shaft_feature("pin1", {0, 0, 65}, -Eigen::Vector3d::UnitZ(), 12.0, 65.0),
                     face_feature("seat", {0, 0, 65}, -Eigen::Vector3d::UnitZ(), 141.0),
                     face_feature("top", {0, 0, 77}, Eigen::Vector3d::UnitZ(), 254.0)});
}

/// 20 mm thick: too thick for every hole of the plate.
inline ProjectElement bolt_element() {
  return element_of("T/bolt-20", cylinder(10.0, 50.0, 24),
                    {shaft_feature("pin1", {0, 0, 50}, -Eigen::Vector3d::UnitZ(), 20.0, 50.0)});
}

/// 40 x 40 x 40 around its origin.
inline ProjectElement block_element() {
  return element_of("T/block-40", box({40, 40, 40}),
                    {face_feature("top", {0, 0, 20}, Eigen::Vector3d::UnitZ(), 1600.0),
                     face_feature("bottom", {0, 0, -20}, -Eigen::Vector3d::UnitZ(), 1600.0),
                     face_feature("right", {20, 0, 0}, Eigen::Vector3d::UnitX(), 1600.0),
                     face_feature("left", {-20, 0, 0}, -Eigen::Vector3d::UnitX(), 1600.0)});
}

inline std::vector<ProjectElement> fixture_elements() {
  return {plate_element(), riser_element(), pin_element(),
          screw_element(), bolt_element(),  block_element()};
}

/// A catalogue of all of them.
inline void write_fixture_catalog(const std::filesystem::path& file) {
  Catalog catalog(file, Catalog::Access::ReadWrite);
  for (const ProjectElement& element : fixture_elements()) {
    SourceRecord source;
    source.path = element.element.source;
    source.sha256 = std::string(64, 'a');
    source.status = "ok";
    const std::vector<ElementRecord> records{{element.element, *element.solid, element.brep}};
    catalog.put(source, records);
  }
}

}  // namespace dowel::testing
