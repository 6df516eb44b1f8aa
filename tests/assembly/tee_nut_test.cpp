// Fastening over a T-slot.

#include <cmath>

#include <catch2/catch.hpp>

#include "dowel/assembly/automation.h"
#include "dowel/kernel/error.h"
#include "workshop.h"

using dowel::FasteningPlan;
using dowel::Feature;
using dowel::Pose;
using dowel::ProjectElement;
using Eigen::Vector3d;
namespace testing = dowel::testing;

namespace {

/// 300 x 120 x 60 with a slot for T-nuts 14 along x: throat 14 x 16, undercut 24 x 10. Its solid is
/// a plain box: the places of the parts are looked at here, not their collisions.
ProjectElement slot_plate() {
  Feature slot;
  slot.name = "slot1";
  slot.kind = dowel::FeatureKind::Slot;
  slot.origin = {0, 0, 60};
  slot.direction = -Vector3d::UnitZ();
  slot.diameter_mm = 14.0;
  slot.depth_mm = 26.0;
  slot.slot = dowel::SlotShape{};
  slot.slot->type = dowel::SlotShape::Type::Tee;
  slot.slot->length_mm = 300.0;
  slot.slot->throat_depth_mm = 16.0;
  slot.slot->undercut_width_mm = 24.0;
  slot.slot->undercut_height_mm = 10.0;
  return testing::element_of(
      "S/plate-T14", testing::box({300, 120, 60}),
      {slot, testing::face_feature("top", {0, 0, 60}, Vector3d::UnitZ(), 30000.0)});
}

/// Like DIN 508: foot 22 x 22 x 8, neck 13.7 wide, 16 high.
ProjectElement tee_nut(const std::string& name, double core_mm) {
  const auto face = [](const std::string& of, const Vector3d& origin, const Vector3d& normal) {
    return testing::face_feature(of, origin, normal, 100.0);
  };
  return testing::element_of(
      name, testing::box({22, 22, 16}),
      {testing::hole_feature("h1", {0, 0, 16}, -Vector3d::UnitZ(), {{core_mm, 16.0}}, true),
       face("top", {0, 0, 16}, Vector3d::UnitZ()), face("bottom", {0, 0, 0}, -Vector3d::UnitZ()),
       face("f1", {0, 9, 8}, Vector3d::UnitZ()), face("f2", {0, -9, 8}, Vector3d::UnitZ()),
       face("f3", {0, 6.85, 12}, Vector3d::UnitY()), face("f4", {0, -6.85, 12}, -Vector3d::UnitY()),
       face("f5", {0, 11, 4}, Vector3d::UnitY()), face("f6", {0, -11, 4}, -Vector3d::UnitY())});
}

/// 22 x 22 x 6 without a neck; a round one has no flat sides.
ProjectElement low_nut(bool is_round) {
  const auto face = [](const std::string& of, const Vector3d& origin, const Vector3d& normal) {
    return testing::face_feature(of, origin, normal, 100.0);
  };
  std::vector<Feature> features{
      testing::hole_feature("h1", {0, 0, 6}, -Vector3d::UnitZ(), {{10.106, 6.0}}, true),
      face("top", {0, 0, 6}, Vector3d::UnitZ()), face("bottom", {0, 0, 0}, -Vector3d::UnitZ())};
  if (!is_round) {
    features.push_back(face("f1", {0, 11, 3}, Vector3d::UnitY()));
    features.push_back(face("f2", {0, -11, 3}, -Vector3d::UnitY()));
  }
  return testing::element_of("S/tee-nut-M12-low", testing::box({22, 22, 6}), features);
}

ProjectElement screw(int length_mm) {
  const double length = length_mm;
  return testing::element_of(
      "S/screw-M12x" + std::to_string(length_mm),
      testing::stepped_pin({{6.0, length}, {9.0, 12.0}}, 24),
      {testing::shaft_feature("pin1", {0, 0, length}, -Vector3d::UnitZ(), 12.0, length)});
}

/// The riser, whose bore may end in a key slot of its foot, 5 deep and 18 wide.
ProjectElement riser(bool has_key_slot) {
  ProjectElement riser = testing::riser_element();
  if (!has_key_slot) return riser;
  Feature& hole = riser.element.features.front();
  hole.depth_mm = 35.0;
  hole.segments.front().to_mm = 35.0;
  Feature slot;
  slot.name = "slot1";
  slot.kind = dowel::FeatureKind::Slot;
  slot.direction = Vector3d::UnitZ();
  slot.diameter_mm = 18.0;
  slot.depth_mm = 5.0;
  slot.slot = dowel::SlotShape{};
  slot.slot->length_mm = 60.0;
  riser.element.features.push_back(slot);
  return riser;
}

void write_catalog(const std::filesystem::path& file, const std::vector<ProjectElement>& elements) {
  dowel::Catalog catalog(file, dowel::Catalog::Access::ReadWrite);
  for (const ProjectElement& element : elements) {
    dowel::SourceRecord source;
    source.path = element.element.source;
    source.status = "ok";
    const std::vector<dowel::ElementRecord> records{{element.element, *element.solid, {}}};
    catalog.put(source, records);
  }
}

}  // namespace

TEST_CASE("over a T-slot a screw is chosen with the T-nut that fits the slot") {
  const bool has_key_slot = GENERATE(false, true);
  CAPTURE(has_key_slot);
  testing::Workshop shop;
  const auto file = shop.folder / "slots.db";
  write_catalog(file,
                {slot_plate(), tee_nut("S/tee-nut-M12", 10.106), tee_nut("S/tee-nut-M10", 8.376),
                 screw(50), screw(60), screw(70), riser(has_key_slot)});
  dowel::Session session{dowel::Project()};
  session.use_catalog(
      std::make_shared<const dowel::Catalog>(file, dowel::Catalog::Access::ReadOnly));
  session.set_mode(dowel::CheckMode::Off, "mode off");
  // The slot runs along y here, 5 mm off; the riser's hole is over its middle.
  const Pose X_WP(Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(0.0), Vector3d::UnitZ())),
                  {5, 0, 0});
  session.place("S/plate-T14", "PLATE", X_WP, "place");
  session.place("T/riser-60x60x40", "RISER", Pose::from_translation({5, 33, 60}), "place");
  const FasteningPlan plan = dowel::plan_fastening(session, {"RISER", "h1"});
  // 40 mm of riser and 8 of throat over the nut: 60 has 12 mm of thread in its 16, 50 too little,
  // and 70 would stand on the floor.
  REQUIRE(plan.ways.size() == 1);
  CHECK(plan.ways[0].screw.element == "S/screw-M12x60");
  REQUIRE(plan.ways[0].tee_nut);
  CHECK(plan.ways[0].tee_nut->element == "S/tee-nut-M12");
  CHECK(plan.ways[0].grip_mm == Approx(48.0));
  CHECK(plan.ways[0].engagement_mm == Approx(12.0));
  CHECK(plan.ways[0].spare_mm == Approx(6.0));  // to the slot's floor at 66
  CHECK(plan.holes.at(plan.ways[0].thread).text() == "PLATE.slot1");

  const auto reports = dowel::fasten(session, plan, 0, "fasten");
  REQUIRE(reports.size() == 2);
  // The foot's shoulder, 8 above its bottom, under the throat at z = 44; along the slot.
  const Pose& X_WN = session.instance("TEE1").X_WI;
  CHECK((X_WN.translation() - Vector3d(5, 33, 36)).norm() < testing::kExact_mm);
  CHECK(std::abs((X_WN.rotation() * Vector3d::UnitX()).y()) == Approx(1.0));
  CHECK((session.instance("SCREW1").X_WI.translation() - Vector3d(5, 33, 40)).norm() <
        testing::kExact_mm);
  CHECK(session.state().mates.size() == 2);
  for (const auto& [number, mate] : session.state().mates) {
    CHECK(session.residual(mate).axis_mm < testing::kExact_mm);
  }

  // Beside the middle no T-nut can be under the hole.
  session.move("RISER", {8, 33, 60}, "move");
  CHECK_THROWS_AS(dowel::plan_fastening(session, {"RISER", "h1"}), dowel::Error);
}

TEST_CASE(
    "a nut without a neck is drawn up in the undercut, where its corners keep it from turning") {
  const bool is_round = GENERATE(false, true);
  testing::Workshop shop;
  const auto file = shop.folder / "slots.db";
  write_catalog(file,
                {slot_plate(), low_nut(is_round), screw(60), screw(63), screw(70), riser(false)});
  dowel::Session session{dowel::Project()};
  session.use_catalog(
      std::make_shared<const dowel::Catalog>(file, dowel::Catalog::Access::ReadOnly));
  session.set_mode(dowel::CheckMode::Off, "mode off");
  session.place("S/plate-T14", "PLATE", Pose(), "place");
  session.place("T/riser-60x60x40", "RISER", Pose::from_translation({33, 0, 60}), "place");
  if (is_round) {
    CHECK_THROWS_WITH(dowel::plan_fastening(session, {"RISER", "h1"}),
                      Catch::Contains("no T-nut fits slot PLATE.slot1"));
    return;
  }
  const FasteningPlan plan = dowel::plan_fastening(session, {"RISER", "h1"});
  // 56 mm to the nut, all 6 of it, and a pitch above the floor at 66: 62 to 64.25.
  REQUIRE(plan.ways.size() == 1);
  CHECK(plan.ways[0].screw.element == "S/screw-M12x63");
  CHECK(plan.ways[0].engagement_mm == Approx(6.0));
  dowel::fasten(session, plan, 0, "fasten");
  // Its top under the throat, at z = 44.
  CHECK((session.instance("TEE1").X_WI.translation() - Vector3d(33, 0, 38)).norm() <
        testing::kExact_mm);
  for (const auto& [number, mate] : session.state().mates) {
    CHECK(session.residual(mate).axis_mm < testing::kExact_mm);
  }
}
