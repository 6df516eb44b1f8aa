#include "exact_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "coarse_torus.h"

namespace dowel {
namespace {

/// Squared sine of the angle between two surfaces below which they are tangent: their curve of
/// intersection says nothing about the rim, and each surface is as good as the other.
constexpr double kTangent = 1e-6;

/// A point is on the near sheet of a closed surface where the facet lies within this many slacks.
constexpr double kSheetSlacks = 4.0;

/// A facet whose normal is this far from its face's (cosine) is of another sheet.
constexpr double kLeastSlope = 0.2;

/// Slack of "inside the triangle", mm: rounding only.
constexpr double kInsideSlack = 1e-9;

/// A place this close to an axis is on it: rounding.
constexpr double kOnAxis_mm = 1e-9;

/// The search along an arc ends when the way to the asked point is this nearly at a right angle to
/// it (radians; the distance is then right to half its square), or after so many steps.
constexpr double kArcAccuracy = 1e-7;
constexpr int kArcSteps = 24;

/// A point this close to both surfaces is on their curve of intersection: rounding.
constexpr double kOnCurve_mm = 1e-12;

/// Axes closer than this (sine, and mm) are one, and the curve is a circle for the first guess.
constexpr double kCoaxial = 1e-9;

/// Arcs whose chord passes the centre closer than this share of the radius are no facet's.
constexpr double kHalfCircle = 0.05;

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
    if (std::abs(df) <= kOnCurve_mm && std::abs(dg) <= kOnCurve_mm) return true;
    x -= nf * ((df - cosine * dg) / determinant) + ng * ((dg - cosine * df) / determinant);
  }
  return true;
}

/// What an axis must have for a surface to be one of revolution about it: this direction, where it
/// is not zero, and a point that it passes through, if any.
struct AxisDemand {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  bool has_point = false;
};

AxisDemand axis_demand(const Surface& surface) {
  struct Visitor {
    AxisDemand operator()(const OtherSurface&) const { return {}; }
    AxisDemand operator()(const PlaneSurface& s) const { return {s.normal, s.origin, false}; }
    AxisDemand operator()(const CylinderSurface& s) const { return {s.axis, s.origin, true}; }
    AxisDemand operator()(const ConeSurface& s) const { return {s.axis, s.apex, true}; }
    AxisDemand operator()(const SphereSurface& s) const {
      return {Eigen::Vector3d::Zero(), s.center, true};
    }
    AxisDemand operator()(const TorusSurface& s) const { return {s.axis, s.center, true}; }
  };
  return std::visit(Visitor{}, surface);
}

/// A circle in which two faces of revolution meet.
struct RimCircle {
  Eigen::Vector3d center;
  Eigen::Vector3d direction;
  double radius_mm;
};

/// From the circle's axis to a point.
Eigen::Vector3d from_axis(const RimCircle& circle, const Eigen::Vector3d& p) {
  const Eigen::Vector3d d = p - circle.center;
  return d - circle.direction * circle.direction.dot(d);
}

/// The circle through `start` about the axis about which both surfaces turn; nothing where there is
/// none. Two spheres are left to the general search.
std::optional<RimCircle> rim_circle(const Face& f, const Face& g, const Eigen::Vector3d& start) {
  AxisDemand a = axis_demand(f.surface);
  AxisDemand b = axis_demand(g.surface);
  if (a.direction.isZero(0.0)) std::swap(a, b);
  if (a.direction.isZero(0.0) || (!a.has_point && !b.has_point)) return std::nullopt;
  if (a.direction.cross(b.direction).squaredNorm() > kCoaxial * kCoaxial) return std::nullopt;
  if (a.has_point && b.has_point &&
      a.direction.cross(b.point - a.point).squaredNorm() > kCoaxial * kCoaxial) {
    return std::nullopt;
  }
  const Eigen::Vector3d& on_axis = a.has_point ? a.point : b.point;
  const Eigen::Vector3d center = on_axis + a.direction * a.direction.dot(start - on_axis);
  return RimCircle{center, a.direction, (start - center).norm()};
}

Eigen::Vector3d edge_of(const ModelTriangle& t, std::size_t i) {
  return t.corners[(i + 1) % 3] - t.corners[i];
}

/// In-plane distance of `c` from edge `i` times the edge's length, positive outside the triangle.
double beyond_edge_by_length(const ModelTriangle& t, std::size_t i, const Eigen::Vector3d& c) {
  return edge_of(t, i).cross(t.normal).dot(c - t.corners[i]);
}

/// Whether `c`, a foot on the face behind a facet, lies on the face's side of the rim at edge `i`.
bool on_face_side(const CollisionModel& model, const ModelTriangle& t, std::size_t i,
                  const Eigen::Vector3d& c) {
  const Face& beyond = model.face(t.neighbours[i]);
  if (t.edges[i] != EdgeShape::Blend) {
    const double distance = outward_distance_mm(beyond, c);
    return t.edges[i] == EdgeShape::Convex ? distance <= 0.0 : distance >= 0.0;
  }
  // Neither surface ends at the other one. The face lies in the circle or around it.
  const auto circle = rim_circle(model.face(t.face), beyond, t.corners[i]);
  if (!circle) return false;
  const Eigen::Vector3d outward = edge_of(t, i).cross(t.normal);
  const bool is_around = outward.dot(circle->center - t.corners[i]) > 0.0;
  return (from_axis(*circle, c).norm() >= circle->radius_mm) == is_around;
}

/// Whether that is no more than the facet's slack, on either side.
bool is_near_edge(const ModelTriangle& t, std::size_t i, const Eigen::Vector3d& c) {
  const double by_length = beyond_edge_by_length(t, i, c);
  return by_length * by_length <= t.slack_mm * t.slack_mm * edge_of(t, i).squaredNorm();
}

/// Whether `c` is seen from edge `i` at a right angle: the rim's arc over a chord lies there and
/// nowhere else.
bool is_over_chord(const ModelTriangle& t, std::size_t i, const Eigen::Vector3d& c) {
  const Eigen::Vector3d chord = edge_of(t, i);
  const double along = chord.dot(c - t.corners[i]);
  return along >= 0.0 && along <= chord.squaredNorm();
}

/// The place of a facet's plane over which the foot `c` on its face lies, seen along the face's
/// normal; nothing where the facet is of another sheet.
std::optional<Eigen::Vector3d> place_under(const ModelTriangle& t, const Face& face,
                                           const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = outward_normal(face, c);
  const double slope = normal.dot(t.normal);
  if (!(slope > kLeastSlope)) return std::nullopt;
  const double height = (t.corners[0] - c).dot(t.normal) / slope;
  if (std::abs(height) > kSheetSlacks * t.slack_mm + kInsideSlack) return std::nullopt;
  return c + height * normal;
}

/// Whether a place of a facet's plane is within the box around its corners: what is beside no edge
/// of a triangle without area may still be anywhere along its line.
bool is_in_box(const ModelTriangle& t, const Eigen::Vector3d& x, double slack_mm) {
  const Eigen::Array3d low = t.corners[0].cwiseMin(t.corners[1]).cwiseMin(t.corners[2]);
  const Eigen::Array3d high = t.corners[0].cwiseMax(t.corners[1]).cwiseMax(t.corners[2]);
  const double slack = slack_mm + kInsideSlack;
  return (x.array() >= low - slack).all() && (x.array() <= high + slack).all();
}

bool is_inside(const ModelTriangle& t, const Eigen::Vector3d& x, double slack_mm) {
  if (!is_in_box(t, x, slack_mm)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = slack_mm > 0.0 ? edge_of(t, i).norm() : 0.0;
    if (beyond_edge_by_length(t, i, x) > slack_mm * length) return false;
  }
  return true;
}

/// Whether the foot `c` of a face lies between one of a facet's chords and the arc over it, where
/// facets fall short of the rim of a disc, or of the wide end of a cone. `x`: the place of the
/// facet's plane under it, not inside by `is_inside`: no foot is between the two.
bool is_short_of_rim(const CollisionModel& model, const ModelTriangle& t, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_chord(model, t, i)) continue;
    if (beyond_edge_by_length(t, i, x) <= 0.0) continue;
    if (beyond_edge_by_length(t, i, c) > 0.0 && !is_near_edge(t, i, c)) continue;
    if (is_over_chord(t, i, c) && on_face_side(model, t, i, c)) {
      return true;
    }
  }
  return false;
}

/// Whether the place `c` of a facet lies between a chord and the arc over it, where facets overhang
/// the rims of holes and of narrow ends of cones. The foot on a curved face may also lie beyond the
/// chord, as the facet is seen along the face's normal.
bool overhangs_rim(const CollisionModel& model, const Chord& chord, const Eigen::Vector3d& c) {
  const ModelTriangle& t = model.triangles()[chord.triangle];
  return is_near_edge(t, chord.edge, c) && is_over_chord(t, chord.edge, c) &&
         !on_face_side(model, t, chord.edge, c);
}

FacePoint at(const Eigen::Vector3d& point, const Eigen::Vector3d& p, FacePoint::Place place) {
  return {point, (p - point).squaredNorm(), place};
}

FacePoint::Place rim_place(EdgeShape shape) {
  return shape == EdgeShape::Convex    ? FacePoint::Place::ConvexRim
         : shape == EdgeShape::Concave ? FacePoint::Place::ConcaveRim
                                       : FacePoint::Place::Face;
}

/// The same as `nearest_on_arc` where the curve is a circle; nothing where it is none.
std::optional<FacePoint> nearest_on_circle(const Face& face, const Face& beyond,
                                           const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                           EdgeShape shape, const Eigen::Vector3d& p) {
  const auto circle = rim_circle(face, beyond, start);
  if (!circle) return std::nullopt;
  const double radius = circle->radius_mm;
  const Eigen::Vector3d to_middle = 0.5 * (start + end) - circle->center;
  if (to_middle.squaredNorm() < kHalfCircle * kHalfCircle * radius * radius) return std::nullopt;
  Eigen::Vector3d outward = from_axis(*circle, p);
  const double from_axis_mm = outward.norm();
  // Every place is as near to a point of the axis.
  if (from_axis_mm <= kOnAxis_mm) outward = to_middle;
  Eigen::Vector3d x = circle->center + outward * (radius / outward.norm());
  if (to_middle.dot(x - start) <= 0.0) {
    const bool start_is_near = (p - start).squaredNorm() < (p - end).squaredNorm();
    return at(start_is_near ? start : end, p, FacePoint::Place::Corner);
  }
  if (shape != EdgeShape::Blend && !to_intersection(face, beyond, x)) return std::nullopt;
  return at(x, p, rim_place(shape));
}

/// Nearest place to `p` of the arc over edge `i`: the curve in which the exact faces on both sides
/// meet, between the corners of the edge. Where that is no circle, the root of "the tangent is at a
/// right angle to the way to p" is sought along the chord by the Illinois rule.
FacePoint nearest_on_arc(const CollisionModel& model, const ModelTriangle& t, std::size_t i,
                         const Eigen::Vector3d& p) {
  const Face& face = model.face(t.face);
  const Face& beyond = model.face(t.neighbours[i]);
  const Eigen::Vector3d& start = t.corners[i];
  const Eigen::Vector3d& end = t.corners[(i + 1) % 3];
  if (const auto place = nearest_on_circle(face, beyond, start, end, t.edges[i], p)) return *place;
  // How far p lies ahead along the curve, seen from its point x.
  const auto ahead = [&](const Eigen::Vector3d& x) {
    Eigen::Vector3d tangent =
        distance_gradient(face.surface, x).cross(distance_gradient(beyond.surface, x));
    if (tangent.dot(end - start) < 0.0) tangent = -tangent;
    return tangent.dot(p - x);
  };
  double low = 0.0;
  double high = 1.0;
  double ahead_low = ahead(start);
  double ahead_high = ahead(end);
  if (ahead_low <= 0.0) return at(start, p, FacePoint::Place::Corner);
  if (ahead_high >= 0.0) return at(end, p, FacePoint::Place::Corner);
  Eigen::Vector3d x = start;
  int last_side = 0;
  for (int step = 0; step < kArcSteps; ++step) {
    const double s = low + (high - low) * ahead_low / (ahead_low - ahead_high);
    x = start + s * (end - start);
    if (!to_intersection(face, beyond, x)) break;
    const double ahead_x = ahead(x);
    if (std::abs(ahead_x) <= kArcAccuracy * (p - x).norm()) break;
    const int side = ahead_x > 0.0 ? 1 : -1;
    if (side > 0) {
      low = s;
      ahead_low = ahead_x;
      if (side == last_side) ahead_high *= 0.5;
    } else {
      high = s;
      ahead_high = ahead_x;
      if (side == last_side) ahead_low *= 0.5;
    }
    last_side = side;
  }
  return at(x, p, rim_place(t.edges[i]));
}

/// Nearest place on the rim of the patch, once it is known not to be inside.
FacePoint nearest_on_rim_of_patch(const CollisionModel& model, const ModelTriangle& t,
                                  const TrianglePoint& q, const Eigen::Vector3d& p) {
  if (q.region >= 4) {
    // The arcs that end at this corner may come nearer than the corner itself.
    const auto corner = static_cast<std::size_t>(q.region - 4);
    FacePoint best = at(q.point, p, FacePoint::Place::Corner);
    for (const std::size_t i : {corner, (corner + 2) % 3}) {
      if (!is_chord(model, t, i)) continue;
      const FacePoint on_arc = nearest_on_arc(model, t, i, p);
      if (on_arc.distance_squared_mm2 < best.distance_squared_mm2) best = on_arc;
    }
    return best;
  }
  const auto i = static_cast<std::size_t>(q.region - 1);
  if (is_chord(model, t, i)) return nearest_on_arc(model, t, i, p);
  return at(closest_point(model.face(t.face).surface, q.point), p, rim_place(t.edges[i]));
}

FacePoint nearest_with_overhang(const CollisionModel& model, const ModelTriangle& t,
                                const Eigen::Vector3d& p, double within_squared_mm2, bool is_over) {
  const Face& face = model.face(t.face);
  // A plane's normal is exact; that of a sliver of another face is rounding.
  if (is_plane(face.surface)) {
    const double height = t.normal.dot(p - t.corners[0]);
    const FacePoint foot{p - height * t.normal, height * height, FacePoint::Place::Face};
    if ((is_over && is_in_box(t, foot.point, 0.0)) ||
        foot.distance_squared_mm2 > within_squared_mm2 || is_inside(t, foot.point, 0.0) ||
        (t.slack_mm > 0.0 && is_short_of_rim(model, t, foot.point, foot.point))) {
      return foot;
    }
  }
  if (t.slack_mm == 0.0 || is_plane(face.surface)) {
    const TrianglePoint q = closest_on_triangle(t.corners, p);
    // On the border the two notions of inside may differ by rounding.
    if (q.region == 0) return at(q.point, p, FacePoint::Place::Face);
    return nearest_on_rim_of_patch(model, t, q, p);
  }
  const Eigen::Vector3d c = closest_point(face.surface, p);
  if (is_coarse(face)) {
    const TrianglePoint q = closest_on_coarse(face, t, c);
    if (q.region == 0) return at(c, p, FacePoint::Place::Face);
    return nearest_on_rim_of_patch(model, t, q, p);
  }
  const auto x = place_under(t, face, c);
  if (x && (is_inside(t, *x, kInsideSlack) || is_short_of_rim(model, t, c, *x))) {
    return at(c, p, FacePoint::Place::Face);
  }
  const TrianglePoint q = closest_on_triangle(t.corners, p);
  if (q.region == 0) return at(closest_point(face.surface, q.point), p, FacePoint::Place::Face);
  return nearest_on_rim_of_patch(model, t, q, p);
}

}  // namespace

bool blend_in_circle(const Face& f, const Face& g) {
  return is_plane(f.surface) != is_plane(g.surface) &&
         rim_circle(f, g, Eigen::Vector3d::Zero()).has_value();
}

Eigen::Vector3d rim_offset(const Face& face, const Face& beyond, const ModelTriangle& t,
                           std::size_t i) {
  const Eigen::Vector3d middle = 0.5 * (t.corners[i] + t.corners[(i + 1) % 3]);
  const bool both = is_exact(face) && is_exact(beyond);
  if (!both || (is_plane(face.surface) && is_plane(beyond.surface))) return {0.0, 0.0, 0.0};
  if (t.edges[i] == EdgeShape::Blend) {
    const auto circle = rim_circle(face, beyond, t.corners[i]);
    const Eigen::Vector3d outward = from_axis(*circle, middle);
    const double radius_mm = outward.norm();
    if (radius_mm <= kOnAxis_mm) return {0.0, 0.0, 0.0};
    return outward * (circle->radius_mm / radius_mm - 1.0);
  }
  Eigen::Vector3d x = middle;
  // Twice: the curve may be far off where the surfaces meet at a small angle.
  if (to_intersection(face, beyond, x) && to_intersection(face, beyond, x)) return x - middle;
  for (int step = 0; step < 8; ++step) {
    x = closest_point(face.surface, closest_point(beyond.surface, x));
  }
  return x - middle;
}

bool is_chord(const CollisionModel& model, const ModelTriangle& t, std::size_t i) {
  return t.slack_mm > 0.0 && t.edges[i] != EdgeShape::Inner && t.edges[i] != EdgeShape::Smooth &&
         is_exact(model.face(t.face)) && is_exact(model.face(t.neighbours[i]));
}

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

FacePoint nearest_on_patch(const CollisionModel& model, std::uint32_t index,
                           const Eigen::Vector3d& p, double within_squared_mm2, bool is_over) {
  FacePoint result =
      nearest_with_overhang(model, model.triangles()[index], p, within_squared_mm2, is_over);
  // The rim is on the face, and so no nearer than its foot.
  if (result.place != FacePoint::Place::Face || result.distance_squared_mm2 > within_squared_mm2) {
    return result;
  }
  const std::span<const Chord> chords = model.overhangs(index);
  if (chords.empty()) return result;
  // Where the foot is beyond the rim on both faces, the rim is nearest, and both have to look
  // there.
  FacePoint on_rim = result;
  on_rim.distance_squared_mm2 = std::numeric_limits<double>::infinity();
  bool overhangs = false;
  for (const Chord& chord : chords) {
    if (!overhangs_rim(model, chord, result.point)) continue;
    overhangs = true;
    const ModelTriangle& t = model.triangles()[chord.triangle];
    FacePoint on_arc = nearest_on_arc(model, t, chord.edge, p);
    // A corner between two chords is none of the rim.
    on_arc.place = rim_place(t.edges[chord.edge]);
    if (on_arc.distance_squared_mm2 < on_rim.distance_squared_mm2) on_rim = on_arc;
  }
  return overhangs ? on_rim : result;
}

}  // namespace dowel
