// Finds convex pieces of material in a model.

#include "dowel/collision/core.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dowel/collision/model.h"
#include "dowel/kernel/tolerance.h"
#include "exact_face.h"

namespace dowel {
namespace {

/// Cores that a model keeps: enough for the strips between the holes of a plate.
constexpr std::size_t kMaxBlocks = 24;
constexpr std::size_t kMaxBars = 6;

/// Blocks end this much short of what they meet: rounding of coordinates, nothing else.
constexpr double kShort_mm = 1.0e-9;

/// Planes at right angles closer than this count as such.
constexpr double kAligned = 1.0e-9;

/// Half widths of the blocks that are grown from a seat, the first that has room is taken.
constexpr std::array<double, 4> kSeedSizes_mm{0.5, 0.2, 0.05, 0.02};

/// A seat in so many blocks needs no further one.
constexpr std::ptrdiff_t kEnough = 2;

/// Cores thinner than this are of no use.
constexpr double kMinHalf_mm = 0.02;

/// Facets end where a cylinder does when they miss its end by this many slacks: either is widened
/// by its own.
constexpr double kEndSlacks = 4.0;

/// A polygon of a triangle cut by up to six planes.
struct Polygon {
  std::array<Eigen::Vector3d, 9> corners;
  std::size_t count = 0;

  /// Keeps what has `sign * coordinate[axis] > sign * limit`.
  void cut(Eigen::Index axis, double sign, double limit) {
    Polygon kept;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& p = corners[i];
      const Eigen::Vector3d& q = corners[(i + 1) % count];
      const double dp = sign * (p[axis] - limit);
      const double dq = sign * (q[axis] - limit);
      if (dp > 0.0) kept.corners[kept.count++] = p;
      if ((dp > 0.0) != (dq > 0.0)) kept.corners[kept.count++] = p + dp / (dp - dq) * (q - p);
    }
    *this = kept;
  }
};

/// Distance of the origin from a triangle in the plane.
double distance_from_origin(const std::array<Eigen::Vector2d, 3>& triangle) {
  double least = std::numeric_limits<double>::infinity();
  int turns = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d& a = triangle[i];
    const Eigen::Vector2d edge = triangle[(i + 1) % 3] - a;
    const double length = edge.squaredNorm();
    const double share = length > 0.0 ? std::clamp(-a.dot(edge) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (a + share * edge).norm());
    const double cross = a.x() * edge.y() - a.y() * edge.x();
    turns += cross > 0.0 ? 1 : (cross < 0.0 ? -1 : 0);
  }
  return std::abs(turns) == 3 ? 0.0 : least;
}

bool is_same(const CylinderSurface& a, const CylinderSurface& b) {
  const Eigen::Vector3d offset = b.origin - a.origin;
  return std::abs(a.radius_mm - b.radius_mm) <= kShort_mm &&
         a.axis.cross(b.axis).norm() <= kAligned && a.axis.cross(offset).norm() <= kShort_mm;
}

class CoreFinder {
 public:
  explicit CoreFinder(const CollisionModel& model) : model_(model) {
    for (const ModelTriangle& t : model.triangles()) {
      for (const Eigen::Vector3d& corner : t.corners) bounds_.extend(corner);
    }
    choose_axes();
  }

  Cores find() {
    Cores result;
    result.axes = axes_;
    find_bars();
    result.cores = bars_;
    const std::vector<Core> blocks = find_blocks();
    result.cores.insert(result.cores.end(), blocks.begin(), blocks.end());
    std::ranges::stable_sort(result.cores, std::ranges::greater(), &Core::volume_mm3);
    for (const Core& core : result.cores) {
      const Eigen::Vector3d center = axes_.transpose() * core.center;
      const Eigen::Vector3d reach = (axes_.transpose() * core.axes).cwiseAbs() * core.half_mm;
      result.boxes_in_axes.push_back({center - reach, center + reach});
      result.bounds_in_axes.extend(center - reach);
      result.bounds_in_axes.extend(center + reach);
    }
    return result;
  }

 private:
  /// Along the largest plane's normal and that of the next one at right angles to it.
  void choose_axes() {
    axes_.setIdentity();
    const auto planes = model_.seat_planes();
    if (planes.empty()) return;
    const Eigen::Vector3d z = planes.front().plane.normal;
    Eigen::Vector3d x = z.unitOrthogonal();
    for (const SeatPlane& seat : planes) {
      if (std::abs(seat.plane.normal.dot(z)) > kAligned) continue;
      x = seat.plane.normal;
      break;
    }
    axes_.col(2) = z;
    axes_.col(1) = z.cross(x).normalized();
    axes_.col(0) = axes_.col(1).cross(z);
  }

  /// How far the exact boundary may stand off a facet along `direction`.
  double margin_mm(const ModelTriangle& t, const Eigen::Vector3d& direction) const {
    const Face& face = model_.face(t.face);
    const double along = std::min(std::abs(t.normal.dot(direction)), 1.0);
    const double unknown = is_exact(face) ? 0.0 : face.facet_error_mm;
    const double in_plane = t.slack_mm * std::sqrt(std::max(0.0, 1.0 - along * along));
    return t.normal_slack_mm * along + (along > 1.0 - kAligned ? 0.0 : in_plane) + unknown;
  }

  /// Calls `visit(triangle, box)` for facets of tree leaves that reach into `box`, given along the
  /// axes, those lower along `direction` first; `visit` may make the box smaller, and ends the
  /// search by leaving nothing of it.
  template <class Visit>
  void visit_in(Aabb box, const Eigen::Vector3d& direction, const Visit& visit) const {
    std::vector<std::uint32_t>& stack = stack_;
    stack.assign(1, 0);
    while (!stack.empty()) {
      const BvhNode& node = model_.nodes()[stack.back()];
      stack.pop_back();
      if (!box_along(axes_, node).overlaps(box)) continue;
      if (node.is_leaf()) {
        for (const ModelTriangle& t : model_.triangles().subspan(node.first, node.count)) {
          visit(t, box);
        }
        continue;
      }
      const auto low = [&](std::uint32_t child) {
        const BvhNode& n = model_.nodes()[child];
        return (n.min + n.max).dot(direction);
      };
      const bool is_first_lower = low(node.first) <= low(node.first + 1);
      stack.push_back(is_first_lower ? node.first + 1 : node.first);
      stack.push_back(is_first_lower ? node.first : node.first + 1);
    }
  }

  static Aabb box_along(const Eigen::Matrix3d& axes, const BvhNode& node) {
    const Eigen::Vector3d center = axes.transpose() * (0.5 * (node.min + node.max));
    const Eigen::Vector3d reach = axes.transpose().cwiseAbs() * (0.5 * (node.max - node.min));
    return {center - reach, center + reach};
  }

  /// What of a facet, with its margin, is inside the open `box`.
  Polygon inside(const ModelTriangle& t, const Aabb& box, Eigen::Vector3d& margin) const {
    Polygon polygon;
    for (const Eigen::Vector3d& corner : t.corners) {
      polygon.corners[polygon.count++] = axes_.transpose() * corner;
    }
    const double reach = model_.max_slack_mm() + model_.max_unknown_mm();
    if (!bounds(std::span(polygon.corners.data(), 3)).overlaps(box.padded(reach))) return {};
    for (Eigen::Index axis = 0; axis < 3 && polygon.count > 0; ++axis) {
      margin[axis] = margin_mm(t, axes_.col(axis));
      polygon.cut(axis, 1.0, box.min[axis] - margin[axis] + kShort_mm);
      polygon.cut(axis, -1.0, box.max[axis] + margin[axis] - kShort_mm);
    }
    return polygon;
  }

  bool is_empty(const Aabb& box) const {
    bool empty = true;
    visit_in(box, axes_.col(0), [&](const ModelTriangle& t, Aabb& left) {
      Eigen::Vector3d margin;
      if (!empty || inside(t, box, margin).count == 0) return;
      empty = false;
      left = {};
    });
    return empty;
  }

  /// Moves one side of an empty box outwards until a facet is met.
  void grow(Aabb& box, Eigen::Index axis, double sign) const {
    // What is in the way lies beyond the middle: the box itself is empty.
    const auto far_side = [&](Aabb& b) -> double& { return (sign > 0.0 ? b.max : b.min)[axis]; };
    Aabb way = box;
    (sign > 0.0 ? way.min : way.max)[axis] = box.center()[axis];
    Aabb all = bounds_in_axes();
    far_side(way) = far_side(all);
    double limit = far_side(way);
    visit_in(way, sign * axes_.col(axis), [&](const ModelTriangle& t, Aabb& left) {
      Eigen::Vector3d margin;
      const Polygon polygon = inside(t, left, margin);
      for (std::size_t i = 0; i < polygon.count; ++i) {
        const double at = polygon.corners[i][axis] - sign * margin[axis];
        if (sign * at < sign * limit) limit = at;
      }
      far_side(left) = limit;
      if (sign * limit <= sign * far_side(box)) left = {};
    });
    if (sign * limit > sign * far_side(box)) far_side(box) = limit;
  }

  Aabb bounds_in_axes() const {
    const Eigen::Vector3d center = axes_.transpose() * bounds_.center();
    const Eigen::Vector3d reach = axes_.transpose().cwiseAbs() * (0.5 * bounds_.size());
    return {center - reach, center + reach};
  }

  void grow_all(Aabb& box, const std::array<Eigen::Index, 3>& order) {
    for (const Eigen::Index axis : order) {
      grow(box, axis, 1.0);
      grow(box, axis, -1.0);
    }
    for (const Aabb& known : boxes_) {
      if (known.padded(kCoincident_mm).contains(box)) return;
    }
    if (is_in_a_bar(box)) return;
    if (0.5 * box.size().minCoeff() < kMinHalf_mm) return;
    if (!model_.nearest(axes_ * box.center()).inside) return;
    std::erase_if(boxes_,
                  [&](const Aabb& known) { return box.padded(kCoincident_mm).contains(known); });
    boxes_.push_back(box);
  }

  bool is_in_a_bar(const Aabb& box) const {
    return std::ranges::any_of(bars_, [&](const Core& bar) {
      for (unsigned corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d at((corner & 1U) != 0 ? box.max.x() : box.min.x(),
                                 (corner & 2U) != 0 ? box.max.y() : box.min.y(),
                                 (corner & 4U) != 0 ? box.max.z() : box.min.z());
        if (bar.depth_mm(axes_ * at) < -kCoincident_mm) return false;
      }
      return true;
    });
  }

  void grow_from_seat(const Eigen::Vector3d& seat, Eigen::Index axis, double outward) {
    const auto covers = [&](const Aabb& known) {
      return known.padded(kCoincident_mm).contains(Aabb{seat, seat});
    };
    if (std::ranges::count_if(boxes_, covers) >= kEnough) return;
    for (const double half : kSeedSizes_mm) {
      Aabb seed{seat, seat};
      seed = seed.padded(half);
      (outward > 0.0 ? seed.max : seed.min)[axis] = seat[axis];
      if (!is_empty(seed)) continue;
      const Eigen::Index u = (axis + 1) % 3;
      const Eigen::Index v = (axis + 2) % 3;
      for (const auto& order : {std::array{u, v, axis}, std::array{v, u, axis}}) {
        Aabb box = seed;
        grow_all(box, order);
      }
      return;
    }
  }

  std::vector<Core> find_blocks() {
    for (const CollisionModel::InnerPoint& inner : model_.inner_points()) {
      const double half = 0.5 * inner.depth_mm;  // a cube of this half width is inside the ball
      const Eigen::Vector3d center = axes_.transpose() * inner.point;
      for (const auto& order : {std::array<Eigen::Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}) {
        Aabb box{center, center};
        box = box.padded(half);
        grow_all(box, order);
      }
    }
    for (const SeatPlane& plane : model_.seat_planes()) {
      const Eigen::Vector3d normal = axes_.transpose() * plane.plane.normal;
      Eigen::Index axis = 0;
      if (normal.cwiseAbs().maxCoeff(&axis) < 1.0 - kAligned) continue;
      for (const Seat& seat : model_.seats(plane)) {
        grow_from_seat(axes_.transpose() * seat.point, axis, normal[axis]);
      }
    }
    std::ranges::stable_sort(boxes_, std::ranges::greater(),
                             [](const Aabb& box) { return box.size().prod(); });
    if (boxes_.size() > kMaxBlocks) boxes_.resize(kMaxBlocks);
    std::vector<Core> blocks;
    for (const Aabb& box : boxes_) {
      blocks.push_back({axes_ * box.center(), axes_, 0.5 * box.size().array() - kShort_mm, false});
    }
    return blocks;
  }

  /// Bars about the axes of the cylinders: with the cylinder's radius, and with what a chamfer or
  /// fillet leaves of it, which reach to the end.
  void find_bars() {
    std::vector<CylinderSurface> known;
    for (std::uint32_t f = 0; f < model_.face_count(); ++f) {
      const auto* cylinder = std::get_if<CylinderSurface>(&model_.face(f).surface);
      // Inside the wall of a hole there is no material.
      if (cylinder == nullptr || model_.face(f).reversed) continue;
      if (std::ranges::any_of(known, [&](const auto& k) { return is_same(k, *cylinder); })) {
        continue;
      }
      known.push_back(*cylinder);
      find_bars_in(*cylinder);
    }
    std::ranges::stable_sort(bars_, std::ranges::greater(), &Core::volume_mm3);
    if (bars_.size() > kMaxBars) bars_.resize(kMaxBars);
  }

  /// A facet as an axis sees it.
  struct Beside {
    double from_mm;  ///< along the axis, with what its exact face stands off it
    double to_mm;
    double radius_mm;  ///< least
    bool is_flat;      ///< across the axis
    bool is_own;       ///< stands for the cylinder itself
  };

  void find_bars_in(const CylinderSurface& cylinder) {
    Eigen::Matrix3d axes;
    axes.col(2) = cylinder.axis;
    axes.col(0) = cylinder.axis.unitOrthogonal();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    std::vector<Beside> beside;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const ModelTriangle& t : model_.triangles()) {
      const Beside seen = beside_axis(cylinder, axes, t);
      if (seen.radius_mm > cylinder.radius_mm && !seen.is_own) continue;
      if (seen.is_own) low = std::min(low, seen.from_mm);
      if (seen.is_own) high = std::max(high, seen.to_mm);
      beside.push_back(seen);
    }
    std::ranges::sort(beside, {}, &Beside::from_mm);
    add_bar(cylinder, axes, cylinder.radius_mm, low, high, beside);
    // The next radius: of the facets that go on where the cylinder ends.
    for (const double end : {low, high}) {
      double radius = 0.0;
      for (const Beside& seen : beside) {
        const bool goes_on = std::min(std::abs(seen.from_mm - end), std::abs(seen.to_mm - end)) <=
                             kCoincident_mm + kEndSlacks * model_.max_slack_mm();
        if (!seen.is_own && !seen.is_flat && goes_on) {
          radius = radius == 0.0 ? seen.radius_mm : std::min(radius, seen.radius_mm);
        }
      }
      if (radius >= 0.5 * cylinder.radius_mm) {
        add_bar(cylinder, axes, radius - kShort_mm, low - cylinder.radius_mm,
                high + cylinder.radius_mm, beside);
      }
    }
  }

  Beside beside_axis(const CylinderSurface& cylinder, const Eigen::Matrix3d& axes,
                     const ModelTriangle& t) const {
    const Face& face = model_.face(t.face);
    const auto* own = std::get_if<CylinderSurface>(&face.surface);
    std::array<Eigen::Vector2d, 3> seen;
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d local = axes.transpose() * (t.corners[i] - cylinder.origin);
      seen[i] = local.head<2>();
      from = std::min(from, local.z());
      to = std::max(to, local.z());
    }
    const double unknown = is_exact(face) ? 0.0 : face.facet_error_mm;
    const double along = margin_mm(t, cylinder.axis);
    return {from - along, to + along, distance_from_origin(seen) - t.slack_mm - unknown,
            to - from <= kShort_mm, own != nullptr && is_same(*own, cylinder)};
  }

  /// Adds the longest stretch from `low` to `high` that no facet reaches into, but for those that
  /// stand for the cylinder itself.
  void add_bar(const CylinderSurface& cylinder, const Eigen::Matrix3d& axes, double radius_mm,
               double low, double high, const std::vector<Beside>& beside) {
    double best_from = low;
    double best_to = low;
    double from = low;
    const auto take = [&](double to) {
      if (to - from <= best_to - best_from) return;
      best_from = from;
      best_to = to;
    };
    for (const Beside& seen : beside) {
      if (seen.is_own || seen.radius_mm >= radius_mm - kShort_mm) continue;
      take(std::min(seen.from_mm, high));
      from = std::max(from, seen.to_mm);
    }
    take(high);
    const double half = 0.5 * (best_to - best_from) - kShort_mm;
    if (half < kMinHalf_mm || radius_mm < kMinHalf_mm) return;
    const Eigen::Vector3d center = cylinder.origin + 0.5 * (best_from + best_to) * cylinder.axis;
    if (!model_.nearest(center).inside) return;
    const double radius = radius_mm - kShort_mm;
    bars_.push_back({center, axes, {radius, radius, half}, true});
  }

  const CollisionModel& model_;
  Eigen::Matrix3d axes_;
  Aabb bounds_;
  std::vector<Core> bars_;
  std::vector<Aabb> boxes_;
  mutable std::vector<std::uint32_t> stack_;
};

}  // namespace

Cores find_cores(const CollisionModel& model) {
  return CoreFinder(model).find();
}

}  // namespace dowel
