#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// What the pictures draw of a solid, in its own frame (mm): facets whose corners carry normals,
/// and the edge lines of a CAD drawing. A corner belongs to one face, so shading breaks at face
/// borders and is smooth inside a curved face.
struct ShadedMesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  ///< unit, outward; one per position
  std::vector<Triangle> triangles;       ///< indices into the positions, in the solid's order
  /// Facet edges where the shading breaks or one kind of surface runs into another; not the borders
  /// between pieces of one smooth surface. Indices into the positions, sorted.
  std::vector<std::array<std::uint32_t, 2>> lines;
};

/// Construction: rounded. Normals come from the exact surface where the face has one, else from the
/// facets of the same face around the corner that turn less than kCrease_rad. Facets with two equal
/// corners are left out. Never fails on a poor mesh: an open edge becomes a line.
/// Expects: indices in range, one face per triangle, finite coordinates.
ShadedMesh shade(const FacetedSolid& solid);

}  // namespace dowel
