#include "groove_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "disjoint_sets.h"
#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// What faces the floor at less than about 84 degrees hangs over it.
constexpr double kFacesFloor = 0.1;

/// A wall farther away is hidden by a nearer one that takes up this much of what they share; not a
/// simple fraction, so that none decides by rounding.
constexpr double kHiddenShare = 0.55;

/// A wall is cut from a bar where the bar's round takes up more of its run than this; fillets of a
/// block's edges take less.
constexpr double kOnBarShare = 0.8;

/// Whether floors that do not meet belong together is probed this far above them, in widths.
constexpr double kProbeHeight = 0.05;

const PlanePatch& patch(const SolidView& view, std::size_t index) {
  return view.patches.patches[index];
}

/// The wall above a ledge, nearest to the ledge's own wall.
std::vector<std::size_t> throats_of(const SolidView& view, const PlanePatch& wall,
                                    const std::vector<std::size_t>& ledges,
                                    const Eigen::Vector3d& up) {
  const Eigen::Vector3d& normal = wall.plane.normal;
  const auto setback_mm = [&](std::size_t throat) {
    return normal.dot(patch(view, throat).plane.origin - wall.plane.origin);
  };
  std::vector<std::size_t> result;
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const std::size_t ledge : ledges) {
    for (const PatchLink& link : view.patches.links[ledge]) {
      const Eigen::Vector3d& other = patch(view, link.patch).plane.normal;
      if (link.is_concave || !are_square(other, up) || !are_opposite(other, -normal)) continue;
      if (setback_mm(link.patch) <= kSameFeature_mm) continue;
      nearest_mm = std::min(nearest_mm, setback_mm(link.patch));
      result.push_back(link.patch);
    }
  }
  std::erase_if(result, [&](std::size_t throat) {
    return setback_mm(throat) > nearest_mm + kSameFeature_mm;
  });
  sort_unique(result);
  return result;
}

void look_up(const SolidView& view, const Eigen::Vector3d& up, GrooveSide& side) {
  for (const PatchLink& link : view.patches.links[side.wall]) {
    const Eigen::Vector3d& normal = patch(view, link.patch).plane.normal;
    if (!link.is_concave || normal.dot(up) >= -kFacesFloor) continue;
    side.ledges.push_back(link.patch);
    side.is_open = side.is_open && are_opposite(normal, up);
  }
  sort_unique(side.ledges);
  if (side.ledges.empty() || !side.is_open) return;
  side.throats = throats_of(view, patch(view, side.wall), side.ledges, up);
  side.is_open = !side.throats.empty();
}

/// Whether a wall ends at its top in the round of a bar that its groove crosses, as the walls of
/// wrench flats do.
bool is_cut_from_bar(const SolidView& view, const PlanePatch& wall, const Eigen::Vector3d& run) {
  double on_bar_mm = 0.0;
  for (const std::uint32_t face : wall.faces) {
    for (const RimEdge& edge : view.graph[face].rim) {
      const FaceNode& across = view.graph[edge.face_across];
      const auto* const bar = std::get_if<CylinderSurface>(&across.surface);
      if (bar == nullptr || across.reversed) continue;
      if (bar->axis.cross(wall.plane.normal).norm() > kCoaxial_rad) continue;
      on_bar_mm += std::abs(run.dot(view.solid.vertices[edge.to] - view.solid.vertices[edge.from]));
    }
  }
  return on_bar_mm > kOnBarShare * extent_along(view.solid, wall.vertices, run).length_mm();
}

/// Walls that stand on the floors, each once.
std::vector<GrooveSide> sides_on(const SolidView& view, const std::vector<std::size_t>& floors,
                                 const Eigen::Vector3d& up) {
  std::map<std::size_t, GrooveSide> by_wall;
  for (const std::size_t floor : floors) {
    for (const PatchLink& link : view.patches.links[floor]) {
      const PlanePatch& wall = patch(view, link.patch);
      if (!link.is_concave || !are_square(wall.plane.normal, up)) continue;
      if (is_cut_from_bar(view, wall, run_of(up, wall.plane.normal))) continue;
      GrooveSide& side = by_wall[link.patch];
      side.wall = link.patch;
      side.floors.push_back(floor);
      if (link.fillet != PatchLink::kNoFillet) side.fillets.push_back(link.fillet);
    }
  }
  std::vector<GrooveSide> result;
  for (auto& [index, side] : by_wall) {
    const PlanePatch& wall = patch(view, index);
    side.run = extent_along(view.solid, wall.vertices, run_of(up, wall.plane.normal));
    sort_unique(side.floors);
    look_up(view, up, side);
    result.push_back(std::move(side));
  }
  return result;
}

/// Width between two walls that face each other.
std::optional<double> width_between(const SolidView& view, const GrooveSide& a,
                                    const GrooveSide& b) {
  const PlaneSurface& p = patch(view, a.wall).plane;
  const PlaneSurface& q = patch(view, b.wall).plane;
  if (patch(view, a.wall).solid != patch(view, b.wall).solid) return std::nullopt;
  if (!are_opposite(p.normal, q.normal)) return std::nullopt;
  const double width_mm = p.normal.dot(q.origin - p.origin);
  return width_mm > kSameFeature_mm ? std::optional(width_mm) : std::nullopt;
}

Extent shared(const Extent& a, const Extent& b) {
  return {std::max(a.low_mm, b.low_mm), std::min(a.high_mm, b.high_mm)};
}

/// Sides that `from` faces and that no nearer one hides.
std::vector<std::size_t> faced_sides(const SolidView& view, const std::vector<GrooveSide>& sides,
                                     std::size_t from) {
  std::vector<std::pair<double, std::size_t>> by_width;
  for (std::size_t to = 0; to < sides.size(); ++to) {
    if (shared(sides[from].run, sides[to].run).length_mm() <= kSameFeature_mm) continue;
    const auto width_mm = width_between(view, sides[from], sides[to]);
    if (width_mm) by_width.emplace_back(*width_mm, to);
  }
  std::sort(by_width.begin(), by_width.end());
  std::vector<std::size_t> result;
  std::vector<std::pair<double, Extent>> nearer;
  for (const auto& [width_mm, to] : by_width) {
    const Extent over = shared(sides[from].run, sides[to].run);
    const bool is_hidden = std::ranges::any_of(nearer, [&, width = width_mm](const auto& other) {
      return other.first < width - kSameFeature_mm &&
             shared(over, other.second).length_mm() > kHiddenShare * over.length_mm();
    });
    if (is_hidden) continue;
    nearer.emplace_back(width_mm, over);
    result.push_back(to);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Floors that do not meet are one where nothing stands between them.
bool share_floor(const SolidView& view, const GrooveSide& a, const GrooveSide& b,
                 const Eigen::Vector3d& up, double floor_mm) {
  std::vector<std::size_t> common;
  std::set_intersection(a.floors.begin(), a.floors.end(), b.floors.begin(), b.floors.end(),
                        std::back_inserter(common));
  if (!common.empty()) return true;
  const PlaneSurface& p = patch(view, a.wall).plane;
  const double width_mm = width_between(view, a, b).value_or(0.0);
  const Eigen::Vector3d run = run_of(up, p.normal);
  const Extent over = shared(a.run, b.run);
  const double probe_mm = kProbeHeight * width_mm;
  const Eigen::Vector3d from = p.normal.dot(p.origin) * p.normal +
                               0.5 * (over.low_mm + over.high_mm) * run +
                               (floor_mm + 2.0 * probe_mm) * up;
  return is_void_between(view.solid, patch(view, a.wall).solid, from + probe_mm * p.normal,
                         from + (width_mm - probe_mm) * p.normal, probe_mm);
}

std::vector<GroovePiece> pieces_of(const SolidView& view, const std::vector<GrooveSide>& sides,
                                   const Eigen::Vector3d& up, double floor_mm) {
  std::vector<std::vector<std::size_t>> faced;
  for (std::size_t i = 0; i < sides.size(); ++i) faced.push_back(faced_sides(view, sides, i));
  std::vector<GroovePiece> pieces;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (const std::size_t j : faced[i]) {
      const GrooveSide& a = sides[i];
      const GrooveSide& b = sides[j];
      if (j <= i || !std::binary_search(faced[j].begin(), faced[j].end(), i)) continue;
      if (!a.is_open || !b.is_open || a.ledges.empty() != b.ledges.empty()) continue;
      if (!share_floor(view, a, b, up, floor_mm)) continue;
      pieces.push_back({{a, b}, shared(a.run, b.run)});
    }
  }
  return pieces;
}

bool has_walls(const SolidView& view, std::size_t floor) {
  const Eigen::Vector3d& up = patch(view, floor).plane.normal;
  return std::ranges::any_of(view.patches.links[floor], [&](const PatchLink& link) {
    return link.is_concave && are_square(patch(view, link.patch).plane.normal, up);
  });
}

/// Patches with walls on them, those of one plane together.
std::vector<std::vector<std::size_t>> floors_by_plane(const SolidView& view) {
  std::vector<std::size_t> floors;
  for (std::size_t i = 0; i < view.patches.patches.size(); ++i) {
    if (has_walls(view, i)) floors.push_back(i);
  }
  const auto offset_mm = [&](std::size_t i) {
    const PlaneSurface& plane = patch(view, floors[i]).plane;
    return plane.normal.dot(plane.origin);
  };
  std::vector<std::size_t> order(floors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return offset_mm(a) < offset_mm(b); });
  DisjointSets sets(floors.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (offset_mm(order[j]) - offset_mm(order[i]) > 2.0 * kSameFeature_mm) break;
      const PlanePatch& a = patch(view, floors[order[i]]);
      const PlanePatch& b = patch(view, floors[order[j]]);
      if (a.solid == b.solid && are_coplanar(view.solid, a, b)) sets.join(order[i], order[j]);
    }
  }
  std::vector<std::vector<std::size_t>> result;
  for (const std::vector<std::size_t>& members : sets.sets()) {
    std::vector<std::size_t> plane;
    plane.reserve(members.size());
    for (const std::size_t i : members) plane.push_back(floors[i]);
    result.push_back(std::move(plane));
  }
  return result;
}

}  // namespace

Eigen::Vector3d run_of(const Eigen::Vector3d& up, const Eigen::Vector3d& normal) {
  return rightward(up.cross(normal).normalized());
}

std::vector<GrooveFloor> groove_floors(const SolidView& view) {
  std::vector<GrooveFloor> result;
  for (const std::vector<std::size_t>& floors : floors_by_plane(view)) {
    const PlaneSurface& plane = patch(view, largest_patch(view, floors)).plane;
    GrooveFloor floor;
    floor.up = plane.normal;
    floor.height_mm = plane.normal.dot(plane.origin);
    floor.pieces = pieces_of(view, sides_on(view, floors, floor.up), floor.up, floor.height_mm);
    if (!floor.pieces.empty()) result.push_back(std::move(floor));
  }
  return result;
}

}  // namespace dowel
