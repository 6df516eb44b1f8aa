#include "dowel/assembly/session.h"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"

using dowel::Catalog;
using dowel::Error;
using dowel::InsertRequest;
using dowel::MoveReport;
using dowel::Pose;
using dowel::Project;
using dowel::Session;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

/// A session in memory with the fixture catalogue.
struct Workshop {
  testing::TemporaryFolder folder;
  Session session{Project()};

  Workshop() {
    testing::write_fixture_catalog(folder / "catalog.db");
    session.use_catalog(
        std::make_shared<const Catalog>(folder / "catalog.db", Catalog::Access::ReadOnly));
  }

  MoveReport place(const std::string& element, const std::string& name, const Eigen::Vector3d& at) {
    return session.place(element, name, Pose::from_translation(at), "place " + name);
  }

  MoveReport insert(const dowel::FeatureName& moving, const dowel::FeatureName& fixed,
                    const dowel::MateOptions& options = {}) {
    return session.insert({.moving = moving, .fixed = fixed, .seat = {}, .options = options},
                          "insert");
  }

  Eigen::Vector3d where(const std::string& name) {
    return session.instance(name).X_WI.translation();
  }
};

}  // namespace

TEST_CASE("a riser is screwed to a plate: seats touch, threads overlap, nothing interferes") {
  Workshop shop;
  CHECK(shop.place("T/plate-5x3", "", {0, 0, 0}).instance == "PLATE1");
  shop.session.set_grounded("PLATE1", true, "ground");
  CHECK(shop.place("T/riser-60x60x40", "", {0, 0, 200}).verdict == Verdict::Clear);
  const MoveReport riser = shop.insert({"RISER1", "h1"}, {"PLATE1", "B3"});
  CHECK_FALSE(riser.refused);
  CHECK(riser.verdict == Verdict::Contact);
  CHECK((shop.where("RISER1") - Eigen::Vector3d(0, 0, 40)).norm() < testing::kExact_mm);

  CHECK(shop.place("T/screw-M12x65", "", {300, 0, 0}).verdict == Verdict::Clear);
  const MoveReport screw = shop.insert({"SCREW1", "pin1"}, {"RISER1", "h1"});
  INFO((screw.touches.empty() ? std::string() : screw.touches.front().with));
  CHECK_FALSE(screw.refused);
  CHECK(screw.verdict == Verdict::Contact);
  CHECK((shop.where("SCREW1") - Eigen::Vector3d(0, 0, 15)).norm() < testing::kExact_mm);
  CHECK(dowel::worst(shop.session.check_all()) == Verdict::Contact);
}

TEST_CASE("a screw goes in and out of its thread along the axis and nowhere else") {
  Workshop shop;
  shop.place("T/plate-5x3", "PLATE1", {0, 0, 0});
  shop.place("T/screw-M12x65", "SCREW1", {300, 100, 0});
  const MoveReport in = shop.insert({"SCREW1", "pin1"}, {"PLATE1", "B3"}, {.offset_mm = 30});
  CHECK_FALSE(in.refused);
  REQUIRE(in.made);
  CHECK(in.made->thread);
  const Eigen::Vector3d seated = shop.where("SCREW1");
  CHECK((seated - Eigen::Vector3d(0, 0, 5)).norm() < testing::kExact_mm);
  const MoveReport out = shop.session.move("SCREW1", seated + Eigen::Vector3d(0, 0, 0.5), "out");
  CHECK_FALSE(out.refused);
  CHECK(out.dropped.size() == 1);  // it left its place along the axis
  CHECK_FALSE(shop.session.move("SCREW1", seated, "in").refused);
  CHECK(shop.session.move("SCREW1", seated + Eigen::Vector3d(1, 0, 0), "beside").refused);
  // Off the axis there is no thread to go into.
  CHECK(shop.place("T/screw-M12x65", "SCREW2", {40.1, 0, 5}).refused);
}

TEST_CASE("a move that interferes is taken back in block, done in warn, unseen in off") {
  Workshop shop;
  shop.place("T/block-40", "A", {0, 0, 0});
  shop.place("T/block-40", "B", {100, 0, 0});
  const dowel::ProjectState before = shop.session.state();
  const MoveReport blocked = shop.session.move("B", {30, 0, 0}, "move");
  CHECK(blocked.refused);
  CHECK(blocked.verdict == Verdict::Interference);
  REQUIRE(blocked.touches.size() == 1);
  CHECK(blocked.touches[0].instance == "B");
  CHECK(blocked.touches[0].with == "A");
  CHECK(blocked.X_WI.translation() == Eigen::Vector3d(100, 0, 0));
  // 60 of 70 mm are free, give or take the tolerance.
  CHECK(blocked.free_share == Approx(60.0 / 70.0).margin(0.001));
  CHECK(blocked.X_WI_free.translation().x() == Approx(40.0).margin(0.03));
  CHECK(shop.session.state() == before);
  CHECK(shop.session.project().journal().size() == 2);

  // Through the other part and out on its far side is no way either.
  CHECK(shop.session.move("B", {-100, 0, 0}, "through").refused);
  // Up to it is contact, along it too.
  const MoveReport touching = shop.session.move("B", {40, 0, 0}, "touch");
  CHECK_FALSE(touching.refused);
  CHECK(touching.verdict == Verdict::Contact);
  CHECK(shop.session.move("B", {40, 2, 0}, "slide").verdict == Verdict::Contact);

  shop.session.set_mode(dowel::CheckMode::Warn, "mode warn");
  const MoveReport warned = shop.session.move("B", {30, 0, 0}, "move");
  CHECK_FALSE(warned.refused);
  CHECK(warned.verdict == Verdict::Interference);
  CHECK(shop.where("B").x() == 30.0);
  CHECK(dowel::worst(shop.session.check_all()) == Verdict::Interference);

  // Out of an interference there is a way in block mode.
  shop.session.set_mode(dowel::CheckMode::Block, "mode block");
  CHECK_FALSE(shop.session.move("B", {90, 0, 0}, "out").refused);
  shop.session.set_mode(dowel::CheckMode::Off, "mode off");
  const MoveReport unseen = shop.session.move("B", {30, 0, 0}, "move");
  CHECK_FALSE(unseen.checked);
  CHECK_FALSE(unseen.refused);
}

TEST_CASE("a refused placement leaves no trace") {
  Workshop shop;
  shop.place("T/block-40", "A", {0, 0, 0});
  const MoveReport refused = shop.place("T/riser-60x60x40", "R", {10, 0, 0});
  CHECK(refused.refused);
  CHECK(shop.session.state().instances.size() == 1);
  CHECK(shop.session.project().element_names() == std::vector<std::string>{"T/block-40"});
  CHECK(shop.session.check_all().empty());
  // Another catalogue may follow right away.
  shop.session.use_catalog(shop.session.catalog());
  CHECK_FALSE(shop.place("T/riser-60x60x40", "R", {100, 0, 0}).refused);
}

TEST_CASE("a turn is checked along its arc, also past the half turn") {
  Workshop shop;
  shop.place("T/block-40", "A", {100, 0, 0});
  shop.place("T/block-40", "POST", {0, 100, 0});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  // From the right to the left over the back meets the post, over the front does not.
  const MoveReport back = shop.session.rotate("A", {0, 0, 0}, up, std::numbers::pi, "back");
  CHECK(back.refused);
  // Both are 40 wide at radius 100: the turn is free up to about 45 of 180 degrees or more.
  CHECK(back.free_share > 0.2);
  CHECK(back.free_share < 0.5);
  CHECK_FALSE(shop.session.rotate("A", {0, 0, 0}, up, -std::numbers::pi, "front").refused);
  CHECK((shop.where("A") - Eigen::Vector3d(-100, 0, 0)).norm() < testing::kExact_mm);
  CHECK_FALSE(shop.session.rotate("A", {0, 0, 0}, up, 0.75, "on").refused);
  CHECK(shop.session.rotate("A", {0, 0, 0}, up, 2.0 * std::numbers::pi, "around").refused);
}

TEST_CASE("a shaft thicker than the bore is refused with the numbers") {
  Workshop shop;
  shop.place("T/plate-5x3", "P", {0, 0, 0});
  shop.place("T/bolt-20", "BOLT", {0, 0, 500});
  const dowel::ProjectState before = shop.session.state();
  CHECK_THROWS_WITH(shop.insert({"BOLT", "pin1"}, {"P", "A1"}),
                    Catch::Contains("BOLT.pin1") && Catch::Contains("20 mm") &&
                        Catch::Contains("P.A1") && Catch::Contains("12 mm wide from 0 to 15"));
  CHECK(shop.session.state() == before);
  // A pin that is no screw does not pass the step.
  shop.place("T/pin-12", "PIN", {0, 0, 600});
  CHECK_THROWS_WITH(shop.insert({"PIN", "pin1"}, {"P", "B3"}), Catch::Contains("10.106 mm wide"));
  const MoveReport held = shop.insert({"PIN", "pin1"}, {"P", "B3"}, {.offset_mm = 15});
  CHECK_FALSE(held.refused);
  CHECK((shop.where("PIN") - Eigen::Vector3d(0, 0, 25)).norm() < testing::kExact_mm);
}

TEST_CASE("mates that a move breaks are dropped, and come back with undo") {
  Workshop shop;
  shop.place("T/plate-5x3", "P", {0, 0, 0});
  shop.place("T/riser-60x60x40", "R", {0, 0, 300});
  shop.insert({"R", "h1"}, {"P", "B2"});
  REQUIRE(shop.session.state().mates.size() == 1);
  const dowel::ProjectState mated = shop.session.state();
  const MoveReport lifted =
      shop.session.move("R", shop.where("R") + Eigen::Vector3d(0, 0, 10), "lift");
  REQUIRE(lifted.dropped.size() == 1);
  CHECK(lifted.dropped[0].fixed.text() == "P.B2");
  CHECK(shop.session.state().mates.empty());
  shop.session.undo(1);
  CHECK(shop.session.state() == mated);
  // Turning about the mate's axis keeps it.
  CHECK(shop.session.rotate("R", {-40, 0, 0}, Eigen::Vector3d::UnitZ(), 0.02, "turn")
            .dropped.empty());
  CHECK(shop.session.remove("P", "remove P").size() == 1);
  CHECK(shop.session.state().mates.empty());
}

TEST_CASE("the scene follows undo, redo and a name that comes back as another element") {
  Workshop shop;
  shop.place("T/block-40", "A", {0, 0, 0});
  shop.place("T/block-40", "B", {40, 0, 0});
  CHECK(shop.session.check_all().size() == 1);
  shop.session.undo(1);
  CHECK(shop.session.check_all().empty());
  shop.session.redo(1);
  CHECK(shop.session.check_all().size() == 1);
  shop.session.remove("B", "remove");
  CHECK(shop.place("T/riser-60x60x40", "B", {50, 0, 0}).verdict == Verdict::Contact);
  CHECK(shop.session.check_all().size() == 1);
  shop.session.undo(2);
  CHECK(shop.session.instance("B").element == "T/block-40");
  CHECK(shop.session.check_all().size() == 1);
}

TEST_CASE("names that nothing carries are told with what they may have been meant for") {
  Workshop shop;
  shop.place("T/plate-5x3", "PLATE1", {0, 0, 0});
  CHECK_THROWS_WITH(shop.session.instance("PLATE2"), Catch::Contains("did you mean PLATE1"));
  CHECK_THROWS_WITH(shop.session.element("T/plate-5x4"), Catch::Contains("T/plate-5x3"));
  CHECK_THROWS_WITH(shop.session.feature({"PLATE1", "A9"}), Catch::Contains("did you mean A"));
  CHECK_THROWS_AS(shop.place("T/block-40", "PLATE1", {500, 0, 0}), Error);
  CHECK_THROWS_AS(shop.place("T/block-40", "a.b", {500, 0, 0}), Error);
  CHECK_THROWS_AS(shop.place("T/block-40", "far", {1e6, 0, 0}), Error);
  CHECK_THROWS_AS(shop.session.set_tolerance(0.0, "t"), Error);
  CHECK_THROWS_AS(shop.session.set_tolerance(std::nan(""), "t"), Error);
  shop.session.set_grounded("PLATE1", true, "g");
  CHECK_THROWS_WITH(shop.session.move("PLATE1", {1, 0, 0}, "m"), Catch::Contains("grounded"));
  CHECK_THROWS_AS(shop.insert({"PLATE1", "A1"}, {"PLATE1", "A2"}), Error);
}

TEST_CASE("a project needs no catalogue once it has its copies") {
  Workshop shop;
  shop.place("T/plate-5x3", "P", {0, 0, 0});
  shop.place("T/riser-60x60x40", "R", {0, 0, 40});
  shop.session.save(shop.folder / "a.dwp");
  CHECK(shop.session.project().file() == shop.folder / "a.dwp");
  shop.session.use_catalog(nullptr);
  CHECK_FALSE(shop.place("T/riser-60x60x40", "R2", {80, 0, 40}).refused);
  CHECK_THROWS_WITH(shop.session.element("T/pin-12"), Catch::Contains("no catalogue is open"));
  const auto rows = shop.session.bill_of_materials();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].element == "T/plate-5x3");
  CHECK(rows[1].count == 2);
  CHECK(rows[1].family == "T");
  CHECK(rows[1].instances == std::vector<std::string>{"R", "R2"});
}

TEST_CASE("an element is placed at a hole and on a face, turned least") {
  Workshop shop;
  shop.place("T/plate-5x3", "P", {0, 0, 0});
  const Pose at = shop.session.pose_at({"P", "C5"});
  CHECK(at == Pose::from_translation({80, 40, 40}));
  const Pose on = shop.session.pose_on("T/riser-60x60x40", {"P", "top"});
  CHECK(on == Pose::from_translation({0, 0, 40}));
  const Pose block = shop.session.pose_on("T/block-40", {"P", "top"});
  CHECK(block == Pose::from_translation({0, 0, 60}));
  CHECK_THROWS_AS(shop.session.pose_on("T/bolt-20", {"P", "top"}), Error);
  CHECK_THROWS_AS(shop.session.pose_on("T/block-40", {"P", "A1"}), Error);
}
