#pragma once

// Solids with slots, and what recognition is to make of them.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "slotted_solids.h"

namespace dowel::testing {

inline constexpr double kSame_mm = 1.0e-9;

inline std::vector<Feature> slots_of(const FacetedSolid& solid) {
  std::vector<Feature> result;
  for (const Feature& feature : recognise_features(solid)) {
    if (feature.kind == FeatureKind::Slot) result.push_back(feature);
  }
  return result;
}

struct ExpectedSlot {
  SlotShape::Type type = SlotShape::Type::Plain;
  Eigen::Vector3d origin;
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d run = Eigen::Vector3d::UnitX();
  double width_mm = 0.0;
  double depth_mm = 0.0;
  double length_mm = 0.0;
  std::array<SlotShape::End, 2> ends{SlotShape::End::Open, SlotShape::End::Open};
};

inline void check_slot(const Feature& feature, const ExpectedSlot& expected,
                       double tolerance_mm = kSame_mm) {
  REQUIRE(feature.kind == FeatureKind::Slot);
  REQUIRE(feature.slot);
  const SlotShape& slot = *feature.slot;
  CAPTURE(feature.name, feature.origin.transpose(), feature.direction.transpose(),
          slot.run.transpose());
  CHECK(slot.type == expected.type);
  CHECK((feature.origin - expected.origin).norm() <= tolerance_mm);
  CHECK((feature.direction - expected.direction).norm() <= kSame_mm);
  CHECK((slot.run - expected.run).norm() <= kSame_mm);
  CHECK(feature.diameter_mm == Approx(expected.width_mm).margin(tolerance_mm));
  CHECK(feature.depth_mm == Approx(expected.depth_mm).margin(tolerance_mm));
  CHECK(slot.length_mm == Approx(expected.length_mm).margin(tolerance_mm));
  CHECK(slot.ends == expected.ends);
  CHECK(feature.through == (expected.type == SlotShape::Type::Through));
  CHECK_FALSE(feature.faces.empty());
}

/// Stands on z = 0, from the corner at the origin.
inline Block plate(double x, double y, double z) {
  return {{0.0, 0.0, 0.0}, {x, y, z}};
}

/// One groove along x through a block of 100 x 60 x 30.
inline FacetedSolid grooved_block(double width_mm = 12.0, double depth_mm = 8.0) {
  const double low_mm = 30.0 - 0.5 * width_mm;
  return carved(plate(100.0, 60.0, 30.0),
                {{{-1.0, low_mm, 30.0 - depth_mm}, {101.0, low_mm + width_mm, 31.0}}});
}

inline FacetedSolid cross_of_grooves() {
  return carved(plate(100.0, 60.0, 30.0), {{{-1.0, 24.0, 22.0}, {101.0, 36.0, 31.0}},
                                           {{40.0, -1.0, 22.0}, {50.0, 61.0, 31.0}}});
}

inline TeeOutline tee_18() {
  return {18.0, 30.0, 12.0, 32.0};
}

/// Slots as a set that does not depend on names, seen through `X_WB`.
inline void check_moved(const std::vector<Feature>& original, const std::vector<Feature>& moved,
                        const Pose& X_WB, double tolerance_mm) {
  REQUIRE(moved.size() == original.size());
  for (const Feature& feature : original) {
    const Eigen::Vector3d run = X_WB.rotation() * feature.slot->run;
    const Eigen::Vector3d origin = X_WB * feature.origin;
    // Which side of a slotted hole is its mouth depends on which looks up.
    const auto is_there = [&](const Feature& other) {
      const Eigen::Vector3d bottom = other.origin + other.depth_mm * other.direction;
      return (other.origin - origin).norm() <= tolerance_mm ||
             (other.through && (bottom - origin).norm() <= tolerance_mm);
    };
    const auto is_same = [&](const Feature& other) {
      const SlotShape& slot = *other.slot;
      const bool is_turned = slot.run.dot(run) < 0.0;
      const std::array<SlotShape::End, 2> ends = feature.slot->ends;
      const bool has_ends =
          slot.ends == (is_turned ? std::array<SlotShape::End, 2>{ends[1], ends[0]} : ends);
      return has_ends && slot.type == feature.slot->type &&
             (slot.run - (is_turned ? -1.0 : 1.0) * run).norm() <= 1.0e-9 &&
             std::abs(other.diameter_mm - feature.diameter_mm) <= tolerance_mm &&
             std::abs(other.depth_mm - feature.depth_mm) <= tolerance_mm &&
             std::abs(slot.length_mm - feature.slot->length_mm) <= tolerance_mm &&
             slot.nominal_mm == feature.slot->nominal_mm && is_there(other);
    };
    CAPTURE(feature.name, origin.transpose(), moved[0].origin.transpose());
    CHECK(std::any_of(moved.begin(), moved.end(), is_same));
  }
}

}  // namespace dowel::testing
