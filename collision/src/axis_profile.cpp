#include "dowel/collision/axis_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
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

/// Axes further apart than this (radians) are not compared.
constexpr double kMaxTilt = 0.1;

/// A face of revolution about the axis that is looked at.
struct CoaxialFace {
  std::uint32_t face;
  double from_mm;
  double to_mm;
  double least_radius_mm;
  double most_radius_mm;
};

bool same_axis(const CylinderSurface& a, const CylinderSurface& b) {
  if (a.axis.cross(b.axis).norm() > kParallel_rad) return false;
  const Eigen::Vector3d between = b.origin - a.origin;
  return (between - a.axis.dot(between) * a.axis).norm() <= kCoincident_mm;
}

/// A stretch of an axis.
struct Stretch {
  double from_mm;
  double to_mm;
};

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
  std::vector<CylinderSurface> axes(bool is_bore) const {
    std::vector<CylinderSurface> result;
    for (std::uint32_t f = 0; f < model_.face_count(); ++f) {
      const auto* cylinder = std::get_if<CylinderSurface>(&model_.face(f).surface);
      if (cylinder == nullptr || model_.face(f).reversed != is_bore) continue;
      const bool is_known = std::ranges::any_of(
          result, [&](const CylinderSurface& axis) { return same_axis(axis, *cylinder); });
      if (!is_known) result.push_back(*cylinder);
    }
    return result;
  }

  /// Faces of revolution about the axis, with the radii that they take. These depend on the height
  /// alone and are least and largest at an end, where vertices lie on the exact face; a torus also
  /// at its middle.
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
      CoaxialFace entry{f, kInfinity, -kInfinity, kInfinity, 0.0};
      for (const ModelTriangle* t : facets_[f]) {
        for (const Eigen::Vector3d& corner : t->corners) {
          const Eigen::Vector3d p = frame(corner);
          entry.from_mm = std::min(entry.from_mm, p.z());
          entry.to_mm = std::max(entry.to_mm, p.z());
          entry.least_radius_mm = std::min(entry.least_radius_mm, p.head<2>().norm());
          entry.most_radius_mm = std::max(entry.most_radius_mm, p.head<2>().norm());
        }
      }
      if (cylinder != nullptr) {
        entry.least_radius_mm = entry.most_radius_mm = cylinder->radius_mm;
      } else if (torus != nullptr) {
        const double middle = frame(torus->center).z();
        if (entry.from_mm <= middle && middle <= entry.to_mm) {
          entry.least_radius_mm = torus->major_radius_mm - torus->minor_radius_mm;
          entry.most_radius_mm = torus->major_radius_mm + torus->minor_radius_mm;
        }
      }
      result.push_back(entry);
    }
    return result;
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
      ProfileStep step{ends[i], ends[i + 1], is_bore ? kInfinity : 0.0, false};
      for (const CoaxialFace& face : coaxial) {
        if (face.to_mm <= step.from_mm + kEndSlack_mm) continue;
        if (face.from_mm >= step.to_mm - kEndSlack_mm) continue;
        step.radius_mm = is_bore ? std::min(step.radius_mm, face.least_radius_mm)
                                 : std::max(step.radius_mm, face.most_radius_mm);
      }
      take_facets(step, frame, coaxial, is_bore);
      const double middle = 0.5 * (step.from_mm + step.to_mm);
      if (is_bore && model_.facets_contain(frame.origin + middle * frame.w)) step.radius_mm = 0.0;
      step.is_round = goes_round(frame, coaxial, step);
      if (is_bore ? step.radius_mm < kInfinity : step.radius_mm > 0.0) {
        profile.steps.push_back(step);
      }
    }
    return profile;
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
      if (is_bore ? range.nearest_mm >= step.radius_mm : range.farthest_mm <= step.radius_mm) {
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
    // A face normal to the axis does not stand off its facets along it.
    const double tall = most - least <= kEndSlack_mm ? 0.0 : t.slack_mm;
    if (most + tall <= low || least - tall >= high) return;
    const Clipped part = clip(corners, low - tall, high + tall);
    if (part.count == 0) return;
    if (is_bore) {
      step.radius_mm = std::min(step.radius_mm, std::max(smallest_radius(part) - t.slack_mm, 0.0));
    } else {
      step.radius_mm = std::max(step.radius_mm, largest_radius(part) + t.slack_mm);
    }
  }

  /// Whether cylinders of the step's radius cover it all the way round: by the area of their
  /// facets, unrolled.
  bool goes_round(const AxisFrame& frame, const std::vector<CoaxialFace>& coaxial,
                  const ProfileStep& step) const {
    double share = 0.0;
    for (const CoaxialFace& face : coaxial) {
      if (!std::holds_alternative<CylinderSurface>(model_.face(face.face).surface) ||
          std::abs(face.least_radius_mm - step.radius_mm) > kEndSlack_mm ||
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

/// The shaft's axis as the bore's axis sees it.
struct RelativeAxis {
  RelativeAxis(const AxisProfile& shaft, const AxisProfile& bore, const Pose& X_VS)
      : origin(X_VS * shaft.origin - bore.origin),
        direction(X_VS.rotation() * shaft.direction),
        cosine(bore.direction.dot(direction)),
        sine(bore.direction.cross(direction).norm()),
        height(bore.direction.dot(origin)),
        axis(bore.direction) {}

  /// Height of the shaft's place `s` along the bore.
  double at(double s) const { return height + cosine * s; }
  /// From the bore's axis to the shaft's at its place `s`.
  Eigen::Vector3d miss(double s) const {
    const Eigen::Vector3d p = origin + s * direction;
    return p - axis.dot(p) * axis;
  }

  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double cosine;
  double sine;
  double height;
  Eigen::Vector3d axis;
};

bool in_relief(const AxisProfile& bore, std::span<const ThreadRelief> reliefs, const Stretch& z,
               double radius) {
  return std::ranges::any_of(reliefs, [&](const ThreadRelief& relief) {
    const Eigen::Vector3d start = relief.start - bore.origin;
    const double cosine = bore.direction.dot(relief.direction);
    const double h0 = bore.direction.dot(start);
    const double h1 = h0 + cosine * relief.length_mm;
    return bore.direction.cross(relief.direction).norm() <= kParallel_rad &&
           (start - h0 * bore.direction).norm() + radius <= relief.radius_mm + kCoincident_mm &&
           z.from_mm >= std::min(h0, h1) - kCoincident_mm &&
           z.to_mm <= std::max(h0, h1) + kCoincident_mm;
  });
}

/// Heights along the bore that a step of the shaft reaches, on its way of `travel_mm`.
Stretch reach_of(const RelativeAxis& axis, const ProfileStep& a, double travel_mm) {
  const auto [z0, z1] = std::minmax({axis.at(a.from_mm), axis.at(a.to_mm)});
  const double tilt = a.radius_mm * axis.sine;
  return {z0 + std::min(travel_mm, 0.0) - tilt, z1 + std::max(travel_mm, 0.0) + tilt};
}

/// Distance of two steps that share no height: `both` is what lies between them, turned round.
double end_gap(const RelativeAxis& axis, const ProfileStep& a, const ProfileStep& b,
               const Stretch& both) {
  const double axial = both.from_mm - both.to_mm;
  const double miss = std::max(axis.miss(a.from_mm).norm(), axis.miss(a.to_mm).norm());
  const double radial = b.radius_mm - a.radius_mm - miss;
  return radial > 0.0 ? std::hypot(axial, radial) : axial;
}

/// What two steps leave between them over the heights that they share.
struct SideGap {
  double gap_mm = kInfinity;                       ///< negative: the shaft passes the bore's radius
  double height_mm = 0.0;                          ///< where that is, along the bore
  Eigen::Vector3d wall = Eigen::Vector3d::Zero();  ///< from the bore's axis to its wall there
};

SideGap side_gap(const RelativeAxis& axis, const ProfileStep& a, const ProfileStep& b,
                 const Stretch& both, double travel_mm) {
  // Places of the shaft's axis that this stretch of the bore can see.
  const double tilt = a.radius_mm * axis.sine;
  const double low = (both.from_mm - std::max(travel_mm, 0.0) - tilt - axis.height) / axis.cosine;
  const double high = (both.to_mm - std::min(travel_mm, 0.0) + tilt - axis.height) / axis.cosine;
  const double s0 = std::max(std::min(low, high), a.from_mm);
  const double s1 = std::min(std::max(low, high), a.to_mm);
  const Eigen::Vector3d miss0 = axis.miss(s0);
  const Eigen::Vector3d miss1 = axis.miss(s1);
  const bool is_at_s0 = miss0.squaredNorm() >= miss1.squaredNorm();
  const Eigen::Vector3d& miss = is_at_s0 ? miss0 : miss1;
  const double miss_mm = miss.norm();
  SideGap result;
  result.gap_mm = b.radius_mm - a.radius_mm - miss_mm;
  result.wall = b.radius_mm * (miss_mm > kEndSlack_mm ? Eigen::Vector3d(miss / miss_mm)
                                                      : axis.axis.unitOrthogonal());
  result.height_mm = std::clamp(axis.at(is_at_s0 ? s0 : s1), both.from_mm, both.to_mm);
  return result;
}

/// Heights at which the shaft passes the bore's radius. A ball of the tolerance's diameter in both
/// bodies needs that over its own height, and by its diameter where its middle is.
class Overlap {
 public:
  explicit Overlap(double tolerance_mm) : tolerance_mm_(tolerance_mm) {}

  /// Adds a stretch; ascending.
  void add(const Stretch& stretch, double by_mm) {
    if (stretch.from_mm > run_.to_mm + kEndSlack_mm) {
      run_.from_mm = stretch.from_mm;
      is_deep_ = false;
    }
    run_.from_mm = std::min(run_.from_mm, stretch.from_mm);
    run_.to_mm = std::max(run_.to_mm, stretch.to_mm);
    is_deep_ = is_deep_ || by_mm >= tolerance_mm_;
    if (is_deep_ && run_.to_mm - run_.from_mm >= tolerance_mm_) is_free_ = false;
  }

  bool is_free() const { return is_free_; }

 private:
  double tolerance_mm_;
  Stretch run_{0.0, -kInfinity};
  bool is_deep_ = false;
  bool is_free_ = true;
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

Fit fit(const AxisProfile& shaft, const AxisProfile& bore, const Pose& X_VS, double tolerance_mm,
        std::span<const ThreadRelief> reliefs_V, double travel_mm) {
  const RelativeAxis axis(shaft, bore, X_VS);
  Fit result;
  if (axis.sine > kMaxTilt) return result;
  const bool turned = axis.cosine < 0.0;
  double least_gap = kInfinity;
  SideGap least_side;
  Overlap overlap(tolerance_mm);
  const std::size_t count = shaft.steps.size();
  for (std::size_t n = 0; n < count; ++n) {
    const ProfileStep& a = shaft.steps[turned ? count - 1 - n : n];
    const Stretch reach = reach_of(axis, a, travel_mm);
    for (const ProfileStep& b : bore.steps) {
      const Stretch both{std::max(reach.from_mm, b.from_mm), std::min(reach.to_mm, b.to_mm)};
      if (both.from_mm >= both.to_mm) {
        least_gap = std::min(least_gap, end_gap(axis, a, b, both));
        continue;
      }
      const SideGap side = side_gap(axis, a, b, both, travel_mm);
      if (side.gap_mm < least_side.gap_mm) {
        least_side = side;
        result.gap_is_met = a.is_round && b.is_round;
      }
      if (side.gap_mm < 0.0 && !in_relief(bore, reliefs_V, both, b.radius_mm - side.gap_mm)) {
        overlap.add(both, -side.gap_mm);
      }
    }
  }
  result.is_free = overlap.is_free() && shaft.steps.size() * bore.steps.size() > 0;
  result.gap_mm = std::min(least_gap, least_side.gap_mm);
  result.gap_is_met = result.gap_is_met && least_side.gap_mm <= least_gap;
  if (std::isfinite(least_side.gap_mm)) {
    result.place_V = bore.origin + least_side.height_mm * axis.axis + least_side.wall;
  }
  return result;
}

}  // namespace dowel
