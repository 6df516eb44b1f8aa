// A shaft in a bore, by their profiles.

#include <algorithm>
#include <cmath>
#include <limits>

#include "dowel/collision/axis_profile.h"
#include "dowel/collision/scene.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Stretches closer than this are one, and axes are one: well below any tolerance.
constexpr double kEndSlack_mm = 1.0e-7;

/// Axes further apart than this (radians) are not compared.
constexpr double kMaxTilt = 0.1;

/// A stretch of an axis.
struct Stretch {
  double from_mm;
  double to_mm;
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
  const double tilt = a.most_radius_mm() * axis.sine;
  return {z0 + std::min(travel_mm, 0.0) - tilt, z1 + std::max(travel_mm, 0.0) + tilt};
}

/// The larger of the two steps' slopes: how fast the room between them can change with the height.
double steepest(const ProfileStep& a, const ProfileStep& b) {
  return std::max(std::abs(a.slope()), std::abs(b.slope()));
}

/// Distance of two steps that share no height: `both` is what lies between them, turned round. The
/// room between them is `radial` at the ends that face each other and may shrink from there on.
double end_gap(const RelativeAxis& axis, const ProfileStep& a, const ProfileStep& b,
               const Stretch& both) {
  const double axial = both.from_mm - both.to_mm;
  const double miss = std::max(axis.miss(a.from_mm).norm(), axis.miss(a.to_mm).norm());
  const bool is_above = both.from_mm > b.to_mm - kEndSlack_mm;  // the shaft's step
  const double slope = steepest(a, b);
  const double tilt = a.most_radius_mm() * axis.sine;
  const double radius_a = is_above == (axis.cosine > 0.0) ? a.from_radius_mm : a.to_radius_mm;
  const double radial =
      (is_above ? b.to_radius_mm : b.from_radius_mm) - radius_a - miss - slope * tilt;
  if (radial <= 0.0) return axial;
  if (slope * radial < axial) return std::hypot(axial, radial);
  return (radial + slope * axial) / std::hypot(1.0, slope);
}

/// How steeply the walls of two steps come nearer to each other than the room across says that they
/// share heights with. None do where both stand upright, nor where only one leans and ends at
/// the other one's end. `fuzz_mm`: by which the heights may be off.
double lean(const RelativeAxis& axis, const ProfileStep& a, const ProfileStep& b, double fuzz_mm) {
  const double slope_a = a.slope() / axis.cosine;
  const double slope_b = b.slope();
  if (slope_a != 0.0 && slope_b != 0.0) return steepest(a, b);
  const auto [low_a, high_a] = std::minmax({axis.at(a.from_mm), axis.at(a.to_mm)});
  // Above or below the other one, a shaft that widens there, or a bore that narrows.
  double result = 0.0;
  if (high_a + fuzz_mm > b.to_mm) result = std::max(result, slope_a);
  if (low_a - fuzz_mm < b.from_mm) result = std::max(result, -slope_a);
  if (b.to_mm + fuzz_mm > high_a) result = std::max(result, -slope_b);
  if (b.from_mm - fuzz_mm < low_a) result = std::max(result, slope_b);
  return result;
}

/// Whether two round steps are no further apart than the tolerance, whose `gap_mm` is a lower
/// bound: the places compared may lie twice the tilt beyond the heights that both have, where the
/// axes are closer by that times the sine, and the shaft's circle is foreshortened.
bool is_met(const RelativeAxis& axis, const ProfileStep& a, const ProfileStep& b, double gap_mm,
            double tolerance_mm) {
  constexpr double kSecondOrder = 3.0;
  if (!a.is_round || !b.is_round) return false;
  const double tilt = a.most_radius_mm() * axis.sine;
  const auto [low, high] = std::minmax({axis.at(a.from_mm), axis.at(a.to_mm)});
  const double shared_mm = std::min(high, b.to_mm) - std::max(low, b.from_mm);
  return shared_mm >= 2.0 * tilt && gap_mm + kSecondOrder * tilt * axis.sine <= tolerance_mm;
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
  const double tilt = a.most_radius_mm() * axis.sine;
  const double low = (both.from_mm - std::max(travel_mm, 0.0) - tilt - axis.height) / axis.cosine;
  const double high = (both.to_mm - std::min(travel_mm, 0.0) + tilt - axis.height) / axis.cosine;
  const double s0 = std::max(std::min(low, high), a.from_mm);
  const double s1 = std::min(std::max(low, high), a.to_mm);
  // The room is least at an end: the radii change evenly and the miss bulges down. What is at one
  // height of the shaft may meet the bore a little above or below.
  const double astray = std::abs(b.slope()) * (tilt + std::abs(travel_mm));
  SideGap result;
  for (const double s : {s0, s1}) {
    const Eigen::Vector3d miss = axis.miss(s);
    const double miss_mm = miss.norm();
    const double height = std::clamp(axis.at(s), both.from_mm, both.to_mm);
    const double radius_b = b.radius_at(height);
    const double gap_mm = radius_b - astray - a.radius_at(s) - miss_mm;
    if (gap_mm >= result.gap_mm) continue;
    result.gap_mm = gap_mm;
    result.height_mm = height;
    result.wall = radius_b * (miss_mm > kEndSlack_mm ? Eigen::Vector3d(miss / miss_mm)
                                                     : axis.axis.unitOrthogonal());
  }
  if (result.gap_mm > 0.0) {
    result.gap_mm /= std::hypot(1.0, lean(axis, a, b, tilt + std::abs(travel_mm)));
  }
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
        result.gap_is_met = is_met(axis, a, b, side.gap_mm, tolerance_mm);
      }
      if (side.gap_mm < 0.0 &&
          !in_relief(bore, reliefs_V, both, b.most_radius_mm() - side.gap_mm)) {
        overlap.add(both, -side.gap_mm);
      }
    }
  }
  result.is_free = overlap.is_free() && shaft.steps.size() * bore.steps.size() > 0;
  result.gap_mm = std::min(least_gap, least_side.gap_mm);
  // A shaft that is far too thick may end in the bore's first tenth of a tolerance: then nothing is
  // known of what faces the wall.
  result.gap_is_met =
      result.gap_is_met && least_side.gap_mm <= least_gap && least_side.gap_mm > -tolerance_mm;
  if (std::isfinite(least_side.gap_mm)) {
    // Where they overlap, in the middle of that.
    const double beyond_mm = std::max(-0.5 * least_side.gap_mm, 0.0);
    result.place_V = bore.origin + least_side.height_mm * axis.axis +
                     (1.0 + beyond_mm / least_side.wall.norm()) * least_side.wall;
  }
  return result;
}

}  // namespace dowel
