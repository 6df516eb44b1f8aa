#include "dowel/catalog/face_outline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "dowel/kernel/convex_hull.h"
#include "dowel/kernel/tolerance.h"
#include "face_graph.h"
#include "facet_geometry.h"
#include "planar_faces.h"

namespace dowel {
namespace {

using Type = OutlineEdge::Type;
using Eigen::Vector3d;

/// Angle from `a` to `b`, counter-clockwise about `normal`.
double angle_rad(const Vector3d& a, const Vector3d& b, const Vector3d& normal) {
  return std::atan2(normal.dot(a.cross(b)), a.dot(b));
}

bool is_same_point(const Vector3d& a, const Vector3d& b) {
  return (a - b).norm() <= kSameFeature_mm;
}

/// The rim of one planar face, made of sides of facets.
class RimTracer {
 public:
  RimTracer(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const Feature& face)
      : solid_(solid), graph_(graph), normal_(face.direction), faces_(face.faces) {
    plane_ = {face.origin, face.direction};
    for (const std::uint32_t f : faces_) {
      for (const RimEdge& edge : graph_[f].rim) {
        if (!std::binary_search(faces_.begin(), faces_.end(), edge.face_across)) {
          leaving_.emplace(edge.from, &edge);
        }
      }
    }
  }

  /// All loops; none where they do not close.
  std::vector<OutlineLoop> run() {
    std::vector<OutlineLoop> loops;
    while (!leaving_.empty()) {
      std::optional<OutlineLoop> loop = next_loop();
      if (!loop) return {};
      loops.push_back(std::move(*loop));
    }
    return loops;
  }

 private:
  using Leaving = std::multimap<std::uint32_t, const RimEdge*>;

  Vector3d along(const RimEdge& edge) const {
    return solid_.vertices[edge.to] - solid_.vertices[edge.from];
  }

  /// Where loops touch in a vertex, the side that turns left most bounds the same piece of face.
  Leaving::iterator after(const RimEdge& edge) {
    const auto [first, last] = leaving_.equal_range(edge.to);
    return std::max_element(first, last, [&](const auto& a, const auto& b) {
      return angle_rad(along(edge), along(*a.second), normal_) <
             angle_rad(along(edge), along(*b.second), normal_);
    });
  }

  std::optional<OutlineLoop> next_loop() {
    OutlineLoop loop;
    auto at = leaving_.begin();
    const std::uint32_t start = at->first;
    while (true) {
      const RimEdge edge = *at->second;
      leaving_.erase(at);
      loop.push_back(side(edge));
      if (edge.to == start) return loop;
      at = after(edge);
      if (at == leaving_.end() || at->first != edge.to) return std::nullopt;
    }
  }

  /// One side of a facet, on the circle of the wall beyond it where that is one.
  OutlineEdge side(const RimEdge& rim) const {
    OutlineEdge edge{Type::Chord, solid_.vertices[rim.from], solid_.vertices[rim.to]};
    const Surface& wall = graph_[rim.face_across].surface;
    const auto* const cylinder = std::get_if<CylinderSurface>(&wall);
    const bool lies_along =
        cylinder != nullptr && std::abs(cylinder->axis.dot(normal_)) <= kCoaxial_rad;
    if (is_plane(wall) || lies_along) {
      edge.type = Type::Line;
    } else if (const auto center = circle_center(wall, plane_)) {
      edge.type = Type::Arc;
      edge.center = *center;
      edge.radius_mm = 0.5 * ((edge.from - *center).norm() + (edge.to - *center).norm());
      edge.turn_rad = angle_rad(edge.from - *center, edge.to - *center, normal_);
    }
    return edge;
  }

  const FacetedSolid& solid_;
  const std::vector<FaceNode>& graph_;
  Vector3d normal_;
  PlaneSurface plane_;
  const std::vector<std::uint32_t>& faces_;
  Leaving leaving_;
};

/// Joins `next` to `edge` where both are one line or arc.
bool join(OutlineEdge& edge, const OutlineEdge& next) {
  if (edge.type == Type::Arc && next.type == Type::Arc) {
    const bool is_one = is_same_point(edge.center, next.center) &&
                        std::abs(edge.radius_mm - next.radius_mm) <= kSameFeature_mm &&
                        (edge.turn_rad > 0.0) == (next.turn_rad > 0.0);
    if (is_one) edge.turn_rad += next.turn_rad;
    if (is_one) edge.to = next.to;
    return is_one;
  }
  if (edge.type == Type::Arc || next.type == Type::Arc) return false;
  // Free-form faces may leave it in a line, too: what is straight is one.
  const Vector3d whole = next.to - edge.from;
  const double length_mm = whole.norm();
  if (!(length_mm > 0.0) || !(whole.dot(edge.to - edge.from) > 0.0) ||
      !(whole.dot(next.to - next.from) > 0.0)) {
    return false;
  }
  if ((edge.to - edge.from).cross(whole).norm() > kMinTolerance_mm * length_mm) return false;
  edge.type = Type::Line;
  edge.to = next.to;
  return true;
}

/// In the plane of a face: x to the right as it is looked at, y up.
struct Frame {
  explicit Frame(const Vector3d& normal) {
    const bool lies = std::abs(normal.z()) > 1.0 - kParallel_rad;
    up = lies ? Vector3d::UnitY() : Vector3d::UnitZ();
    right = up.cross(normal).normalized();
    up = normal.cross(right);
  }
  /// Whether `a` is left of `b`, else below it; what differs by less is level.
  bool before(const Vector3d& a, const Vector3d& b) const {
    const double across_mm = right.dot(a - b);
    if (std::abs(across_mm) > kSameFeature_mm) return across_mm < 0.0;
    return up.dot(a - b) < -kSameFeature_mm;
  }
  Vector3d right;
  Vector3d up;
};

/// Whole lines and arcs, from the first corner on: how the facets were cut does not show.
OutlineLoop joined(const OutlineLoop& sides, const Frame& frame) {
  OutlineLoop loop;
  for (const OutlineEdge& side : sides) {
    if (loop.empty() || !join(loop.back(), side)) loop.push_back(side);
  }
  while (loop.size() > 1 && join(loop.back(), loop.front())) loop.erase(loop.begin());
  if (loop.size() == 1 && loop[0].type == Type::Arc) {
    OutlineEdge& circle = loop[0];
    circle.from = circle.to = circle.center + circle.radius_mm * frame.right;
    circle.turn_rad = std::copysign(2.0 * std::numbers::pi, circle.turn_rad);
    return loop;
  }
  const auto first = std::min_element(
      loop.begin(), loop.end(),
      [&](const OutlineEdge& a, const OutlineEdge& b) { return frame.before(a.from, b.from); });
  std::rotate(loop.begin(), first, loop.end());
  return loop;
}

/// Counter-clockwise positive.
double enclosed_mm2(const OutlineLoop& loop, const Vector3d& normal) {
  if (loop.empty()) return 0.0;
  const Vector3d& middle = loop.front().from;
  double area_mm2 = 0.0;
  for (const OutlineEdge& edge : loop) {
    area_mm2 += 0.5 * normal.dot((edge.from - middle).cross(edge.to - middle));
    if (edge.type != Type::Arc) continue;
    // Sine of the turn alone: at both ends of a full circle it is nothing, whatever its chord is.
    area_mm2 += 0.5 * edge.radius_mm * edge.radius_mm * (edge.turn_rad - std::sin(edge.turn_rad));
  }
  return area_mm2;
}

/// Whether an exact curved face stands out of `plane` between vertices that do not.
bool bulges_through(const FacetedSolid& solid, const FaceNode& node, double facet_error_mm,
                    const PlaneSurface& plane) {
  if (!(facet_error_mm > 0.0) || std::holds_alternative<OtherSurface>(node.surface)) return false;
  return std::ranges::any_of(node.triangles, [&](std::uint32_t t) {
    const auto [a, b, c] = solid.corners(t);
    for (const Vector3d& p : {Vector3d((a + b + c) / 3.0), Vector3d(0.5 * (a + b)),
                              Vector3d(0.5 * (b + c)), Vector3d(0.5 * (c + a))}) {
      if (plane.normal.dot(p - plane.origin) < -2.0 * facet_error_mm) continue;
      const Vector3d on_face = closest_point(node.surface, p);
      if (plane.normal.dot(on_face - plane.origin) > kSameFeature_mm) return true;
    }
    return false;
  });
}

bool is_on_hull(const FacetedSolid& solid, const ConvexHull& hull,
                const std::vector<FaceNode>& graph, const PlaneSurface& plane) {
  const bool has_facets_behind = std::ranges::all_of(hull.vertices, [&](std::uint32_t v) {
    return plane.normal.dot(solid.vertices[v] - plane.origin) <= kSameFeature_mm;
  });
  if (!has_facets_behind) return false;
  for (std::size_t f = 0; f < graph.size(); ++f) {
    if (bulges_through(solid, graph[f], solid.faces[f].facet_error_mm, plane)) return false;
  }
  return true;
}

FaceOutline outline_of(const FacetedSolid& solid, const ConvexHull& hull,
                       const std::vector<FaceNode>& graph, const Feature& face) {
  FaceOutline outline;
  outline.on_hull = is_on_hull(solid, hull, graph, {face.origin, face.direction});
  const Frame frame(face.direction);
  std::vector<OutlineLoop> loops;
  for (const OutlineLoop& sides : RimTracer(solid, graph, face).run()) {
    loops.push_back(joined(sides, frame));
  }
  if (loops.empty()) return outline;
  const auto outer = std::ranges::max_element(
      loops, {}, [&](const OutlineLoop& loop) { return enclosed_mm2(loop, face.direction); });
  outline.outer = std::move(*outer);
  loops.erase(outer);
  std::ranges::stable_sort(loops, [&](const OutlineLoop& a, const OutlineLoop& b) {
    return frame.before(a.front().from, b.front().from);
  });
  outline.inner = std::move(loops);
  return outline;
}

}  // namespace

double FaceOutline::area_mm2(const Vector3d& normal) const {
  double sum_mm2 = enclosed_mm2(outer, normal);
  for (const OutlineLoop& loop : inner) sum_mm2 += enclosed_mm2(loop, normal);
  return sum_mm2;
}

std::vector<FaceOutline> face_outlines(const FacetedSolid& solid,
                                       const std::vector<Feature>& features) {
  const std::vector<FaceNode> graph = face_graph(solid);
  const ConvexHull hull = convex_hull(solid.vertices);
  std::vector<FaceOutline> outlines;
  for (const Feature& feature : features) {
    if (feature.kind != FeatureKind::Face) continue;
    const bool is_known = std::ranges::all_of(
        feature.faces, [&graph](std::uint32_t face) { return face < graph.size(); });
    outlines.push_back(is_known ? outline_of(solid, hull, graph, feature) : FaceOutline());
  }
  return outlines;
}

}  // namespace dowel
