// Rules that reckon with what `design` states.

#include <cmath>

#include "rule_examples.h"

namespace dowel::testing {
namespace {

using Eigen::Vector3d;

const Vector3d kDown = -Vector3d::UnitZ();

void clamp_examples(Seen& seen) {
  FixtureBuilder b = sound_fixture();
  // Its contact is 50 mm over the plate's top.
  CHECK(state_of(b, "CLP-06", seen) == RuleState::NotEvaluated);
  state(b, "CLAMP", "stroke_mm", 5.0);
  CHECK(state_of(b, "CLP-06", seen) == RuleState::Pass);
  state(b, "WORK", "height_tolerance_mm", 4.5);
  CHECK(state_of(b, "CLP-06", seen) == RuleState::Fail);
  state(b, "WORK", "height_tolerance_mm", 0.5);
  state(b, "CLAMP", "height_max_mm", 50.1);
  CHECK(state_of(b, "CLP-06", seen) == RuleState::Pass);
  state(b, "CLAMP", "height_max_mm", 49.9);
  CHECK(state_of(b, "CLP-06", seen) == RuleState::Fail);

  CHECK(state_of(b, "CLP-12", seen) == RuleState::NotEvaluated);
  state(b, "CLAMP", "pad_mm2", 256.0);
  CHECK(state_of(b, "CLP-12", seen) == RuleState::Pass);
  state(b, "CLAMP", "pad_mm2", 256.0 / 0.89);
  CHECK(state_of(b, "CLP-12", seen) == RuleState::Fail);
}

void locator_examples(Seen& seen) {
  FixtureBuilder b = sound_fixture();
  CHECK(state_of(b, "LOC-11", seen) == RuleState::NotEvaluated);
  state(b, "WORK.bottom", "machined", 1.0);
  CHECK(state_of(b, "LOC-11", seen) == RuleState::Pass);
  state(b, "WORK.bottom", "machined", 0.0);
  CHECK(state_of(b, "LOC-11", seen) == RuleState::Fail);
  // Half of its pad is beside the workpiece.
  state(b, "WORK.bottom", "machined", 1.0);
  b.state.instances.at("REST2").X_WI = Pose::from_translation({60, -30, 40});
  CHECK(state_of(b, "LOC-11", seen) == RuleState::Fail);

  CHECK(state_of(b, "LOC-13", seen) == RuleState::NotEvaluated);
  for (const char* name : {"REST1", "REST2", "REST3", "STOP1", "STOP2", "STOP3"}) {
    state(b, name, "chip_relief_mm", 1.5);
  }
  CHECK(state_of(b, "LOC-13", seen) == RuleState::Pass);
  state(b, "STOP3", "chip_relief_mm", 0.5);
  CHECK(state_of(b, "LOC-13", seen) == RuleState::Fail);

  CHECK(state_of(b, "STK-04", seen) == RuleState::NotApplicable);
  b.state.design.roles["REST3"] = Role::AdjustableSupport;
  CHECK(state_of(b, "STK-04", seen) == RuleState::NotEvaluated);
  state(b, "REST3", "height_min_mm", 10.0);
  state(b, "REST3", "height_max_mm", 20.1);
  CHECK(state_of(b, "STK-04", seen) == RuleState::Pass);
  state(b, "REST3", "height_max_mm", 19.9);
  CHECK(state_of(b, "STK-04", seen) == RuleState::Fail);
}

/// The value of a finding's column, as a number.
double value_in(const RuleResult& result, const std::string& column) {
  for (const auto& [name, value] : result.findings.at(0).values) {
    if (name == column) return std::stod(value);
  }
  FAIL("there is no column " << column);
  return 0.0;
}

void pin_examples(Seen& seen) {
  // A round pin with 0.01 and a diamond with 0.02 of play in holes of 12, 40 mm apart.
  FixtureBuilder b = pinned_fixture(true);
  CHECK(state_of(b, "LOC-09", seen) == RuleState::NotEvaluated);
  state(b, "PIN2", "land_mm", 2.5);
  state(b, "PIN2", "centre_tolerance_mm", 0.0);
  state(b, "WORK", "centre_tolerance_mm", 0.005);
  CHECK(state_of(b, "LOC-09", seen) == RuleState::Pass);
  state(b, "WORK", "centre_tolerance_mm", 0.1);
  const RuleResult tight = result_of(b, "LOC-09", seen);
  CHECK(tight.state() == RuleState::Fail);
  // The land's corner at half its width and 0.095 aside meets the hole's wall.
  const double half_mm = 0.5 * std::sqrt(144.0 - std::pow(2.5 + 2.0 * 0.095, 2));
  const double half_land_mm = 0.5 * std::sqrt(144.0 - 2.5 * 2.5);
  CHECK(value_in(tight, "needed_mm") == Approx(2.0 * (half_land_mm - half_mm)).epsilon(0.03));

  CHECK(state_of(b, "LOC-10", seen) == RuleState::Fail);  // 40 mm are less than half of 144
  b.state.design.limits["pin_spread"] = 0.25;
  const RuleResult near = result_of(b, "LOC-10", seen);
  CHECK(near.state() == RuleState::Pass);
  CHECK(value_in(near, "least_mm") == Approx(0.25 * std::hypot(120.0, 80.0)).epsilon(1e-5));
  CHECK(value_in(near, "turn_deg") ==
        Approx(std::atan(0.03 / 80.0) * 180.0 / std::acos(-1.0)).epsilon(1e-5));

  CHECK(state_of(b, "LOC-12", seen) == RuleState::Pass);  // 10 mm in the hole
  b.state.design.limits["pin_slenderness"] = 2.0;
  CHECK(state_of(b, "LOC-12", seen) == RuleState::Fail);

  CHECK(state_of(b, "FST-12", seen) == RuleState::Pass);  // 40 mm to the long sides
  b.state.design.limits["edge_in_diameters"] = 3.5;
  CHECK(state_of(b, "FST-12", seen) == RuleState::Fail);
}

/// A block of 60 x 60 x 40 whose bore is over hole B2 of the plate, and a screw through it.
FixtureBuilder screwed_block(double bore_mm) {
  FixtureBuilder b;
  DrilledHole hole;
  hole.radius_mm = 0.5 * bore_mm;
  ProjectElement block =
      element_of("T/block", plate_with_holes({60, 60, 40}, {hole}, 24),
                 {hole_feature("h1", {0, 0, 40}, kDown, {{bore_mm, 40.0}}, true)});
  block.element.role = "riser";
  b.add_element(block);
  ProjectElement screw = screw_element();
  screw.element.role = "fastener";
  screw.element.features[0].thread = "M12";
  b.add_element(screw);
  b.place("T/block", "BLOCK", {-40, 0, 40});
  b.place("T/screw-M12x65", "SCREW", {-40, 0, 15});
  return b;
}

void screw_examples(Seen& seen) {
  FixtureBuilder b = screwed_block(13.0);
  CHECK(state_of(b, "FST-11", seen) == RuleState::NotEvaluated);
  // ISO 898-1: an M12 has a stress area of 84.3 mm2; three quarters of 640 N/mm2 on it are 40.5 kN.
  state(b, "SCREW", "preload_N", 40400.0);
  CHECK(state_of(b, "FST-11", seen) == RuleState::Pass);
  state(b, "SCREW", "preload_N", 40600.0);
  CHECK(state_of(b, "FST-11", seen) == RuleState::Fail);

  CHECK(state_of(b, "CMP-06", seen) == RuleState::Pass);
  CHECK(state_of(screwed_block(16.2), "CMP-06", seen) == RuleState::Fail);

  CHECK(state_of(b, "CMP-10", seen) == RuleState::Pass);
  b.state.instances.at("BLOCK").X_WI = Pose::from_translation({-39.9, 0, 40});
  CHECK(state_of(b, "CMP-10", seen) == RuleState::Fail);
  b.state.instances.at("BLOCK").X_WI = Pose::from_translation({-20, 0, 40});  // for no hole
  CHECK(state_of(b, "CMP-10", seen) == RuleState::NotApplicable);
}

void stock_examples(Seen& seen) {
  FixtureBuilder b = screwed_block(13.0);
  CHECK(state_of(b, "SYS-04", seen) == RuleState::NotApplicable);
  state(b, "T/block", "stock", 1.0);
  CHECK(state_of(b, "SYS-04", seen) == RuleState::Pass);
  b.place("T/block", "BLOCK2", {60, 0, 40});
  CHECK(state_of(b, "SYS-04", seen) == RuleState::Fail);

  b.remove("BLOCK");
  CHECK(state_of(b, "STK-03", seen) == RuleState::NotApplicable);
  b.remove("SCREW");
  b.place("T/screw-M12x65", "SCREW", {-40, 0, 30});
  for (const char* name : {"LOW", "HIGH"}) {
    b.place("T/block", name, {-40, 0, name[0] == 'L' ? 40.0 : 80.0});
  }
  CHECK(state_of(b, "STK-03", seen) == RuleState::NotEvaluated);
  state(b, "LOW", "height_tolerance_mm", 0.02);
  state(b, "HIGH", "height_tolerance_mm", 0.03);
  CHECK(state_of(b, "STK-03", seen) == RuleState::Pass);
  state(b, "HIGH", "height_tolerance_mm", 0.04);
  const RuleResult result = result_of(b, "STK-03", seen);
  CHECK(result.state() == RuleState::Fail);
  CHECK(value_in(result, "likely_mm") == Approx(std::hypot(0.02, 0.04)).epsilon(1e-5));
}

/// A strap of 80 x 20 x 20 along x with a screw through its middle: its nose on the block of the
/// sound fixture, 30 mm from the screw, its heel on a post, 32 mm from it.
FixtureBuilder strapped(double tilt_rad) {
  FixtureBuilder b = sound_fixture();
  b.remove("CLAMP");
  DrilledHole hole;
  hole.radius_mm = 8.0;
  ProjectElement strap = element_of("T/strap", plate_with_holes({80, 20, 20}, {hole}, 24),
                                    {hole_feature("h1", {0, 0, 20}, kDown, {{16.0, 20.0}}, true),
                                     face_feature("bottom", {0, 0, 0}, kDown, 1399.0)});
  strap.element.role = "clamp";
  b.add_element(strap);
  // Level: heel as high as the block's top at 90. Tilted: the nose's edge on the block at x = 40,
  // the bottom on the near edge of the post at x = 104.
  b.add_box("T/post", {16, 16, 50.0 + 64.0 * std::tan(tilt_rad)}, "riser");
  b.place("T/post", "POST", {112, 0, 40});
  b.place("T/strap", "STRAP", {80, 0, 90});
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-tilt_rad, Vector3d::UnitY()));
  b.state.instances.at("STRAP").X_WI =
      Pose(turn, {40.0 + 40.0 * std::cos(tilt_rad), 0, 90.0 + 40.0 * std::sin(tilt_rad)});
  ProjectElement screw = element_of("T/screw-M12x100", stepped_pin({{6.0, 100.0}, {9.0, 12.0}}, 24),
                                    {shaft_feature("pin1", {0, 0, 100}, kDown, 12.0, 100.0)});
  screw.element.role = "fastener";
  b.add_element(screw);
  b.place("T/screw-M12x100", "SCREW", {80, 0, tilt_rad > 0.0 ? 16.0 : 10.0});
  b.state.design.clamp_forces_N["STRAP"] = 6000.0;
  return b;
}

void strap_examples(Seen& seen) {
  FixtureBuilder b = strapped(0.0);
  CHECK(state_of(b, "CLP-07", seen) == RuleState::Pass);
  const RuleResult level = result_of(b, "CLP-08", seen);
  CHECK(level.state() == RuleState::Pass);
  CHECK(value_in(level, "share") == Approx(32.0 / 62.0).epsilon(1e-5));
  CHECK(value_in(level, "screw_force_N") == Approx(6000.0 * 62.0 / 32.0).epsilon(1e-5));
  b.state.instances.at("POST").X_WI = Pose::from_translation({106, 0, 40});
  CHECK(state_of(b, "CLP-08", seen) == RuleState::Fail);  // 26 mm of 56

  const double tilt_rad = 4.0 * std::acos(-1.0) / 180.0;
  const RuleResult tilted = result_of(strapped(tilt_rad), "CLP-07", seen);
  CHECK(tilted.state() == RuleState::Fail);
  CHECK(value_in(tilted, "tilt_deg") == Approx(4.0).epsilon(1e-5));
}

}  // namespace

void stated_examples(Seen& seen) {
  clamp_examples(seen);
  locator_examples(seen);
  pin_examples(seen);
  screw_examples(seen);
  stock_examples(seen);
  strap_examples(seen);
}

}  // namespace dowel::testing

TEST_CASE("rules take what is stated of clamps, locators and pins", "[rule]") {
  dowel::testing::Seen seen;
  dowel::testing::clamp_examples(seen);
  dowel::testing::locator_examples(seen);
  dowel::testing::pin_examples(seen);
}

TEST_CASE("rules take what is stated of screws, stacks, stock and straps", "[rule]") {
  dowel::testing::Seen seen;
  dowel::testing::screw_examples(seen);
  dowel::testing::stock_examples(seen);
  dowel::testing::strap_examples(seen);
}
