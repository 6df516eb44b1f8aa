// Point queries of CollisionModel.

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dowel/collision/model.h"
#include "exact_face.h"

namespace dowel {
namespace {

/// Deep enough for any tree of 32-bit triangle counts of which no side has less than a quarter.
constexpr std::size_t kStackSize = 80;

/// A ray that passes an edge closer than this (relative to the triangle's size and distance) is not
/// counted but replaced by another: rounding could count it twice or not at all. The products that
/// tell on which side it passes are off by eight roundings, 1e-15, at most.
constexpr double kGrazing = 1e-9;

/// Steps of a walk over a face's facets: points that slide leave a facet for one near by.
constexpr int kWalk = 12;

/// Rays in general position: no axis of a machined part is parallel to one.
constexpr std::array<std::array<double, 3>, 8> kRays{{{0.27, 0.53, 0.81},
                                                      {-0.61, 0.37, 0.69},
                                                      {0.43, -0.79, 0.41},
                                                      {0.71, 0.59, -0.33},
                                                      {-0.31, -0.67, 0.67},
                                                      {0.83, -0.29, -0.47},
                                                      {-0.57, 0.73, -0.39},
                                                      {-0.73, -0.41, -0.53}}};

/// Boundaries of two solids closer than this are as near to a point: rounding.
constexpr double kTouching_mm = 1e-9;

double distance_squared(const BvhNode& node, const Eigen::Vector3d& p) {
  return (node.min - p).cwiseMax(p - node.max).cwiseMax(0.0).squaredNorm();
}

/// 1 where a ray from `origin` leaves the material through the triangle, -1 where it enters, 0
/// where it does neither; nothing where it grazes an edge or the plane.
std::optional<int> crossing(const ModelTriangle& t, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& ray) {
  const Eigen::Vector3d a = t.corners[0] - origin;
  const Eigen::Vector3d b = t.corners[1] - origin;
  const Eigen::Vector3d c = t.corners[2] - origin;
  const double u = ray.dot(c.cross(b));
  const double v = ray.dot(a.cross(c));
  const double w = ray.dot(b.cross(a));
  const double scale = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
  const double slack = kGrazing * scale;
  const bool positive = u > -slack && v > -slack && w > -slack;
  const bool negative = u < slack && v < slack && w < slack;
  if (!positive && !negative) return 0;
  if (std::abs(u) <= slack || std::abs(v) <= slack || std::abs(w) <= slack) return std::nullopt;
  const double along = (u * a + v * b + w * c).dot(ray) / (u + v + w);
  if (std::abs(along) <= kGrazing * std::sqrt(scale)) return std::nullopt;
  if (along <= 0.0) return 0;
  return u + v + w < 0.0 ? 1 : -1;
}

bool ray_meets(const BvhNode& node, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse) {
  const Eigen::Array3d near = (node.min - origin).array() * inverse.array();
  const Eigen::Array3d far = (node.max - origin).array() * inverse.array();
  const double enter = near.min(far).maxCoeff();
  const double leave = near.max(far).minCoeff();
  return leave >= 0.0 && enter <= leave * (1.0 + 1e-12) + 1e-12;
}

/// How often a ray leaves the material more than it enters it; nothing where it grazes a facet.
std::optional<int> exits(const CollisionModel& model, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& ray) {
  const Eigen::Vector3d inverse = ray.cwiseInverse();
  std::array<std::uint32_t, kStackSize> stack{};
  std::size_t depth = 1;
  int sum = 0;
  while (depth > 0) {
    const BvhNode& node = model.nodes()[stack[--depth]];
    if (!ray_meets(node, origin, inverse)) continue;
    if (!node.is_leaf()) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (const ModelTriangle& t : model.triangles().subspan(node.first, node.count)) {
      const std::optional<int> through = crossing(t, origin, ray);
      if (!through) return std::nullopt;
      sum += *through;
    }
  }
  return sum;
}

constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

bool is_inside(const CollisionModel& model, const FacePoint& place, std::uint32_t triangle,
               const Eigen::Vector3d& p) {
  switch (place.place) {
    case FacePoint::Place::ConvexRim:
      return false;
    case FacePoint::Place::ConcaveRim:
      return true;
    case FacePoint::Place::Corner:
      return model.facets_contain(p);
    case FacePoint::Place::Face:
      break;
  }
  const ModelTriangle& t = model.triangles()[triangle];
  const Face& face = model.face(t.face);
  if (is_exact(face)) return outward_distance_mm(face, p) < 0.0;
  return t.normal.dot(p - place.point) < 0.0;
}

/// What is nearest so far. Where solids of one element touch, the boundary of either is as near: of
/// the one that the point is in it is taken.
struct Best {
  FacePoint place;
  std::uint32_t triangle = kNoTriangle;
  double limit_squared_mm2 = std::numeric_limits<double>::infinity();  ///< what is beyond is no use

  void look_at(const CollisionModel& model, std::uint32_t t, const Eigen::Vector3d& p) {
    const ModelTriangle& facet = model.triangles()[t];
    const double height = facet.normal.dot(p - facet.corners[0]);
    const double above = std::max(std::abs(height) - facet.normal_slack_mm, 0.0);
    if (above * above > limit_squared_mm2) return;
    const auto& [a, b, c] = facet.corners;
    const double beside =
        (a.cwiseMin(b).cwiseMin(c) - p).cwiseMax(p - a.cwiseMax(b).cwiseMax(c)).maxCoeff() -
        facet.slack_mm;
    if (beside > 0.0 && beside * beside > limit_squared_mm2) return;
    const FacePoint candidate = nearest_on_patch(model, t, p, limit_squared_mm2);
    if (candidate.distance_squared_mm2 >= limit_squared_mm2) return;
    if (model.solid_count() > 1 && is_as_near(candidate)) {
      const bool was_inside = is_inside(model, place, triangle, p);
      const bool is_nearer = candidate.distance_squared_mm2 < place.distance_squared_mm2;
      if (was_inside == is_inside(model, candidate, t, p) ? !is_nearer : was_inside) return;
    }
    place = candidate;
    triangle = t;
    limit_squared_mm2 = candidate.distance_squared_mm2;
    if (model.solid_count() > 1) {
      const double distance = std::sqrt(limit_squared_mm2) + kTouching_mm;
      limit_squared_mm2 = distance * distance;
    }
  }

 private:
  bool is_as_near(const FacePoint& candidate) const {
    return triangle != kNoTriangle &&
           std::abs(std::sqrt(candidate.distance_squared_mm2) -
                    std::sqrt(place.distance_squared_mm2)) <= kTouching_mm;
  }
};

NearestPoint to_result(const CollisionModel& model, const Best& best, const Eigen::Vector3d& p) {
  return {best.place.point, std::sqrt(best.place.distance_squared_mm2),
          is_inside(model, best.place, best.triangle, p), best.triangle,
          best.place.place == FacePoint::Place::Face};
}

void search(const CollisionModel& model, const Eigen::Vector3d& point, Best& best) {
  struct Entry {
    std::uint32_t node;
    double distance_squared;
  };
  // Zeros would take a fifth of a search near by.
  std::array<Entry, kStackSize> stack;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::size_t depth = 0;
  stack[depth++] = {0, distance_squared(model.nodes()[0], point)};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.distance_squared >= best.limit_squared_mm2) continue;
    const BvhNode& node = model.nodes()[entry.node];
    if (node.is_leaf()) {
      for (std::uint32_t i = 0; i < node.count; ++i) best.look_at(model, node.first + i, point);
      continue;
    }
    Entry near{node.first, distance_squared(model.nodes()[node.first], point)};
    Entry far{node.first + 1, distance_squared(model.nodes()[node.first + 1], point)};
    if (far.distance_squared < near.distance_squared) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
}

}  // namespace

NearestPoint CollisionModel::nearest(const Eigen::Vector3d& point) const {
  Best best;
  search(*this, point, best);
  return to_result(*this, best, point);
}

std::optional<NearestPoint> CollisionModel::nearest_within(const Eigen::Vector3d& point,
                                                           double radius_mm) const {
  Best best;
  best.limit_squared_mm2 = radius_mm * radius_mm;
  search(*this, point, best);
  if (best.triangle == kNoTriangle) return std::nullopt;
  return to_result(*this, best, point);
}

Footing CollisionModel::walk_towards(std::uint32_t start, const Eigen::Vector3d& point) const {
  std::uint32_t at = start;
  for (int step = 0; step < kWalk; ++step) {
    const ModelTriangle& t = triangles_[at];
    double most = 0.0;
    std::uint32_t next = at;
    bool is_over = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d edge = t.corners[(i + 1) % 3] - t.corners[i];
      const double beyond = edge.cross(t.normal).dot(point - t.corners[i]);
      if (t.edges[i] != EdgeShape::Inner) {
        is_over = is_over && beyond <= 0.0;
      } else if (beyond > most) {
        most = beyond;
        next = t.beyond[i];
      }
    }
    if (next == at) return {at, is_over};
    at = next;
  }
  return {at, false};
}

NearestPoint CollisionModel::nearest_brute_force(const Eigen::Vector3d& point) const {
  Best best;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) best.look_at(*this, t, point);
  return to_result(*this, best, point);
}

bool CollisionModel::facets_contain(const Eigen::Vector3d& point) const {
  for (const auto& ray : kRays) {
    const auto sum = exits(*this, point, Eigen::Vector3d(ray.data()));
    if (sum) return *sum > 0;
  }
  return winding_number(point) > 0.5;
}

double CollisionModel::winding_number(const Eigen::Vector3d& point) const {
  double sum = 0.0;
  for (const ModelTriangle& t : triangles_) {
    const Eigen::Vector3d a = t.corners[0] - point;
    const Eigen::Vector3d b = t.corners[1] - point;
    const Eigen::Vector3d c = t.corners[2] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double numerator = a.dot(b.cross(c));
    const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    sum += std::atan2(numerator, denominator);
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace dowel
