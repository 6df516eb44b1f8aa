// Rules of T-nuts and keys in slots.

#include <algorithm>

#include "rule_examples.h"

namespace dowel::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// 300 x 120 x 60 with a slot for T-nuts 14 along x: throat 14 x 16, undercut 24 x 10. Its solid is
/// a plain box: what stands in the slot is looked at here, not what it collides with.
ProjectElement slot_plate() {
  Feature slot;
  slot.name = "slot1";
  slot.kind = FeatureKind::Slot;
  slot.origin = {0, 0, 60};
  slot.direction = -Vector3d::UnitZ();
  slot.diameter_mm = 14.0;
  slot.depth_mm = 26.0;
  slot.slot = SlotShape{};
  slot.slot->type = SlotShape::Type::Tee;
  slot.slot->length_mm = 300.0;
  slot.slot->throat_depth_mm = 16.0;
  slot.slot->undercut_width_mm = 24.0;
  slot.slot->undercut_height_mm = 10.0;
  ProjectElement plate =
      element_of("T/plate-T14", box({300, 120, 60}, {0, 0, 30}),
                 {slot, face_feature("top", {0, 0, 60}, Vector3d::UnitZ(), 30000.0)});
  plate.element.role = "base plate";
  return plate;
}

/// As in DIN 508: a neck of 13.7 over a foot of `foot_mm` x 8, 16 high. In its solid x is across
/// the slot and y up; z runs along the slot from 0 to 22.
ProjectElement tee_nut(double foot_mm) {
  const double foot = 0.5 * foot_mm;
  const double neck = 0.5 * 13.7;
  ProjectElement nut =
      element_of("T/tee-nut-M12",
                 prism({{-foot, 0},
                        {foot, 0},
                        {foot, 8},
                        {neck, 8},
                        {neck, 16},
                        {-neck, 16},
                        {-neck, 8},
                        {-foot, 8}},
                       22.0),
                 {hole_feature("h1", {0, 16, 11}, -Vector3d::UnitY(), {{10.106, 16.0}}, true)});
  nut.element.role = "fastener";
  nut.element.features[0].thread = "M12";
  return nut;
}

/// Plate, T-nut, riser and a screw through it whose tip is `tip_mm` over the plate's bottom. The
/// nut's shoulder is under the throat, at z = 44, its bottom at 36, the slot's floor at 34.
FixtureBuilder slotted(double tip_mm, double foot_mm) {
  FixtureBuilder b;
  b.add_element(slot_plate());
  b.state.instances.at("PLATE").element = "T/plate-T14";
  b.add_element(tee_nut(foot_mm));
  ProjectElement riser = riser_element();
  riser.element.role = "riser";
  b.add_element(riser);
  ProjectElement screw = screw_element();
  screw.element.role = "fastener";
  screw.element.features[0].thread = "M12";
  b.add_element(screw);
  b.place("T/riser-60x60x40", "RISER", {0, 0, 60});
  b.place("T/screw-M12x65", "SCREW", {0, 0, tip_mm});
  b.place("T/tee-nut-M12", "TEE", {0, 0, 0});
  Eigen::Matrix3d turn;
  turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  b.state.instances.at("TEE").X_WI = Pose::from_matrix(turn, {-11, 0, 36});
  return b;
}

/// A key of 28 x `width_mm` x 10, half in the plate's slot, half in the riser's own of 14.
FixtureBuilder keyed(double width_mm) {
  FixtureBuilder b = slotted(35.0, 22.0);
  Feature slot;
  slot.name = "slot1";
  slot.kind = FeatureKind::Slot;
  slot.direction = Vector3d::UnitZ();
  slot.diameter_mm = 14.0;
  slot.depth_mm = 5.0;
  slot.slot = SlotShape{};
  slot.slot->length_mm = 60.0;
  element_called(b, "T/riser-60x60x40").features.push_back(slot);
  b.add_box("T/key-14x28", {28, width_mm, 10}, "locator");
  b.place("T/key-14x28", "KEY", {0, 0, 55});
  return b;
}

bool passes(const RuleResult& result, const std::string& subject) {
  const auto found = std::ranges::find(result.findings, subject, &RuleFinding::subject);
  REQUIRE(found != result.findings.end());
  return found->state == RuleState::Pass;
}

void tee_examples(Seen& seen) {
  CHECK(state_of(slotted(35.0, 22.0), "CMP-07", seen) == RuleState::Pass);
  CHECK(state_of(slotted(35.0, 23.8), "CMP-07", seen) == RuleState::Fail);
  // The tip 1 mm over the floor; closer; with 5 of 16 mm of thread.
  CHECK(state_of(slotted(35.0, 22.0), "FST-06", seen) == RuleState::Pass);
  CHECK(state_of(slotted(34.5, 22.0), "FST-06", seen) == RuleState::Fail);
  CHECK(state_of(slotted(47.0, 22.0), "FST-06", seen) == RuleState::Fail);
  CHECK(state_of(slotted(35.0, 22.0), "SYS-01", seen) == RuleState::Pass);
  FixtureBuilder beside = slotted(35.0, 22.0);
  beside.state.instances.at("RISER").X_WI = Pose::from_translation({20, 5, 60});
  CHECK(state_of(beside, "SYS-01", seen) == RuleState::Fail);

  // Plate, T-nut, screw, riser: each holds the next.
  const RuleResult held = result_of(slotted(35.0, 22.0), "FST-01", seen);
  for (const char* name : {"TEE", "SCREW", "RISER"}) CHECK(passes(held, name));
  // Its foot 3 mm under the throat it carries nothing yet; without its screw neither.
  FixtureBuilder low = slotted(32.0, 22.0);
  low.state.instances.at("TEE").X_WI =
      Pose(low.state.instances.at("TEE").X_WI.rotation(), {-11, 0, 33});
  CHECK_FALSE(passes(result_of(low, "FST-01", seen), "RISER"));
  FixtureBuilder loose = slotted(35.0, 22.0);
  loose.remove("SCREW");
  CHECK_FALSE(passes(result_of(loose, "FST-01", seen), "TEE"));
}

void key_examples(Seen& seen) {
  CHECK(state_of(keyed(14.0), "CMP-08", seen) == RuleState::Pass);
  CHECK(state_of(keyed(13.8), "CMP-08", seen) == RuleState::Fail);
  CHECK(passes(result_of(keyed(14.0), "FST-01", seen), "KEY"));
  CHECK_FALSE(passes(result_of(keyed(13.8), "FST-01", seen), "KEY"));
  // A key alone holds no part down.
  FixtureBuilder b = keyed(14.0);
  b.remove("SCREW");
  CHECK_FALSE(passes(result_of(b, "FST-01", seen), "RISER"));

  // On one screw a locator turns, with a key it does not, and it is located across the slot.
  b = keyed(14.0);
  b.state.design.roles["RISER"] = Role::Locator;
  CHECK(passes(result_of(b, "FST-09", seen), "RISER"));
  CHECK(passes(result_of(b, "FST-03", seen), "RISER"));
  b.remove("KEY");
  CHECK_FALSE(passes(result_of(b, "FST-09", seen), "RISER"));
  CHECK_FALSE(passes(result_of(b, "FST-03", seen), "RISER"));
}

/// A plate on another one, with pins of 12 through both.
void stacked_plates_example(Seen& seen) {
  FixtureBuilder b;
  Element& plate = element_called(b, "T/plate-5x3");
  for (const double x_mm : {-100.0, 100.0}) {
    plate.features.push_back(hole_feature(x_mm < 0 ? "d1" : "d2", {x_mm, 60, 40},
                                          -Vector3d::UnitZ(), {{12.0, 40.0}}, true));
    plate.features.back().fit = "H7";
  }
  CHECK(state_of(b, "SYS-05", seen) == RuleState::NotApplicable);
  b.place("T/plate-5x3", "TABLE", {0, 0, -40});
  ProjectElement pin = pin_element();
  pin.element.features[0].fit = "m6";
  b.add_element(pin);
  b.place("T/pin-12", "PIN1", {-100, 60, -15});
  CHECK(state_of(b, "SYS-05", seen) == RuleState::Fail);
  b.place("T/pin-12", "PIN2", {100, 60, -15});
  CHECK(state_of(b, "SYS-05", seen) == RuleState::Pass);
}

}  // namespace

void slot_examples(Seen& seen) {
  tee_examples(seen);
  key_examples(seen);
  stacked_plates_example(seen);
}

}  // namespace dowel::testing

TEST_CASE("a T-nut in its slot carries what its screw holds, a key settles and holds nothing",
          "[rule]") {
  dowel::testing::Seen seen;
  dowel::testing::slot_examples(seen);
}
