#include "dowel/assembly/unit.h"

#include <catch2/catch.hpp>

#include "dowel/assembly/project_diff.h"
#include "dowel/kernel/error.h"
#include "workshop.h"

using dowel::MateKind;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectDiff;
using dowel::Session;
using dowel::testing::kExact_mm;
using dowel::testing::Workshop;
using Eigen::Vector3d;

namespace {

/// A riser on B4 with a pin standing in its bore.
void build_sub_assembly(Workshop& shop) {
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  shop.insert({"RISER", "h1"}, {"PLATE", "B4"});
  shop.place("T/pin-12", "PIN", {0, 0, 300});
  shop.insert({"PIN", "pin1"}, {"RISER", "h1"}, 5.0);
}

}  // namespace

TEST_CASE("a sub-assembly is saved and comes back as a unit elsewhere") {
  Workshop shop;
  build_sub_assembly(shop);
  const auto names = shop.session.sub_assembly("RISER");
  CHECK(names == std::vector<std::string>{"PIN", "RISER"});
  const auto file = shop.folder / "unit.dwp";
  dowel::save_unit(shop.session, {"RISER", "PIN"}, file);
  CHECK_THROWS_AS(dowel::save_unit(shop.session, {"RISER"}, file), dowel::Error);

  // A project without a catalogue: the unit brings its elements.
  Session other{Project()};
  const Pose X_WU(Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d::UnitZ())), {500, 0, 0});
  const auto reports = other.insert_unit(Project::open(file), "LEFT", X_WU, "insert-unit");
  REQUIRE(reports.size() == 2);
  CHECK_FALSE(reports.front().refused);
  CHECK((other.instance("LEFT-RISER").X_WI.translation() - Vector3d(500, 0, 0)).norm() < kExact_mm);
  const Vector3d apart = shop.where("PIN") - shop.where("RISER");
  const Pose X_WR = other.instance("LEFT-RISER").X_WI;
  CHECK((X_WR.inverse() * other.instance("LEFT-PIN").X_WI.translation() - apart).norm() <
        kExact_mm);
  CHECK(other.unit("LEFT-PIN").size() == 2);
  CHECK(other.state().mates.size() == 2);  // the insert, and what makes it a unit
  CHECK(other.project().journal().size() == 1);

  // It moves as one, and a second one does not go where it is.
  CHECK_FALSE(other
                  .move("LEFT-PIN",
                        other.instance("LEFT-PIN").X_WI.translation() + Vector3d(0, 0, 50), "move")
                  .refused);
  CHECK((other.instance("LEFT-RISER").X_WI.translation() - Vector3d(500, 0, 50)).norm() <
        kExact_mm);
  const auto again = other.insert_unit(Project::open(file), "RIGHT",
                                       Pose::from_translation({500, 0, 60}), "insert-unit");
  CHECK(again.front().refused);
  CHECK(other.state().instances.size() == 2);
  CHECK_THROWS_AS(other.insert_unit(Project::open(file), "LEFT", X_WU, "insert-unit"),
                  dowel::Error);
  CHECK(other.project().replay() == other.state());
}

TEST_CASE("an element of the same name and another shape is not taken for the same") {
  Workshop shop;
  build_sub_assembly(shop);
  const auto file = shop.folder / "unit.dwp";
  dowel::save_unit(shop.session, {"RISER", "PIN"}, file);
  Session other{Project()};
  dowel::ProjectElement pin = dowel::testing::pin_element();
  pin.element.sha256 = std::string(64, 'b');
  dowel::ProjectState state;
  dowel::Instance instance;
  instance.number = 1;
  instance.name = "PIN";
  instance.element = pin.element.name;
  state.instances.emplace("PIN", instance);
  Project project;
  project.commit("place", state, std::vector<dowel::ProjectElement>{pin});
  Session third{std::move(project)};
  CHECK_THROWS_WITH(third.insert_unit(Project::open(file), "U", Pose(), "insert-unit"),
                    Catch::Contains("another element called \"T/pin-12\""));
}

TEST_CASE("two projects are compared by names and mates") {
  Workshop shop;
  build_sub_assembly(shop);
  const dowel::ProjectState before = shop.session.state();
  CHECK(dowel::diff(before, before).is_empty());
  shop.place("T/block-40", "BLOCK", {-90, 0, 60});
  shop.session.move("PIN", shop.where("PIN") + Vector3d(0, 0, 30), "move");
  shop.session.set_mode(dowel::CheckMode::Warn, "mode warn");
  const ProjectDiff difference = dowel::diff(before, shop.session.state());
  REQUIRE(difference.added.size() == 1);
  CHECK(difference.added.front().name == "BLOCK");
  CHECK(difference.removed.empty());
  REQUIRE(difference.changed.size() == 1);
  CHECK(difference.changed.front().first.name == "PIN");
  REQUIRE(difference.mates_removed.size() == 1);
  CHECK(difference.mates_removed.front().moving.text() == "PIN.pin1");
  CHECK(difference.mates_added.empty());
  CHECK(difference.settings == std::vector<std::string>{"mode: block, warn"});
  const ProjectDiff back = dowel::diff(shop.session.state(), before);
  CHECK(back.removed.size() == 1);
  CHECK(back.mates_added.size() == 1);
}
