#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "workshop.h"

using dowel::DragMode;
using dowel::DragReport;
using dowel::DragRequest;
using dowel::MateKind;
using dowel::Pose;
using dowel::Verdict;
using dowel::testing::kExact_mm;
using dowel::testing::Workshop;
using Eigen::Vector3d;

namespace {

/// What a part that stops at another may miss it by: the smallest tolerance of a verdict.
constexpr double kTouching_mm = 2e-6;

}  // namespace

TEST_CASE("a drag keeps to what the mates leave free, and takes along what stands on the part") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 40});
  shop.mate(MateKind::FaceOnFace, {"RISER", "bottom"}, {"PLATE", "top"});
  shop.place("T/pin-12", "PIN", {0, 0, 50});
  shop.mate(MateKind::Align, {"PIN", "pin1"}, {"RISER", "h1"});
  const Vector3d pin = shop.where("PIN");

  const DragReport report = shop.drag("RISER", {10, 5, 30});
  CHECK_FALSE(report.move.refused);
  CHECK((report.allowed_mm_W - Vector3d(10, 5, 0)).norm() < kExact_mm);
  CHECK((shop.where("RISER") - Vector3d(10, 5, 40)).norm() < kExact_mm);
  CHECK(report.move.moved_along == std::vector<std::string>{"PIN"});
  CHECK((shop.where("PIN") - pin - Vector3d(10, 5, 0)).norm() < kExact_mm);
  CHECK(shop.session.state().mates.size() == 2);

  // The pin alone goes along the bore, and leaves the riser where it is.
  CHECK(shop.drag("PIN", {0, 0, 12}).move.moved_along.empty());
  CHECK((shop.where("PIN") - pin - Vector3d(10, 5, 12)).norm() < kExact_mm);
  CHECK_THROWS_AS(shop.drag("PIN", {20, 0, 0}), dowel::Error);
  CHECK_THROWS_AS(shop.drag("PLATE", {20, 0, 0}), dowel::Error);

  shop.session.undo(2);
  CHECK(shop.where("RISER") == Vector3d(0, 0, 40));
  CHECK((shop.where("PIN") - pin).norm() == 0.0);
}

TEST_CASE("a drag ends where it touches, however fast it is") {
  Workshop shop;
  shop.stand_block("A", -60, 0);
  shop.stand_block("B", 60, 10);
  const DragReport report = shop.drag("A", {500, 0, 0});
  CHECK_FALSE(report.move.refused);
  CHECK(report.move.verdict == Verdict::Contact);
  REQUIRE(report.move.stopped_by.size() == 1);
  CHECK(report.move.stopped_by.front().with == "B");
  CHECK((shop.where("A") - Vector3d(20, 0, 60)).norm() < kTouching_mm);
  CHECK(report.move.free_share == Approx(80.0 / 500.0).margin(1e-6));
  // There is no further way, and away is free.
  CHECK(shop.drag("A", {1, 0, 0}).move.refused);
  CHECK((shop.where("A") - Vector3d(20, 0, 60)).norm() < kTouching_mm);
  CHECK_FALSE(shop.drag("A", {-30, 0, 0}).move.refused);
  CHECK((shop.where("A") - Vector3d(-10, 0, 60)).norm() < kTouching_mm);
}

TEST_CASE("warn drags through and says so, off does not look") {
  Workshop shop;
  shop.stand_block("A", -60, 0);
  shop.stand_block("B", 60, 0);
  const DragReport through = shop.drag("A", {200, 0, 0}, DragMode::Warn);
  CHECK_FALSE(through.move.refused);
  CHECK(through.move.stopped_by.size() == 1);
  CHECK(through.move.free_share == Approx(80.0 / 200.0).margin(1e-3));
  CHECK((shop.where("A") - Vector3d(140, 0, 60)).norm() < kExact_mm);
  const DragReport into = shop.drag("A", {-80, 0, 0}, DragMode::Off);
  CHECK_FALSE(into.move.checked);
  CHECK((shop.where("A") - Vector3d(60, 0, 60)).norm() < kExact_mm);
}

TEST_CASE("a drag that slides goes along what it meets") {
  Workshop shop;
  shop.stand_block("A", -60, 0);
  shop.stand_block("B", 60, 10);
  const DragReport report = shop.drag("A", {100, 25, 0}, DragMode::Slide);
  CHECK(report.slid);
  CHECK_FALSE(report.move.refused);
  // Against the wall at x = 20, and on to the goal's y.
  CHECK((shop.where("A") - Vector3d(20, 25, 60)).norm() < 1e-3);
  CHECK(report.move.verdict != Verdict::Interference);

  SECTION("into a corner it stays there") {
    shop.stand_block("C", 20, 75);
    const DragReport corner = shop.drag("A", {30, 60, 0}, DragMode::Slide);
    CHECK_FALSE(corner.move.refused);
    CHECK((shop.where("A") - Vector3d(20, 35, 60)).norm() < 1e-3);
  }
}

TEST_CASE("a pin slides along a wall at any angle") {
  for (const double turn_deg : {5.0, 15.0, 30.0}) {
    CAPTURE(turn_deg);
    Workshop shop;
    const double turn_rad = turn_deg * std::numbers::pi / 180.0;
    const Vector3d normal(-std::cos(turn_rad), -std::sin(turn_rad), 0);
    const Vector3d along(-std::sin(turn_rad), std::cos(turn_rad), 0);
    shop.session.place(
        "T/block-40", "WALL",
        Pose(Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ())), {60, 0, 60}),
        "place");
    shop.place("T/pin-12", "PIN", {0, 0, 40});
    shop.mate(MateKind::FaceOnFace, {"PIN", "bottom"}, {"PLATE", "top"});
    const Vector3d goal(45, -2, 40);
    const DragReport report = shop.drag("PIN", goal - Vector3d(0, 0, 40), DragMode::Slide);
    CHECK(report.slid);
    const Vector3d end = shop.where("PIN");
    // 5.99 from the wall, and as near to the goal as the wall allows.
    CHECK(normal.dot(end - Vector3d(60, 0, 40)) == Approx(20.0 + 5.99).margin(1e-3));
    CHECK(along.dot(goal - end) == Approx(0.0).margin(1e-3));
  }
}

TEST_CASE("a drag turns about the axis that is left, and a unit turns as one") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  shop.insert({"RISER", "h1"}, {"PLATE", "B4"});
  shop.place("T/block-40", "BLOCK", {50, 0, 150});
  shop.session.fix(std::vector<std::string>{"RISER", "BLOCK"}, "unit");
  DragRequest request;
  request.instance = "RISER";
  request.turn_rad = 0.5 * std::numbers::pi;
  const DragReport report = shop.session.drag(request, "drag");
  CHECK_FALSE(report.move.refused);
  CHECK(report.move.moved_along == std::vector<std::string>{"BLOCK"});
  CHECK((shop.where("RISER") - Vector3d(40, 0, 40)).norm() < kExact_mm);
  // From (50, 0) about (40, 0).
  CHECK((shop.where("BLOCK") - Vector3d(40, 10, 150)).norm() < kExact_mm);
  CHECK((shop.session.instance("BLOCK").X_WI.rotation() * Vector3d::UnitX() - Vector3d::UnitY())
            .norm() < 1e-12);

  request.axis_W = Vector3d::UnitX();
  CHECK_THROWS_AS(shop.session.drag(request, "drag"), dowel::Error);

  // So does it in a move, which leaves the mate with the plate.
  const auto moved = shop.session.move("BLOCK", Vector3d(40, 10, 190), "move");
  CHECK_FALSE(moved.refused);
  CHECK(moved.dropped.size() == 1);
  CHECK((shop.where("RISER") - Vector3d(40, 0, 80)).norm() < kExact_mm);
}

TEST_CASE("a turn stops at what is in its way") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  shop.insert({"RISER", "h1"}, {"PLATE", "B3"});
  shop.stand_block("B", 60, 0);  // 40 of 42.4 mm to the corner's circle
  DragRequest request;
  request.instance = "RISER";
  request.turn_rad = 0.5 * std::numbers::pi;
  const DragReport report = shop.session.drag(request, "drag");
  CHECK_FALSE(report.move.refused);
  REQUIRE(report.move.stopped_by.size() == 1);
  // The corner at 45 degrees and 42.426 mm comes to x = 40 at 45 - acos(40 / 42.426) degrees.
  const double expected_rad =
      std::numbers::pi / 4.0 - std::acos(40.0 / (30.0 * std::numbers::sqrt2));
  const double turned_rad = Eigen::Quaterniond::Identity().angularDistance(
      shop.session.instance("RISER").X_WI.rotation());
  CHECK(turned_rad == Approx(expected_rad).margin(2e-3));
  CHECK(turned_rad > 0.05);
}
