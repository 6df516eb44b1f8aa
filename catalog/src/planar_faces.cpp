#include "planar_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "axis.h"
#include "disjoint_sets.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

const PlaneSurface& plane_of(const FaceNode& node) {
  return std::get<PlaneSurface>(node.surface);
}

/// Area and first moment of pieces of one plane, about a point of it.
struct PlaneSums {
  std::vector<double> areas_mm2;
  std::vector<Eigen::Vector3d> moments_mm3;
  void add(double area_mm2, const Eigen::Vector3d& centroid) {
    areas_mm2.push_back(area_mm2);
    moments_mm3.push_back(area_mm2 * centroid);
  }
};

/// Facets between two corners of a circle leave out (or put in) the segment between chord and arc.
/// False where something else than lines and circles bounds the face, too.
bool add_circle_segments(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                         const FaceNode& node, const Eigen::Vector3d& middle, PlaneSums& sums) {
  const PlaneSurface& plane = plane_of(node);
  bool is_exact = true;
  for (const RimEdge& edge : node.rim) {
    const Surface& wall = graph[edge.face_across].surface;
    const std::optional<Eigen::Vector3d> center = circle_center(wall, plane);
    is_exact = is_exact && (center || is_plane(wall));
    if (!center) continue;
    const Eigen::Vector3d a = solid.vertices[edge.from] - *center;
    const Eigen::Vector3d b = solid.vertices[edge.to] - *center;
    // Positive where the face lies inside the circle: its rim runs counter-clockwise.
    const double angle_rad = std::atan2(plane.normal.dot(a.cross(b)), a.dot(b));
    const double radius_mm = 0.5 * (a.norm() + b.norm());
    const double area_mm2 = 0.5 * radius_mm * radius_mm * (angle_rad - std::sin(angle_rad));
    const Eigen::Vector3d bisector = a + b;
    if (!(std::abs(area_mm2) > 0.0) || !(bisector.norm() > 0.0)) continue;
    const double half_chord = std::sin(0.5 * std::abs(angle_rad));
    const double reach_mm = 2.0 / 3.0 * std::pow(radius_mm * half_chord, 3) / std::abs(area_mm2);
    sums.add(area_mm2, *center + reach_mm * bisector.normalized() - middle);
  }
  return is_exact;
}

Feature make_face(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                  std::vector<std::uint32_t> faces) {
  const PlaneSurface& plane = plane_of(graph[largest_face(graph, faces)]);
  PlaneSums sums;
  std::vector<double> stated_areas_mm2;
  bool is_exact = true;
  for (const std::uint32_t face : faces) {
    stated_areas_mm2.push_back(graph[face].area_mm2);
    for (const std::uint32_t t : graph[face].triangles) {
      const auto corners = canonical_corners(solid, t);
      sums.add(0.5 * plane.normal.dot(doubled_area(corners)),
               (corners[0] + corners[1] + corners[2]) / 3.0 - plane.origin);
    }
    is_exact = add_circle_segments(solid, graph, graph[face], plane.origin, sums) && is_exact;
  }
  Feature feature;
  feature.kind = FeatureKind::Face;
  feature.direction = plane.normal;
  const double area_mm2 = ordered_sum(sums.areas_mm2);
  // A CAD kernel integrates along the curves of a file, some of which are splines near a circle.
  feature.area_mm2 = is_exact ? area_mm2 : ordered_sum(stated_areas_mm2);
  feature.origin = plane.origin;
  if (area_mm2 > 0.0) {
    const Eigen::Vector3d centroid = ordered_sum(sums.moments_mm3) / area_mm2;
    feature.origin += centroid - plane.normal.dot(centroid) * plane.normal;
  }
  std::sort(faces.begin(), faces.end());
  feature.faces = std::move(faces);
  return feature;
}

bool are_coplanar(const FacetedSolid& solid, const FaceNode& a, const FaceNode& b) {
  const PlaneSurface& plane = plane_of(a);
  if (plane.normal.dot(plane_of(b).normal) <= 0.0) return false;
  return std::all_of(b.vertices.begin(), b.vertices.end(), [&](std::uint32_t v) {
    return std::abs(plane.normal.dot(solid.vertices[v] - plane.origin)) <= kSameFeature_mm;
  });
}

/// Planar faces across which the surface turns, but little, by face. Pieces of one plane do not.
std::vector<std::vector<std::uint32_t>> near_tangent_neighbours(
    const std::vector<FaceNode>& graph) {
  const double least_cosine = std::cos(kCrease_rad);
  std::vector<std::vector<std::uint32_t>> result(graph.size());
  for (std::size_t face = 0; face < graph.size(); ++face) {
    for (const std::uint32_t next : graph[face].neighbours) {
      const Eigen::Vector3d& here = plane_of(graph[face]).normal;
      const Eigen::Vector3d& there = plane_of(graph[next]).normal;
      if (here.dot(there) > least_cosine && here.cross(there).norm() > kCoaxial_rad) {
        result[face].push_back(next);
      }
    }
  }
  return result;
}

/// Faces that are no faces of their own but the facets of a curved one: a mesh file has only
/// planes, and the facets of a bore or a ball come in chains that turn little from one to the next.
/// A shallow chamfer ends at its face and so is none.
std::vector<bool> facets_of_curves(const std::vector<FaceNode>& graph) {
  std::vector<bool> result(graph.size(), false);
  const bool is_polyhedron = std::all_of(
      graph.begin(), graph.end(), [](const FaceNode& node) { return is_plane(node.surface); });
  if (!is_polyhedron) return result;
  const std::vector<std::vector<std::uint32_t>> next = near_tangent_neighbours(graph);
  for (std::size_t face = 0; face < graph.size(); ++face) {
    const auto in_chain =
        std::count_if(next[face].begin(), next[face].end(),
                      [&](std::uint32_t neighbour) { return next[neighbour].size() >= 2; });
    result[face] = in_chain >= 2;
  }
  return result;
}

}  // namespace

std::optional<Eigen::Vector3d> circle_center(const Surface& wall, const PlaneSurface& plane) {
  Axis axis;
  if (const auto* cylinder = std::get_if<CylinderSurface>(&wall)) {
    axis = {cylinder->origin, cylinder->axis};
  } else if (const auto* cone = std::get_if<ConeSurface>(&wall)) {
    axis = {cone->apex, cone->axis};
  } else if (const auto* torus = std::get_if<TorusSurface>(&wall)) {
    axis = {torus->center, torus->axis};
  } else if (const auto* sphere = std::get_if<SphereSurface>(&wall)) {
    axis = {sphere->center, plane.normal};
  } else {
    return std::nullopt;
  }
  if (!axis.is_parallel(plane.normal)) return std::nullopt;
  return axis.at(axis.height_mm(plane));
}

std::uint32_t largest_face(const std::vector<FaceNode>& graph,
                           const std::vector<std::uint32_t>& faces) {
  return *std::min_element(faces.begin(), faces.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (graph[a].area_mm2 != graph[b].area_mm2) return graph[a].area_mm2 > graph[b].area_mm2;
    return less_by_coordinates(plane_of(graph[a]).normal, plane_of(graph[b]).normal);
  });
}

std::vector<std::vector<std::uint32_t>> coplanar_sets(const FacetedSolid& solid,
                                                      const std::vector<FaceNode>& graph,
                                                      const std::vector<bool>& is_taken) {
  const std::vector<bool> is_facet = facets_of_curves(graph);
  const auto is_wanted = [&](std::size_t face) {
    return is_plane(graph[face].surface) && !is_taken[face] && !is_facet[face] &&
           !graph[face].triangles.empty();
  };
  DisjointSets sets(graph.size());
  for (std::size_t face = 0; face < graph.size(); ++face) {
    if (!is_wanted(face)) continue;
    for (const std::uint32_t next : graph[face].neighbours) {
      if (next <= face || !is_wanted(next)) continue;
      if (are_coplanar(solid, graph[face], graph[next]) ||
          are_coplanar(solid, graph[next], graph[face])) {
        sets.join(face, next);
      }
    }
  }
  std::vector<std::vector<std::uint32_t>> result;
  for (const std::vector<std::size_t>& members : sets.sets()) {
    if (!is_wanted(members.front())) continue;
    std::vector<std::uint32_t> faces;
    faces.reserve(members.size());
    for (const std::size_t face : members) faces.push_back(static_cast<std::uint32_t>(face));
    result.push_back(std::move(faces));
  }
  return result;
}

std::vector<Feature> find_planar_faces(const FacetedSolid& solid,
                                       const std::vector<FaceNode>& graph,
                                       const std::vector<bool>& is_taken) {
  std::vector<Feature> result;
  for (std::vector<std::uint32_t>& faces : coplanar_sets(solid, graph, is_taken)) {
    result.push_back(make_face(solid, graph, std::move(faces)));
  }
  return result;
}

}  // namespace dowel
