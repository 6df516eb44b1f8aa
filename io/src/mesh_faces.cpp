#include "mesh_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "dowel/kernel/box.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct HalfEdge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t triangle = 0;
  std::uint32_t side = 0;  ///< the triangle's edge from corner `side` to the next

  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_uses(const FacetedSolid& mesh) {
  std::vector<HalfEdge> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k];
      const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const HalfEdge& a, const HalfEdge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return uses;
}

using Neighbours = std::vector<std::array<std::uint32_t, 3>>;

Neighbours neighbours_of(const FacetedSolid& mesh) {
  const std::vector<HalfEdge> uses = sorted_uses(mesh);
  Neighbours neighbours(mesh.triangles.size(), {kNone, kNone, kNone});
  for (std::size_t i = 1; i < uses.size(); ++i) {
    const HalfEdge& a = uses[i - 1];
    const HalfEdge& b = uses[i];
    if (!a.same_edge(b)) continue;
    neighbours[a.triangle][a.side] = b.triangle;
    neighbours[b.triangle][b.side] = a.triangle;
  }
  return neighbours;
}

Vector3d doubled_area(const FacetedSolid& mesh, std::uint32_t triangle) {
  const auto corners = mesh.corners(triangle);
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Grows faces from the largest triangles, whose planes are the best known.
void group_coplanar(const Neighbours& neighbours, FacetedSolid& mesh) {
  const double tolerance_mm = kCoplanarRatio * bounds(mesh.vertices).size().norm();
  std::vector<double> area(mesh.triangles.size());
  for (std::uint32_t t = 0; t < area.size(); ++t) area[t] = 0.5 * doubled_area(mesh, t).norm();
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
  mesh.faces.clear();
  mesh.face_of.assign(mesh.triangles.size(), kNone);
  for (const std::uint32_t seed : order) {
    if (mesh.face_of[seed] != kNone) continue;
    const Vector3d normal = doubled_area(mesh, seed);
    const auto index = static_cast<std::uint32_t>(mesh.faces.size());
    Face face;
    // A needle without area that joined no neighbour has no plane to speak of.
    const bool has_plane = normal.norm() > 0.0;
    const PlaneSurface plane{mesh.corners(seed)[0],
                             has_plane ? Vector3d(normal.normalized()) : Vector3d::UnitZ()};
    if (has_plane) face.surface = plane;
    mesh.face_of[seed] = index;
    std::vector<std::uint32_t> front{seed};
    while (!front.empty()) {
      const std::uint32_t t = front.back();
      front.pop_back();
      face.area_mm2 += area[t];
      for (const std::uint32_t next : neighbours[t]) {
        if (!has_plane || next == kNone || mesh.face_of[next] != kNone) continue;
        if (doubled_area(mesh, next).dot(plane.normal) < 0.0) continue;
        const auto corners = mesh.corners(next);
        const bool is_coplanar = std::all_of(corners.begin(), corners.end(), [&](const auto& c) {
          return std::abs((c - plane.origin).dot(plane.normal)) <= tolerance_mm;
        });
        if (!is_coplanar) continue;
        mesh.face_of[next] = index;
        front.push_back(next);
      }
    }
    mesh.faces.push_back(face);
  }
}

struct Shell {
  Aabb bounds;
  double volume_mm3 = 0.0;
  std::uint32_t solid = 0;
};

/// Numbers the closed shells of the mesh; one number per triangle.
std::vector<std::uint32_t> shell_of_triangles(const Neighbours& neighbours) {
  std::vector<std::uint32_t> shell_of(neighbours.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t seed = 0; seed < shell_of.size(); ++seed) {
    if (shell_of[seed] != kNone) continue;
    shell_of[seed] = count;
    std::vector<std::uint32_t> front{seed};
    while (!front.empty()) {
      const std::uint32_t t = front.back();
      front.pop_back();
      for (const std::uint32_t next : neighbours[t]) {
        if (next == kNone || shell_of[next] != kNone) continue;
        shell_of[next] = count;
        front.push_back(next);
      }
    }
    ++count;
  }
  return shell_of;
}

void set_solids(const Neighbours& neighbours, FacetedSolid& mesh) {
  const std::vector<std::uint32_t> shell_of = shell_of_triangles(neighbours);
  std::vector<Shell> shells(*std::max_element(shell_of.begin(), shell_of.end()) + 1);
  const Vector3d center = bounds(mesh.vertices).center();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto c = mesh.corners(t);
    for (const Vector3d& corner : c) shells[shell_of[t]].bounds.extend(corner);
    shells[shell_of[t]].volume_mm3 += (c[0] - center).dot((c[1] - center).cross(c[2] - center)) / 6;
  }
  mesh.solid_count = 0;
  for (Shell& shell : shells) {
    if (shell.volume_mm3 > 0.0) shell.solid = mesh.solid_count++;
  }
  for (Shell& cavity : shells) {
    if (cavity.volume_mm3 > 0.0) continue;
    double smallest_mm3 = std::numeric_limits<double>::infinity();
    for (const Shell& shell : shells) {
      const bool is_around = shell.volume_mm3 > 0.0 && shell.bounds.contains(cavity.bounds);
      if (!is_around || shell.volume_mm3 >= smallest_mm3) continue;
      smallest_mm3 = shell.volume_mm3;
      cavity.solid = shell.solid;
    }
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.faces[mesh.face_of[t]].solid = shells[shell_of[t]].solid;
  }
}

Convexity convexity(const FacetedSolid& mesh, std::uint32_t a, std::uint32_t b,
                    const Vector3d& along) {
  const Vector3d normal_a = doubled_area(mesh, a).normalized();
  const Vector3d normal_b = doubled_area(mesh, b).normalized();
  const Vector3d cross = normal_a.cross(normal_b);
  const double angle_rad = std::atan2(cross.norm(), normal_a.dot(normal_b));
  if (!std::isfinite(angle_rad) || !(along.norm() > 0.0)) return Convexity::Unknown;
  if (angle_rad < kTangent_rad) return Convexity::Smooth;
  const double side = cross.dot(along.normalized());
  if (std::abs(side) < kParallel_rad) return Convexity::Unknown;
  return side > 0.0 ? Convexity::Convex : Convexity::Concave;
}

void set_edges(const Neighbours& neighbours, FacetedSolid& mesh) {
  mesh.edges.clear();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t other = neighbours[t][k];
      if (other == kNone || other < t || mesh.face_of[other] == mesh.face_of[t]) continue;
      Edge edge;
      edge.faces = {std::min(mesh.face_of[t], mesh.face_of[other]),
                    std::max(mesh.face_of[t], mesh.face_of[other])};
      edge.curve = CurveKind::Line;
      edge.start = mesh.vertices[mesh.triangles[t][k]];
      edge.end = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
      edge.length_mm = (edge.end - edge.start).norm();
      edge.convexity = convexity(mesh, t, other, edge.end - edge.start);
      mesh.edges.push_back(edge);
    }
  }
}

}  // namespace

MeshEdgeCounts count_edges(const FacetedSolid& mesh) {
  const std::vector<HalfEdge> uses = sorted_uses(mesh);
  MeshEdgeCounts counts;
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].same_edge(uses[first])) ++last;
    ++counts.all;
    if (last - first == 1) ++counts.open;
    if (last - first > 2) ++counts.crowded;
    first = last;
  }
  return counts;
}

void set_planar_faces(FacetedSolid& mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  group_coplanar(neighbours, mesh);
  set_solids(neighbours, mesh);
  set_edges(neighbours, mesh);
}

}  // namespace dowel
