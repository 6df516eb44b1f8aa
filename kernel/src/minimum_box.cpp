#include "dowel/kernel/minimum_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "calipers.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/convex_hull.h"
#include "dowel/kernel/tolerance.h"
#include "hull_facets.h"
#include "planar_hull.h"

namespace dowel {
namespace {

// Bounds on the effort. The largest faces are all tried; of the rest, on finely faceted curved
// parts, only some in every direction, for neighbours give nearly the same box.
constexpr std::size_t kMaxLargeFaces = 256;
constexpr std::size_t kMaxFaces = 512;
constexpr double kThinning_rad = 0.1;
constexpr std::size_t kMaxEdges = 40;  // all pairs of them are tried
constexpr std::size_t kMaxMergedFaces = 4096;
constexpr std::size_t kRefined = 8;
constexpr std::size_t kRefinedOfMany = 3;  // on bodies of more than kManyPoints extreme points
constexpr std::size_t kManyPoints = 256;
constexpr int kMaxRefinements = 32;
constexpr std::size_t kExtremeDirections = 512;
constexpr double kFirstTilt_rad = 0.4;
constexpr double kLastTilt_rad = 1.0e-6;
// A box that no face is flush with is worse to work with; it must be smaller by this part.
constexpr double kWorthTilting = 1.0e-4;

/// A box without its place.
struct Candidate {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double volume_mm3 = std::numeric_limits<double>::infinity();

  /// 3 where the axes are those of the coordinates, less the farther they are from them.
  double alignment() const { return axes.cwiseAbs().colwise().maxCoeff().sum(); }
};

/// True where `a` is the smaller box; of equally large ones, where it is better aligned.
bool is_better(const Candidate& a, const Candidate& b) {
  if (a.volume_mm3 < b.volume_mm3 * (1.0 - kEqualVolumes)) return true;
  if (b.volume_mm3 < a.volume_mm3 * (1.0 - kEqualVolumes)) return false;
  return a.alignment() > b.alignment() + kEqualVolumes;
}

/// The boundary of a convex polyhedron, for looking at it from any direction.
struct Polyhedron {
  struct Ridge {
    std::array<std::uint32_t, 2> facets{};
    std::array<std::uint32_t, 2> ends{};
  };

  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> area_vectors;  ///< per facet, outward
  std::vector<Ridge> ridges;
};

/// The hull that `triangles` bound, about `origin`. Which facets are one is decided on the points
/// as they are, before rounding moves them.
Polyhedron make_polyhedron(std::span<const Eigen::Vector3d> points,
                           std::span<const Triangle> triangles, const Eigen::Vector3d& origin) {
  Polyhedron result;
  for (const Eigen::Vector3d& p : points) result.points.push_back(p - origin);
  struct HalfRidge {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t facet = 0;
  };
  std::vector<HalfRidge> halves;
  for (const HullFacet& facet : hull_facets(points, triangles)) {
    const auto index = static_cast<std::uint32_t>(result.area_vectors.size());
    const Eigen::Vector3d& apex = result.points[facet[0]];
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t from = facet[i];
      const std::uint32_t to = facet[(i + 1) % facet.size()];
      area += 0.5 * (result.points[from] - apex).cross(result.points[to] - apex);
      halves.push_back({std::min(from, to), std::max(from, to), index});
    }
    result.area_vectors.push_back(area);
  }
  std::sort(halves.begin(), halves.end(), [](const HalfRidge& a, const HalfRidge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.facet < b.facet;
  });
  for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
    result.ridges.push_back(
        {{halves[i].facet, halves[i + 1].facet}, {halves[i].low, halves[i].high}});
  }
  return result;
}

/// Corners of the outline seen along `direction`, once each, in no order. Facets that are seen
/// edge-on may count as either side.
std::vector<Eigen::Vector3d> silhouette(const Polyhedron& body, const Eigen::Vector3d& direction) {
  std::vector<bool> faces_viewer(body.area_vectors.size());
  for (std::size_t i = 0; i < faces_viewer.size(); ++i) {
    faces_viewer[i] = body.area_vectors[i].dot(direction) > 0.0;
  }
  std::vector<std::uint32_t> corners;
  for (const Polyhedron::Ridge& ridge : body.ridges) {
    if (faces_viewer[ridge.facets[0]] == faces_viewer[ridge.facets[1]]) continue;
    corners.insert(corners.end(), ridge.ends.begin(), ridge.ends.end());
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector3d> result;
  result.reserve(corners.size());
  for (const std::uint32_t corner : corners) result.push_back(body.points[corner]);
  return result;
}

/// Best box with a face across `direction` around points of extent `height_mm` along it whose
/// outline is the hull of `outline`.
Candidate best_box_across(const Eigen::Vector3d& direction, double height_mm,
                          std::span<const Eigen::Vector3d> outline) {
  const Eigen::Vector3d u = direction.unitOrthogonal();
  const Eigen::Vector3d v = direction.cross(u);
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(outline.size());
  for (const Eigen::Vector3d& p : outline) flat.emplace_back(u.dot(p), v.dot(p));
  std::vector<Eigen::Vector2d> polygon;
  for (const std::uint32_t i : planar_hull(flat)) polygon.push_back(flat[i]);

  Candidate best;
  if (polygon.size() < 2) return best;
  for (const FlushRectangle& rectangle : flush_rectangles(polygon)) {
    Candidate candidate;
    candidate.volume_mm3 = rectangle.area_mm2 * height_mm;
    if (candidate.volume_mm3 >= best.volume_mm3 * (1.0 + kEqualVolumes)) continue;
    const Eigen::Vector3d along = (rectangle.along.x() * u + rectangle.along.y() * v).normalized();
    candidate.axes << along, direction.cross(along), direction;
    if (is_better(candidate, best)) best = candidate;
  }
  return best;
}

double extent_mm(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& p : points) {
    const double at = direction.dot(p);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return high - low;
}

Candidate best_box_across(const Polyhedron& body, const Eigen::Vector3d& direction) {
  return best_box_across(direction, extent_mm(body.points, direction), silhouette(body, direction));
}

/// A total order, so that the order of the input has no say.
bool is_longer(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (a.squaredNorm() != b.squaredNorm()) return a.squaredNorm() > b.squaredNorm();
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Directions of `vectors`, whichever way they point, the longest first; parallel ones are added
/// up, so that slivers of a face cannot turn it. At most `max_large` directions, then more that
/// differ from all others by kThinning_rad, `max_count` in all.
std::vector<Eigen::Vector3d> distinct_directions(std::vector<Eigen::Vector3d> vectors,
                                                 std::size_t max_large, std::size_t max_count) {
  std::sort(vectors.begin(), vectors.end(), is_longer);
  const double thin_cosine = std::cos(kThinning_rad);
  std::vector<Eigen::Vector3d> sums;
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& vector : vectors) {
    if (vector.squaredNorm() < std::numeric_limits<double>::min()) break;
    const Eigen::Vector3d direction = vector.normalized();
    bool is_new = result.size() < max_count;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double cosine = direction.dot(result[i]);
      if (std::abs(cosine) < thin_cosine) continue;
      if (direction.cross(result[i]).norm() <= kParallel_rad) {
        sums[i] += cosine > 0.0 ? vector : Eigen::Vector3d(-vector);
        is_new = false;
        break;
      }
      if (result.size() >= max_large) is_new = false;
    }
    if (!is_new) continue;
    sums.push_back(vector);
    result.push_back(direction);
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = sums[i].normalized();
  return result;
}

/// Where boxes may have a face: along the faces, and along two edges at once, for the best box may
/// touch by edges alone (a tetrahedron stands in its cube).
std::vector<Eigen::Vector3d> promising_directions(const Polyhedron& body,
                                                  const Polyhedron& screen) {
  std::vector<Eigen::Vector3d> faces = body.area_vectors;
  if (faces.size() > kMaxMergedFaces) {
    // The largest would all be neighbours on a round body; the coarse one has some on every side.
    std::sort(faces.begin(), faces.end(), is_longer);
    faces.resize(kMaxMergedFaces);
    faces.insert(faces.end(), screen.area_vectors.begin(), screen.area_vectors.end());
  }
  std::vector<Eigen::Vector3d> result =
      distinct_directions(std::move(faces), kMaxLargeFaces, kMaxFaces);
  std::vector<Eigen::Vector3d> edges;
  for (const Polyhedron::Ridge& ridge : screen.ridges) {
    edges.push_back(screen.points[ridge.ends[1]] - screen.points[ridge.ends[0]]);
  }
  edges = distinct_directions(std::move(edges), kMaxEdges, kMaxEdges);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Eigen::Vector3d normal = edges[i].cross(edges[j]);
      if (normal.norm() > kParallel_rad) result.push_back(normal.normalized());
    }
  }
  return result;
}

/// Turns the box about each of its axes in turn as long as that makes it smaller.
Candidate refined(const Polyhedron& body, Candidate box) {
  bool is_improving = true;
  for (int round = 0; is_improving && round < kMaxRefinements; ++round) {
    is_improving = false;
    const Eigen::Matrix3d axes = box.axes;
    for (int k = 0; k < 3; ++k) {
      const Candidate turned = best_box_across(body, axes.col(k));
      if (turned.volume_mm3 >= box.volume_mm3 * (1.0 - kEqualVolumes)) continue;
      box = turned;
      is_improving = true;
    }
  }
  return box;
}

/// Tilts the direction of one face of the box, by less and less, as long as the box shrinks.
/// Compass search: the volume is smooth only piecewise.
Candidate tilted(const Polyhedron& body, Candidate box) {
  double step_rad = kFirstTilt_rad;
  while (step_rad > kLastTilt_rad) {
    bool is_improving = true;
    for (int round = 0; is_improving && round < kMaxRefinements; ++round) {
      is_improving = false;
      const Eigen::Matrix3d axes = box.axes;
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          if (i == 0 && j == 0) continue;
          const Eigen::Vector3d direction =
              axes.col(2) + step_rad * (i * axes.col(0) + j * axes.col(1));
          const Candidate turned = best_box_across(body, direction.normalized());
          if (turned.volume_mm3 >= box.volume_mm3 * (1.0 - kEqualVolumes)) continue;
          box = turned;
          is_improving = true;
        }
      }
    }
    step_rad *= 0.5;
  }
  return box;
}

/// The body itself where it is small, else the hull of its extreme points in many directions.
Polyhedron coarse(const Polyhedron& body) {
  if (body.points.size() <= 2 * kExtremeDirections) return body;
  std::vector<std::uint32_t> extremes;
  const double golden_angle_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < kExtremeDirections; ++i) {
    // A spiral over the half sphere; its opposite half comes with the other end.
    const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(kExtremeDirections);
    const double r = std::sqrt(1.0 - z * z);
    const double angle_rad = golden_angle_rad * static_cast<double>(i);
    const Eigen::Vector3d direction(r * std::cos(angle_rad), r * std::sin(angle_rad), z);
    const auto [low, high] =
        std::minmax_element(body.points.begin(), body.points.end(),
                            [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                              return direction.dot(a) < direction.dot(b);
                            });
    extremes.push_back(static_cast<std::uint32_t>(low - body.points.begin()));
    extremes.push_back(static_cast<std::uint32_t>(high - body.points.begin()));
  }
  std::sort(extremes.begin(), extremes.end());
  extremes.erase(std::unique(extremes.begin(), extremes.end()), extremes.end());
  std::vector<Eigen::Vector3d> points;
  points.reserve(extremes.size());
  for (const std::uint32_t i : extremes) points.push_back(body.points[i]);
  const ConvexHull hull = convex_hull(points);
  return hull.triangles.empty() ? body
                                : make_polyhedron(points, hull.triangles, Eigen::Vector3d::Zero());
}

/// The best of `candidates` and the next smallest that are different boxes.
std::vector<Candidate> most_promising(std::vector<Candidate> candidates, std::size_t count) {
  std::vector<Candidate> result(1);
  for (const Candidate& candidate : candidates) {
    if (is_better(candidate, result.front())) result.front() = candidate;
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.volume_mm3 < b.volume_mm3; });
  for (const Candidate& candidate : candidates) {
    if (result.size() == count) break;
    if (candidate.volume_mm3 > result.back().volume_mm3 * (1.0 + kEqualVolumes)) {
      result.push_back(candidate);
    }
  }
  return result;
}

Eigen::Matrix3d solid_axes(const Polyhedron& body) {
  const Polyhedron screen = coarse(body);
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& direction : promising_directions(body, screen)) {
    candidates.push_back(best_box_across(screen, direction));
  }
  candidates = most_promising(std::move(candidates),
                              body.points.size() > kManyPoints ? kRefinedOfMany : kRefined);

  Candidate flush;
  for (const Candidate& candidate : candidates) {
    const Candidate box = refined(body, best_box_across(body, candidate.axes.col(2)));
    if (is_better(box, flush)) flush = box;
  }
  Candidate best = flush;
  for (const Candidate& candidate : candidates) {
    const Candidate start = refined(screen, candidate);
    const Candidate box = best_box_across(body, tilted(screen, start).axes.col(2));
    const bool is_worth_it = box.volume_mm3 < flush.volume_mm3 * (1.0 - kWorthTilting);
    if (is_worth_it && box.volume_mm3 < best.volume_mm3) best = box;
  }
  return best.axes;
}

/// Axes for points that lie in a plane, on a line or in one place.
Eigen::Matrix3d flat_axes(const std::vector<Eigen::Vector3d>& points) {
  const auto farthest = [&](auto distance) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                               return distance(a) < distance(b);
                             });
  };
  const Eigen::Vector3d& start = points.front();
  const Eigen::Vector3d along =
      farthest([&](const Eigen::Vector3d& p) { return (p - start).norm(); }) - start;
  if (along.norm() == 0.0) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d normal = along.cross(
      farthest([&](const Eigen::Vector3d& p) { return along.cross(p - start).norm(); }) - start);
  if (points.size() < 3 || normal.squaredNorm() < std::numeric_limits<double>::min()) {
    const Eigen::Vector3d x = along.normalized();
    const Eigen::Vector3d y = x.unitOrthogonal();
    Eigen::Matrix3d axes;
    axes << x, y, x.cross(y);
    return axes;
  }
  std::vector<Eigen::Vector3d> about_start;
  about_start.reserve(points.size());
  for (const Eigen::Vector3d& p : points) about_start.push_back(p - start);
  return best_box_across(normal.normalized(), 1.0, about_start).axes;
}

/// The same axes, ordered and signed as close to the identity as right-handed ones can be, and
/// exact where they are coordinate axes up to rounding.
Eigen::Matrix3d tidied(const Eigen::Matrix3d& axes) {
  Eigen::Matrix3d best = axes;
  double most = -std::numeric_limits<double>::infinity();
  std::array<int, 3> order{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turned;
      for (int k = 0; k < 3; ++k) {
        const bool is_negative = ((signs >> static_cast<unsigned>(k)) & 1U) != 0;
        turned.col(k) = (is_negative ? -1.0 : 1.0) * axes.col(order[static_cast<std::size_t>(k)]);
      }
      if (turned.determinant() > 0.0 && turned.trace() > most + kEqualVolumes) {
        most = turned.trace();
        best = turned;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  if ((best - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRounding) best.setIdentity();
  return best;
}

/// The box of given axes around all points, also in the arithmetic of Obb::face_distance_mm.
Obb box_along(const Eigen::Matrix3d& axes, std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d origin = bounds(points).center();
  Aabb local;
  for (const Eigen::Vector3d& p : points) local.extend(axes.transpose() * (p - origin));
  Obb box;
  box.axes = axes;
  box.center = origin + axes * local.center();
  for (const Eigen::Vector3d& p : points) {
    box.half_extents_mm =
        box.half_extents_mm.cwiseMax((axes.transpose() * (p - box.center)).cwiseAbs());
  }
  return box;
}

}  // namespace

Obb minimum_box(std::span<const Eigen::Vector3d> points) {
  DOWEL_EXPECTS(!points.empty());
  const ConvexHull hull = convex_hull(points);

  // From here on the extreme points alone, sorted, so that the order of the input has no say.
  std::vector<std::uint32_t> order = hull.vertices;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(points[a].begin(), points[a].end(), points[b].begin(),
                                        points[b].end());
  });
  std::vector<Eigen::Vector3d> extremes;
  std::vector<std::uint32_t> new_index(points.size(), 0);
  for (const std::uint32_t i : order) {
    new_index[i] = static_cast<std::uint32_t>(extremes.size());
    extremes.push_back(points[i]);
  }
  if (hull.triangles.empty()) return box_along(tidied(flat_axes(extremes)), points);

  std::vector<Triangle> triangles = hull.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = new_index[v];
  }
  const Polyhedron body = make_polyhedron(extremes, triangles, bounds(points).center());
  return box_along(tidied(solid_axes(body)), points);
}

}  // namespace dowel
