#include "dowel/assembly/restraint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

/// Share of the forces that may stay unbalanced: far over the rounding of NNLS, far below what a
/// force is known to.
constexpr double kBalanced = 1.0e-6;

/// Columns `passive` of `a` that solve best by least squares.
Eigen::VectorXd solve_on(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                         const std::vector<Eigen::Index>& passive) {
  Eigen::MatrixXd part(a.rows(), static_cast<Eigen::Index>(passive.size()));
  for (std::size_t i = 0; i < passive.size(); ++i) {
    part.col(static_cast<Eigen::Index>(i)) = a.col(passive[i]);
  }
  return part.colPivHouseholderQr().solve(b);
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Unit vectors across `normal`, square to each other.
std::pair<Eigen::Vector3d, Eigen::Vector3d> tangents(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d first = normal.unitOrthogonal();
  return {first, normal.cross(first)};
}

}  // namespace

Wrench wrench_of(const Eigen::Vector3d& force_N, const Eigen::Vector3d& at,
                 const LocatingFrame& frame) {
  Wrench wrench;
  wrench << force_N, (at - frame.reference).cross(force_N) / frame.length_mm;
  return wrench;
}

NonNegative non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  DOWEL_EXPECTS(a.allFinite() && b.allFinite() && a.rows() == b.size());
  NonNegative result;
  result.x = Eigen::VectorXd::Zero(a.cols());
  std::vector<Eigen::Index> passive;
  // A gradient of a column that is smaller than this is rounding.
  const double zero = 1.0e-12 * std::max(1.0e-300, a.norm() * b.norm());
  const Eigen::Index most_steps = 3 * a.cols() + 30;
  for (Eigen::Index step = 0;; ++step) {
    const Eigen::VectorXd gradient = a.transpose() * (b - a * result.x);
    Eigen::Index next = -1;
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
      if (std::ranges::find(passive, i) != passive.end() || gradient[i] <= zero) continue;
      if (next < 0 || gradient[i] > gradient[next]) next = i;
    }
    if (next < 0) break;
    if (step == most_steps) {
      result.has_converged = false;
      break;
    }
    passive.push_back(next);
    Eigen::VectorXd solution = solve_on(a, b, passive);
    while (solution.size() > 0 && solution.minCoeff() <= 0.0) {
      // Back along the way to it, to where the first one reaches zero; that one goes.
      double share = 1.0;
      for (std::size_t i = 0; i < passive.size(); ++i) {
        const double to = solution[static_cast<Eigen::Index>(i)];
        const double from = result.x[passive[i]];
        if (to <= 0.0) share = std::min(share, from / std::max(from - to, 1.0e-300));
      }
      std::vector<Eigen::Index> kept;
      for (std::size_t i = 0; i < passive.size(); ++i) {
        double& x = result.x[passive[i]];
        const double to = solution[static_cast<Eigen::Index>(i)];
        const double from = x;
        x += share * (to - x);
        const bool goes = to <= 0.0 && from / std::max(from - to, 1.0e-300) <= share;
        if (goes || x <= 0.0) {
          x = 0.0;
        } else {
          kept.push_back(passive[i]);
        }
      }
      passive = kept;
      solution = passive.empty() ? Eigen::VectorXd() : solve_on(a, b, passive);
    }
    for (std::size_t i = 0; i < passive.size(); ++i) {
      result.x[passive[i]] = solution[static_cast<Eigen::Index>(i)];
    }
  }
  result.residual = (a * result.x - b).norm();
  return result;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> pushing_matrix(std::span<const LocatingPoint> points,
                                                        const LocatingFrame& frame) {
  std::vector<LocatingPoint> pushing(points.begin(), points.end());
  for (LocatingPoint point : points) {
    if (!point.two_sided) continue;
    point.normal = -point.normal;
    pushing.push_back(point);
  }
  return locator_matrix(pushing, frame);
}

Seating seating_forces(std::span<const LocatingPoint> points, const LocatingFrame& frame,
                       const Wrench& wrench) {
  DOWEL_EXPECTS(!points.empty());
  const Eigen::MatrixXd G = locator_matrix(points, frame);
  const NonNegative pushing = non_negative_least_squares(pushing_matrix(points, frame), -wrench);
  Eigen::VectorXd forces = pushing.x.head(G.cols());
  Eigen::Index opposite = G.cols();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].two_sided) forces[static_cast<Eigen::Index>(i)] -= pushing.x[opposite++];
  }
  if (pushing.residual > kBalanced * wrench.norm()) {
    forces = G.completeOrthogonalDecomposition().solve(-wrench);
  }
  Seating result;
  result.forces_N.assign(forces.data(), forces.data() + forces.size());
  result.residual_N = (G * forces + wrench).norm();
  result.least_N = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].two_sided) result.least_N = std::min(result.least_N, result.forces_N[i]);
  }
  return result;
}

ForceClosure force_closure(std::span<const FrictionContact> contacts, const LocatingFrame& frame,
                           const Wrench& wrench) {
  const auto clamps = std::ranges::count_if(
      contacts, [](const FrictionContact& contact) { return contact.preload_N.has_value(); });
  const auto columns = static_cast<Eigen::Index>(contacts.size()) * kConeEdges;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6 + clamps, columns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(6 + clamps);
  b.head<6>() = -wrench;
  Eigen::Matrix3Xd edges(3, columns);
  Eigen::Index clamp_row = 6;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FrictionContact& contact = contacts[i];
    const auto [first, second] = tangents(contact.normal);
    for (int k = 0; k < kConeEdges; ++k) {
      const double turn_rad = 2.0 * std::numbers::pi * k / kConeEdges;
      const Eigen::Index column = static_cast<Eigen::Index>(i) * kConeEdges + k;
      edges.col(column) = contact.normal + contact.friction * (std::cos(turn_rad) * first +
                                                               std::sin(turn_rad) * second);
      a.col(column).head<6>() = wrench_of(edges.col(column), contact.at, frame);
      if (contact.preload_N) a(clamp_row, column) = 1.0;
    }
    if (contact.preload_N) b[clamp_row++] = *contact.preload_N;
  }
  const NonNegative found = non_negative_least_squares(a, b);
  ForceClosure result;
  result.residual_N = found.residual;
  result.holds = found.residual <= kBalanced * b.norm();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int k = 0; k < kConeEdges; ++k) {
      const Eigen::Index column = static_cast<Eigen::Index>(i) * kConeEdges + k;
      force += found.x[column] * edges.col(column);
    }
    result.forces_N.push_back(force);
  }
  return result;
}

double load_factor(std::span<const FrictionContact> contacts, const LocatingFrame& frame,
                   const Wrench& dead, const Wrench& load, double most) {
  const auto holds = [&](double factor) {
    return force_closure(contacts, frame, dead + factor * load).holds;
  };
  if (!holds(0.0)) return 0.0;
  if (holds(most)) return most;
  // The wrenches that contacts can balance are a convex set, so that one end is enough.
  double good = 0.0;
  double bad = most;
  constexpr double kShare = 1.0e-3;
  while (bad - good > kShare * bad) {
    const double middle = 0.5 * (good + bad);
    (holds(middle) ? good : bad) = middle;
    if (bad < kBalanced) break;
  }
  return good;
}

bool has_form_closure(const Eigen::MatrixXd& wrenches) {
  if (wrenches.cols() <= wrenches.rows()) return false;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(wrenches);
  const Eigen::VectorXd& values = svd.singularValues();
  if (values[values.size() - 1] <= kLocatingRank * values[0]) return false;
  // All forces at least 1: lambda = 1 + mu with mu >= 0, scale being free.
  const Eigen::VectorXd sum = wrenches.rowwise().sum();
  const NonNegative found = non_negative_least_squares(wrenches, -sum);
  return found.residual <= kBalanced * std::max(1.0, sum.norm());
}

std::vector<Eigen::Vector2d> convex_polygon(std::span<const Eigen::Vector2d> points) {
  std::vector<Eigen::Vector2d> sorted(points.begin(), points.end());
  std::ranges::sort(sorted, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return sorted;
  // Andrew's monotone chain: the lower side, then the upper one.
  std::vector<Eigen::Vector2d> hull;
  const auto add = [&](const Eigen::Vector2d& point, std::size_t least) {
    while (hull.size() >= least + 2 &&
           cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Eigen::Vector2d& point : sorted) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = sorted.size() - 1; i-- > 0;) add(sorted[i], lower);
  hull.pop_back();
  return hull;
}

double polygon_area_mm2(std::span<const Eigen::Vector2d> polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * twice;
}

double support_margin_mm(std::span<const Eigen::Vector2d> supports, const Eigen::Vector2d& point) {
  const std::vector<Eigen::Vector2d> polygon = convex_polygon(supports);
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = polygon.size() >= 3;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& from = polygon[i];
    const Eigen::Vector2d way = polygon[(i + 1) % polygon.size()] - from;
    const double length2 = way.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp(way.dot(point - from) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (from + share * way - point).norm());
    if (cross(way, point - from) < 0.0) inside = false;
  }
  return inside ? nearest : -nearest;
}

}  // namespace dowel
