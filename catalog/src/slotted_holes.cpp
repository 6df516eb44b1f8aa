#include "slotted_holes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "axis.h"
#include "disjoint_sets.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Lines that probe the void run this far off the middle, in widths of the slot.
constexpr double kProbeOffset = 0.05;

/// A half cylinder between two parallel walls.
struct RoundEnd {
  Eigen::Vector3d center;   ///< a point of its axis
  Eigen::Vector3d up;       ///< along its axis
  Eigen::Vector3d outward;  ///< from the walls to the cylinder
  double radius_mm = 0.0;
  std::uint32_t solid = 0;
  std::array<std::vector<std::size_t>, 2> walls;  ///< left and right of `outward` seen from above
  std::vector<std::uint32_t> faces;
};

bool are_of_one_cylinder(const CylinderSurface& a, const CylinderSurface& b) {
  return a.axis.cross(b.axis).norm() <= kCoaxial_rad &&
         std::abs(a.radius_mm - b.radius_mm) <= kSameFeature_mm &&
         Axis{a.origin, a.axis}.distance_mm(b.origin) <= kSameFeature_mm;
}

/// Neighbouring faces of one inner cylinder that walls run into without an edge.
std::vector<std::vector<std::size_t>> inner_cylinders(const SolidView& view) {
  const auto cylinder = [&](std::size_t face) {
    const FaceNode& node = view.graph[face];
    return node.reversed ? std::get_if<CylinderSurface>(&node.surface) : nullptr;
  };
  DisjointSets sets(view.graph.size());
  for (std::size_t face = 0; face < view.graph.size(); ++face) {
    const CylinderSurface* const here = cylinder(face);
    if (here == nullptr) continue;
    for (const std::uint32_t next : view.graph[face].neighbours) {
      const CylinderSurface* const there = cylinder(next);
      if (there != nullptr && are_of_one_cylinder(*here, *there)) sets.join(face, next);
    }
  }
  std::vector<std::vector<std::size_t>> result;
  for (std::vector<std::size_t>& faces : sets.sets()) {
    const bool has_wall = std::ranges::any_of(
        faces, [&](std::size_t face) { return !view.patches.tangent_patches[face].empty(); });
    if (has_wall && cylinder(faces.front()) != nullptr) result.push_back(std::move(faces));
  }
  return result;
}

/// Where a wall is closed by a floor square to the axis, it is a pocket.
bool has_floor(const SolidView& view, std::size_t wall, const Eigen::Vector3d& up) {
  return std::ranges::any_of(view.patches.links[wall], [&](const PatchLink& link) {
    const Eigen::Vector3d& normal = view.patches.patches[link.patch].plane.normal;
    return link.is_concave && normal.cross(up).norm() <= kCoaxial_rad;
  });
}

std::optional<RoundEnd> round_end(const SolidView& view, const std::vector<std::size_t>& faces) {
  RoundEnd end;
  // Which of the faces is asked must not matter: the first of them in space.
  const auto before = [&](std::size_t a, std::size_t b) {
    const auto& p = std::get<CylinderSurface>(view.graph[a].surface);
    const auto& q = std::get<CylinderSurface>(view.graph[b].surface);
    return std::lexicographical_compare(p.axis.data(), p.axis.data() + 3, q.axis.data(),
                                        q.axis.data() + 3);
  };
  const std::size_t first = *std::min_element(faces.begin(), faces.end(), before);
  const auto& cylinder = std::get<CylinderSurface>(view.graph[first].surface);
  end.center = cylinder.origin;
  end.up = upward(cylinder.axis);
  end.radius_mm = cylinder.radius_mm;
  end.solid = view.graph[first].solid;
  std::vector<std::size_t> walls;
  for (const std::size_t face : faces) {
    end.faces.push_back(static_cast<std::uint32_t>(face));
    const auto& tangent = view.patches.tangent_patches[face];
    walls.insert(walls.end(), tangent.begin(), tangent.end());
  }
  sort_unique(walls);
  std::erase_if(walls, [&](std::size_t wall) {
    return !are_square(view.patches.patches[wall].plane.normal, end.up);
  });
  if (walls.size() < 2) return std::nullopt;

  const PlaneSurface& plane = view.patches.patches[walls.front()].plane;
  end.outward = end.up.cross(plane.normal).normalized();
  const Extent reach =
      extent_along(view.solid, view.patches.patches[walls.front()].vertices, end.outward);
  if (0.5 * (reach.low_mm + reach.high_mm) > end.outward.dot(end.center)) {
    end.outward = -end.outward;
  }
  const Eigen::Vector3d left = end.up.cross(end.outward);
  for (const std::size_t wall : walls) {
    const Eigen::Vector3d& normal = view.patches.patches[wall].plane.normal;
    if (!are_square(normal, end.outward) || has_floor(view, wall, end.up)) return std::nullopt;
    end.walls[normal.dot(left) < 0.0 ? 0 : 1].push_back(wall);
  }
  if (end.walls[0].empty() || end.walls[1].empty()) return std::nullopt;
  return end;
}

/// How far apart two ends are that face each other over the same walls.
std::optional<double> distance_between(const SolidView& view, const RoundEnd& a,
                                       const RoundEnd& b) {
  if (a.solid != b.solid || std::abs(a.radius_mm - b.radius_mm) > kSameFeature_mm) {
    return std::nullopt;
  }
  if (a.up.cross(b.up).norm() > kCoaxial_rad || !are_opposite(a.outward, b.outward)) {
    return std::nullopt;
  }
  const double distance_mm = (a.center - b.center).dot(a.outward);
  if (distance_mm <= kSameFeature_mm) return std::nullopt;
  const auto& patches = view.patches.patches;
  const PlanePatch& wall_a = patches[a.walls[0].front()];
  const PlanePatch& wall_b = patches[b.walls[1].front()];
  if (!are_coplanar(view.solid, wall_a, wall_b)) return std::nullopt;
  const Extent depth_a = extent_along(view.solid, wall_a.vertices, a.up);
  const Extent depth_b = extent_along(view.solid, wall_b.vertices, a.up);
  if (std::min(depth_a.high_mm, depth_b.high_mm) <=
      std::max(depth_a.low_mm, depth_b.low_mm) + kSameFeature_mm) {
    return std::nullopt;
  }
  return distance_mm;
}

/// Height of the mouth on the side of `up`: the lower of the two sides.
double mouth_mm(const SolidView& view, const SlotFinding& slot, const Eigen::Vector3d& up,
                double width_mm, std::vector<std::uint32_t>& beyond) {
  double result_mm = std::numeric_limits<double>::infinity();
  for (const std::vector<std::size_t>& side : slot.walls) {
    double height_mm = -std::numeric_limits<double>::infinity();
    for (const std::size_t wall : side) {
      WallTop top = top_of_wall(view, view.patches.patches[wall], up, 0.5 * width_mm);
      height_mm = std::max(height_mm, top.height_mm);
      beyond.insert(beyond.end(), top.beyond.begin(), top.beyond.end());
    }
    result_mm = std::min(result_mm, height_mm);
  }
  return result_mm;
}

std::optional<SlotFinding> slotted_hole(const SolidView& view, const RoundEnd& a, const RoundEnd& b,
                                        double distance_mm) {
  const double width_mm = 2.0 * a.radius_mm;
  SlotFinding slot;
  std::vector<std::uint32_t>& faces = slot.feature.faces;
  for (const std::size_t side : {0U, 1U}) {
    slot.walls[side] = a.walls[side];
    const std::vector<std::size_t>& more = b.walls[1 - side];
    slot.walls[side].insert(slot.walls[side].end(), more.begin(), more.end());
    sort_unique(slot.walls[side]);
    for (const std::size_t wall : slot.walls[side]) {
      const std::vector<std::uint32_t>& of_wall = view.patches.patches[wall].faces;
      faces.insert(faces.end(), of_wall.begin(), of_wall.end());
    }
  }
  faces.insert(faces.end(), a.faces.begin(), a.faces.end());
  faces.insert(faces.end(), b.faces.begin(), b.faces.end());
  sort_unique(faces);

  std::vector<std::uint32_t> below;
  const double top_mm = mouth_mm(view, slot, a.up, width_mm, slot.mouth_faces);
  const double bottom_mm = -mouth_mm(view, slot, -a.up, width_mm, below);
  if (top_mm - bottom_mm <= kSameFeature_mm) return std::nullopt;
  const double height_mm = 0.5 * (top_mm + bottom_mm);
  const auto at = [&](const RoundEnd& end, double height) {
    return Eigen::Vector3d(end.center + (height - a.up.dot(end.center)) * a.up);
  };
  const double offset_mm = kProbeOffset * width_mm;
  const Eigen::Vector3d top = 0.5 * (at(a, top_mm) + at(b, top_mm));
  if (!is_void_between(view.solid, a.solid, at(b, height_mm), at(a, height_mm), offset_mm) ||
      !is_void_between(view.solid, a.solid, top - (top_mm - bottom_mm) * a.up, top, offset_mm)) {
    return std::nullopt;
  }
  Feature& feature = slot.feature;
  feature.kind = FeatureKind::Slot;
  feature.origin = top;
  feature.direction = -a.up;
  feature.diameter_mm = width_mm;
  feature.depth_mm = top_mm - bottom_mm;
  feature.through = true;
  feature.slot = SlotShape{.type = SlotShape::Type::Through,
                           .run = rightward(a.outward),
                           .length_mm = distance_mm + width_mm,
                           .ends = {SlotShape::End::Round, SlotShape::End::Round}};
  return slot;
}

}  // namespace

std::vector<SlotFinding> find_slotted_holes(const SolidView& view) {
  std::vector<RoundEnd> ends;
  for (const std::vector<std::size_t>& faces : inner_cylinders(view)) {
    if (auto end = round_end(view, faces)) ends.push_back(std::move(*end));
  }
  std::vector<SlotFinding> result;
  for (const RoundEnd& a : ends) {
    if (rightward(a.outward) != a.outward) continue;  // each pair once
    const RoundEnd* nearest = nullptr;
    double nearest_mm = 0.0;
    for (const RoundEnd& b : ends) {
      const std::optional<double> distance_mm = distance_between(view, a, b);
      if (!distance_mm || (nearest != nullptr && *distance_mm >= nearest_mm)) continue;
      nearest = &b;
      nearest_mm = *distance_mm;
    }
    if (nearest == nullptr) continue;
    if (auto slot = slotted_hole(view, a, *nearest, nearest_mm)) result.push_back(std::move(*slot));
  }
  return result;
}

}  // namespace dowel
