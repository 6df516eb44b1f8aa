#include "coarse_torus.h"

#include <array>
#include <cmath>
#include <numbers>
#include <variant>

namespace dowel {
namespace {

/// Facets further off a torus than this share of the radius of its tube are coarse.
constexpr double kCoarseTube = 0.25;

/// The angles about the axis and about the tube of a torus, seen from the first corner of a facet.
class TorusAngles {
 public:
  TorusAngles(const TorusSurface& torus, const ModelTriangle& t) : torus_(torus) {
    start_ = radial(t.corners[0]).normalized();
    side_ = torus.axis.cross(start_);
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = near(Eigen::Vector2d::Zero(), t.corners[i]);
    for (std::size_t i = 1; i < 3; ++i) corners_[i] = near(corners_[0], t.corners[i]);
    middle_ = (corners_[0] + corners_[1] + corners_[2]) / 3.0;
  }

  /// How far that part may stand off the facet: the error of linear interpolation, by the largest
  /// second derivatives (Waldron, "The Error in Linear Interpolation at the Vertices of a Simplex",
  /// 1998).
  double reach_mm() const {
    Eigen::Vector2d span = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      span = span.cwiseMax((corners_[(i + 1) % 3] - corners_[i]).cwiseAbs());
    }
    const double tube_mm = torus_.minor_radius_mm;
    return ((torus_.major_radius_mm + tube_mm) * span.x() * span.x() +
            2.0 * tube_mm * span.x() * span.y() + tube_mm * span.y() * span.y()) /
           6.0;
  }

  /// Nearest place to `c`, a place of the torus, of the part for which the facet stands: a triangle
  /// of angles, to scale at `c`. Parts of a face that are next to each other share their sides.
  TrianglePoint closest(const Eigen::Vector3d& c) const {
    const Eigen::Vector2d at = near(middle_, c);
    const Eigen::Vector2d scale(
        std::abs(torus_.major_radius_mm + torus_.minor_radius_mm * std::cos(at.y())),
        torus_.minor_radius_mm);
    const auto flat = [&](const Eigen::Vector2d& angles) {
      return Eigen::Vector3d(scale.x() * angles.x(), scale.y() * angles.y(), 0.0);
    };
    TrianglePoint q =
        closest_on_triangle({flat(corners_[0]), flat(corners_[1]), flat(corners_[2])}, flat(at));
    q.point = place(q.point.head<2>().cwiseQuotient(scale));
    return q;
  }

 private:
  Eigen::Vector3d radial(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = p - torus_.center;
    return d - torus_.axis * torus_.axis.dot(d);
  }
  /// Of all pairs of angles of `p` the one around `other`.
  Eigen::Vector2d near(const Eigen::Vector2d& other, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d r = radial(p);
    const double height = torus_.axis.dot(p - torus_.center);
    const Eigen::Vector2d angles(std::atan2(side_.dot(r), start_.dot(r)),
                                 std::atan2(height, r.norm() - torus_.major_radius_mm));
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return {other.x() + std::remainder(angles.x() - other.x(), kTurn),
            other.y() + std::remainder(angles.y() - other.y(), kTurn)};
  }
  Eigen::Vector3d place(const Eigen::Vector2d& angles) const {
    const double from_axis_mm =
        torus_.major_radius_mm + torus_.minor_radius_mm * std::cos(angles.y());
    return torus_.center + torus_.minor_radius_mm * std::sin(angles.y()) * torus_.axis +
           from_axis_mm * (std::cos(angles.x()) * start_ + std::sin(angles.x()) * side_);
  }

  const TorusSurface& torus_;
  Eigen::Vector3d start_;
  Eigen::Vector3d side_;
  std::array<Eigen::Vector2d, 3> corners_;
  Eigen::Vector2d middle_;
};

}  // namespace

bool is_coarse(const Face& face) {
  const auto* torus = std::get_if<TorusSurface>(&face.surface);
  return torus != nullptr && face.facet_error_mm > kCoarseTube * torus->minor_radius_mm;
}

double coarse_reach_mm(const Face& face, const ModelTriangle& t) {
  return TorusAngles(std::get<TorusSurface>(face.surface), t).reach_mm();
}

TrianglePoint closest_on_coarse(const Face& face, const ModelTriangle& t,
                                const Eigen::Vector3d& c) {
  return TorusAngles(std::get<TorusSurface>(face.surface), t).closest(c);
}

}  // namespace dowel
