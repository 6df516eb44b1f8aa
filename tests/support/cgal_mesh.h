#pragma once

#include <vector>

#include <CGAL/Aff_transformation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

/// Facets and poses as CGAL has them. Its own target: CGAL brings compiler options of its own.
namespace dowel::testing {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

inline CgalMesh cgal_mesh(const FacetedSolid& solid) {
  CgalMesh mesh;
  std::vector<CgalMesh::Vertex_index> vertices;
  vertices.reserve(solid.vertices.size());
  for (const Eigen::Vector3d& p : solid.vertices) {
    vertices.push_back(mesh.add_vertex({p.x(), p.y(), p.z()}));
  }
  for (const Triangle& t : solid.triangles) {
    mesh.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  }
  return mesh;
}

inline CGAL::Aff_transformation_3<CgalKernel> cgal_pose(const Pose& pose) {
  const Eigen::Matrix3d r = pose.rotation_matrix();
  const Eigen::Vector3d& p = pose.translation();
  return {r(0, 0), r(0, 1), r(0, 2), p.x(),   r(1, 0), r(1, 1),
          r(1, 2), p.y(),   r(2, 0), r(2, 1), r(2, 2), p.z()};
}

}  // namespace dowel::testing
