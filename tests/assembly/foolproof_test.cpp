// Whether a workpiece seats in a wrong orientation: what a hand would find out with the block.

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/assembly/fixture_analysis.h"
#include "fixture_projects.h"

namespace {

using dowel::FoolproofAnalysis;
using dowel::ProjectElement;
using dowel::WrongOrientation;
using dowel::testing::FixtureBuilder;
using Eigen::Vector3d;
namespace testing = dowel::testing;

FoolproofAnalysis foolproof(const FixtureBuilder& builder) {
  const auto session = builder.session();
  return dowel::analyse_fixture(*session).foolproof;
}

/// The sound fixture with another block of its size, drilled through at `holes`.
FixtureBuilder with_drilled_block(const std::vector<Eigen::Vector2d>& holes) {
  FixtureBuilder builder = testing::sound_fixture();
  std::vector<testing::DrilledHole> drilled;
  std::vector<dowel::Feature> features;
  for (const Eigen::Vector2d& at : holes) {
    testing::DrilledHole hole;
    hole.radius_mm = 5.0;
    hole.x = at.x();
    hole.y = at.y();
    drilled.push_back(hole);
    features.push_back(testing::hole_feature("h" + std::to_string(drilled.size()),
                                             {at.x(), at.y(), 30}, -Vector3d::UnitZ(),
                                             {{10.0, 30.0}}, true));
  }
  ProjectElement block = testing::element_of(
      "W/drilled", testing::plate_with_holes({120, 80, 30}, drilled, 24), features);
  block.element.role = "workpiece";
  builder.add_element(block);
  builder.state.instances.at("WORK").element = "W/drilled";
  return builder;
}

bool is_turn(const WrongOrientation& wrong, const Vector3d& axis, double angle_rad) {
  return std::abs(wrong.angle_rad - angle_rad) < 1e-9 && wrong.axis_W.cross(axis).norm() < 1e-9;
}

}  // namespace

TEST_CASE("a plain block looks the same after half turns and seats in no other way",
          "[foolproof]") {
  const FoolproofAnalysis analysis = foolproof(testing::sound_fixture());
  CHECK(analysis.same == 3);
  CHECK(analysis.wrong.size() == 20);
  CHECK(analysis.is_foolproof());
  for (const WrongOrientation& wrong : analysis.wrong) CHECK_FALSE(wrong.against.empty());
}

TEST_CASE("a block with a hole off its middle seats after a half turn", "[foolproof]") {
  const FoolproofAnalysis analysis = foolproof(with_drilled_block({{30, 20}}));
  CHECK(analysis.same == 0);
  CHECK_FALSE(analysis.is_foolproof());
  int seated = 0;
  for (const WrongOrientation& wrong : analysis.wrong) {
    if (!wrong.seats) continue;
    ++seated;
    CHECK((is_turn(wrong, Vector3d::UnitX(), std::numbers::pi) ||
           is_turn(wrong, Vector3d::UnitY(), std::numbers::pi) ||
           is_turn(wrong, Vector3d::UnitZ(), std::numbers::pi)));
    // Where the block was, but turned: its box is the same.
    const Vector3d middle = wrong.X_WI * Vector3d(0, 0, 15);
    CHECK((middle - Vector3d(0, 0, 75)).norm() < 0.02);
  }
  CHECK(seated == 3);
}

TEST_CASE("a pin under the hole keeps the block from seating turned", "[foolproof]") {
  // Off the middle both ways, so that no half turn brings the hole over the pin; 9 mm stays free of
  // the hole and does not locate.
  FixtureBuilder builder = with_drilled_block({{30, 20}});
  ProjectElement pin = testing::element_of("T/guard", testing::cylinder(4.5, 30.0, 24), {});
  builder.add_element(pin);
  builder.place("T/guard", "GUARD", {30, 20, 40});
  builder.fix("GUARD");
  const FoolproofAnalysis analysis = foolproof(builder);
  CHECK(analysis.wrong.size() == 23);
  CHECK(analysis.is_foolproof());
}

TEST_CASE("two holes as far apart as the pins seat the other way round, too", "[foolproof]") {
  FixtureBuilder builder = testing::pinned_fixture(true);
  testing::DrilledHole left;
  left.radius_mm = 6.0;
  left.x = -15.0;
  testing::DrilledHole right = left;
  right.x = 25.0;
  ProjectElement work = testing::element_of(
      "W/shifted", testing::plate_with_holes({120, 80, 30}, {left, right}, 24),
      {testing::hole_feature("h1", {-15, 0, 30}, -Vector3d::UnitZ(), {{12.0, 30.0}}, true),
       testing::hole_feature("h2", {25, 0, 30}, -Vector3d::UnitZ(), {{12.0, 30.0}}, true)});
  work.element.role = "workpiece";
  builder.add_element(work);
  builder.state.instances.at("WORK").element = "W/shifted";
  builder.state.instances.at("WORK").X_WI = dowel::Pose::from_translation({-5, 0, 60});
  const FoolproofAnalysis analysis = foolproof(builder);
  CHECK_FALSE(analysis.is_foolproof());
  for (const WrongOrientation& wrong : analysis.wrong) {
    if (!wrong.seats) continue;
    CHECK(std::abs(wrong.angle_rad - std::numbers::pi) < 1e-9);
    // The middle of the holes stays over the middle of the pins.
    CHECK((wrong.X_WI * Vector3d(5, 0, 0)).head<2>().norm() < 0.02);
  }
}
