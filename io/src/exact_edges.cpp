#include "exact_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include <BRepAdaptor_Curve.hxx>
#include <BRepGProp_Face.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Geom2d_Curve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Circ.hxx>

#include "dowel/kernel/tolerance.h"
#include "occt.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// One appearance of an edge in a wire of a face.
struct EdgeUse {
  const PlacedFace* face = nullptr;
  TopoDS_Edge edge;  ///< with the orientation that it has in the face
};

/// Outward unit normal of a face at the middle of one of its edges.
std::optional<Vector3d> outward_normal(const EdgeUse& use, const std::vector<Face>& faces,
                                       const Vector3d& middle, double parameter) {
  const Face& face = faces[use.face->index];
  if (!std::holds_alternative<OtherSurface>(face.surface)) {
    return (face.reversed ? -1.0 : 1.0) * distance_gradient(face.surface, middle);
  }
  double first = 0.0;
  double last = 0.0;
  const auto curve = BRep_Tool::CurveOnSurface(use.edge, use.face->face, first, last);
  if (curve.IsNull()) return std::nullopt;
  const gp_Pnt2d uv = curve->Value(parameter);
  gp_Pnt point;
  gp_Vec normal;
  BRepGProp_Face(use.face->face).Normal(uv.X(), uv.Y(), point, normal);
  const Vector3d direction = to_eigen(normal);
  if (!(direction.norm() > 0.0) || !direction.allFinite()) return std::nullopt;
  return (use.face->turned ? -1.0 : 1.0) * direction.normalized();
}

Convexity convexity(const EdgeUse& a, const EdgeUse& b, const std::vector<Face>& faces,
                    const BRepAdaptor_Curve& curve) {
  const double parameter = 0.5 * (curve.FirstParameter() + curve.LastParameter());
  gp_Pnt point;
  gp_Vec derivative;
  curve.D1(parameter, point, derivative);
  const auto normal_a = outward_normal(a, faces, to_eigen(point), parameter);
  const auto normal_b = outward_normal(b, faces, to_eigen(point), parameter);
  if (!normal_a || !normal_b) return Convexity::Unknown;
  const Vector3d cross = normal_a->cross(*normal_b);
  const double angle_rad = std::atan2(cross.norm(), normal_a->dot(*normal_b));
  if (!std::isfinite(angle_rad)) return Convexity::Unknown;
  if (angle_rad < kTangent_rad) return Convexity::Smooth;
  // The wire runs with the material of face `a` on its left, seen from outside.
  const bool backward = (a.edge.Orientation() == TopAbs_REVERSED) != a.face->turned;
  const Vector3d along = (backward ? -1.0 : 1.0) * to_eigen(derivative).normalized();
  const double side = cross.normalized().dot(along);
  // A knife edge or a slit: the normals are opposite and their cross product is noise.
  if (std::abs(side) < kTangent_rad || !std::isfinite(side)) return Convexity::Unknown;
  return side > 0.0 ? Convexity::Convex : Convexity::Concave;
}

Edge describe(const BRepAdaptor_Curve& curve) {
  Edge edge;
  const double first = curve.FirstParameter();
  const double last = curve.LastParameter();
  edge.start = to_eigen(curve.Value(first));
  edge.end = to_eigen(curve.Value(last));
  switch (curve.GetType()) {
    case GeomAbs_Line:
      edge.curve = CurveKind::Line;
      edge.length_mm = (edge.end - edge.start).norm();
      break;
    case GeomAbs_Circle: {
      const gp_Circ circle = curve.Circle();
      edge.curve = CurveKind::Circle;
      edge.center = to_eigen(circle.Location());
      edge.axis = to_eigen(circle.Axis().Direction());
      edge.radius_mm = circle.Radius();
      edge.length_mm = circle.Radius() * std::abs(last - first);
      break;
    }
    default:
      edge.length_mm = GCPnts_AbscissaPoint::Length(curve);
  }
  return edge;
}

std::optional<Edge> edge_between(const EdgeUse& a, const EdgeUse& b,
                                 const std::vector<Face>& faces) {
  const BRepAdaptor_Curve curve(a.edge);
  Edge edge = describe(curve);
  const bool is_finite = edge.start.allFinite() && edge.end.allFinite() &&
                         std::isfinite(edge.length_mm) && edge.length_mm >= 0.0;
  if (!is_finite) return std::nullopt;
  edge.faces = {std::min(a.face->index, b.face->index), std::max(a.face->index, b.face->index)};
  edge.convexity = convexity(a, b, faces, curve);
  edge.closed = BRep_Tool::IsClosed(a.edge);
  return edge;
}

}  // namespace

std::vector<Edge> exact_edges(const std::vector<PlacedFace>& placed,
                              const std::vector<Face>& faces) {
  TopTools_IndexedMapOfShape known;
  std::vector<std::vector<EdgeUse>> uses;
  for (const PlacedFace& face : placed) {
    for (TopExp_Explorer it(face.face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(it.Current());
      const bool is_boundary =
          edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
      if (!is_boundary || BRep_Tool::Degenerated(edge)) continue;
      const auto index = static_cast<std::size_t>(known.Add(edge));
      if (uses.size() < index) uses.resize(index);
      uses[index - 1].push_back({&face, edge});
    }
  }
  std::vector<Edge> edges;
  for (const std::vector<EdgeUse>& use : uses) {
    if (use.size() != 2 || use[0].face->index == use[1].face->index) continue;
    if (const auto edge = edge_between(use[0], use[1], faces)) edges.push_back(*edge);
  }
  return edges;
}

}  // namespace dowel
