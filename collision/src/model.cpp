#include "dowel/collision/model.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <unordered_map>

#include "coarse_torus.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "exact_face.h"

namespace dowel {
namespace {

/// Sine of the dihedral angle below which two faces run on smoothly into each other (about 1
/// degree).
constexpr double kSmoothSine = 0.02;

/// Planes closer than this are one.
constexpr double kSamePlane_mm = 1.0e-9;

/// Measured rim errors are taken with this allowance: they are measured at the middle of a chord.
constexpr double kRimAllowance = 1.25;

struct DirectedEdge {
  std::uint64_t key;
  std::uint32_t triangle;
  std::uint32_t edge;
};

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) {
  return (std::uint64_t{from} << 32U) | to;
}

/// For each triangle and edge, the triangle beyond it.
std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const FacetedSolid& solid) {
  std::vector<DirectedEdge> edges;
  edges.reserve(solid.triangles.size() * 3);
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const Triangle& triangle = solid.triangles[t];
    for (std::uint32_t i = 0; i < 3; ++i) {
      edges.push_back({edge_key(triangle[i], triangle[(i + 1) % 3]), t, i});
    }
  }
  std::ranges::sort(edges, {}, &DirectedEdge::key);
  std::vector<std::array<std::uint32_t, 3>> result(solid.triangles.size());
  for (const DirectedEdge& edge : edges) {
    const auto reverse =
        edge_key(static_cast<std::uint32_t>(edge.key), static_cast<std::uint32_t>(edge.key >> 32U));
    const auto beyond = std::ranges::lower_bound(edges, reverse, {}, &DirectedEdge::key);
    result[edge.triangle][edge.edge] = beyond->triangle;  // exists: the mesh is closed
  }
  return result;
}

/// Whether a corner is the tip of a cone, where it has no one normal.
bool is_apex(const Face& face, const Eigen::Vector3d& corner) {
  const auto* cone = std::get_if<ConeSurface>(&face.surface);
  return cone != nullptr && (corner - cone->apex).norm() <= kCoincident_mm;
}

EdgeShape edge_shape(const FacetedSolid& solid, std::uint32_t t, std::uint32_t beyond,
                     const Eigen::Vector3d& normal, std::size_t edge) {
  if (solid.face_of[t] == solid.face_of[beyond]) return EdgeShape::Inner;
  const Face& face = solid.faces[solid.face_of[t]];
  const Face& face_beyond = solid.faces[solid.face_of[beyond]];
  const std::uint32_t from = solid.triangles[t][edge];
  const std::uint32_t to = solid.triangles[t][(edge + 1) % 3];
  std::uint32_t opposite = from;
  for (const std::uint32_t vertex : solid.triangles[beyond]) {
    if (vertex != from && vertex != to) opposite = vertex;
  }
  const Eigen::Vector3d& a = solid.vertices[from];
  const Eigen::Vector3d along = (solid.vertices[to] - a).normalized();
  if (is_exact(face) && is_exact(face_beyond)) {
    // Facets of a curved face meet a tangent plane at an angle; the exact faces do not, on the rim.
    double sine = 0.0;
    bool is_ahead = false;
    for (const Eigen::Vector3d& end : {a, solid.vertices[to]}) {
      if (is_apex(face, end) || is_apex(face_beyond, end)) continue;
      const Eigen::Vector3d n = outward_normal(face, end);
      const Eigen::Vector3d n_beyond = outward_normal(face_beyond, end);
      const double sine_here = n.cross(n_beyond).dot(along);
      if (std::abs(sine_here) > std::abs(sine)) sine = sine_here;
      is_ahead = is_ahead || n.dot(n_beyond) > 0.0;
    }
    if (std::abs(sine) > kSmoothSine) return sine > 0.0 ? EdgeShape::Convex : EdgeShape::Concave;
    if (is_ahead) return blend_in_circle(face, face_beyond) ? EdgeShape::Blend : EdgeShape::Smooth;
  }
  const Eigen::Vector3d away = solid.vertices[opposite] - a;
  const double height = normal.dot(away);
  const double reach = (away - along * along.dot(away)).norm();
  if (std::abs(height) <= kSmoothSine * reach) {
    return normal.cross(along).dot(away) < 0.0 ? EdgeShape::Smooth
           : height < 0.0                      ? EdgeShape::Convex
                                               : EdgeShape::Concave;
  }
  return height < 0.0 ? EdgeShape::Convex : EdgeShape::Concave;
}

/// How far the exact face can stand off the inside of a facet along x, y and z: a cylinder does so
/// across its axis only.
Eigen::Vector3d inner_reach(const Face& face, double slack_mm) {
  const auto* cylinder = std::get_if<CylinderSurface>(&face.surface);
  if (cylinder == nullptr) return Eigen::Vector3d::Constant(slack_mm);
  return slack_mm * (1.0 - cylinder->axis.array().square()).max(0.0).sqrt().matrix();
}

/// Whether an edge of `t` keeps all of `points` more than `margin_mm` out, seen along its normal.
bool is_beyond_an_edge(const ModelTriangle& t, std::span<const Eigen::Vector3d> points,
                       double margin_mm) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = t.corners[(i + 1) % 3] - t.corners[i];
    const Eigen::Vector3d outward = edge.cross(t.normal);
    const double limit = margin_mm * outward.norm();
    if (std::ranges::all_of(points, [&](const Eigen::Vector3d& p) {
          return outward.dot(p - t.corners[i]) > limit;
        })) {
      return true;
    }
  }
  return false;
}

bool are_one(const PlaneSurface& a, const PlaneSurface& b) {
  return a.normal.dot(b.normal) > 0.0 && a.normal.cross(b.normal).norm() <= kParallel_rad &&
         std::abs(a.normal.dot(b.origin - a.origin)) <= kSamePlane_mm;
}

bool overlap(const BvhNode& node, const Aabb& box) {
  return (node.min.array() <= box.max.array()).all() && (box.min.array() <= node.max.array()).all();
}

}  // namespace

CollisionModel::CollisionModel(std::shared_ptr<const FacetedSolid> solid,
                               std::span<const std::uint32_t> hole_faces)
    : solid_(std::move(solid)) {
  DOWEL_EXPECTS(solid_ != nullptr);
  if (const auto defect = find_defect(*solid_)) throw Error(ErrorCode::FileMalformed, *defect);
  build_tree(build_triangles(hole_faces));
  find_overhangs();
  find_inner_points();
  find_seat_planes();
  profiles_ = find_axis_profiles(*this);
  cores_ = find_cores(*this);
}

std::vector<Eigen::Vector3d> CollisionModel::build_triangles(
    std::span<const std::uint32_t> hole_faces) {
  const FacetedSolid& solid = *solid_;
  const auto neighbours = triangle_neighbours(solid);
  std::vector<bool> is_hole(solid.faces.size(), false);
  for (const std::uint32_t face : hole_faces) {
    DOWEL_EXPECTS(face < is_hole.size());
    is_hole[face] = true;
  }

  std::vector<Eigen::Vector3d> reaches(solid.triangles.size());
  triangles_.resize(solid.triangles.size());
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    ModelTriangle& t = triangles_[i];
    t.corners = solid.corners(i);
    t.face = solid.face_of[i];
    t.is_hole = is_hole[t.face];
    const Face& face = solid.faces[t.face];
    t.normal = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
    // A sliver's own normal is rounding; its plane's is not.
    if (const auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      t.normal = plane->normal;
    } else if (t.normal.squaredNorm() > 0.0) {
      t.normal.normalize();
    }
    t.slack_mm = is_exact(face) && !is_plane(face.surface) ? face.facet_error_mm : 0.0;
    if (is_coarse(face)) t.slack_mm = std::max(t.slack_mm, coarse_reach_mm(face, t));
    const bool is_flat = is_plane(face.surface);
    reaches[i] = inner_reach(face, t.slack_mm);
    if (!is_exact(face)) max_unknown_mm_ = std::max(max_unknown_mm_, face.facet_error_mm);
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t beyond = neighbours[i][edge];
      t.beyond[edge] = beyond;
      t.neighbours[edge] = solid.face_of[beyond];
      t.edges[edge] = edge_shape(solid, i, beyond, t.normal, edge);
      if (t.edges[edge] != EdgeShape::Inner && t.edges[edge] != EdgeShape::Smooth) {
        const Eigen::Vector3d offset =
            kRimAllowance * rim_offset(face, solid.faces[t.neighbours[edge]], t, edge);
        t.slack_mm = std::max(t.slack_mm, offset.norm());
        reaches[i] = reaches[i].cwiseMax(offset.cwiseAbs());
      }
    }
    t.normal_slack_mm = is_flat ? 0.0 : t.slack_mm;
    max_slack_mm_ = std::max(max_slack_mm_, t.slack_mm);
  }

  // Components, by the smallest triangle in each.
  component_of_.resize(triangles_.size());
  std::iota(component_of_.begin(), component_of_.end(), 0U);
  const auto root = [&](std::uint32_t t) {
    while (component_of_[t] != t) t = component_of_[t] = component_of_[component_of_[t]];
    return t;
  };
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t beyond : neighbours[t]) {
      const auto [low, high] = std::minmax({root(t), root(beyond)});
      component_of_[high] = low;
    }
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) component_of_[t] = root(t);
  return reaches;
}

void CollisionModel::find_overhangs() {
  // Chords whose arc bulges over their own face, each with the facets of it that it reaches.
  std::vector<std::pair<std::uint32_t, Chord>> found;
  std::vector<std::uint32_t> stack;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const ModelTriangle& t = triangles_[i];
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      if (!is_chord(*this, t, edge)) continue;
      const Eigen::Vector3d offset = rim_offset(face(t.face), face(t.neighbours[edge]), t, edge);
      const Eigen::Vector3d& a = t.corners[edge];
      const Eigen::Vector3d& b = t.corners[(edge + 1) % 3];
      if ((b - a).cross(t.normal).dot(offset) >= 0.0) continue;
      const Eigen::Vector3d bulge = kRimAllowance * offset;
      const std::array<Eigen::Vector3d, 4> around{a, b, a + bulge, b + bulge};
      const Aabb box = bounds(around);
      stack.assign(1, 0);
      while (!stack.empty()) {
        const BvhNode& node = nodes_[stack.back()];
        stack.pop_back();
        if (!overlap(node, box)) continue;
        if (!node.is_leaf()) {
          stack.insert(stack.end(), {node.first, node.first + 1});
          continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
          const ModelTriangle& other = triangles_[k];
          if (other.face != t.face) continue;
          const double margin_mm = other.slack_mm + t.normal_slack_mm + kCoincident_mm;
          if (!is_beyond_an_edge(other, around, margin_mm)) found.emplace_back(k, Chord{i, edge});
        }
      }
    }
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first; });
  overhang_begin_.assign(triangles_.size() + 1, 0);
  for (const auto& [triangle, chord] : found) {
    ++overhang_begin_[triangle + 1];
    overhangs_.push_back(chord);
  }
  std::partial_sum(overhang_begin_.begin(), overhang_begin_.end(), overhang_begin_.begin());
}

CollisionModel::InnerPoint CollisionModel::pushed_inwards(InnerPoint from, Eigen::Vector3d boundary,
                                                          double step_mm) const {
  constexpr int kPushes = 12;
  double push = 0.5 * step_mm;
  for (int k = 0; k < kPushes; ++k) {
    const Eigen::Vector3d away = (from.point - boundary).normalized();
    if (!away.allFinite()) break;
    const Eigen::Vector3d moved = from.point + push * away;
    const NearestPoint next = nearest(moved);
    if (next.inside && next.distance_mm > from.depth_mm) {
      from = {moved, next.distance_mm};
      boundary = next.point;
    } else {
      push *= 0.5;
    }
  }
  return from;
}

void CollisionModel::find_inner_points() {
  // From some facets of each component a step inward: the middle of the way to the far side is a
  // start, pushed away from the nearest boundary as long as that makes it deeper.
  constexpr std::size_t kStarts = 24;
  constexpr int kSteps = 9;
  std::map<std::uint32_t, std::vector<std::uint32_t>> components;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) components[component_of_[t]].push_back(t);
  for (const auto& [component, members] : components) {
    InnerPoint best{Eigen::Vector3d::Zero(), 0.0};
    const std::size_t stride = std::max<std::size_t>(1, members.size() / kStarts);
    Aabb box;
    for (const std::uint32_t t : members) {
      for (const Eigen::Vector3d& corner : triangles_[t].corners) box.extend(corner);
    }
    const double reach = box.size().minCoeff();
    for (std::size_t i = 0; i < members.size(); i += stride) {
      const ModelTriangle& t = triangles_[members[i]];
      const Eigen::Vector3d center = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
      double step = 0.5 * reach;
      for (int k = 0; k < kSteps; ++k, step *= 0.5) {
        const Eigen::Vector3d start = center - step * t.normal;
        const NearestPoint near = nearest(start);
        if (!near.inside) continue;
        const InnerPoint found = pushed_inwards({start, near.distance_mm}, near.point, step);
        if (found.depth_mm > best.depth_mm) best = found;
        break;
      }
    }
    if (best.depth_mm > 0.0) inner_points_.push_back(best);
  }
}

void CollisionModel::find_seat_planes() {
  constexpr std::size_t kSeatPlanes = 16;
  struct Entry {
    PlaneSurface plane;
    double area_mm2 = 0.0;
  };
  std::vector<Entry> entries;
  for (const Face& face : solid_->faces) {
    const auto* plane = std::get_if<PlaneSurface>(&face.surface);
    if (plane == nullptr) continue;
    const auto known = std::ranges::find_if(
        entries, [&](const Entry& entry) { return are_one(entry.plane, *plane); });
    if (known == entries.end()) {
      entries.push_back({*plane, face.area_mm2});
    } else {
      known->area_mm2 += face.area_mm2;
    }
  }
  std::ranges::stable_sort(entries, std::ranges::greater(), &Entry::area_mm2);
  if (entries.size() > kSeatPlanes) entries.resize(kSeatPlanes);
  for (const Entry& entry : entries) {
    seat_planes_.push_back({entry.plane, 0, 0});
    find_seats(seat_planes_.back());
  }
}

void CollisionModel::find_seats(SeatPlane& plane) {
  constexpr std::size_t kSeats = 8;
  std::vector<Seat> places;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const ModelTriangle& t = triangles_[i];
    const auto* surface = std::get_if<PlaneSurface>(&face(t.face).surface);
    if (surface == nullptr || !are_one(*surface, plane.plane)) continue;
    const Eigen::Vector3d center = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
    const FacePoint near = nearest_on_patch(*this, i, center);
    if (near.place != FacePoint::Place::Face || !std::isfinite(near.distance_squared_mm2)) continue;
    places.push_back({near.point, i});
  }
  // The farthest from all that are taken is taken next.
  plane.first = static_cast<std::uint32_t>(seats_.size());
  std::vector<double> distance(places.size(), std::numeric_limits<double>::infinity());
  while (plane.count < std::min(kSeats, places.size())) {
    const auto farthest = std::ranges::max_element(distance) - distance.begin();
    const Seat& taken = places[static_cast<std::size_t>(farthest)];
    seats_.push_back(taken);
    ++plane.count;
    for (std::size_t i = 0; i < places.size(); ++i) {
      distance[i] = std::min(distance[i], (places[i].point - taken.point).squaredNorm());
    }
  }
}

std::size_t CollisionModel::memory_bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(BvhNode) +
         triangles_.capacity() * sizeof(ModelTriangle) +
         component_of_.capacity() * sizeof(component_of_[0]) +
         node_boxes_.capacity() * sizeof(NodeBox) + overhangs_.capacity() * sizeof(Chord) +
         overhang_begin_.capacity() * sizeof(overhang_begin_[0]) +
         inner_points_.capacity() * sizeof(InnerPoint) +
         seat_planes_.capacity() * sizeof(SeatPlane) + seats_.capacity() * sizeof(Seat) +
         profiles_.memory_bytes() + cores_.memory_bytes();
}

}  // namespace dowel
