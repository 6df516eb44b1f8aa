#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Core>

namespace dowel::testing {

/// A corner of an outline, and how the outline goes on to the next one: straight, or along an arc
/// that turns by `sweep_rad`, counter-clockwise where that is positive.
struct Corner {
  double x = 0.0;
  double y = 0.0;
  double sweep_rad = 0.0;  ///< in (-2 pi, 2 pi); 0: straight

  Eigen::Vector2d point() const { return {x, y}; }
};

/// Closed, of lines and arcs that do not meet but at corners, with the material on the left:
/// counter-clockwise around it, clockwise around a hole in it.
using Outline = std::vector<Corner>;

/// One piece of an outline, from `start` to `end`.
struct OutlinePiece {
  Eigen::Vector2d start;
  Eigen::Vector2d end;
  double sweep_rad = 0.0;  ///< 0: a line, and the rest says nothing
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;
  Eigen::Vector2d middle_direction = Eigen::Vector2d::Zero();  ///< unit, from the centre
  double cos_half_sweep = 1.0;

  /// From corner `index` to the next one.
  OutlinePiece(const Outline& outline, std::size_t index)
      : start(outline[index].point()),
        end(outline[(index + 1) % outline.size()].point()),
        sweep_rad(outline[index].sweep_rad) {
    if (sweep_rad == 0.0) return;
    const Eigen::Vector2d chord = end - start;
    const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / chord.norm();
    center = 0.5 * (start + end) + 0.5 * chord.norm() / std::tan(0.5 * sweep_rad) * left;
    radius_mm = (start - center).norm();
    middle_direction = sweep_rad > 0.0 ? -left : left;
    cos_half_sweep = std::cos(0.5 * sweep_rad);
  }

  bool is_arc() const { return sweep_rad != 0.0; }

  /// Expects: an arc; `share` in [0, 1], 0 at the start.
  Eigen::Vector2d on_arc(double share) const {
    const Eigen::Vector2d from = start - center;
    const double angle = std::atan2(from.y(), from.x()) + share * sweep_rad;
    return center + radius_mm * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }

  /// Along the outline, not of unit length.
  Eigen::Vector2d tangent_at(const Eigen::Vector2d& p) const {
    if (!is_arc()) return end - start;
    const Eigen::Vector2d r = p - center;
    return sweep_rad > 0.0 ? Eigen::Vector2d(-r.y(), r.x()) : Eigen::Vector2d(r.y(), -r.x());
  }

  /// The corner of the smallest box around it in which the coordinates are least (`sign` -1) or
  /// largest (1).
  Eigen::Vector2d extreme(double sign) const {
    Eigen::Vector2d result =
        sign * Eigen::Vector2d((sign * start).cwiseMax(Eigen::Vector2d(sign * end)));
    for (Eigen::Index axis = 0; is_arc() && axis < 2; ++axis) {
      if (sign * middle_direction[axis] < cos_half_sweep) continue;
      result[axis] = center[axis] + sign * radius_mm;
    }
    return result;
  }

  double distance_mm(const Eigen::Vector2d& p) const {
    if (is_arc()) {
      const Eigen::Vector2d r = p - center;
      const double length = r.norm();
      if (r.dot(middle_direction) >= length * cos_half_sweep) return std::abs(length - radius_mm);
      return std::sqrt(std::min((p - start).squaredNorm(), (p - end).squaredNorm()));
    }
    const Eigen::Vector2d along = end - start;
    const double share = std::clamp((p - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (start + share * along - p).norm();
  }

  /// Whether p changes sides by this piece: its chord crosses the ray from p along x, or else p is
  /// between chord and arc. Both ask the same about the chord, so that a point on it is told once.
  bool flips(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d chord = end - start;
    const Eigen::Vector2d r = p - start;
    const bool is_left = chord.y() == 0.0 ? (r.y() >= 0.0) == (chord.x() > 0.0)
                                          : chord.x() * r.y() - chord.y() * r.x() > 0.0;
    const bool is_crossed =
        (start.y() > p.y()) != (end.y() > p.y()) && is_left == (chord.y() > 0.0);
    const bool is_beyond_chord = is_arc() && is_left == (sweep_rad < 0.0) &&
                                 (p - center).squaredNorm() < radius_mm * radius_mm;
    return is_crossed != is_beyond_chord;
  }
};

/// The area within outlines, with its distance from any point of the plane.
class OutlinedArea {
 public:
  enum class Plane { Whole, RightOfAxis };

  /// RightOfAxis: the profile of a body of revolution, x its radius: what lies on x = 0 is no
  /// boundary, and no point left of that is asked about.
  explicit OutlinedArea(const std::vector<Outline>& outlines, Plane plane = Plane::Whole) {
    for (const Outline& outline : outlines) {
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const OutlinePiece piece(outline, i);
        const bool is_on_axis = !piece.is_arc() && piece.start.x() == 0.0 && piece.end.x() == 0.0;
        if (plane == Plane::Whole || !is_on_axis) pieces_.push_back(piece);
        min_ = min_.cwiseMin(piece.extreme(-1.0));
        max_ = max_.cwiseMax(piece.extreme(1.0));
      }
    }
  }

  const Eigen::Vector2d& min() const { return min_; }
  const Eigen::Vector2d& max() const { return max_; }

  /// Negative inside.
  double signed_distance_mm(const Eigen::Vector2d& p) const {
    double least_mm = std::numeric_limits<double>::infinity();
    bool is_inside = false;
    for (const OutlinePiece& piece : pieces_) {
      least_mm = std::min(least_mm, piece.distance_mm(p));
      if (piece.flips(p)) is_inside = !is_inside;
    }
    return is_inside ? -least_mm : least_mm;
  }

 private:
  std::vector<OutlinePiece> pieces_;
  Eigen::Vector2d min_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d max_ = -min_;
};

inline Outline straight_outline(const std::vector<Eigen::Vector2d>& polygon) {
  Outline result;
  result.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) result.push_back({p.x(), p.y()});
  return result;
}

/// The same line run the other way: around a hole what was around material, and back.
inline Outline reversed(const Outline& outline) {
  Outline result;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Corner& corner = outline[n - 1 - i];
    result.push_back({corner.x, corner.y, -outline[(2 * n - 2 - i) % n].sweep_rad});
  }
  return result;
}

/// Counter-clockwise, of two arcs that meet at `phase_rad` and opposite.
inline Outline circle(const Eigen::Vector2d& center, double radius_mm, double phase_rad) {
  const Eigen::Vector2d r = radius_mm * Eigen::Vector2d(std::cos(phase_rad), std::sin(phase_rad));
  const Eigen::Vector2d a = center + r;
  const Eigen::Vector2d b = center - r;
  return {{a.x(), a.y(), std::numbers::pi}, {b.x(), b.y(), std::numbers::pi}};
}

}  // namespace dowel::testing
