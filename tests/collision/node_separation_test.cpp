// Boxes of nodes in single precision against the same in double, the reference.

#include "node_separation.h"

#include <catch2/catch.hpp>

#include "random_geometry.h"
#include "solids.h"

using dowel::BvhNode;
using dowel::CollisionModel;
using dowel::NodeSeparation;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

double gap_in_double(const BvhNode& a, const BvhNode& b, const Pose& X_BA) {
  const Eigen::Matrix3d R = X_BA.rotation_matrix();
  const Eigen::Vector3d half_a = 0.5 * (a.max - a.min);
  const Eigen::Vector3d half_b = 0.5 * (b.max - b.min);
  const Eigen::Vector3d offset_B =
      X_BA * Eigen::Vector3d(0.5 * (a.max + a.min)) - 0.5 * (b.max + b.min);
  const Eigen::Vector3d along_b = offset_B.cwiseAbs() - half_b - R.cwiseAbs() * half_a;
  const Eigen::Vector3d along_a =
      (R.transpose() * offset_B).cwiseAbs() - half_a - R.cwiseAbs().transpose() * half_b;
  return std::max(along_a.maxCoeff(), along_b.maxCoeff());
}

CollisionModel model_of(const dowel::FacetedSolid& solid) {
  return CollisionModel(std::make_shared<const dowel::FacetedSolid>(solid), {});
}

}  // namespace

TEST_CASE("gaps of nodes are lower bounds, and tight ones", "[property]") {
  testing::RandomGeometry random(31);
  const CollisionModel a = model_of(testing::cylinder(6.0, 40.0, 48));
  const CollisionModel b = model_of(testing::cylinder(60.0, 10.0, 96));
  int apart = 0;
  int meeting = 0;
  double worst_mm = 0.0;
  for (int pose = 0; pose < 1'000; ++pose) {
    const Pose X_BA = random.pose(40.0);
    const NodeSeparation separation(a, b, X_BA);
    for (int pair = 0; pair < 100; ++pair) {
      const std::uint32_t i = random.index(static_cast<std::uint32_t>(a.nodes().size()));
      const std::uint32_t j = random.index(static_cast<std::uint32_t>(b.nodes().size()));
      const double gap_mm = separation.gap_mm(a.node_boxes()[i], b.node_boxes()[j]);
      const double reference_mm = gap_in_double(a.nodes()[i], b.nodes()[j], X_BA);
      REQUIRE(gap_mm <= reference_mm);
      worst_mm = std::max(worst_mm, reference_mm - gap_mm);
      (reference_mm > 0.0 ? apart : meeting) += 1;
    }
  }
  // A micrometre for bodies of 130 mm.
  CHECK(worst_mm < 1.0e-3);
  CHECK(apart > 10'000);
  CHECK(meeting > 1'000);
}

TEST_CASE("boxes of nodes contain their nodes also far from the origin") {
  dowel::FacetedSolid solid = testing::cylinder(6.0, 40.0, 48);
  const Eigen::Vector3d far(9'000.0, -7'000.0, 5'000.0);
  for (Eigen::Vector3d& vertex : solid.vertices) vertex += far;
  for (dowel::Face& face : solid.faces) {
    face.surface = transformed(Pose::from_translation(far), face.surface);
  }
  const CollisionModel model = model_of(solid);
  const Eigen::Vector3d root = 0.5 * (model.nodes()[0].min + model.nodes()[0].max);
  for (std::size_t n = 0; n < model.nodes().size(); ++n) {
    for (std::size_t lane = 0; lane < 3; ++lane) {
      const auto axis = static_cast<Eigen::Index>(lane);
      const double center = root[axis] + static_cast<double>(model.node_boxes()[n].center[lane]);
      const double half = model.node_boxes()[n].half[lane];
      CHECK(center - half <= model.nodes()[n].min[axis]);
      CHECK(center + half >= model.nodes()[n].max[axis]);
      CHECK(half <= 0.5 * (model.nodes()[n].max[axis] - model.nodes()[n].min[axis]) + 1e-5);
    }
  }
}
