// Mates made beside each other in a session.

#include <cmath>
#include <numbers>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "dowel/assembly/session.h"
#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"

using dowel::Catalog;
using dowel::Error;
using dowel::Freedom;
using dowel::MateKind;
using dowel::MateRequest;
using dowel::MateStatus;
using dowel::MoveReport;
using dowel::Pose;
using dowel::Project;
using dowel::Session;
namespace testing = dowel::testing;

namespace {

/// 100 x 60 x 20 with clearance holes h1 at x = -40 and h2 at x = 40, 80 apart: two of the plate's
/// pitch.
dowel::ProjectElement bar_element() {
  const auto hole_at = [](double x) {
    dowel::testing::DrilledHole hole;
    hole.x = x;
    hole.radius_mm = 6.5;
    return hole;
  };
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  return testing::element_of(
      "T/bar-100", testing::plate_with_holes({100, 60, 20}, {hole_at(-40), hole_at(40)}, 24),
      {testing::hole_feature("h1", {-40, 0, 20}, down, {{13.0, 20.0}}, true),
       testing::hole_feature("h2", {40, 0, 20}, down, {{13.0, 20.0}}, true),
       testing::face_feature("top", {0, 0, 20}, Eigen::Vector3d::UnitZ(), 5700.0),
       testing::face_feature("bottom", {0, 0, 0}, down, 5700.0),
       testing::face_feature("right", {50, 0, 10}, Eigen::Vector3d::UnitX(), 1200.0)});
}

/// 200 x 60 x 40 with a groove along x, 14 wide and 12 deep, in its features alone.
dowel::ProjectElement rail_element() {
  dowel::Feature groove;
  groove.name = "slot1";
  groove.kind = dowel::FeatureKind::Slot;
  groove.origin = {0, 0, 40};
  groove.direction = -Eigen::Vector3d::UnitZ();
  groove.diameter_mm = 14.0;
  groove.depth_mm = 12.0;
  groove.slot.emplace();
  groove.slot->length_mm = 200.0;
  return testing::element_of("T/rail", testing::box({200, 60, 80}), {groove});
}

/// 40 x 14 x 20, stands on z = -10.
dowel::ProjectElement key_element() {
  return testing::element_of(
      "T/key", testing::box({40, 14, 20}),
      {testing::face_feature("bottom", {0, 0, -10}, -Eigen::Vector3d::UnitZ(), 560.0),
       testing::face_feature("front", {0, -7, 0}, -Eigen::Vector3d::UnitY(), 800.0),
       testing::face_feature("back", {0, 7, 0}, Eigen::Vector3d::UnitY(), 800.0)});
}

struct Workshop {
  testing::TemporaryFolder folder;
  Session session{Project()};

  Workshop() {
    testing::write_fixture_catalog(folder / "catalog.db");
    {
      Catalog catalog(folder / "catalog.db", Catalog::Access::ReadWrite);
      for (const auto& element : {bar_element(), rail_element(), key_element()}) {
        dowel::SourceRecord source;
        source.path = element.element.source;
        source.status = "ok";
        const std::vector<dowel::ElementRecord> records{{element.element, *element.solid, {}}};
        catalog.put(source, records);
      }
    }
    session.use_catalog(
        std::make_shared<const Catalog>(folder / "catalog.db", Catalog::Access::ReadOnly));
    place("T/plate-5x3", "PLATE", Pose());
    session.set_grounded("PLATE", true, "ground");
  }

  MoveReport place(const std::string& element, const std::string& name, const Pose& X_WI) {
    return session.place(element, name, X_WI, "place " + name);
  }

  MoveReport mate(std::optional<MateKind> kind, const dowel::FeatureName& moving,
                  const dowel::FeatureName& fixed, const dowel::MateOptions& options = {}) {
    MateRequest request;
    request.kind = kind;
    request.moving = moving;
    request.fixed = fixed;
    request.options = options;
    return session.mate(request, "mate " + moving.text());
  }

  Eigen::Vector3d hole(const std::string& instance, const std::string& feature) {
    return session.feature({instance, feature}).origin_W();
  }
};

Pose turned(double degrees, const Eigen::Vector3d& at) {
  return Pose::from_translation(at) *
         Pose::about_axis({0, 0, 0}, Eigen::Vector3d::UnitZ(), degrees * std::numbers::pi / 180.0);
}

}  // namespace

TEST_CASE("a bar is mated by two holes: the second takes the turn, a third is redundant") {
  Workshop shop;
  const double degrees = GENERATE(0.0, 30.0, -75.0, 170.0);
  CAPTURE(degrees);
  shop.place("T/bar-100", "BAR", turned(degrees, {20, 10, 200}));
  const MoveReport first = shop.mate({}, {"BAR", "h1"}, {"PLATE", "B2"});
  CHECK_FALSE(first.refused);
  CHECK(first.verdict == dowel::Verdict::Contact);
  auto left = shop.session.freedoms("BAR").freedoms;
  REQUIRE(left.size() == 1);
  CHECK(left[0].kind == Freedom::Kind::Turn);
  CHECK((left[0].point_W - Eigen::Vector3d(-40, 0, 40)).head<2>().norm() < testing::kExact_mm);

  const MoveReport second = shop.mate(MateKind::Align, {"BAR", "h2"}, {"PLATE", "B4"});
  CHECK_FALSE(second.refused);
  CHECK(second.dropped.empty());
  CHECK_FALSE(second.is_redundant);
  CHECK((shop.hole("BAR", "h1") - Eigen::Vector3d(-40, 0, 60)).norm() < testing::kExact_mm);
  CHECK((shop.hole("BAR", "h2") - Eigen::Vector3d(40, 0, 60)).norm() < testing::kExact_mm);
  CHECK(shop.session.freedoms("BAR").freedoms.empty());
  CHECK(shop.session.state().mates.size() == 2);

  const MoveReport third = shop.mate(MateKind::FaceOnFace, {"BAR", "bottom"}, {"PLATE", "top"});
  CHECK_FALSE(third.refused);
  CHECK(third.is_redundant);
  const auto shares = shop.session.freedoms("BAR").mates;
  REQUIRE(shares.size() == 3);
  CHECK(shares[2].verdict.status == MateStatus::Redundant);
  // A mate that holds already moves nothing, to the bit.
  CHECK(third.X_WI == second.X_WI);
}

TEST_CASE("a mate that contradicts others is refused with its miss and whom it is against") {
  Workshop shop;
  shop.place("T/bar-100", "BAR", turned(10, {0, 0, 200}));
  shop.mate({}, {"BAR", "h1"}, {"PLATE", "B2"});
  const dowel::ProjectState before = shop.session.state();
  // B5 is 120 from B2, h2 80 from h1.
  const MoveReport refused = shop.mate(MateKind::Align, {"BAR", "h2"}, {"PLATE", "B5"});
  CHECK(refused.refused);
  REQUIRE(refused.conflict);
  CHECK(refused.conflict->mate.fixed.feature == "B5");
  CHECK(refused.conflict->off_mm >= 40.0 - testing::kExact_mm);
  REQUIRE(refused.conflict->against.size() == 1);
  CHECK(refused.conflict->against[0].moving.feature == "h1");
  CHECK(shop.session.state() == before);
  const MoveReport lifted =
      shop.mate(MateKind::FaceOnFace, {"BAR", "bottom"}, {"PLATE", "top"}, {.offset_mm = 5});
  CHECK(lifted.refused);
  REQUIRE(lifted.conflict);
  CHECK(lifted.conflict->off_mm == Approx(5.0).margin(testing::kExact_mm));
  CHECK(shop.session.state() == before);
}

TEST_CASE(
    "a mate that would interfere is refused like a move, and undo takes one back to the bit") {
  Workshop shop;
  shop.place("T/block-40", "BLOCK", turned(0, {-40, 0, 60}));
  shop.place("T/bar-100", "BAR", turned(0, {0, 0, 200}));
  const dowel::ProjectState before = shop.session.state();
  const MoveReport refused = shop.mate({}, {"BAR", "h1"}, {"PLATE", "B2"});
  CHECK(refused.refused);
  CHECK_FALSE(refused.conflict);
  CHECK(refused.verdict == dowel::Verdict::Interference);
  REQUIRE_FALSE(refused.touches.empty());
  CHECK(refused.touches[0].instance == "BAR");
  CHECK(shop.session.state() == before);
  CHECK(dowel::worst(shop.session.check_all()) == dowel::Verdict::Contact);

  CHECK_FALSE(shop.mate({}, {"BAR", "h1"}, {"PLATE", "A3"}).refused);
  shop.session.undo(1);
  CHECK(shop.session.state() == before);
  shop.session.redo(1);
  CHECK(shop.session.state().mates.size() == 1);
  CHECK(shop.session.project().replay() == shop.session.state());
}

TEST_CASE("parts that hang together move along where one alone cannot") {
  Workshop shop;
  shop.place("T/bar-100", "BAR", turned(25, {0, 0, 200}));
  shop.mate({}, {"BAR", "h1"}, {"PLATE", "B2"});
  shop.place("T/riser-60x60x40", "RISER", turned(0, {0, 0, 300}));
  shop.mate({}, {"RISER", "h1"}, {"BAR", "h2"});
  const MoveReport report = shop.mate(MateKind::Align, {"BAR", "h2"}, {"PLATE", "B4"});
  CHECK_FALSE(report.refused);
  CHECK(report.moved_along == std::vector<std::string>{"RISER"});
  CHECK(report.dropped.empty());
  CHECK((shop.hole("RISER", "h1") - Eigen::Vector3d(40, 0, 100)).norm() < testing::kExact_mm);
  // What stands on a grounded part alone is not asked.
  shop.session.set_grounded("RISER", true, "ground");
  CHECK(shop.session.freedoms("RISER").freedoms.empty());
  CHECK(shop.mate(MateKind::Align, {"BAR", "h2"}, {"PLATE", "A4"}).refused);
}

TEST_CASE("angle, fix and seat hold what they say, and go by unmate") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", turned(0, {0, 0, 300}));
  shop.mate(MateKind::FaceOnFace, {"RISER", "bottom"}, {"PLATE", "top"});
  auto left = shop.session.freedoms("RISER").freedoms;
  CHECK(left.size() == 3);
  shop.place("T/block-40", "BLOCK", turned(0, {200, 0, 300}));
  MateRequest fix;
  fix.kind = MateKind::Fix;
  fix.moving.instance = "BLOCK";
  fix.fixed.instance = "RISER";
  CHECK_FALSE(shop.session.mate(fix, "fix").refused);
  CHECK(shop.session.freedoms("BLOCK").freedoms.size() == 3);

  MateRequest angle;
  angle.kind = MateKind::Angle;
  angle.moving = {"RISER", "right"};
  angle.fixed = {"BLOCK", "right"};
  angle.angle_rad = 1.0;
  CHECK(shop.session.mate(angle, "angle").refused);  // fixed to each other
  CHECK(shop.session.state().mates.size() == 2);
  shop.place("T/block-40", "OTHER", turned(0, {-200, 0, 300}));
  angle.moving = {"OTHER", "right"};
  CHECK_FALSE(shop.session.mate(angle, "angle").refused);
  const auto right = shop.session.feature({"OTHER", "right"}).direction_W();
  CHECK(right.dot(Eigen::Vector3d::UnitX()) == Approx(std::cos(1.0)).margin(1e-12));

  // All of it is in the file and comes back.
  shop.session.save(shop.folder / "a.dwp");
  const dowel::ProjectState state = shop.session.state();
  const std::vector<std::uint32_t> all{1, 2, 3};
  shop.session.unmate(all, "unmate");
  CHECK(shop.session.state().mates.empty());
  CHECK(shop.session.freedoms("BLOCK").freedoms.size() == 6);
  shop.session.undo(1);
  CHECK(shop.session.state() == state);
  CHECK(shop.session.project().replay() == state);
}

TEST_CASE("a key in a slot slides along it and nothing else") {
  Workshop shop;
  shop.session.set_mode(dowel::CheckMode::Off, "off");
  shop.place("T/rail", "RAIL", turned(30, {0, 0, 500}));
  shop.session.set_grounded("RAIL", true, "ground");
  shop.place("T/key", "KEY", turned(190, {50, 20, 700}));
  REQUIRE_FALSE(shop.mate(MateKind::KeyInSlot, {"KEY", "bottom"}, {"RAIL", "slot1"}).refused);
  const auto left = shop.session.freedoms("KEY").freedoms;
  REQUIRE(left.size() == 1);
  CHECK(left[0].kind == Freedom::Kind::Slide);
  const Eigen::Vector3d run(std::cos(std::numbers::pi / 6), 0.5, 0);
  CHECK((left[0].axis_W - run).norm() < 1e-9);
  // On the floor, in the middle, where it is along the slot, turned least: by 20 degrees back.
  const Pose X = shop.session.instance("KEY").X_WI;
  CHECK(X.translation().z() == Approx(538.0).margin(testing::kExact_mm));
  CHECK(std::abs(X.translation().cross(run).z()) < testing::kExact_mm);
  CHECK((X.rotation() * Eigen::Vector3d::UnitX()).dot(run) == Approx(-1.0));
  CHECK(shop.session.project().replay() == shop.session.state());
}

TEST_CASE("a project of version 1 opens, and is one of this version after that", "[golden]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "old.dwp";
  Project::create(file);
  {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TABLE mate_target; PRAGMA user_version = 1");
  }
  CHECK(Project::open(file).state().instances.empty());
  SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
  CHECK(database.execAndGet("PRAGMA user_version").getInt() == 2);
  CHECK(database.tableExists("mate_target"));
}

TEST_CASE("targets of mates that are not there, or no poses, are damage", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  Project::create(file);
  const auto code_after = [&](const std::string& sql) {
    {
      SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
      database.exec("PRAGMA foreign_keys = OFF");
      database.exec(sql);
    }
    try {
      Project::open(file);
    } catch (const Error& error) {
      return error.code();
    }
    return dowel::ErrorCode::NotFound;
  };
  CHECK(code_after("INSERT INTO mate_target (mate, angle_rad) VALUES (7, 0.5)") ==
        dowel::ErrorCode::FileMalformed);
}

TEST_CASE("requests that make no sense name what was expected") {
  Workshop shop;
  shop.place("T/bar-100", "BAR", turned(0, {0, 0, 200}));
  CHECK_THROWS_AS(shop.mate({}, {"PLATE", "B2"}, {"BAR", "h1"}), Error);  // grounded
  CHECK_THROWS_AS(shop.mate({}, {"BAR", "h1"}, {"BAR", "h2"}), Error);
  CHECK_THROWS_AS(shop.mate(MateKind::Align, {"BAR", "top"}, {"PLATE", "B2"}), Error);
  CHECK_THROWS_AS(shop.mate(MateKind::KeyInSlot, {"BAR", "bottom"}, {"PLATE", "top"}), Error);
  CHECK_THROWS_AS(shop.mate(MateKind::FaceOnFace, {"BAR", "h1"}, {"PLATE", "B1"}), Error);
  shop.place("T/bolt-20", "BOLT", turned(0, {0, 0, 400}));
  CHECK_THROWS_WITH(shop.mate(MateKind::Align, {"BOLT", "pin1"}, {"PLATE", "B2"}),
                    Catch::Contains("20 mm") && Catch::Contains("12 mm wide"));
  CHECK(shop.session.state().mates.empty());
}
