#include "dowel/kernel/predicates.h"

#include <cmath>
#include <limits>

#include "expansion.h"

namespace dowel {
namespace {

/// Half an ulp of 1: the relative error of one rounded operation.
constexpr double kUnitRoundoff = 0.5 * std::numeric_limits<double>::epsilon();

// Shewchuk's error bounds of the rounded determinants, relative to the sum of the magnitudes of
// their terms.
constexpr double kBound2d = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
constexpr double kBound3d = (7.0 + 56.0 * kUnitRoundoff) * kUnitRoundoff;

using Difference = Expansion<2>;

int exact_orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Difference bx = Difference::difference(b.x(), a.x());
  const Difference by = Difference::difference(b.y(), a.y());
  const Difference cx = Difference::difference(c.x(), a.x());
  const Difference cy = Difference::difference(c.y(), a.y());
  return (bx * cy - by * cx).sign();
}

int exact_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  const Difference bx = Difference::difference(b.x(), a.x());
  const Difference by = Difference::difference(b.y(), a.y());
  const Difference bz = Difference::difference(b.z(), a.z());
  const Difference cx = Difference::difference(c.x(), a.x());
  const Difference cy = Difference::difference(c.y(), a.y());
  const Difference cz = Difference::difference(c.z(), a.z());
  const Difference dx = Difference::difference(d.x(), a.x());
  const Difference dy = Difference::difference(d.y(), a.y());
  const Difference dz = Difference::difference(d.z(), a.z());
  return ((by * cz - bz * cy) * dx + (bz * cx - bx * cz) * dy + (bx * cy - by * cx) * dz).sign();
}

}  // namespace

int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  const double left = u.x() * v.y();
  const double right = u.y() * v.x();
  const double determinant = left - right;
  const double bound = kBound2d * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return bound == 0.0 ? 0 : exact_orient2d(a, b, c);
}

int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d) {
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  const Eigen::Vector3d w = d - a;
  const double yz = u.y() * v.z();
  const double zy = u.z() * v.y();
  const double zx = u.z() * v.x();
  const double xz = u.x() * v.z();
  const double xy = u.x() * v.y();
  const double yx = u.y() * v.x();
  const double determinant = (yz - zy) * w.x() + (zx - xz) * w.y() + (xy - yx) * w.z();
  const double bound = kBound3d * ((std::abs(yz) + std::abs(zy)) * std::abs(w.x()) +
                                   (std::abs(zx) + std::abs(xz)) * std::abs(w.y()) +
                                   (std::abs(xy) + std::abs(yx)) * std::abs(w.z()));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  // No magnitude, no error: all products are exactly zero, as for points of a level plane.
  return bound == 0.0 ? 0 : exact_orient3d(a, b, c, d);
}

}  // namespace dowel
