#include "dowel/collision/axis_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dowel/collision/model.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Facets that reach into a stretch by less than this end at it: well below any tolerance.
constexpr double kEndSlack_mm = 1.0e-7;

/// Most steps of a profile; a part with more shoulders is told by its cylinders' ends alone.
constexpr std::size_t kMaxSteps = 16;

/// Share of a full turn that cylinders must cover to count as round.
constexpr double kRound = 1.0 - 1.0e-6;

/// A face of revolution about the axis that is looked at.
struct CoaxialFace {
  std::uint32_t face;
  double from_mm;
  double to_mm;
  double least_radius_mm;
  double most_radius_mm;
  const ConeSurface* cone = nullptr;  ///< else the radii hold for all of it

  void add(double radius_mm, double height_mm) {
    from_mm = std::min(from_mm, height_mm);
    to_mm = std::max(to_mm, height_mm);
    least_radius_mm = std::min(least_radius_mm, radius_mm);
    most_radius_mm = std::max(most_radius_mm, radius_mm);
  }
};

bool same_axis(const CylinderSurface& a, const CylinderSurface& b) {
  if (a.axis.cross(b.axis).norm() > kParallel_rad) return false;
  const Eigen::Vector3d between = b.origin - a.origin;
  return (between - a.axis.dot(between) * a.axis).norm() <= kCoincident_mm;
}

/// In the plane normal to the axis, the part of a triangle between two heights.
struct Clipped {
  std::array<Eigen::Vector2d, 8> points;
  std::size_t count = 0;
};

/// Two directions normal to the axis.
struct AxisFrame {
  explicit AxisFrame(const CylinderSurface& cylinder)
      : origin(cylinder.origin),
        w(cylinder.axis),
        u(cylinder.axis.unitOrthogonal()),
        v(cylinder.axis.cross(u)) {}
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = p - origin;
    return {u.dot(d), v.dot(d), w.dot(d)};
  }
  Eigen::Vector3d origin, w, u, v;
};

Clipped clip(const std::array<Eigen::Vector3d, 3>& corners, double low, double high) {
  std::array<Eigen::Vector3d, 8> polygon{corners[0], corners[1], corners[2]};
  std::size_t count = 3;
  const auto cut = [&](double limit, double sign) {
    std::array<Eigen::Vector3d, 8> kept;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& p = polygon[i];
      const Eigen::Vector3d& q = polygon[(i + 1) % count];
      const double dp = sign * (limit - p.z());
      const double dq = sign * (limit - q.z());
      if (dp >= 0.0) kept[n++] = p;
      if ((dp < 0.0) != (dq < 0.0)) kept[n++] = p + dp / (dp - dq) * (q - p);
    }
    polygon = kept;
    count = n;
  };
  cut(high, 1.0);
  if (count > 0) cut(low, -1.0);
  Clipped result;
  for (std::size_t i = 0; i < count; ++i) result.points[result.count++] = polygon[i].head<2>();
  return result;
}

double largest_radius(const Clipped& c) {
  double largest = 0.0;
  for (std::size_t i = 0; i < c.count; ++i) largest = std::max(largest, c.points[i].norm());
  return largest;
}

/// Distance of the polygon from the axis; 0 where it goes round it or lies across.
double smallest_radius(const Clipped& c) {
  double smallest = kInfinity;
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Eigen::Vector2d& p = c.points[i];
    const Eigen::Vector2d edge = c.points[(i + 1) % c.count] - p;
    const double length2 = edge.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp(-p.dot(edge) / length2, 0.0, 1.0) : 0.0;
    smallest = std::min(smallest, (p + s * edge).norm());
    const double side = edge.x() * -p.y() + edge.y() * p.x();
    left = left || side > 0.0;
    right = right || side < 0.0;
  }
  return left != right && c.count > 2 ? 0.0 : smallest;
}

/// Distances from the axis that a box can have, and its heights: bounds.
struct BoxRange {
  BoxRange(const AxisFrame& frame, const BvhNode& node) {
    const Eigen::Vector3d center = frame(0.5 * (node.min + node.max));
    const Eigen::Vector3d half = 0.5 * (node.max - node.min);
    const double radial = center.head<2>().norm();
    const double reach = half.norm();
    const double tall = frame.w.cwiseAbs().dot(half);
    nearest_mm = radial - reach;
    farthest_mm = radial + reach;
    low_mm = center.z() - tall;
    high_mm = center.z() + tall;
  }
  double nearest_mm;
  double farthest_mm;
  double low_mm;
  double high_mm;
};

/// Builds the profiles of one model.
class Finder {
 public:
  explicit Finder(const CollisionModel& model) : model_(model), facets_(model.face_count()) {
    for (const ModelTriangle& t : model.triangles()) facets_[t.face].push_back(&t);
  }

  AxisProfiles find() {
    AxisProfiles result;
    for (const bool is_bore : {false, true}) {
      for (const CylinderSurface& axis : axes(is_bore)) {
        AxisProfile profile = build(axis, is_bore);
        if (!profile.steps.empty()) {
          (is_bore ? result.bores : result.shafts).push_back(std::move(profile));
        }
      }
    }
    return result;
  }

 private:
  /// Axes of cylinders, and of cones that share none with a cylinder.
  std::vector<CylinderSurface> axes(bool is_bore) const {
    std::vector<CylinderSurface> result;
    const auto add = [&](const CylinderSurface& axis) {
      const bool is_known = std::ranges::any_of(
          result, [&](const CylinderSurface& known) { return same_axis(known, axis); });
      if (!is_known) result.push_back(axis);
    };
    for (const bool wants_cones : {false, true}) {
      for (std::uint32_t f = 0; f < model_.face_count(); ++f) {
        const Face& face = model_.face(f);
        if (face.reversed != is_bore) continue;
        const auto* cylinder = std::get_if<CylinderSurface>(&face.surface);
        const auto* cone = std::get_if<ConeSurface>(&face.surface);
        if (cylinder != nullptr && !wants_cones) add(*cylinder);
        if (cone != nullptr && wants_cones) add({cone->apex, cone->axis, 0.0});
      }
    }
    return result;
  }

  /// Faces of revolution about the axis, with the radii that they take. These depend on the height
  /// alone and are least and largest at an end, where vertices lie on the exact face; a torus also
  /// turns round in between.
  std::vector<CoaxialFace> coaxial_faces(const CylinderSurface& axis) const {
    std::vector<CoaxialFace> result;
    const AxisFrame frame(axis);
    for (std::uint32_t f = 0; f < model_.face_count(); ++f) {
      const Surface& surface = model_.face(f).surface;
      const auto* cylinder = std::get_if<CylinderSurface>(&surface);
      const auto* cone = std::get_if<ConeSurface>(&surface);
      const auto* torus = std::get_if<TorusSurface>(&surface);
      const bool is_coaxial =
          (cylinder != nullptr && same_axis(axis, *cylinder)) ||
          (cone != nullptr && same_axis(axis, {cone->apex, cone->axis, 0.0})) ||
          (torus != nullptr && same_axis(axis, {torus->center, torus->axis, 0.0}));
      if (!is_coaxial) continue;
      CoaxialFace entry{f, kInfinity, -kInfinity, kInfinity, 0.0, cone};
      for (const ModelTriangle* t : facets_[f]) {
        for (const Eigen::Vector3d& corner : t->corners) {
          const Eigen::Vector3d p = frame(corner);
          entry.add(p.head<2>().norm(), p.z());
        }
        if (torus != nullptr) add_turns(entry, *torus, model_.face(f), frame, *t);
      }
      if (cylinder != nullptr) {
        entry.least_radius_mm = entry.most_radius_mm = cylinder->radius_mm;
      }
      result.push_back(entry);
    }
    return result;
  }

  /// Adds the crowns, the inmost and the outmost circle of a torus where they pass over a facet.
  static void add_turns(CoaxialFace& entry, const TorusSurface& torus, const Face& face,
                        const AxisFrame& frame, const ModelTriangle& t) {
    const double middle = frame(torus.center).z();
    const auto angle_of = [&](const Eigen::Vector3d& corner) {
      const Eigen::Vector3d p = frame(corner);
      return std::atan2(p.z() - middle, p.head<2>().norm() - torus.major_radius_mm);
    };
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double start = angle_of(t.corners[0]);
    const double second = std::remainder(angle_of(t.corners[1]) - start, kTurn);
    const double third = std::remainder(angle_of(t.corners[2]) - start, kTurn);
    const auto [least, most] = std::minmax({0.0, second, third});
    // Facets this far off span more of the tube than their corners tell.
    const bool spans_any = face.facet_error_mm >= 0.5 * torus.minor_radius_mm;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double angle = 0.25 * kTurn * quarter;
      const double turn = std::remainder(angle - start, kTurn);
      if (!spans_any && (turn <= least || turn >= most)) continue;
      entry.add(torus.major_radius_mm + torus.minor_radius_mm * std::cos(angle),
                middle + torus.minor_radius_mm * std::sin(angle));
    }
  }

  /// Heights at which the profile may change, the ends of the part included.
  std::vector<double> breaks(const CylinderSurface& axis, const std::vector<CoaxialFace>& coaxial,
                             bool with_planes) const {
    const BoxRange all(AxisFrame(axis), model_.nodes()[0]);
    std::vector<double> result{all.low_mm, all.high_mm};
    for (const CoaxialFace& face : coaxial) {
      result.insert(result.end(), {face.from_mm, face.to_mm});
    }
    for (std::uint32_t f = 0; with_planes && f < model_.face_count(); ++f) {
      const auto* plane = std::get_if<PlaneSurface>(&model_.face(f).surface);
      if (plane != nullptr && plane->normal.cross(axis.axis).norm() <= kParallel_rad) {
        result.push_back(axis.axis.dot(plane->origin - axis.origin));
      }
    }
    std::ranges::sort(result);
    const auto last = std::unique(result.begin(), result.end(),
                                  [](double a, double b) { return b - a <= 10.0 * kEndSlack_mm; });
    result.erase(last, result.end());
    return result;
  }

  AxisProfile build(const CylinderSurface& axis, bool is_bore) {
    const std::vector<CoaxialFace> coaxial = coaxial_faces(axis);
    std::vector<double> ends = breaks(axis, coaxial, true);
    if (ends.size() > kMaxSteps) ends = breaks(axis, coaxial, false);
    AxisProfile profile{axis.origin, axis.axis, {}};
    if (ends.size() < 2 || ends.size() > kMaxSteps) return profile;
    const AxisFrame frame(axis);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double start_mm = is_bore ? kInfinity : 0.0;
      ProfileStep step{ends[i], ends[i + 1], start_mm, start_mm, false};
      for (const CoaxialFace& face : coaxial) {
        if (face.to_mm <= step.from_mm + kEndSlack_mm) continue;
        if (face.from_mm >= step.to_mm - kEndSlack_mm) continue;
        if (face.cone != nullptr) {
          bound(step, radius_of(*face.cone, frame, step.from_mm),
                radius_of(*face.cone, frame, step.to_mm), is_bore);
        } else {
          const double radius = is_bore ? face.least_radius_mm : face.most_radius_mm;
          bound(step, radius, radius, is_bore);
        }
      }
      take_facets(step, frame, coaxial, is_bore);
      const double middle = 0.5 * (step.from_mm + step.to_mm);
      if (is_bore && model_.facets_contain(frame.origin + middle * frame.w)) {
        bound(step, 0.0, 0.0, is_bore);
      }
      step.is_round = goes_round(frame, coaxial, step);
      if (is_bore ? step.most_radius_mm() < kInfinity : step.most_radius_mm() > 0.0) {
        profile.steps.push_back(step);
      }
    }
    return profile;
  }

  static double radius_of(const ConeSurface& cone, const AxisFrame& frame, double height_mm) {
    const double from_apex = height_mm - frame.w.dot(cone.apex - frame.origin);
    return std::abs(from_apex) * std::tan(cone.half_angle_rad);
  }

  /// Bounds a step by radii at its two ends. Radii of surfaces that cross in between lie on the
  /// safe side of the straight line: the larger of two lines bulges down, the smaller one up.
  static void bound(ProfileStep& step, double from_radius_mm, double to_radius_mm, bool is_bore) {
    const auto tighter = [is_bore](double a, double b) {
      return is_bore ? std::min(a, b) : std::max(a, b);
    };
    step.from_radius_mm = tighter(step.from_radius_mm, from_radius_mm);
    step.to_radius_mm = tighter(step.to_radius_mm, to_radius_mm);
  }

  /// Takes all other facets into account, those that the tree finds able to change the step.
  void take_facets(ProfileStep& step, const AxisFrame& frame,
                   const std::vector<CoaxialFace>& coaxial, bool is_bore) {
    const double low = step.from_mm + kEndSlack_mm;
    const double high = step.to_mm - kEndSlack_mm;
    stack_.assign(1, 0);
    while (!stack_.empty()) {
      const BvhNode& node = model_.nodes()[stack_.back()];
      stack_.pop_back();
      const BoxRange range(frame, node);
      if (range.high_mm <= low || range.low_mm >= high) continue;
      if (is_bore ? range.nearest_mm >= step.most_radius_mm()
                  : range.farthest_mm <= step.least_radius_mm()) {
        continue;
      }
      if (!node.is_leaf()) {
        stack_.insert(stack_.end(), {node.first, node.first + 1});
        continue;
      }
      for (const ModelTriangle& t : model_.triangles().subspan(node.first, node.count)) {
        const bool is_known = std::ranges::any_of(
            coaxial, [&](const CoaxialFace& known) { return known.face == t.face; });
        if (!is_known) take_facet(step, frame, t, is_bore);
      }
    }
  }

  static void take_facet(ProfileStep& step, const AxisFrame& frame, const ModelTriangle& t,
                         bool is_bore) {
    const double low = step.from_mm + kEndSlack_mm;
    const double high = step.to_mm - kEndSlack_mm;
    const std::array<Eigen::Vector3d, 3> corners{frame(t.corners[0]), frame(t.corners[1]),
                                                 frame(t.corners[2])};
    const auto [least, most] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
    // A plane normal to the axis does not stand off its facets along it.
    const bool is_level = most - least <= kEndSlack_mm && t.normal_slack_mm == 0.0;
    const double tall = is_level ? 0.0 : t.slack_mm;
    if (most + tall <= low || least - tall >= high) return;
    const Clipped part = clip(corners, low - tall, high + tall);
    if (part.count == 0) return;
    const double radius = is_bore ? std::max(smallest_radius(part) - t.slack_mm, 0.0)
                                  : largest_radius(part) + t.slack_mm;
    bound(step, radius, radius, is_bore);
  }

  /// Whether cylinders of the step's radius cover it all the way round: by the area of their
  /// facets, unrolled.
  bool goes_round(const AxisFrame& frame, const std::vector<CoaxialFace>& coaxial,
                  const ProfileStep& step) const {
    if (step.from_radius_mm != step.to_radius_mm) return false;
    double share = 0.0;
    for (const CoaxialFace& face : coaxial) {
      if (!std::holds_alternative<CylinderSurface>(model_.face(face.face).surface) ||
          std::abs(face.least_radius_mm - step.from_radius_mm) > kEndSlack_mm ||
          face.from_mm > step.from_mm + 10.0 * kEndSlack_mm ||
          face.to_mm < step.to_mm - 10.0 * kEndSlack_mm) {
        continue;
      }
      double turns_mm = 0.0;  // angle times height
      for (const ModelTriangle* t : facets_[face.face]) turns_mm += unrolled(frame, *t);
      share += turns_mm / (2.0 * std::numbers::pi * (face.to_mm - face.from_mm));
    }
    return share >= kRound;
  }

  static double unrolled(const AxisFrame& frame, const ModelTriangle& t) {
    std::array<Eigen::Vector2d, 3> flat;
    double first = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d p = frame(t.corners[i]);
      const double angle = std::atan2(p.y(), p.x());
      if (i == 0) first = angle;
      flat[i] = {std::remainder(angle - first, 2.0 * std::numbers::pi), p.z()};
    }
    const Eigen::Vector2d ab = flat[1] - flat[0];
    const Eigen::Vector2d ac = flat[2] - flat[0];
    return 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  }

  const CollisionModel& model_;
  std::vector<std::vector<const ModelTriangle*>> facets_;  // by face
  std::vector<std::uint32_t> stack_;
};

}  // namespace

std::size_t AxisProfiles::memory_bytes() const {
  std::size_t bytes = (shafts.capacity() + bores.capacity()) * sizeof(AxisProfile);
  for (const auto* profiles : {&shafts, &bores}) {
    for (const AxisProfile& profile : *profiles) {
      bytes += profile.steps.capacity() * sizeof(ProfileStep);
    }
  }
  return bytes;
}

AxisProfiles find_axis_profiles(const CollisionModel& model) {
  return Finder(model).find();
}

}  // namespace dowel
