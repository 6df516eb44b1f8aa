#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "disjoint_sets.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "inward.h"
#include "mesh_edges.h"

namespace dowel {
namespace {

/// Triangles that hang together through their edges.
struct Component {
  std::vector<std::uint32_t> triangles;
  bool is_closed = true;  ///< each edge used once in each direction
  double volume_mm3 = 0.0;
  std::uint32_t solid = 0;
  Aabb bounds;
  bool to_turn = false;
};

std::vector<Component> components_of(const FacetedSolid& solid) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(solid);
  std::vector<std::uint32_t> parent(solid.triangles.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) {
      // The lower index becomes the root, so that components come in the order of triangles.
      const std::uint32_t a = root_of(parent, uses[first].triangle);
      const std::uint32_t b = root_of(parent, uses[i].triangle);
      parent[std::max(a, b)] = std::min(a, b);
    }
  });

  std::vector<Component> components;
  std::vector<std::uint32_t> component_of(solid.triangles.size());
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    const std::uint32_t root = root_of(parent, i);
    if (root == i) {
      component_of[i] = static_cast<std::uint32_t>(components.size());
      components.emplace_back().solid = solid.faces[solid.face_of[i]].solid;
    } else {
      component_of[i] = component_of[root];
    }
    Component& component = components[component_of[i]];
    component.triangles.push_back(i);
    for (const Eigen::Vector3d& corner : solid.corners(i)) component.bounds.extend(corner);
  }
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2 || uses[first].upwards == uses[first + 1].upwards) {
      components[component_of[uses[first].triangle]].is_closed = false;
    }
  });
  for (Component& component : components) {
    const Eigen::Vector3d center = component.bounds.center();
    for (const std::uint32_t i : component.triangles) {
      component.volume_mm3 += signed_volume_mm3(solid.corners(i), center);
    }
  }
  return components;
}

/// How often the component's surface goes around `point`, in turns: 0 outside, 1 or -1 inside.
/// Source: Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983.
double winding_number(const FacetedSolid& solid, const Component& component,
                      const Eigen::Vector3d& point) {
  double angle_rad = 0.0;
  for (const std::uint32_t i : component.triangles) {
    const std::array<Eigen::Vector3d, 3> corners = solid.corners(i);
    const Eigen::Vector3d a = corners[0] - point;
    const Eigen::Vector3d b = corners[1] - point;
    const Eigen::Vector3d c = corners[2] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle_rad += 2.0 * std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle_rad / (4.0 * std::numbers::pi);
}

bool lies_inside(const FacetedSolid& solid, const Component& inner, const Component& outer) {
  if (!outer.is_closed || inner.solid != outer.solid || !outer.bounds.contains(inner.bounds)) {
    return false;
  }
  const std::array<Eigen::Vector3d, 3> corners = solid.corners(inner.triangles.front());
  const Eigen::Vector3d point = (corners[0] + corners[1] + corners[2]) / 3.0;
  return std::abs(winding_number(solid, outer, point)) > 0.5;
}

/// Turns outermost components outward. What lies inside one that turned was described from the same
/// wrong side, and gets the sense that its depth of nesting asks for; other cavities are kept.
void choose_components_to_turn(const FacetedSolid& solid, std::vector<Component>& components) {
  const std::size_t count = components.size();
  std::vector<std::vector<std::size_t>> containers(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i != j && lies_inside(solid, components[i], components[j])) containers[i].push_back(j);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!components[i].is_closed) continue;
    std::size_t outermost = i;
    for (const std::size_t j : containers[i]) {
      if (containers[j].empty()) outermost = j;
    }
    if (components[outermost].volume_mm3 >= 0.0) continue;
    const bool is_cavity = containers[i].size() % 2 == 1;
    components[i].to_turn = (components[i].volume_mm3 > 0.0) == is_cavity;
  }
}

}  // namespace

std::vector<double> agreement_of_faces(const FacetedSolid& solid) {
  std::vector<double> result(solid.faces.size(), 0.0);
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    const Face& face = solid.faces[solid.face_of[i]];
    if (std::holds_alternative<OtherSurface>(face.surface)) continue;
    const std::array<Eigen::Vector3d, 3> corners = solid.corners(i);
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // The corners are on the exact face; the middle of a coarse facet may be beyond a fillet's
    // tube.
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners) {
      outward += distance_gradient(face.surface, corner);
    }
    const double cosine = normal.dot(outward) / 3.0;
    result[solid.face_of[i]] += face.reversed ? -cosine : cosine;
  }
  return result;
}

namespace {

/// Makes the exact faces agree with their facets where these turned. Returns which faces changed.
std::vector<bool> align_faces(FacetedSolid& solid, const std::vector<bool>& is_turned) {
  std::vector<bool> has_turned(solid.faces.size(), false);
  const std::vector<double> agreement = agreement_of_faces(solid);
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    if (is_turned[i]) has_turned[solid.face_of[i]] = true;
  }
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    Face& face = solid.faces[f];
    if (!has_turned[f] || agreement[f] >= 0.0) continue;
    if (auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      plane->normal = -plane->normal;
    } else {
      face.reversed = !face.reversed;
    }
  }
  return has_turned;
}

Convexity turned(Convexity convexity) {
  switch (convexity) {
    case Convexity::Convex:
      return Convexity::Concave;
    case Convexity::Concave:
      return Convexity::Convex;
    case Convexity::Unknown:
    case Convexity::Smooth:
      break;
  }
  return convexity;
}

}  // namespace

std::optional<std::uint32_t> find_inward_component(const FacetedSolid& solid) {
  const std::vector<Component> components = components_of(solid);
  for (const Component& component : components) {
    const double size_mm = component.bounds.size().norm();
    if (component.volume_mm3 >= -kRounding * size_mm * size_mm * size_mm) continue;
    const bool is_inside = std::ranges::any_of(components, [&](const Component& other) {
      return &other != &component && lies_inside(solid, component, other);
    });
    if (!is_inside) return component.triangles.front();
  }
  return std::nullopt;
}

void orient_outward(FacetedSolid& solid) {
  std::vector<Component> components = components_of(solid);
  if (std::none_of(components.begin(), components.end(),
                   [](const Component& c) { return c.is_closed && c.volume_mm3 < 0.0; })) {
    return;
  }
  choose_components_to_turn(solid, components);

  std::vector<bool> is_turned(solid.triangles.size(), false);
  for (const Component& component : components) {
    if (!component.to_turn) continue;
    for (const std::uint32_t i : component.triangles) {
      std::swap(solid.triangles[i][1], solid.triangles[i][2]);
      is_turned[i] = true;
    }
  }
  const std::vector<bool> has_turned = align_faces(solid, is_turned);
  for (Edge& edge : solid.edges) {
    if (has_turned[edge.faces[0]] && has_turned[edge.faces[1]]) {
      edge.convexity = turned(edge.convexity);
    }
  }
}

}  // namespace dowel
