#include "exact_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dowel {
namespace {

/// Squared sine of the angle between two surfaces below which they are tangent: their curve of
/// intersection says nothing about the rim, and each surface is as good as the other.
constexpr double kTangent = 1e-6;

/// A point is on the near sheet of a closed surface where the facet lies within this many slacks.
constexpr double kSheetSlacks = 4.0;

/// Barycentric slack of "inside the triangle", relative: rounding only.
constexpr double kInsideSlack = 1e-9;

/// Moves `x` to the nearest point that lies on both surfaces, by Newton steps of least length.
/// False where they are tangent there.
bool to_intersection(const Face& f, const Face& g, Eigen::Vector3d& x) {
  for (int step = 0; step < 3; ++step) {
    const double df = signed_distance_mm(f.surface, x);
    const double dg = signed_distance_mm(g.surface, x);
    const Eigen::Vector3d nf = distance_gradient(f.surface, x);
    const Eigen::Vector3d ng = distance_gradient(g.surface, x);
    const double cosine = nf.dot(ng);
    const double determinant = 1.0 - cosine * cosine;
    if (!(determinant > kTangent)) return false;
    x -= nf * ((df - cosine * dg) / determinant) + ng * ((dg - cosine * df) / determinant);
  }
  return true;
}

/// Point of the curve f with g that is nearest to `p`, starting from a point `q` of a chord of it
/// and sliding along the curve no further than `reach_mm`.
Eigen::Vector3d nearest_on_rim(const Face& f, const Face& g, const Eigen::Vector3d& q,
                               const Eigen::Vector3d& p, double reach_mm) {
  Eigen::Vector3d x = q;
  if (!to_intersection(f, g, x)) return closest_point(f.surface, q);
  for (int step = 0; step < 2 && reach_mm > 0.0; ++step) {
    const Eigen::Vector3d tangent =
        distance_gradient(f.surface, x).cross(distance_gradient(g.surface, x)).normalized();
    const double shift = std::clamp(tangent.dot(p - x), -reach_mm, reach_mm);
    x += shift * tangent;
    if (!to_intersection(f, g, x)) return closest_point(f.surface, q);
  }
  return x;
}

/// True where `c`, a point of the plane of a facet, lies on the face's side of the exact surface
/// beyond its edge.
bool on_face_side(const Face& beyond, EdgeShape shape, const Eigen::Vector3d& c) {
  const double distance = outward_distance_mm(beyond, c);
  return shape == EdgeShape::Convex ? distance <= 0.0 : distance >= 0.0;
}

/// In-plane distance of `c` from edge `i`, positive outside the triangle.
double beyond_edge(const ModelTriangle& t, std::size_t i, const Eigen::Vector3d& c) {
  const Eigen::Vector3d& a = t.corners[i];
  const Eigen::Vector3d along = (t.corners[(i + 1) % 3] - a).normalized();
  return along.cross(t.normal).dot(c - a);
}

bool ends_in_curve(const CollisionModel& model, const ModelTriangle& t, std::size_t i) {
  if (t.edges[i] != EdgeShape::Convex && t.edges[i] != EdgeShape::Concave) return false;
  const Face& beyond = model.face(t.neighbours[i]);
  return is_exact(beyond) && !is_plane(beyond.surface);
}

enum class Footing { Inside, Outside, Overhang };

/// Whether the foot `c` on the plane of a planar facet belongs to the exact face: facets overhang
/// the rims of holes and fall short of the rims of discs.
Footing footing_on_plane(const CollisionModel& model, const ModelTriangle& t,
                         const Eigen::Vector3d& c) {
  bool outside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double beyond = beyond_edge(t, i, c);
    const bool curved = ends_in_curve(model, t, i);
    if (!curved || std::abs(beyond) > t.slack_mm) {
      outside = outside || beyond > 0.0;
      continue;
    }
    if (!on_face_side(model.face(t.neighbours[i]), t.edges[i], c)) {
      if (beyond <= 0.0) return Footing::Overhang;
      outside = true;
    }
  }
  return outside ? Footing::Outside : Footing::Inside;
}

/// Whether the foot `c` on a curved surface lies over the facet, seen along the surface's normal.
bool foot_is_over(const ModelTriangle& t, const Face& face, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = outward_normal(face, c);
  const double slope = normal.dot(t.normal);
  if (!(slope > 0.2)) return false;
  const double height = (t.corners[0] - c).dot(t.normal) / slope;
  if (std::abs(height) > kSheetSlacks * t.slack_mm + kInsideSlack) return false;
  const Eigen::Vector3d x = c + height * normal;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = t.corners[(i + 1) % 3] - t.corners[i];
    if (edge.cross(t.normal).dot(x - t.corners[i]) > kInsideSlack * edge.norm()) return false;
  }
  return true;
}

FacePoint at(const Eigen::Vector3d& point, const Eigen::Vector3d& p, FacePoint::Place place) {
  return {point, (p - point).squaredNorm(), place};
}

/// Nearest place on the rim of the patch, once it is known not to be inside.
FacePoint nearest_on_rim_of_patch(const CollisionModel& model, const ModelTriangle& t,
                                  const TrianglePoint& q, const Eigen::Vector3d& p) {
  const Face& face = model.face(t.face);
  if (q.region >= 4) return at(q.point, p, FacePoint::Place::Corner);
  const auto i = static_cast<std::size_t>(q.region - 1);
  const Eigen::Vector3d lifted = closest_point(face.surface, q.point);
  switch (t.edges[i]) {
    case EdgeShape::Inner:
    case EdgeShape::Smooth:
      return at(lifted, p, FacePoint::Place::Face);
    case EdgeShape::Convex:
    case EdgeShape::Concave:
      break;
  }
  const auto place =
      t.edges[i] == EdgeShape::Convex ? FacePoint::Place::ConvexRim : FacePoint::Place::ConcaveRim;
  const Face& beyond = model.face(t.neighbours[i]);
  if (t.slack_mm == 0.0 || !is_exact(face) || !is_exact(beyond)) return at(lifted, p, place);
  const double to_end =
      std::min((q.point - t.corners[i]).norm(), (q.point - t.corners[(i + 1) % 3]).norm());
  return at(nearest_on_rim(face, beyond, q.point, p, to_end), p, place);
}

}  // namespace

TrianglePoint closest_on_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                                  const Eigen::Vector3d& p) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, 4};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, 5};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + d1 / (d1 - d3) * ab, 1};
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, 6};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + d2 / (d2 - d6) * ac, 3};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 2};
  }
  const double scale = 1.0 / (va + vb + vc);
  return {a + vb * scale * ab + vc * scale * ac, 0};
}

double outward_distance_mm(const Face& face, const Eigen::Vector3d& p) {
  const double distance = signed_distance_mm(face.surface, p);
  return face.reversed ? -distance : distance;
}

Eigen::Vector3d outward_normal(const Face& face, const Eigen::Vector3d& p) {
  const Eigen::Vector3d gradient = distance_gradient(face.surface, p);
  return face.reversed ? Eigen::Vector3d(-gradient) : gradient;
}

FacePoint nearest_on_patch(const CollisionModel& model, const ModelTriangle& t,
                           const Eigen::Vector3d& p) {
  const Face& face = model.face(t.face);
  if (t.slack_mm == 0.0) {
    const TrianglePoint q = closest_on_triangle(t.corners, p);
    if (q.region == 0) return at(q.point, p, FacePoint::Place::Face);
    return nearest_on_rim_of_patch(model, t, q, p);
  }
  if (is_plane(face.surface)) {
    const Eigen::Vector3d c = p - t.normal * t.normal.dot(p - t.corners[0]);
    const Footing footing = footing_on_plane(model, t, c);
    if (footing == Footing::Inside) return at(c, p, FacePoint::Place::Face);
    TrianglePoint q = closest_on_triangle(t.corners, p);
    if (footing == Footing::Overhang && q.region == 0) {
      // The rim itself belongs to the curved face beyond it, which answers for it.
      return {c, std::numeric_limits<double>::infinity(), FacePoint::Place::Face};
    }
    return nearest_on_rim_of_patch(model, t, q, p);
  }
  const Eigen::Vector3d c = closest_point(face.surface, p);
  if (foot_is_over(t, face, c)) return at(c, p, FacePoint::Place::Face);
  TrianglePoint q = closest_on_triangle(t.corners, p);
  if (q.region == 0) return at(closest_point(face.surface, q.point), p, FacePoint::Place::Face);
  return nearest_on_rim_of_patch(model, t, q, p);
}

}  // namespace dowel
