#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "solids.h"

/// The same solid as other exporters and other machines would write it.
namespace dowel::testing {

namespace detail {

/// A permutation of 0 … count-1.
inline std::vector<std::uint32_t> permutation(std::size_t count, RandomGeometry& random) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[random.index(static_cast<std::uint32_t>(i))]);
  }
  return order;
}

}  // namespace detail

/// Vertices, triangles, their first corners and faces in another order.
inline FacetedSolid shuffled(const FacetedSolid& solid, RandomGeometry& random) {
  const auto vertex = detail::permutation(solid.vertices.size(), random);
  const auto triangle = detail::permutation(solid.triangles.size(), random);
  const auto face = detail::permutation(solid.faces.size(), random);
  FacetedSolid result = solid;
  for (std::size_t i = 0; i < vertex.size(); ++i) result.vertices[vertex[i]] = solid.vertices[i];
  for (std::size_t i = 0; i < face.size(); ++i) result.faces[face[i]] = solid.faces[i];
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    Triangle t = solid.triangles[i];
    for (std::uint32_t& v : t) v = vertex[v];
    std::rotate(t.begin(), t.begin() + random.index(3), t.end());
    result.triangles[triangle[i]] = t;
    result.face_of[triangle[i]] = face[solid.face_of[i]];
  }
  result.edges.clear();
  return result;
}

/// Seen in a mirror: x becomes -x.
inline FacetedSolid mirrored(FacetedSolid solid) {
  const auto flip = [](Eigen::Vector3d& p) { p.x() = -p.x(); };
  for (Eigen::Vector3d& p : solid.vertices) flip(p);
  for (Triangle& t : solid.triangles) std::swap(t[1], t[2]);
  for (Face& face : solid.faces) {
    if (auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      flip(plane->origin);
      flip(plane->normal);
    } else if (auto* cylinder = std::get_if<CylinderSurface>(&face.surface)) {
      flip(cylinder->origin);
      flip(cylinder->axis);
    } else if (auto* cone = std::get_if<ConeSurface>(&face.surface)) {
      flip(cone->apex);
      flip(cone->axis);
    }
  }
  solid.edges.clear();
  return solid;
}

/// Every face cut in two along the plane x = `at_x`, where no triangle crosses it.
inline FacetedSolid with_split_faces(FacetedSolid solid, double at_x) {
  const std::size_t count = solid.faces.size();
  std::vector<std::uint32_t> other_half(count, 0);
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto corners = solid.corners(t);
    if ((corners[0] + corners[1] + corners[2]).x() / 3.0 < at_x) continue;
    std::uint32_t& face = solid.face_of[t];
    if (other_half[face] == 0) {
      other_half[face] = static_cast<std::uint32_t>(solid.faces.size());
      solid.faces.push_back(solid.faces[face]);
    }
    face = other_half[face];
  }
  // Areas follow the facets; only their sum matters here.
  std::vector<double> share(solid.faces.size(), 0.0);
  std::vector<double> whole(count, 0.0);
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto c = solid.corners(t);
    share[solid.face_of[t]] += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
  }
  for (std::size_t f = 0; f < count; ++f) {
    whole[f] = share[f] + (other_half[f] == 0 ? 0.0 : share[other_half[f]]);
  }
  for (std::size_t f = 0; f < count; ++f) {
    const double area = solid.faces[f].area_mm2;
    solid.faces[f].area_mm2 = area * share[f] / whole[f];
    if (other_half[f] != 0) {
      solid.faces[other_half[f]].area_mm2 = area * share[other_half[f]] / whole[f];
    }
  }
  solid.edges.clear();
  return solid;
}

/// Every face in its triangles, each a face of its own on the same surface.
inline FacetedSolid in_triangles(FacetedSolid solid) {
  std::vector<Face> faces;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto c = solid.corners(t);
    faces.push_back(solid.faces[solid.face_of[t]]);
    faces.back().area_mm2 = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
    solid.face_of[t] = t;
  }
  solid.faces = std::move(faces);
  solid.edges.clear();
  return solid;
}

/// As from an exporter that writes B-splines only: no face tells its surface.
inline FacetedSolid without_surfaces(FacetedSolid solid) {
  for (Face& face : solid.faces) {
    face.surface = OtherSurface{};
    face.reversed = false;
  }
  solid.edges.clear();
  return solid;
}

}  // namespace dowel::testing
