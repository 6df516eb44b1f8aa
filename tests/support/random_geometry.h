#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "dowel/kernel/pose.h"

namespace dowel::testing {

/// Seeded geometry, the same on every machine (the distributions of the standard library are not).
class RandomGeometry {
 public:
  explicit RandomGeometry(std::uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }

  /// In [0, count). Expects: count > 0.
  std::uint32_t index(std::uint32_t count) {
    return static_cast<std::uint32_t>(engine_() % static_cast<std::uint64_t>(count));
  }

  bool coin() { return (engine_() >> 63U) != 0; }

  /// In the cube of half edge `reach_mm` around the origin.
  Eigen::Vector3d point(double reach_mm) {
    const double x = uniform(-reach_mm, reach_mm);
    const double y = uniform(-reach_mm, reach_mm);
    const double z = uniform(-reach_mm, reach_mm);
    return {x, y, z};
  }

  std::vector<Eigen::Vector3d> points(std::size_t count, double reach_mm) {
    std::vector<Eigen::Vector3d> result(count);
    for (Eigen::Vector3d& p : result) p = point(reach_mm);
    return result;
  }

  /// Uniform on the sphere.
  Eigen::Vector3d direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).normalized();
  }

  /// Uniform over all rotations. Source: Shoemake, "Uniform Random Rotations", 1992.
  Eigen::Quaterniond rotation() {
    const double u = uniform(0.0, 1.0);
    const double a = uniform(0.0, 2.0 * std::numbers::pi);
    const double b = uniform(0.0, 2.0 * std::numbers::pi);
    const double p = std::sqrt(1.0 - u);
    const double q = std::sqrt(u);
    return Eigen::Quaterniond(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b))
        .normalized();
  }

  /// Any rotation; translation in the cube of half edge `reach_mm`.
  Pose pose(double reach_mm) {
    const Eigen::Quaterniond turn = rotation();
    return {turn, point(reach_mm)};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace dowel::testing
