#include "surface_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// Below this many vertices a quadric fits anything.
constexpr std::size_t kFewestVertices = 6;

/// Normals of a cylinder or cone keep their angle to the axis; with facets whose normals vary more
/// than this along every direction (variance) there is no point in trying.
constexpr double kNormalVariance = 0.01;

constexpr int kMaxSteps = 30;

/// The exact face may exceed the area on the fitted surface by this ratio, and the measured facet
/// error that of the fit by that one: what coarse rims and the measurement itself leave.
constexpr double kAreaSlack = 1.0e-3;
constexpr double kFacetErrorSlack = 1.5;

struct Sample {
  std::vector<Eigen::Vector3d> points;  ///< sorted, without repetition
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double reach_mm = 0.0;  ///< from the middle
};

Sample make_sample(const FacetedSolid& solid, const std::vector<std::uint32_t>& triangles) {
  Sample sample;
  for (const std::uint32_t t : triangles) {
    sample.triangles.push_back(canonical_corners(solid, t));
    for (const Eigen::Vector3d& p : sample.triangles.back()) sample.points.push_back(p);
  }
  std::sort(sample.triangles.begin(), sample.triangles.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        less_by_coordinates);
  });
  std::sort(sample.points.begin(), sample.points.end(), less_by_coordinates);
  sample.points.erase(std::unique(sample.points.begin(), sample.points.end()), sample.points.end());
  for (const Eigen::Vector3d& p : sample.points) sample.middle += p;
  if (!sample.points.empty()) sample.middle /= static_cast<double>(sample.points.size());
  for (const Eigen::Vector3d& p : sample.points) {
    sample.reach_mm = std::max(sample.reach_mm, (p - sample.middle).norm());
  }
  return sample;
}

/// `direction`, or the coordinate axis that it misses by less than the tolerance over `reach_mm`.
Eigen::Vector3d snapped_direction(const Eigen::Vector3d& direction, double reach_mm) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  const Eigen::Vector3d axis =
      std::copysign(1.0, direction[largest]) * Eigen::Vector3d::Unit(largest);
  return (direction - axis).norm() * reach_mm <= kSameFeature_mm ? axis : direction;
}

std::optional<SurfaceFit> fit_plane(const Sample& sample, const Face& face) {
  if (face.facet_error_mm > kSameFeature_mm) return std::nullopt;
  Eigen::Vector3d doubled = Eigen::Vector3d::Zero();
  for (const auto& triangle : sample.triangles) doubled += doubled_area(triangle);
  if (!(doubled.norm() > 0.0)) return std::nullopt;

  const auto fits = [&](const Eigen::Vector3d& normal, const Eigen::Vector3d& origin) {
    return std::all_of(sample.points.begin(), sample.points.end(), [&](const auto& p) {
      return std::abs(normal.dot(p - origin)) <= kSameFeature_mm;
    });
  };
  const Eigen::Vector3d normal = doubled.normalized();
  for (const Eigen::Vector3d& n : {snapped_direction(normal, sample.reach_mm), normal}) {
    if (fits(n, sample.middle)) return SurfaceFit{PlaneSurface{sample.middle, n}, false};
  }
  return std::nullopt;
}

/// Cone about the line through `origin` along `axis`: radius at the origin and growth along the
/// axis. A cylinder grows by zero.
struct Frustum {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius_mm = 0.0;
  double growth = 0.0;

  /// Distance of `p` from the surface, positive outside; exact on it, slightly off far from it.
  double residual_mm(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = p - origin;
    const double z = q.dot(axis);
    return ((q - z * axis).norm() - radius_mm - growth * z) / std::hypot(1.0, growth);
  }
  double worst_mm(const std::vector<Eigen::Vector3d>& points) const {
    double worst = 0.0;
    for (const Eigen::Vector3d& p : points) worst = std::max(worst, std::abs(residual_mm(p)));
    return worst;
  }
};

enum class Freedom { Cone, Cylinder, CylinderAlongAxis };

/// One step of Gauss and Newton; the size of the step in mm at the rim of the sample. Normal
/// equations do: the residuals are computed anew in every step, so that rounding costs steps only.
double improve(Frustum& frustum, const Sample& sample, Freedom freedom) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const Eigen::Vector3d u = any_perpendicular(frustum.axis);
  const Eigen::Vector3d v = frustum.axis.cross(u);
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6d rhs = Vector6d::Zero();
  // Turns and growth are measured at the rim, so that all unknowns are lengths.
  const double reach = sample.reach_mm;
  for (const Eigen::Vector3d& p : sample.points) {
    const Eigen::Vector3d q = p - frustum.origin;
    const double z = q.dot(frustum.axis);
    const Eigen::Vector3d radial = q - z * frustum.axis;
    const double rho = radial.norm();
    const Eigen::Vector3d out = rho > 0.0 ? Eigen::Vector3d(radial / rho) : u;
    const double residual = rho - frustum.radius_mm - frustum.growth * z;
    const double tilt = -(z + frustum.growth * rho) / reach;
    Vector6d row;
    row << -out.dot(u), -out.dot(v), -1.0, tilt * out.dot(u), tilt * out.dot(v), -z / reach;
    if (freedom != Freedom::Cone) row[5] = 0.0;
    if (freedom == Freedom::CylinderAlongAxis) row.segment<2>(3).setZero();
    normal += row * row.transpose();
    rhs -= residual * row;
  }
  if (freedom != Freedom::Cone) normal(5, 5) = 1.0;
  if (freedom == Freedom::CylinderAlongAxis) normal(3, 3) = normal(4, 4) = 1.0;
  const Vector6d step = normal.ldlt().solve(rhs);
  if (!step.allFinite()) return 0.0;
  frustum.origin += step[0] * u + step[1] * v;
  frustum.radius_mm += step[2];
  frustum.axis = (frustum.axis + (step[3] * u + step[4] * v) / reach).normalized();
  frustum.growth += step[5] / reach;
  return step.norm();
}

Frustum improved(Frustum frustum, const Sample& sample, Freedom freedom) {
  for (int i = 0; i < kMaxSteps; ++i) {
    const double step_mm = improve(frustum, sample, freedom);
    if (!(step_mm > kRounding * sample.reach_mm)) break;
    if (!(frustum.radius_mm < kMaxCoordinate_mm)) break;
  }
  return frustum;
}

/// Axis from the direction along which the normals vary least, circle by linear least squares.
std::optional<Frustum> first_guess(const Sample& sample) {
  double weight = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const auto& triangle : sample.triangles) {
    const Eigen::Vector3d doubled = doubled_area(triangle);
    const double area = doubled.norm();
    if (!(area > 0.0)) continue;
    weight += area;
    mean += doubled;
    moment += doubled * doubled.transpose() / area;
  }
  if (!(weight > 0.0)) return std::nullopt;
  mean /= weight;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment / weight -
                                                              mean * mean.transpose());
  if (solver.info() != Eigen::Success || solver.eigenvalues()[0] > kNormalVariance) {
    return std::nullopt;
  }

  Frustum guess;
  guess.axis = solver.eigenvectors().col(0);
  const Eigen::Vector3d u = any_perpendicular(guess.axis);
  const Eigen::Vector3d v = guess.axis.cross(u);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : sample.points) {
    const Eigen::Vector2d flat(u.dot(p - sample.middle), v.dot(p - sample.middle));
    const Eigen::Vector3d row(2.0 * flat.x(), 2.0 * flat.y(), 1.0);
    normal += row * row.transpose();
    rhs += flat.squaredNorm() * row;
  }
  const Eigen::Vector3d circle = normal.ldlt().solve(rhs);
  const double radius_squared = circle.z() + circle.head<2>().squaredNorm();
  if (!circle.allFinite() || !(radius_squared > 0.0)) return std::nullopt;
  guess.origin = sample.middle + circle.x() * u + circle.y() * v;
  guess.radius_mm = std::sqrt(radius_squared);
  return guess;
}

/// Area of the facets laid onto the surface, and how far they stand off it.
struct Drape {
  double area_mm2 = 0.0;
  double facet_error_mm = 0.0;
};

Drape drape(const Frustum& frustum, const Sample& sample) {
  Drape result;
  const Eigen::Vector3d u = any_perpendicular(frustum.axis);
  const Eigen::Vector3d v = frustum.axis.cross(u);
  for (const auto& triangle : sample.triangles) {
    std::array<Eigen::Vector3d, 3> polar;  // rho, angle, z
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d q = triangle[i] - frustum.origin;
      polar[i] = {std::hypot(q.dot(u), q.dot(v)), std::atan2(q.dot(v), q.dot(u)),
                  q.dot(frustum.axis)};
      result.facet_error_mm =
          std::max(result.facet_error_mm,
                   std::abs(frustum.residual_mm(0.5 * (triangle[i] + triangle[(i + 1) % 3]))));
    }
    // Flat pattern of a developable surface: a triangle stays one where its angles are small, and
    // (mean radius) d_angle by d_slant is its area to third order.
    Eigen::Vector2d side[2];
    const double rho = (polar[0].x() + polar[1].x() + polar[2].x()) / 3.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double turn = std::remainder(polar[i + 1].y() - polar[0].y(), 2.0 * std::numbers::pi);
      side[i] = {rho * turn, (polar[i + 1].z() - polar[0].z()) * std::hypot(1.0, frustum.growth)};
    }
    result.area_mm2 += 0.5 * std::abs(side[0].x() * side[1].y() - side[0].y() * side[1].x());
  }
  return result;
}

bool follows(const Frustum& frustum, const Sample& sample, const Face& face) {
  if (!(frustum.radius_mm > kSameFeature_mm)) return false;
  if (!(frustum.worst_mm(sample.points) <= kSameFeature_mm)) return false;
  const Drape draped = drape(frustum, sample);
  if (!(face.facet_error_mm <= kFacetErrorSlack * draped.facet_error_mm + kSameFeature_mm)) {
    return false;
  }
  // An apex has no angle, so that a tip's flat pattern is known roughly only.
  if (std::abs(frustum.growth) * sample.reach_mm > kSameFeature_mm) return true;
  return std::abs(face.area_mm2 - draped.area_mm2) <= kAreaSlack * face.area_mm2;
}

SurfaceFit as_surface(const Frustum& frustum, const Sample& sample) {
  SurfaceFit fit;
  if (frustum.growth == 0.0) {
    fit.surface = CylinderSurface{frustum.origin, frustum.axis, frustum.radius_mm};
  } else {
    fit.surface = ConeSurface{frustum.origin - frustum.radius_mm / frustum.growth * frustum.axis,
                              std::copysign(1.0, frustum.growth) * frustum.axis,
                              std::atan(std::abs(frustum.growth))};
  }
  double agreement = 0.0;
  for (const auto& triangle : sample.triangles) {
    const Eigen::Vector3d centroid = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    agreement += doubled_area(triangle).dot(distance_gradient(fit.surface, centroid));
  }
  fit.reversed = agreement < 0.0;
  return fit;
}

std::optional<SurfaceFit> fit_frustum(const Sample& sample, const Face& face) {
  const std::optional<Frustum> guess = first_guess(sample);
  if (!guess) return std::nullopt;

  const Frustum cylinder = improved(*guess, sample, Freedom::Cylinder);
  Frustum straight = cylinder;
  straight.axis = snapped_direction(cylinder.axis, sample.reach_mm);
  straight = improved(straight, sample, Freedom::CylinderAlongAxis);
  for (const Frustum& candidate : {straight, cylinder}) {
    if (follows(candidate, sample, face)) return as_surface(candidate, sample);
  }
  const Frustum cone = improved(*guess, sample, Freedom::Cone);
  if (cone.growth != 0.0 && follows(cone, sample, face)) return as_surface(cone, sample);
  return std::nullopt;
}

}  // namespace

std::optional<SurfaceFit> fit_surface(const FacetedSolid& solid, const Face& face,
                                      const std::vector<std::uint32_t>& triangles) {
  const Sample sample = make_sample(solid, triangles);
  if (sample.points.size() < 3) return std::nullopt;
  if (auto plane = fit_plane(sample, face)) return plane;
  if (sample.points.size() < kFewestVertices) return std::nullopt;
  return fit_frustum(sample, face);
}

}  // namespace dowel
