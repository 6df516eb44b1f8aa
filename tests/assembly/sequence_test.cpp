#include "dowel/assembly/sequence.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "workshop.h"

using dowel::AssemblySequence;
using dowel::MateKind;
using dowel::WayOut;
using dowel::testing::Workshop;
using Eigen::Vector3d;

namespace {

std::vector<std::string> order_of(const AssemblySequence& sequence) {
  std::vector<std::string> order;
  for (const dowel::AssemblyStep& step : sequence.steps) {
    order.insert(order.end(), step.parts.begin(), step.parts.end());
  }
  return order;
}

}  // namespace

TEST_CASE("the straight ways out of a hole are told, and what blocks them") {
  Workshop shop;
  // Stands on the step at a depth of 15; its top is at z = 55.
  shop.place("T/pin-12", "PIN", {0, 0, 100});
  REQUIRE_FALSE(shop.insert({"PIN", "pin1"}, {"PLATE", "B3"}, 15.0).refused);
  std::vector<WayOut> ways = shop.session.ways_out("PIN");
  REQUIRE(ways.size() == 2);
  CHECK(ways[0].along == "PLATE.B3");
  CHECK(ways[0].blocked_by.empty());
  CHECK((ways[0].direction_W - Vector3d::UnitZ()).norm() < 1e-12);
  // Down through the hole there is the step.
  REQUIRE(ways[1].blocked_by.size() == 1);
  CHECK(ways[1].blocked_by.front().with == "PLATE");
  CHECK(ways[1].free_mm == Approx(0.0).margin(1e-6));

  shop.place("T/block-40", "LID", {0, 0, 100});  // from z = 80
  ways = shop.session.ways_out("PIN");
  CHECK_FALSE(ways[0].blocked_by.empty());
  CHECK(ways[0].blocked_by.front().with == "LID");
  CHECK(ways[0].free_mm == Approx(25.0).margin(0.06));
  CHECK(shop.session.ways_out("PIN", {.without = {"LID"}})[0].blocked_by.empty());
}

TEST_CASE("a way in goes along mates, and takes along what hangs on the part") {
  Workshop shop;
  const auto ways_in = [&](const char* name, bool with_sub_assembly) {
    dowel::WayQuery query;
    query.with_sub_assembly = with_sub_assembly;
    query.by_mates_alone = true;
    return shop.session.ways_out(name, query);
  };
  shop.place("T/block-40", "B", {0, 0, 60});
  CHECK(shop.session.ways_out("B").size() == 1);  // up from the base
  CHECK(ways_in("B", false).empty());
  shop.place("T/pin-12", "PIN", {-80, 0, 100});
  REQUIRE_FALSE(shop.insert({"PIN", "pin1"}, {"PLATE", "B1"}, 15.0).refused);
  CHECK(ways_in("PIN", false).size() == 2);
  // What stands on B is in its way, unless it comes along.
  shop.place("T/block-40", "TOP", {0, 0, 150});
  REQUIRE_FALSE(shop.mate(MateKind::FaceOnFace, {"B", "bottom"}, {"PLATE", "top"}).refused);
  REQUIRE_FALSE(shop.mate(MateKind::FaceOnFace, {"TOP", "bottom"}, {"B", "top"}).refused);
  CHECK_FALSE(ways_in("B", false)[0].blocked_by.empty());
  CHECK(ways_in("B", true)[0].blocked_by.empty());
}

TEST_CASE("parts are brought in before what would be in their way") {
  Workshop shop;
  // Placed in an order in which they could not be assembled: the lid first.
  shop.place("T/block-40", "LID", {0, 0, 200});
  shop.place("T/screw-M12x65", "SCREW", {0, 0, 300});
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  REQUIRE_FALSE(shop.insert({"RISER", "h1"}, {"PLATE", "B3"}).refused);
  REQUIRE_FALSE(shop.insert({"SCREW", "pin1"}, {"RISER", "h1"}).refused);
  const AssemblySequence sequence = dowel::plan_sequence(shop.session);
  CHECK(sequence.blocked.empty());
  CHECK(sequence.base == std::vector<std::string>{"PLATE"});
  CHECK(order_of(sequence) == std::vector<std::string>{"RISER", "SCREW", "LID"});
  for (const dowel::AssemblyStep& step : sequence.steps) {
    CHECK((step.way.direction_W - Vector3d::UnitZ()).norm() < 1e-12);
  }
}

TEST_CASE("parts that lock each other are told with what locks them") {
  Workshop shop;
  shop.place("T/pin-12", "PIN", {0, 0, 100});
  REQUIRE_FALSE(shop.insert({"PIN", "pin1"}, {"PLATE", "B3"}, 15.0).refused);
  shop.place("T/block-40", "FREE", {80, 0, 60});
  shop.place("T/plate-5x3", "ROOF", {0, 0, 80});  // 25 mm above the pin, on the block
  shop.session.set_grounded("ROOF", true, "ground");
  const AssemblySequence sequence = dowel::plan_sequence(shop.session);
  // Up it meets the roof, down the step; the block under the roof has no way but up.
  REQUIRE(sequence.blocked.size() == 2);
  CHECK(sequence.blocked[0].part == "PIN");
  REQUIRE(sequence.blocked[0].ways.size() == 2);
  std::vector<std::string> blockers;
  for (const WayOut& way : sequence.blocked[0].ways) {
    REQUIRE(way.blocked_by.size() == 1);
    blockers.push_back(way.blocked_by.front().with);
  }
  std::ranges::sort(blockers);
  CHECK(blockers == std::vector<std::string>{"PLATE", "ROOF"});
  CHECK(sequence.steps.empty());
}

TEST_CASE("a unit comes in as one") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  shop.insert({"RISER", "h1"}, {"PLATE", "B3"});
  // The lid is fixed to the riser, the pin between them can only come with both.
  shop.place("T/block-40", "LID", {0, 0, 140});
  shop.session.fix(std::vector<std::string>{"RISER", "LID"}, "unit");
  const AssemblySequence sequence = dowel::plan_sequence(shop.session);
  REQUIRE(sequence.steps.size() == 1);
  CHECK(sequence.steps.front().parts == std::vector<std::string>{"RISER", "LID"});
}

TEST_CASE("parts that are in one place are told, for no way can be free for them") {
  Workshop shop;
  shop.session.set_mode(dowel::CheckMode::Off, "mode off");
  shop.place("T/block-40", "A", {-20, 0, 60});
  shop.place("T/block-40", "B", {10, 0, 60});  // 10 mm of both in one place
  shop.place("T/block-40", "C", {80, 0, 60});
  const AssemblySequence sequence = dowel::plan_sequence(shop.session);
  CHECK(order_of(sequence) == std::vector<std::string>{"C"});
  REQUIRE(sequence.blocked.size() == 2);
  REQUIRE(sequence.entered.size() == 1);
  CHECK(sequence.entered[0].instance == "A");
  CHECK(sequence.entered[0].with == "B");
  CHECK(sequence.entered[0].pair.depth_mm > 0.0);
  // Where nothing is blocked, nothing is told.
  shop.place("T/block-40", "D", {-100, -55, 60});
  shop.session.remove("A", "remove");
  CHECK(dowel::plan_sequence(shop.session).entered.empty());
}
