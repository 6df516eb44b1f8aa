#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision_element.h"
#include "dowel/collision/scene.h"
#include "random_geometry.h"
#include "solids.h"

/// What moves of many kinds are asked about.
namespace dowel::testing {

/// A plate with two holes, and on it a block, a drilled riser, a post, a wedge and a bar askew.
struct Surroundings {
  static constexpr double kTop_mm = 20.0;  ///< of the plate
  CollisionScene scene;
  std::vector<BodyId> bodies;

  Surroundings() {
    const auto stand = [this](FacetedSolid solid, double x, double y, double z,
                              double yaw_rad = 0.0) {
      const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
      bodies.push_back(
          scene.add(collision_element(std::move(solid)), Pose(Eigen::Quaterniond(yaw), {x, y, z})));
    };
    stand(plate_with_holes({120, 80, kTop_mm}, {{-40, 0, 6.0}, {40, 20, 6.0, 12.0}}, 12), 0, 0, 0);
    stand(box({20, 20, 20}, {0, 0, 10}), 0, 25, kTop_mm);
    stand(plate_with_holes({30, 30, 15}, {{0, 0, 6.5}}, 10), 40, -20, kTop_mm);
    stand(cylinder(8, 25, 14), -10, -25, kTop_mm);
    stand(wedge(0.5, 20, 15), -45, 25, kTop_mm);
    stand(box({50, 6, 20}, {0, 0, 10}), -42, -27, kTop_mm, 0.6);
  }
};

/// Places where parts of a fixture are: flush on faces, in holes, beside and in each other.
inline Pose anchor(RandomGeometry& random) {
  constexpr std::array<double, 5> kHeights{Surroundings::kTop_mm, Surroundings::kTop_mm + 15,
                                           Surroundings::kTop_mm + 20, 8.0, 0.0};
  constexpr std::array<std::array<double, 2>, 5> kAxes{
      {{-40, 0}, {40, 20}, {40, -20}, {0, 0}, {-10, -9}}};
  const auto& axis = kAxes[random.index(kAxes.size())];
  return Pose::from_translation({axis[0], axis[1], kHeights[random.index(kHeights.size())]});
}

/// A small step, a slide along the plate, a turn about z, or any motion; now and then a jump.
inline Pose next(RandomGeometry& random, const Pose& pose) {
  if (random.index(8) == 0) return anchor(random);
  const double size = std::pow(10.0, random.uniform(-4.0, 1.0));
  switch (random.index(4)) {
    case 0:
      return Pose(pose.rotation(), pose.translation() + random.point(size));
    case 1: {
      Eigen::Vector3d shift = random.point(size);
      shift.z() = 0.0;
      return Pose(pose.rotation(), pose.translation() + shift);
    }
    case 2:
      return pose * Pose::about_axis({0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.05 * size);
    default:
      return Pose::about_axis(pose.translation(), random.direction(), 0.02 * size) * pose;
  }
}

/// Who is met and how, as text.
inline std::string told(std::span<const BodyVerdict> verdicts) {
  std::string result;
  for (const BodyVerdict& v : verdicts) {
    result += std::to_string(v.with.value) + ' ' + std::string(to_string(v.pair.verdict)) + ' ';
  }
  return result;
}

/// A pin for either hole, a block, a pin with a collar.
inline FacetedSolid mover(int kind) {
  switch (kind) {
    case 0:
      return cylinder(5.993, 30, 12);
    case 1:
      return box({15, 15, 15}, {0, 0, 7.5});
    default:
      return stepped_pin({{5.993, 12}, {9.0, 6}}, 12);
  }
}

}  // namespace dowel::testing
