#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <Eigen/Geometry>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/tolerance.h"
#include "equal_holes.h"
#include "hole_grid.h"

namespace dowel {
namespace {

constexpr std::size_t kFewestOnCircle = 3;
/// Among more equal holes than these (a sieve) circles are not looked for.
constexpr std::size_t kMostHoles = 200;

/// Equal holes in their opening plane.
struct Pattern {
  std::vector<const Feature*> holes;
  std::vector<Eigen::Vector2d> at;  ///< in the view frame, from the first hole
  ViewFrame frame;
};

/// Holes of a pattern on one circle, around it.
struct Circle {
  std::vector<std::size_t> holes;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;
};

/// Grid holes are called "A1" or "g2.A1", others "h1", "cb2".
bool is_in_grid(const Feature& hole) {
  const std::size_t dot = hole.name.find('.');
  const char first = hole.name[dot == std::string::npos ? 0 : dot + 1];
  return first >= 'A' && first <= 'Z';
}

std::vector<Pattern> patterns_of(const std::vector<Feature>& features) {
  std::vector<Pattern> patterns;
  for (const Feature& feature : features) {
    if (feature.kind != FeatureKind::Hole || is_in_grid(feature)) continue;
    const auto same = std::ranges::find_if(patterns, [&feature](const Pattern& pattern) {
      return are_equal_holes(*pattern.holes.front(), feature);
    });
    Pattern& pattern = same == patterns.end() ? patterns.emplace_back() : *same;
    if (pattern.holes.empty()) pattern.frame = view_frame(-feature.direction);
    pattern.holes.push_back(&feature);
    const Eigen::Vector3d from_first = feature.origin - pattern.holes.front()->origin;
    pattern.at.emplace_back(pattern.frame.right.dot(from_first), pattern.frame.up.dot(from_first));
  }
  std::erase_if(patterns, [](const Pattern& pattern) {
    return pattern.holes.size() < kFewestOnCircle || pattern.holes.size() > kMostHoles;
  });
  return patterns;
}

/// Centre of the circle through three points. Expects: they are not in line.
Eigen::Vector2d center_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                          const Eigen::Vector2d& c) {
  Eigen::Matrix2d lines;
  lines.row(0) = (b - a).transpose();
  lines.row(1) = (c - a).transpose();
  const Eigen::Vector2d offset =
      lines.inverse() * (0.5 * Eigen::Vector2d((b - a).squaredNorm(), (c - a).squaredNorm()));
  return a + offset;
}

/// All holes of the pattern on the circle about `center`, from the right around to the left.
Circle circle_about(const Pattern& pattern, const Eigen::Vector2d& center, double radius_mm) {
  std::vector<std::pair<double, std::size_t>> by_angle;
  for (std::size_t i = 0; i < pattern.at.size(); ++i) {
    const Eigen::Vector2d p = pattern.at[i] - center;
    if (std::abs(p.norm() - radius_mm) > kCoaxial_mm) continue;
    double angle_rad = std::atan2(p.y(), p.x());
    if (angle_rad * radius_mm < -kCoaxial_mm) angle_rad += 2.0 * std::numbers::pi;
    by_angle.emplace_back(angle_rad, i);
  }
  std::sort(by_angle.begin(), by_angle.end());
  Circle circle;
  for (const auto& [angle_rad, hole] : by_angle) {
    circle.holes.push_back(hole);
    circle.center += pattern.at[hole] / static_cast<double>(by_angle.size());
  }
  for (const std::size_t hole : circle.holes) {
    circle.radius_mm +=
        (pattern.at[hole] - circle.center).norm() / static_cast<double>(circle.holes.size());
  }
  return circle;
}

bool is_evenly_spaced(const Pattern& pattern, const Circle& circle) {
  const std::size_t count = circle.holes.size();
  if (count < kFewestOnCircle) return false;
  const double chord_mm =
      2.0 * circle.radius_mm * std::sin(std::numbers::pi / static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& a = pattern.at[circle.holes[i]];
    const Eigen::Vector2d& b = pattern.at[circle.holes[(i + 1) % count]];
    if (std::abs((b - a).norm() - chord_mm) > 2.0 * kCoaxial_mm) return false;
    if (std::abs((a - circle.center).norm() - circle.radius_mm) > kCoaxial_mm) return false;
  }
  return true;
}

/// Circles on which two holes are equally far from a third, as the neighbours of a hole are.
std::vector<Circle> candidates(const Pattern& pattern) {
  std::map<std::vector<std::size_t>, Circle> circles;  // by their holes, sorted
  for (std::size_t i = 0; i < pattern.at.size(); ++i) {
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t j = 0; j < pattern.at.size(); ++j) {
      if (j != i) others.emplace_back((pattern.at[j] - pattern.at[i]).norm(), j);
    }
    std::sort(others.begin(), others.end());
    for (std::size_t a = 0; a < others.size(); ++a) {
      for (std::size_t b = a + 1; b < others.size(); ++b) {
        if (others[b].first - others[a].first > 2.0 * kCoaxial_mm) break;
        const Eigen::Vector2d p = pattern.at[others[a].second] - pattern.at[i];
        const Eigen::Vector2d q = pattern.at[others[b].second] - pattern.at[i];
        const double twice_area_mm2 = std::abs(p.x() * q.y() - p.y() * q.x());
        if (twice_area_mm2 <= kCoaxial_mm * others[a].first) continue;
        const Eigen::Vector2d center =
            center_of(pattern.at[i], pattern.at[others[a].second], pattern.at[others[b].second]);
        Circle circle = circle_about(pattern, center, (pattern.at[i] - center).norm());
        if (!is_evenly_spaced(pattern, circle)) continue;
        std::vector<std::size_t> key = circle.holes;
        std::sort(key.begin(), key.end());
        circles.emplace(std::move(key), std::move(circle));
      }
    }
  }
  std::vector<Circle> result;
  for (auto& [key, circle] : circles) result.push_back(std::move(circle));
  return result;
}

/// The circles with the most holes, of those the smallest; no hole is in two.
std::vector<Circle> best_circles(const Pattern& pattern) {
  std::vector<Circle> found = candidates(pattern);
  std::ranges::stable_sort(found, [](const Circle& a, const Circle& b) {
    if (a.holes.size() != b.holes.size()) return a.holes.size() > b.holes.size();
    return a.radius_mm < b.radius_mm - kCoaxial_mm;
  });
  std::vector<bool> is_taken(pattern.holes.size(), false);
  std::vector<Circle> result;
  for (const Circle& circle : found) {
    if (std::ranges::any_of(circle.holes, [&](std::size_t hole) { return is_taken[hole]; })) {
      continue;
    }
    for (const std::size_t hole : circle.holes) is_taken[hole] = true;
    result.push_back(circle);
  }
  return result;
}

/// To the grid of features. Adding zero turns -0 into 0.
double rounded(double length_mm) {
  return std::round(length_mm * kFeatureSteps_per_mm) / kFeatureSteps_per_mm + 0.0;
}

BoltCircle to_bolt_circle(const Pattern& pattern, const Circle& circle) {
  const Feature& first = *pattern.holes.front();
  BoltCircle result;
  result.center = (first.origin + circle.center.x() * pattern.frame.right +
                   circle.center.y() * pattern.frame.up)
                      .unaryExpr(&rounded);
  result.direction = first.direction;
  result.diameter_mm = rounded(2.0 * circle.radius_mm);
  result.hole_diameter_mm = first.diameter_mm;
  for (const std::size_t hole : circle.holes) result.holes.push_back(pattern.holes[hole]->name);
  return result;
}

}  // namespace

std::vector<BoltCircle> find_bolt_circles(const std::vector<Feature>& features) {
  std::vector<BoltCircle> result;
  for (const Pattern& pattern : patterns_of(features)) {
    for (const Circle& circle : best_circles(pattern)) {
      result.push_back(to_bolt_circle(pattern, circle));
    }
  }
  return result;
}

}  // namespace dowel
