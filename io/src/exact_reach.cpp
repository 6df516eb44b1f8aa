#include "exact_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Circ.hxx>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/convex_hull.h"
#include "dowel/kernel/tolerance.h"
#include "occt.h"

namespace dowel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Pieces that one search may look at: what a ring of a B-spline fillet that lies flat needs, some
/// ten milliseconds.
constexpr std::size_t kMostPieces = 20'000;

/// Share of what a facet's piece departs from a linear one by which it may depart from a quadratic
/// one; the share halves with the piece.
constexpr double kCubicShare = 0.1;

/// The facet error is measured at some points of each facet; between them it may be larger.
constexpr double kErrorBetweenProbes = 1.5;

/// True for surfaces of straight lines that end on the face's edges.
bool reaches_farthest_on_edges(const BRepAdaptor_Surface& surface) {
  switch (surface.GetType()) {
    case GeomAbs_Plane:
    case GeomAbs_Cylinder:
    case GeomAbs_Cone:
    case GeomAbs_SurfaceOfExtrusion:
      return true;
    default:
      return false;
  }
}

/// True where a quadratic on a triangle rises or falls along one of its sides everywhere, by its
/// Bezier coefficients at the corners and between them, across from each corner. Then it has its
/// maximum on the triangle's border, and a face whose pieces all do so has it on its edges. (The
/// pieces leave the face a little where its edges are curved: that must not count.)
bool rises_throughout(const std::array<double, 3>& corners, const std::array<double, 3>& between,
                      double margin) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3;
    const std::size_t b = (k + 2) % 3;
    const auto [least, most] =
        std::minmax({between[k] - corners[a], corners[b] - between[k], between[a] - between[b]});
    if (least > margin || most < -margin) return true;
  }
  return false;
}

}  // namespace

/// A stretch, a patch or a part of one, and how far it reaches at its corners and between them.
struct ExactReach::Piece {
  double upper_mm = 0.0;    ///< what it reaches at most
  std::uint32_t index = 0;  ///< of the curve or face
  bool is_stretch = false;
  double cubic_share = kCubicShare;
  std::array<Vector2d, 3> uv{};  ///< of a stretch: the parameters of its ends, in the first two
  std::array<double, 3> at_corners{};
  std::array<double, 3> at_middles{};  ///< of the side across from each corner; of a stretch one

  bool operator<(const Piece& other) const { return upper_mm < other.upper_mm; }
};

/// Best first: the piece that may reach farthest is divided until none can pass what was seen.
class ExactReach::Search {
 public:
  Search(const ExactReach& reach, const Vector3d& direction)
      : reach_(reach), direction_(direction) {
    for (const Vector3d& point : reach.corners_) see(direction.dot(point));
    for (const Stretch& stretch : reach.stretches_) see(direction.dot(stretch.points[1]));
    for (const Arc& arc : reach.arcs_) see(farthest_mm(arc));
    for (const Stretch& stretch : reach.stretches_) {
      if (reach.curves_[stretch.curve].GetType() != GeomAbs_Circle) add(stretch);
    }
    for (const Patch& patch : reach.patches_) add(patch);
  }

  double run(double slack_mm) {
    std::size_t steps = 0;
    while (!pieces_.empty() && pieces_.top().upper_mm > seen_mm_ + slack_mm) {
      const Piece piece = pieces_.top();
      const bool is_indivisible = !piece.is_stretch && reach_.faces_[piece.index].is_misplaced;
      if (is_indivisible || ++steps > kMostPieces) break;
      pieces_.pop();
      if (piece.is_stretch) {
        halve(piece);
      } else {
        quarter(piece);
      }
    }
    return pieces_.empty() ? seen_mm_ : std::max(seen_mm_, pieces_.top().upper_mm);
  }

 private:
  double see(double at_mm) {
    seen_mm_ = std::max(seen_mm_, at_mm);
    return at_mm;
  }

  double farthest_mm(const Arc& arc) const {
    const double x = direction_.dot(arc.at_start);
    const double y = direction_.dot(arc.at_quarter);
    // The ends are nodes of the mesh and have been seen.
    const double center_mm = direction_.dot(arc.center);
    const double turn_rad = 2.0 * std::numbers::pi;
    const double ahead_rad = std::remainder(std::atan2(y, x) - arc.from_rad, turn_rad);
    const bool passes =
        (ahead_rad < 0.0 ? ahead_rad + turn_rad : ahead_rad) <= arc.to_rad - arc.from_rad;
    return passes ? center_mm + std::hypot(x, y)
                  : center_mm + x * std::cos(arc.to_rad) + y * std::sin(arc.to_rad);
  }

  void add(const Stretch& stretch) {
    Piece piece{.index = stretch.curve, .is_stretch = true};
    piece.uv[0].x() = stretch.from;
    piece.uv[1].x() = stretch.to;
    piece.at_corners = {direction_.dot(stretch.points[0]), direction_.dot(stretch.points[2])};
    piece.at_middles = {direction_.dot(stretch.points[1])};
    push_stretch(piece, std::numeric_limits<double>::infinity());
  }

  void add(const Patch& patch) {
    Piece piece{.index = patch.face, .uv = patch.uv};
    for (std::size_t k = 0; k < 3; ++k) piece.at_corners[k] = direction_.dot(patch.corners[k]);
    push_patch(piece, *std::ranges::max_element(piece.at_corners) + reach_.patch_error_mm_);
  }

  /// Keeps a piece that reaches no farther than `limit_mm` if it may pass what was seen.
  void push(Piece& piece, double limit_mm, double upper_mm) {
    piece.upper_mm = upper_mm < limit_mm ? upper_mm : limit_mm;
    if (piece.upper_mm > seen_mm_) pieces_.push(piece);
  }

  void push_stretch(Piece& piece, double limit_mm) {
    const auto& [from, to, none] = piece.at_corners;
    const double bulge = piece.at_middles[0] - 0.5 * (from + to);
    const double coefficient = piece.at_middles[0] + bulge;  // of the quadratic Bezier curve
    push(piece, limit_mm, std::max({from, to, coefficient}) + piece.cubic_share * std::abs(bulge));
  }

  void push_patch(Piece& piece, double limit_mm) {
    if (!(limit_mm > seen_mm_)) return;
    if (reach_.faces_[piece.index].is_misplaced) return push(piece, limit_mm, limit_mm);
    std::array<double, 3> coefficients;  // of the quadratic Bezier patch, at the middles
    double largest_bulge = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3;
      const std::size_t b = (k + 2) % 3;
      const Vector3d middle = reach_.on_face(piece.index, 0.5 * (piece.uv[a] + piece.uv[b]));
      piece.at_middles[k] = direction_.dot(middle);
      const double bulge = piece.at_middles[k] - 0.5 * (piece.at_corners[a] + piece.at_corners[b]);
      coefficients[k] = piece.at_middles[k] + bulge;
      largest_bulge = std::max(largest_bulge, std::abs(bulge));
    }
    const double margin = piece.cubic_share * largest_bulge;
    if (rises_throughout(piece.at_corners, coefficients, 2.0 * margin)) return;
    for (const double at_mm : piece.at_middles) see(at_mm);
    push(piece, limit_mm,
         std::max(*std::ranges::max_element(piece.at_corners),
                  *std::ranges::max_element(coefficients)) +
             margin);
  }

  void halve(const Piece& whole) {
    const double middle = 0.5 * (whole.uv[0].x() + whole.uv[1].x());
    for (std::size_t k = 0; k < 2; ++k) {
      Piece half = whole;
      half.cubic_share *= 0.5;
      half.uv[1 - k].x() = middle;
      half.at_corners[1 - k] = whole.at_middles[0];
      const double quarter = 0.5 * (half.uv[0].x() + half.uv[1].x());
      half.at_middles[0] = see(direction_.dot(reach_.on_curve(whole.index, quarter)));
      push_stretch(half, whole.upper_mm);
    }
  }

  void quarter(const Piece& whole) {
    std::array<Vector2d, 3> middles;
    for (std::size_t k = 0; k < 3; ++k) {
      middles[k] = 0.5 * (whole.uv[(k + 1) % 3] + whole.uv[(k + 2) % 3]);
    }
    Piece inner = whole;
    inner.cubic_share *= 0.5;
    Piece corner = inner;
    inner.uv = middles;
    inner.at_corners = whole.at_middles;
    push_patch(inner, whole.upper_mm);
    for (std::size_t k = 0; k < 3; ++k) {
      corner.uv = middles;
      corner.at_corners = whole.at_middles;
      // Between corner k and another one lies the middle that is across from the third.
      corner.uv[k] = whole.uv[k];
      corner.at_corners[k] = whole.at_corners[k];
      push_patch(corner, whole.upper_mm);
    }
  }

  const ExactReach& reach_;
  Vector3d direction_;
  double seen_mm_ = -std::numeric_limits<double>::infinity();
  std::priority_queue<Piece> pieces_;
};

ExactReach::ExactReach(const TopoDS_Shape& shape, const FacetedSolid& solid) {
  for (const Face& face : solid.faces) {
    patch_error_mm_ = std::max(patch_error_mm_, kErrorBetweenProbes * face.facet_error_mm);
  }
  for (const std::uint32_t v : convex_hull(solid.vertices).vertices) {
    corners_.push_back(solid.vertices[v]);
  }
  add_edges(shape);
  add_faces(shape);
}

double ExactReach::along_mm(const Vector3d& direction, double slack_mm) const {
  DOWEL_EXPECTS(slack_mm > 0.0);
  return Search(*this, direction).run(slack_mm);
}

Vector3d ExactReach::on_face(std::uint32_t face, const Vector2d& uv) const {
  return to_eigen(faces_[face].surface.Value(uv.x(), uv.y()));
}

Vector3d ExactReach::on_curve(std::uint32_t curve, double at) const {
  return to_eigen(curves_[curve].Value(at));
}

void ExactReach::add_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(e));
    if (BRep_Tool::Degenerated(edge)) continue;
    opencascade::handle<Poly_PolygonOnTriangulation> polygon;
    opencascade::handle<Poly_Triangulation> facets;
    TopLoc_Location location;
    BRep_Tool::PolygonOnTriangulation(edge, polygon, facets, location);
    if (polygon.IsNull() || facets.IsNull() || !polygon->HasParameters()) continue;
    const BRepAdaptor_Curve curve(edge);
    if (curve.GetType() == GeomAbs_Line) continue;
    const auto index = static_cast<std::uint32_t>(curves_.size());
    curves_.push_back(curve);
    const auto node = [&](int i) {
      return to_eigen(facets->Node(polygon->Node(i)).Transformed(location.Transformation()));
    };
    for (int i = 1; i < polygon->NbNodes(); ++i) {
      Stretch stretch{index, polygon->Parameter(i), polygon->Parameter(i + 1), {}};
      stretch.points = {node(i), on_curve(index, 0.5 * (stretch.from + stretch.to)), node(i + 1)};
      // Edges that do not lie on their nodes, as in damaged files, say nothing.
      const bool is_placed =
          (on_curve(index, stretch.from) - stretch.points[0]).norm() <= kMaxDeflection_mm &&
          (on_curve(index, stretch.to) - stretch.points[2]).norm() <= kMaxDeflection_mm;
      if (!is_placed || !stretch.points[1].allFinite()) continue;
      stretches_.push_back(stretch);
      if (curve.GetType() != GeomAbs_Circle) continue;
      const gp_Circ circle = curve.Circle();
      arcs_.push_back({to_eigen(circle.Location()),
                       circle.Radius() * to_eigen(circle.XAxis().Direction()),
                       circle.Radius() * to_eigen(circle.YAxis().Direction()),
                       std::min(stretch.from, stretch.to), std::max(stretch.from, stretch.to)});
    }
  }
}

void ExactReach::add_faces(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  for (int f = 1; f <= faces.Extent(); ++f) {
    const TopoDS_Face& face = TopoDS::Face(faces(f));
    const BRepAdaptor_Surface surface(face);
    if (reaches_farthest_on_edges(surface)) continue;
    faces_.push_back({surface, false});
    add_patches(face);
  }
}

/// Those of the last of `faces_`.
void ExactReach::add_patches(const TopoDS_Face& face) {
  TopLoc_Location location;
  const auto facets = BRep_Tool::Triangulation(face, location);
  if (facets.IsNull() || !facets->HasUVNodes()) return;
  const auto index = static_cast<std::uint32_t>(faces_.size() - 1);
  const auto corner = [&](int node) {
    return to_eigen(facets->Node(node).Transformed(location.Transformation()));
  };
  const auto uv = [&](int node) {
    const gp_Pnt2d at = facets->UVNode(node);
    return Vector2d(at.X(), at.Y());
  };
  for (int n = 1; n <= facets->NbNodes(); ++n) {
    // Written so that NaN counts as misplaced.
    const bool is_placed = (on_face(index, uv(n)) - corner(n)).norm() <= kMaxDeflection_mm;
    faces_[index].is_misplaced = faces_[index].is_misplaced || !is_placed;
  }
  for (int t = 1; t <= facets->NbTriangles(); ++t) {
    std::array<int, 3> nodes{};
    facets->Triangle(t).Get(nodes[0], nodes[1], nodes[2]);
    Patch patch{index, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      patch.uv[k] = uv(nodes[k]);
      patch.corners[k] = corner(nodes[k]);
    }
    patches_.push_back(patch);
  }
}

Obb exact_box(const FacetedShape& facets) {
  const ExactReach reach(facets.shape, facets.solid);
  return enclosing_box(facets.solid, [&](const Vector3d& direction, double slack_mm) {
    return reach.along_mm(direction, slack_mm);
  });
}

}  // namespace dowel
