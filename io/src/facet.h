#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

struct FacetOptions {
  double deflection_mm = 0.0;  ///< 0: relative to the size, see `default_deflection_mm`
  double angular_deflection_rad = 0.5;
  std::uint32_t max_triangles = 400'000;
};

struct FacetedShape {
  FacetedSolid solid;  ///< `find_defect` returns nothing
  TopoDS_Shape shape;  ///< the solids that it stands for, outward, with the mesher's facets
  /// Faces whose boundary lies off the surface that they claim by more than the deflection. They
  /// stand as free-form ones: nobody can tell which of the two was meant.
  std::size_t misplaced_faces = 0;
};

/// A thousandth of the bounding box's diagonal, within [kMinDeflection_mm, kMaxDeflection_mm].
double default_deflection_mm(double diagonal_mm);

/// Facets of the solids of `shape` with their exact faces and edges. Where the mesh is not closed,
/// other deflections are tried, then healed copies of the shape (then `FacetedShape::shape` is the
/// healed one). Where it has more than `max_triangles`, it is coarsened. Inside-out solids are
/// turned.
/// Throws Error{FileMalformed}: no closed mesh, too many triangles, coordinates out of range.
FacetedShape facet(const TopoDS_Shape& shape, const FacetOptions& options);

}  // namespace dowel
