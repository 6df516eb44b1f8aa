#include "slot_geometry.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "core_line.h"
#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

Eigen::Vector3d with_sense(const Eigen::Vector3d& direction,
                           std::initializer_list<Eigen::Index> order) {
  for (const Eigen::Index i : order) {
    if (std::abs(direction[i]) > kUnitVectorSlack) {
      return direction[i] > 0.0 ? direction : Eigen::Vector3d(-direction);
    }
  }
  return direction;
}

/// A chamfer or rounding between the wall's top and what lies beyond.
bool is_bevel(const SolidView& view, const PlanePatch& wall, const Eigen::Vector3d& up,
              std::uint32_t face, double widest_mm) {
  const FaceNode& node = view.graph[face];
  const Eigen::Vector3d& normal = wall.plane.normal;
  if (const auto* plane = std::get_if<PlaneSurface>(&node.surface)) {
    if (plane->normal.dot(up) <= kTangent_rad || plane->normal.dot(normal) <= kTangent_rad ||
        !are_square(plane->normal, up.cross(normal).normalized())) {
      return false;
    }
  } else if (const auto* cylinder = std::get_if<CylinderSurface>(&node.surface)) {
    if (node.reversed || !are_square(cylinder->axis, up) || !are_square(cylinder->axis, normal)) {
      return false;
    }
  } else {
    return false;
  }
  return extent_along(view.solid, node.vertices, normal).length_mm() <= widest_mm;
}

template <class T>
void make_sorted_set(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

void sort_unique(std::vector<std::uint32_t>& values) {
  make_sorted_set(values);
}

void sort_unique(std::vector<std::size_t>& values) {
  make_sorted_set(values);
}

Extent extent_along(const FacetedSolid& solid, const std::vector<std::uint32_t>& vertices,
                    const Eigen::Vector3d& direction) {
  Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const std::uint32_t v : vertices) {
    const double height_mm = direction.dot(solid.vertices[v]);
    extent.low_mm = std::min(extent.low_mm, height_mm);
    extent.high_mm = std::max(extent.high_mm, height_mm);
  }
  return extent;
}

std::size_t largest_patch(const SolidView& view, const std::vector<std::size_t>& patches) {
  return *std::ranges::min_element(patches, [&](std::size_t a, std::size_t b) {
    const PlanePatch& p = view.patches.patches[a];
    const PlanePatch& q = view.patches.patches[b];
    if (p.area_mm2 != q.area_mm2) return p.area_mm2 > q.area_mm2;
    return less_by_coordinates(p.plane.normal, q.plane.normal);
  });
}

bool are_square(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) <= kCoaxial_rad;
}

bool are_opposite(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.dot(b) < 0.0 && a.cross(b).norm() <= kCoaxial_rad;
}

Eigen::Vector3d rightward(const Eigen::Vector3d& direction) {
  return with_sense(direction, {0, 1, 2});
}

Eigen::Vector3d upward(const Eigen::Vector3d& direction) {
  return with_sense(direction, {2, 1, 0});
}

WallTop top_of_wall(const SolidView& view, const PlanePatch& wall, const Eigen::Vector3d& up,
                    double widest_bevel_mm) {
  WallTop top;
  const double edge_mm = extent_along(view.solid, wall.vertices, up).high_mm;
  top.height_mm = edge_mm;
  for (const std::uint32_t face : wall.faces) {
    for (const RimEdge& edge : view.graph[face].rim) {
      const double low_mm =
          std::min(up.dot(view.solid.vertices[edge.from]), up.dot(view.solid.vertices[edge.to]));
      if (low_mm < edge_mm - kSameFeature_mm) continue;
      const std::uint32_t across = edge.face_across;
      if (!is_bevel(view, wall, up, across, widest_bevel_mm)) {
        top.beyond.push_back(across);
        continue;
      }
      const std::vector<std::uint32_t>& vertices = view.graph[across].vertices;
      top.height_mm = std::max(top.height_mm, extent_along(view.solid, vertices, up).high_mm);
      const std::vector<std::uint32_t>& next = view.graph[across].neighbours;
      top.beyond.insert(top.beyond.end(), next.begin(), next.end());
    }
  }
  sort_unique(top.beyond);
  return top;
}

bool is_void_between(const FacetedSolid& solid, std::uint32_t lump, const Eigen::Vector3d& from,
                     const Eigen::Vector3d& to, double offset_mm) {
  const double length_mm = (to - from).norm();
  if (length_mm <= kSameFeature_mm) return true;
  const Axis axis{from, (to - from) / length_mm};
  const std::vector<VoidStretch> stretches = VoidFinder(solid).along(lump, axis, offset_mm);
  return std::ranges::any_of(stretches, [&](const VoidStretch& stretch) {
    return stretch.low_mm <= kSameFeature_mm && stretch.high_mm >= length_mm - kSameFeature_mm;
  });
}

}  // namespace dowel
