// Rules of catalogue parts: washers in pairs, lengths of screws, places on the grid, room for
// hands, an order of assembly.

#include <cmath>

#include "hexagon_screw.h"
#include "rule_examples.h"

namespace dowel::testing {
namespace {

using Eigen::Vector3d;

/// A seat with a cone of 120 degrees, 14 wide below and 22 at its mouth, 6 high.
ProjectElement conical_seat() {
  const double cone_mm = 4.0 / std::sqrt(3.0);
  Feature hole = hole_feature("h1", {0, 0, 6}, -Vector3d::UnitZ(), {{14.0, 6.0}}, true);
  hole.segments = {{HoleSegment::Type::Cone, 22.0, 14.0, 0.0, cone_mm},
                   {HoleSegment::Type::Cylinder, 14.0, 14.0, cone_mm, 6.0}};
  ProjectElement seat = element_of(
      "T/seat", revolved({{7, 0}, {16, 0}, {16, 6}, {11, 6}, {7, 6 - cone_mm}}, 48), {hole});
  seat.element.role = "fastener";
  return seat;
}

/// A whole ball instead of a slice of one: what it bears with is looked at.
ProjectElement ball_washer(double radius_mm) {
  ProjectElement washer = element_of(
      "T/ball-washer", sphere(radius_mm, 48),
      {hole_feature("h1", {0, 0, radius_mm}, -Vector3d::UnitZ(), {{13.0, 2.0 * radius_mm}}, true)});
  washer.element.role = "fastener";
  return washer;
}

/// The ball touches the cone where its radius stands square to it: at the height of its middle
/// h over the tip of the cone, h sin 60 is the radius.
FixtureBuilder washers(double aside_mm) {
  constexpr double kRadius_mm = 17.0;
  const double tip_mm = 6.0 - 11.0 / std::sqrt(3.0);
  FixtureBuilder b;
  b.add_element(conical_seat());
  b.add_element(ball_washer(kRadius_mm));
  b.place("T/seat", "SEAT", {20, 0, 40});
  b.place("T/ball-washer", "WASHER",
          {20.0 + aside_mm, 0.0, 40.0 + tip_mm + kRadius_mm / std::sin(std::acos(0.5))});
  return b;
}

void washer_examples(Seen& seen) {
  CHECK(state_of(washers(0.0), "CMP-09", seen) == RuleState::Pass);
  CHECK(result_of(washers(60.0), "CMP-09", seen).count(RuleState::Fail) == 2);
  FixtureBuilder alone = washers(0.0);
  alone.remove("WASHER");
  CHECK(state_of(alone, "CMP-09", seen) == RuleState::Fail);
  // A ball on a flat is no pair: upside down, the seat shows it no cone.
  FixtureBuilder flipped = washers(0.0);
  const Pose upside_down(Eigen::Quaterniond(0, 1, 0, 0), {20, 0, 46});
  flipped.state.instances.at("SEAT").X_WI = upside_down;
  flipped.state.instances.at("WASHER").X_WI = Pose::from_translation({20, 0, 46.0 + 15.492});
  CHECK(state_of(flipped, "CMP-09", seen) == RuleState::Fail);
}

/// On the plate's hole B2, a riser of 40 and a screw whose head is on it.
FixtureBuilder screwed_with(int length_mm) {
  FixtureBuilder b;
  ProjectElement riser = riser_element();
  riser.element.role = "riser";
  b.add_element(riser);
  ProjectElement screw = hexagon_screw(length_mm);
  b.add_element(screw);
  b.place("T/riser-60x60x40", "RISER", {-40, 0, 40});
  b.place(screw.element.name, "SCREW", {-40.0, 0.0, 80.0 - length_mm});
  return b;
}

void screw_examples(Seen& seen) {
  CHECK(state_of(screwed_with(65), "FST-08", seen) == RuleState::Pass);
  CHECK(state_of(screwed_with(70), "FST-08", seen) == RuleState::Pass);
  CHECK(state_of(screwed_with(67), "FST-08", seen) == RuleState::Fail);
  // 65 long it is 10 mm in the thread, whose core begins 25 mm over the plate's bottom.
  FixtureBuilder shank = screwed_with(65);
  state(shank, "SCREW", "thread_length_mm", 10.5);
  CHECK(state_of(shank, "FST-08", seen) == RuleState::Pass);
  state(shank, "SCREW", "thread_length_mm", 9.5);
  CHECK(state_of(shank, "FST-08", seen) == RuleState::Fail);
}

void grid_examples(Seen& seen) {
  CHECK(state_of(screwed_with(65), "SYS-01", seen) == RuleState::Pass);
  FixtureBuilder off = screwed_with(65);
  off.state.instances.at("RISER").X_WI = Pose::from_translation({-40, 0.5, 40});
  CHECK(state_of(off, "SYS-01", seen) == RuleState::Fail);
}

/// A box of 200 x 200 x 100 around a hollow of 100 x 100 x 60, which begins 10 over its bottom.
ProjectElement hollow_box() {
  return element_of(
      "T/hollow", hollowed(box({200, 200, 100}, {0, 0, 50}), box({100, 100, 60}, {0, 0, 40})), {});
}

void order_examples(Seen& seen) {
  FixtureBuilder open = sound_fixture();
  CHECK(state_of(open, "ACC-05", seen) == RuleState::NotApplicable);
  open.remove("CLAMP");  // it is fixed to the plate, so that nothing goes under it
  open.state.design.limits["assembly_order"] = 1.0;
  CHECK(state_of(open, "ACC-05", seen) == RuleState::Pass);
  FixtureBuilder closed;
  closed.state.design.limits["assembly_order"] = 1.0;
  closed.add_element(hollow_box());
  closed.add_box("T/lump", {30, 30, 30}, "riser");
  closed.place("T/hollow", "HOLLOW", {0, 0, 140});
  closed.place("T/lump", "LUMP", {0, 0, 160});
  CHECK(state_of(closed, "ACC-05", seen) == RuleState::Fail);
}

void hand_examples(Seen& seen) {
  FixtureBuilder b = sound_fixture();
  CHECK(state_of(b, "ACC-06", seen) == RuleState::NotApplicable);
  state(b, "CLAMP", "manual", 1.0);
  CHECK(state_of(b, "ACC-06", seen) == RuleState::Pass);
  b.add_element(hollow_box());
  b.place("T/hollow", "COVER", {0, 0, 65});
  CHECK(state_of(b, "ACC-06", seen) == RuleState::Fail);
  state(b, "CLAMP", "manual", 0.0);
  CHECK(state_of(b, "ACC-06", seen) == RuleState::NotApplicable);
}

}  // namespace

void catalogue_part_examples(Seen& seen) {
  washer_examples(seen);
  screw_examples(seen);
  grid_examples(seen);
  order_examples(seen);
  hand_examples(seen);
}

TEST_CASE("washers, lengths, places, hands and orders pass and fail their rules", "[rule]") {
  Seen seen;
  catalogue_part_examples(seen);
}

}  // namespace dowel::testing
