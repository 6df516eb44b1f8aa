#include <algorithm>
#include <utility>

#include "element.h"
#include "solids.h"

namespace dowel::bench {

namespace {

using testing::DrilledHole;

std::vector<std::uint32_t> bores(const FacetedSolid& solid) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const Face& face = solid.faces[f];
    if (face.reversed && std::holds_alternative<CylinderSurface>(face.surface)) result.push_back(f);
  }
  return result;
}

/// Strips of a drilled plate between its holes, along both sides.
std::vector<Aabb> strips(const Aabb& plate, const std::vector<DrilledHole>& holes) {
  std::vector<Aabb> result;
  for (const int axis : {0, 1}) {
    std::vector<std::pair<double, double>> spans;
    for (const DrilledHole& hole : holes) {
      const double at = axis == 0 ? hole.x : hole.y;
      spans.emplace_back(at - hole.radius_mm, at + hole.radius_mm);
    }
    std::sort(spans.begin(), spans.end());
    spans.emplace_back(plate.max[axis], plate.max[axis]);
    double reach = plate.min[axis];
    for (const auto& [low, high] : spans) {
      if (low > reach) {
        Aabb strip = plate;
        strip.min[axis] = reach;
        strip.max[axis] = low;
        result.push_back(strip);
      }
      reach = std::max(reach, high);
    }
  }
  return result;
}

/// Turns a prism that stands on z = 0 so that z becomes -y and y becomes z, without rounding.
FacetedSolid lying(FacetedSolid prism) {
  const auto turn = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), -p.z(), p.y()); };
  for (Eigen::Vector3d& p : prism.vertices) p = turn(p);
  for (Face& face : prism.faces) {
    auto& plane = std::get<PlaneSurface>(face.surface);
    plane = {turn(plane.origin), turn(plane.normal)};
  }
  for (Edge& edge : prism.edges) {
    edge.start = turn(edge.start);
    edge.end = turn(edge.end);
  }
  return prism;
}

}  // namespace

ElementPtr share(Element element) {
  return std::make_shared<const Element>(std::move(element));
}

Aabb box_of(double min_x, double min_y, double min_z, double max_x, double max_y, double max_z) {
  return {{min_x, min_y, min_z}, {max_x, max_y, max_z}};
}

Element element(std::string name, FacetedSolid solid, const Aabb& box) {
  Element result;
  result.name = std::move(name);
  result.hole_faces = bores(solid);
  result.solid = std::make_shared<const FacetedSolid>(std::move(solid));
  result.box = box;
  result.hull = {box};
  return result;
}

Element drilled_plate(std::string name, const Eigen::Vector3d& size,
                      const std::vector<DrilledHole>& holes, std::uint32_t segments) {
  const Aabb box =
      box_of(-0.5 * size.x(), -0.5 * size.y(), 0.0, 0.5 * size.x(), 0.5 * size.y(), size.z());
  Element result = element(std::move(name), testing::plate_with_holes(size, holes, segments), box);
  result.core = strips(box, holes);
  return result;
}

Element block(std::string name, const Eigen::Vector3d& size) {
  const Aabb box =
      box_of(-0.5 * size.x(), -0.5 * size.y(), 0.0, 0.5 * size.x(), 0.5 * size.y(), size.z());
  Element result = element(std::move(name), testing::box(size, {0.0, 0.0, 0.5 * size.z()}), box);
  result.core = {box};
  return result;
}

Element slotted_plate(double length_mm, double width_mm, double height_mm, std::uint32_t slots,
                      double pitch_mm) {
  constexpr double kNeck_mm = 7.0;  // half widths and depths of the slot
  constexpr double kFoot_mm = 11.5;
  constexpr double kNeckDepth_mm = 12.0;
  constexpr double kDepth_mm = 21.0;
  const double half = 0.5 * length_mm;
  const Aabb box = box_of(-half, -0.5 * width_mm, -height_mm, half, 0.5 * width_mm, 0.0);
  std::vector<Eigen::Vector2d> outline{{-half, -height_mm}, {half, -height_mm}, {half, 0.0}};
  std::vector<Aabb> core{box};
  core.front().max.z() = -kDepth_mm;
  double reach = -half;
  for (std::uint32_t i = 0; i < slots; ++i) {
    const double x = pitch_mm * (i - 0.5 * (slots - 1.0));
    Aabb land = box;
    land.min.x() = reach;
    land.max.x() = x - kNeck_mm;
    land.min.z() = -kNeckDepth_mm;
    core.push_back(land);
    reach = x + kNeck_mm;
  }
  core.push_back(box);
  core.back().min.x() = reach;
  core.back().min.z() = -kNeckDepth_mm;
  for (std::uint32_t i = slots; i-- > 0;) {
    const double x = pitch_mm * (i - 0.5 * (slots - 1.0));
    for (const auto& [dx, z] : {std::pair{kNeck_mm, 0.0},
                                {kNeck_mm, -kNeckDepth_mm},
                                {kFoot_mm, -kNeckDepth_mm},
                                {kFoot_mm, -kDepth_mm},
                                {-kFoot_mm, -kDepth_mm},
                                {-kFoot_mm, -kNeckDepth_mm},
                                {-kNeck_mm, -kNeckDepth_mm},
                                {-kNeck_mm, 0.0}}) {
      outline.emplace_back(x + dx, z);
    }
  }
  outline.emplace_back(-half, 0.0);
  FacetedSolid solid = lying(testing::prism(outline, width_mm));
  for (Eigen::Vector3d& p : solid.vertices) p.y() += 0.5 * width_mm;
  for (Face& face : solid.faces) std::get<PlaneSurface>(face.surface).origin.y() += 0.5 * width_mm;
  for (Edge& edge : solid.edges) {
    edge.start.y() += 0.5 * width_mm;
    edge.end.y() += 0.5 * width_mm;
  }
  Element result = element("slotted plate", std::move(solid), box);
  result.core = std::move(core);
  return result;
}

}  // namespace dowel::bench
