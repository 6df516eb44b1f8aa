#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Eigen/Core>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "dowel/kernel/box.h"
#include "dowel/kernel/faceted_solid.h"
#include "facet.h"

namespace dowel {

/// How far a solid reaches in a direction, by its exact faces and edges rather than its facets.
///
/// Planes, cylinders and cones reach farthest on their edges, other faces also between them. The
/// curve or patch that may reach farthest is halved until what is left is decided: over a short
/// piece, reach is a quadratic of its parameters, which its Bezier coefficients bound.
class ExactReach {
 public:
  /// `shape` has the mesher's facets, `solid` is made of them. Keeps neither.
  ExactReach(const TopoDS_Shape& shape, const FacetedSolid& solid);

  /// Largest `direction . p` over the solid, from above; farther than it is by no more than
  /// `slack_mm`, but where thousands of steps do not get there. Expects: a unit vector,
  /// slack > 0.
  double along_mm(const Eigen::Vector3d& direction, double slack_mm) const;

 private:
  struct Piece;
  class Search;

  /// A stretch of a curved edge between two nodes of the mesh.
  struct Stretch {
    std::uint32_t curve = 0;
    double from = 0.0;  ///< parameters
    double to = 0.0;
    std::array<Eigen::Vector3d, 3> points;  ///< at `from`, the middle, `to`
  };
  /// A stretch of a circle, which needs no search: where it lies at the angle 0 and a quarter of a
  /// turn on, seen from its centre.
  struct Arc {
    Eigen::Vector3d center;
    Eigen::Vector3d at_start;
    Eigen::Vector3d at_quarter;
    double from_rad = 0.0;
    double to_rad = 0.0;
  };
  /// A facet of a face that may reach farther than its edges.
  struct Patch {
    std::uint32_t face = 0;
    std::array<Eigen::Vector2d, 3> uv;
    std::array<Eigen::Vector3d, 3> corners;
  };
  struct CurvedFace {
    BRepAdaptor_Surface surface;
    /// Its facets do not lie on it, as in damaged files: they and their error are what bounds it.
    bool is_misplaced = false;
  };

  void add_edges(const TopoDS_Shape& shape);
  void add_faces(const TopoDS_Shape& shape);
  void add_patches(const TopoDS_Face& face);
  Eigen::Vector3d on_face(std::uint32_t face, const Eigen::Vector2d& uv) const;
  Eigen::Vector3d on_curve(std::uint32_t curve, double at) const;

  std::vector<Eigen::Vector3d> corners_;  ///< of the facets' hull
  double patch_error_mm_ = 0.0;           ///< by which a patch may pass its corners
  std::vector<BRepAdaptor_Curve> curves_;
  std::vector<Arc> arcs_;
  std::vector<Stretch> stretches_;
  std::vector<CurvedFace> faces_;
  std::vector<Patch> patches_;
};

/// Smallest box found around the exact solid that `facets` stand for.
Obb exact_box(const FacetedShape& facets);

}  // namespace dowel
