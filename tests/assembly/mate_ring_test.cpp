// Mates that go around in a ring, and rings of grounded parts.

#include <string>

#include <catch2/catch.hpp>

#include "workshop.h"

using dowel::MateKind;
using dowel::MoveReport;
using dowel::testing::Workshop;
using Eigen::Vector3d;

namespace {

/// Three blocks of 40 on the plate's side, each 100 mm above the next; none touches another.
void place_blocks(Workshop& shop) {
  shop.place("T/block-40", "A", {300, 0, 20});
  shop.place("T/block-40", "B", {300, 0, 120});
  shop.place("T/block-40", "C", {300, 0, 220});
}

}  // namespace

TEST_CASE(
    "a ring of parts that stand on each other is refused with the ring, and nothing is lost") {
  Workshop shop;
  place_blocks(shop);
  const bool is_grounded = GENERATE(false, true);
  CAPTURE(is_grounded);
  if (is_grounded) shop.session.set_grounded("C", true, "ground");
  REQUIRE_FALSE(shop.mate(MateKind::FaceOnFace, {"A", "top"}, {"B", "bottom"}).refused);
  REQUIRE_FALSE(shop.mate(MateKind::FaceOnFace, {"B", "top"}, {"C", "bottom"}).refused);
  const dowel::ProjectState before = shop.session.state();
  // A on top of C: it would have to be 120 mm above itself.
  const MoveReport report = shop.mate(MateKind::FaceOnFace, {"A", "bottom"}, {"C", "top"});
  CHECK(report.refused);
  REQUIRE(report.conflict);
  CHECK(report.conflict->mate.moving.text() == "A.bottom");
  CHECK(report.conflict->off_mm == Approx(120.0).margin(1e-6));
  REQUIRE(report.conflict->against.size() == 2);
  CHECK(report.conflict->against[0].moving.text() == "A.top");
  CHECK(report.conflict->against[1].moving.text() == "B.top");
  CHECK(shop.session.state() == before);
}

TEST_CASE("a ring of fixed parts is one unit, and its last mate is redundant") {
  Workshop shop;
  place_blocks(shop);
  CHECK_FALSE(shop.mate(MateKind::Fix, {"B", ""}, {"A", ""}).is_redundant);
  CHECK_FALSE(shop.mate(MateKind::Fix, {"C", ""}, {"B", ""}).is_redundant);
  const MoveReport last = shop.mate(MateKind::Fix, {"A", ""}, {"C", ""});
  CHECK_FALSE(last.refused);
  CHECK(last.is_redundant);
  CHECK(shop.session.unit("B").size() == 3);
  // It moves as one, any of it first, and stays a ring that holds.
  CHECK_FALSE(shop.session.move("B", {400, 0, 120}, "move").refused);
  CHECK((shop.where("A") - Vector3d(400, 0, 20)).norm() < dowel::testing::kExact_mm);
  CHECK((shop.where("C") - Vector3d(400, 0, 220)).norm() < dowel::testing::kExact_mm);
  CHECK(shop.session.state().mates.size() == 3);
  // Grounded at one place it is held at all, and says by what.
  shop.session.set_grounded("C", true, "ground");
  CHECK(shop.session.freedoms("A").freedoms.empty());
  CHECK_THROWS_WITH(
      shop.session.move("A", {0, 0, 500}, "move"),
      Catch::Contains("A is fixed to C, which is grounded") && Catch::Contains("`ground C off`"));
}

TEST_CASE("parts that are all grounded are not mated, and it is said which to free") {
  Workshop shop;
  place_blocks(shop);
  REQUIRE_FALSE(shop.mate(MateKind::FaceOnFace, {"B", "bottom"}, {"A", "top"}).refused);
  for (const char* name : {"A", "B", "C"}) shop.session.set_grounded(name, true, "ground");
  const dowel::ProjectState before = shop.session.state();
  for (const auto& [moving, fixed] :
       {std::pair("A", "C"), std::pair("C", "B"), std::pair("B", "A")}) {
    CHECK_THROWS_WITH(shop.mate(MateKind::FaceOnFace, {moving, "top"}, {fixed, "bottom"}),
                      Catch::Contains(std::string(moving) + " is grounded and does not move"));
  }
  CHECK_THROWS_WITH(shop.mate(MateKind::FaceOnFace, {"A", "top"}, {"A", "bottom"}),
                    Catch::Contains("A"));
  CHECK(shop.session.state() == before);
  CHECK(shop.session.freedoms("B").freedoms.empty());
  shop.session.set_grounded("C", false, "ground off");
  CHECK_FALSE(shop.mate(MateKind::FaceOnFace, {"C", "bottom"}, {"B", "top"}).refused);
  CHECK((shop.where("C") - Vector3d(300, 0, 100)).norm() < dowel::testing::kExact_mm);
}
