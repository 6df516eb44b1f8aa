#include "dowel/kernel/convex_hull.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "dowel/kernel/check.h"
#include "dowel/kernel/predicates.h"
#include "hull_facets.h"
#include "planar_hull.h"

namespace dowel {
namespace {

using Index = std::uint32_t;
constexpr Index kNone = std::numeric_limits<Index>::max();

/// Component to leave out so that a plane with `normal` keeps most of its area.
int dominant_axis(const Eigen::Vector3d& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// `p` without its component `axis`; the rest in cyclic order.
Eigen::Vector2d without(const Eigen::Vector3d& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

bool are_collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orient2d(without(a, axis), without(b, axis), without(c, axis)) != 0) return false;
  }
  return true;
}

/// A facet under construction. Edge k runs from corner k to corner k + 1.
struct Facet {
  std::array<Index, 3> corners{};
  std::array<Index, 3> neighbours{};
  std::vector<Index> outside;  ///< points strictly above the facet, the farthest one last
  bool is_dead = false;
};

/// Quickhull over distinct points in lexicographic order. Facets may be coplanar and their corners
/// need not be extreme; both are put right at the end.
class Quickhull {
 public:
  explicit Quickhull(std::span<const Eigen::Vector3d> points) : points_(points) {}

  /// Four points that span space, or fewer where all lie in a plane.
  std::vector<Index> find_simplex() const;

  std::vector<Triangle> run(const std::vector<Index>& simplex);

 private:
  const Eigen::Vector3d& at(Index i) const { return points_[i]; }
  bool is_above(Index point, const Facet& facet) const {
    return orient3d(at(facet.corners[0]), at(facet.corners[1]), at(facet.corners[2]), at(point)) >
           0;
  }

  void start(const std::vector<Index>& simplex);
  void expand(Index seed);
  void find_visible(Index seed, Index point);
  void add_cone(Index point);
  void hand_out(Index point);
  void give(std::span<const Index> points, std::span<const Index> facets);

  /// An edge between a visible facet and one that is not, in the direction of the visible one.
  struct HorizonEdge {
    Index from = 0;
    Index to = 0;
    Index beyond = 0;  ///< the facet that stays
  };

  std::span<const Eigen::Vector3d> points_;
  std::vector<Facet> facets_;
  std::vector<Index> open_;  ///< facets with points outside, some of them dead
  // Scratch of one expansion.
  std::vector<Index> visible_;
  std::vector<HorizonEdge> horizon_;
  std::vector<Index> created_;
  std::vector<Index> visited_for_;   ///< per facet: the point it was last looked at from
  std::vector<Index> created_from_;  ///< per point: the new facet whose first corner it is
};

std::vector<Index> Quickhull::find_simplex() const {
  // Rounded distances choose, so that the first simplex is a large one; predicates decide.
  const auto count = static_cast<Index>(points_.size());
  std::vector<Index> simplex;
  if (count == 0) return simplex;
  simplex.push_back(0);
  if (count == 1) return simplex;
  const Index last = count - 1;
  simplex.push_back(last);

  const Eigen::Vector3d along = at(last) - at(0);
  const auto add_best = [&](auto measure, auto is_degenerate) {
    Index best = 0;
    double most = -1.0;
    for (Index i = 0; i < count; ++i) {
      const double value = measure(at(i));
      if (value > most) {
        most = value;
        best = i;
      }
    }
    for (Index i = 0; is_degenerate(at(best)) && i < count; ++i) best = i;
    if (is_degenerate(at(best))) return false;
    simplex.push_back(best);
    return true;
  };
  if (!add_best([&](const Eigen::Vector3d& p) { return along.cross(p - at(0)).squaredNorm(); },
                [&](const Eigen::Vector3d& p) { return are_collinear(at(0), at(last), p); })) {
    return simplex;
  }
  const Index third = simplex[2];
  const Eigen::Vector3d normal = along.cross(at(third) - at(0));
  add_best([&](const Eigen::Vector3d& p) { return std::abs(normal.dot(p - at(0))); },
           [&](const Eigen::Vector3d& p) { return orient3d(at(0), at(last), at(third), p) == 0; });
  return simplex;
}

void Quickhull::start(const std::vector<Index>& simplex) {
  std::array<Index, 4> v{simplex[0], simplex[1], simplex[2], simplex[3]};
  if (orient3d(at(v[0]), at(v[1]), at(v[2]), at(v[3])) > 0) std::swap(v[1], v[2]);
  // Now v[3] is below the facet v[0] v[1] v[2].
  facets_.resize(4);
  facets_[0] = {{v[0], v[1], v[2]}, {1, 2, 3}, {}, false};
  facets_[1] = {{v[1], v[0], v[3]}, {0, 3, 2}, {}, false};
  facets_[2] = {{v[2], v[1], v[3]}, {0, 1, 3}, {}, false};
  facets_[3] = {{v[0], v[2], v[3]}, {0, 2, 1}, {}, false};
  visited_for_.assign(4, kNone);
  created_from_.assign(points_.size(), kNone);

  std::vector<Index> all(points_.size());
  std::iota(all.begin(), all.end(), 0U);
  give(all, std::array<Index, 4>{0, 1, 2, 3});
}

/// Gives each of `points` to the first of `facets` that it is above; the others are inside.
void Quickhull::give(std::span<const Index> points, std::span<const Index> facets) {
  for (const Index point : points) {
    for (const Index f : facets) {
      if (!is_above(point, facets_[f])) continue;
      facets_[f].outside.push_back(point);
      break;
    }
  }
  for (const Index f : facets) {
    Facet& facet = facets_[f];
    if (facet.outside.empty()) continue;
    const Eigen::Vector3d& origin = at(facet.corners[0]);
    const Eigen::Vector3d normal =
        (at(facet.corners[1]) - origin).cross(at(facet.corners[2]) - origin);
    std::size_t farthest = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < facet.outside.size(); ++i) {
      const double height = normal.dot(at(facet.outside[i]) - origin);
      if (height > most) {
        most = height;
        farthest = i;
      }
    }
    std::swap(facet.outside[farthest], facet.outside.back());
    open_.push_back(f);
  }
}

/// Collects the facets that `point` is strictly above, from `seed` on, and their horizon. Facets in
/// the plane of the point stay: with them the new facets are never degenerate.
void Quickhull::find_visible(Index seed, Index point) {
  visible_.assign(1, seed);
  horizon_.clear();
  facets_[seed].is_dead = true;
  visited_for_[seed] = point;
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    const Index f = visible_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index g = facets_[f].neighbours[k];
      if (visited_for_[g] != point) {
        visited_for_[g] = point;
        if (is_above(point, facets_[g])) {
          facets_[g].is_dead = true;
          visible_.push_back(g);
        }
      }
      if (!facets_[g].is_dead) {
        horizon_.push_back({facets_[f].corners[k], facets_[f].corners[(k + 1) % 3], g});
      }
    }
  }
}

/// Joins `point` to the horizon.
void Quickhull::add_cone(Index point) {
  created_.clear();
  for (const HorizonEdge& edge : horizon_) {
    const auto f = static_cast<Index>(facets_.size());
    facets_.push_back({{edge.from, edge.to, point}, {edge.beyond, kNone, kNone}, {}, false});
    visited_for_.push_back(kNone);
    created_.push_back(f);
    created_from_[edge.from] = f;
    Facet& beyond = facets_[edge.beyond];
    for (std::size_t k = 0; k < 3; ++k) {
      if (beyond.corners[k] == edge.to && beyond.corners[(k + 1) % 3] == edge.from) {
        beyond.neighbours[k] = f;
      }
    }
  }
  for (const Index f : created_) {
    const Index next = created_from_[facets_[f].corners[1]];
    facets_[f].neighbours[1] = next;
    facets_[next].neighbours[2] = f;
  }
}

/// The points outside the facets that went belong to the new ones, or are inside now.
void Quickhull::hand_out(Index point) {
  std::vector<Index> orphans;
  for (const Index f : visible_) {
    for (const Index p : facets_[f].outside) {
      if (p != point) orphans.push_back(p);
    }
    facets_[f].outside = {};
  }
  give(orphans, created_);
}

void Quickhull::expand(Index seed) {
  const Index point = facets_[seed].outside.back();
  find_visible(seed, point);
  add_cone(point);
  hand_out(point);
}

std::vector<Triangle> Quickhull::run(const std::vector<Index>& simplex) {
  start(simplex);
  // First come, first served: the hull grows evenly on all sides, which keeps horizons short.
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (!facets_[open_[i]].is_dead) expand(open_[i]);
  }
  std::vector<Triangle> triangles;
  for (const Facet& facet : facets_) {
    if (!facet.is_dead) triangles.push_back(facet.corners);
  }
  return triangles;
}

/// Indices of the distinct points, in lexicographic order; of equal ones the first.
std::vector<Index> sorted_distinct(std::span<const Eigen::Vector3d> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](Index i, Index j) {
    const Eigen::Vector3d& a = points[i];
    const Eigen::Vector3d& b = points[j];
    for (int axis = 0; axis < 3; ++axis) {
      if (a[axis] != b[axis]) return a[axis] < b[axis];
    }
    return i < j;
  });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](Index i, Index j) { return points[i] == points[j]; }),
              order.end());
  return order;
}

/// Extreme points of points that lie in one plane, the one through `simplex`.
std::vector<Index> flat_extremes(std::span<const Eigen::Vector3d> points,
                                 const std::vector<Index>& simplex) {
  if (simplex.size() < 3) return simplex;
  const Eigen::Vector3d& a = points[simplex[0]];
  const Eigen::Vector3d& b = points[simplex[1]];
  const Eigen::Vector3d& c = points[simplex[2]];
  // A rounded normal may point anywhere; the projection must keep the triangle exactly.
  int axis = dominant_axis((b - a).cross(c - a));
  while (orient2d(without(a, axis), without(b, axis), without(c, axis)) == 0) axis = (axis + 1) % 3;
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.push_back(without(p, axis));
  return planar_hull(flat);
}

}  // namespace

ConvexHull convex_hull(std::span<const Eigen::Vector3d> points) {
  DOWEL_EXPECTS(points.size() < kNone);
  for (const Eigen::Vector3d& p : points) DOWEL_EXPECTS(p.allFinite());

  const std::vector<Index> order = sorted_distinct(points);
  std::vector<Eigen::Vector3d> sorted;
  sorted.reserve(order.size());
  for (const Index i : order) sorted.push_back(points[i]);

  Quickhull quickhull(sorted);
  const std::vector<Index> simplex = quickhull.find_simplex();
  ConvexHull hull;
  if (simplex.size() < 4) {
    hull.vertices = flat_extremes(sorted, simplex);
  } else {
    hull.triangles = fan_triangles(hull_facets(sorted, quickhull.run(simplex)));
    for (const Triangle& t : hull.triangles) {
      hull.vertices.insert(hull.vertices.end(), t.begin(), t.end());
    }
    std::sort(hull.vertices.begin(), hull.vertices.end());
    hull.vertices.erase(std::unique(hull.vertices.begin(), hull.vertices.end()),
                        hull.vertices.end());
  }

  for (Index& v : hull.vertices) v = order[v];
  std::sort(hull.vertices.begin(), hull.vertices.end());
  for (Triangle& t : hull.triangles) {
    for (Index& v : t) v = order[v];
  }
  return hull;
}

}  // namespace dowel
