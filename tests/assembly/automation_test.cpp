#include "dowel/assembly/automation.h"

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"

using dowel::Catalog;
using dowel::Error;
using dowel::fasten;
using dowel::MoveReport;
using dowel::plan_fastening;
using dowel::plan_stack;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectElement;
using dowel::Session;
using dowel::stack;
namespace testing = dowel::testing;

namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

ProjectElement spacer(int height) {
  const double height_mm = height;
  testing::DrilledHole hole;
  hole.radius_mm = 6.5;
  return testing::element_of(
      "T/spacer-" + std::to_string(height),
      testing::plate_with_holes({38, 38, height_mm}, {hole}, 24),
      {testing::hole_feature("h1", {0, 0, height_mm}, -kUp, {{13.0, height_mm}}, true),
       testing::face_feature("top", {0, 0, height_mm}, kUp, 1300),
       testing::face_feature("bottom", {0, 0, 0}, -kUp, 1300)});
}

/// Under the head at z = 0, the thread down.
ProjectElement screw(int length) {
  const double length_mm = length;
  auto solid = testing::stepped_pin({{6.0, length_mm}, {9.0, 12.0}}, 24);
  return testing::element_of(
      "T/screw-M12x" + std::to_string(length), std::move(solid),
      {testing::shaft_feature("pin1", {0, 0, length_mm}, -kUp, 12.0, length_mm),
       testing::shaft_feature("pin2", {0, 0, length_mm + 12}, -kUp, 18.0, 12.0),
       testing::face_feature("bottom", {0, 0, 0}, -kUp, 110)});
}

ProjectElement ring(const std::string& name, double outer_mm, double bore_mm, double height_mm) {
  testing::DrilledHole hole;
  hole.radius_mm = bore_mm / 2;
  return testing::element_of(
      name, testing::plate_with_holes({outer_mm, outer_mm, height_mm}, {hole}, 24),
      {testing::hole_feature("h1", {0, 0, height_mm}, -kUp, {{bore_mm, height_mm}}, true),
       testing::face_feature("top", {0, 0, height_mm}, kUp, 100),
       testing::face_feature("bottom", {0, 0, 0}, -kUp, 100)});
}

struct Workshop {
  testing::TemporaryFolder folder;
  Session session{Project()};

  Workshop() {
    testing::write_fixture_catalog(folder / "catalog.db");
    {
      Catalog catalog(folder / "catalog.db", Catalog::Access::ReadWrite);
      for (const ProjectElement& element :
           {spacer(10), spacer(20), spacer(40), screw(45), screw(70), screw(80), screw(100),
            ring("T/washer-M12", 24, 13, 2.5), ring("T/nut-M12", 18, 10.106, 10.8)}) {
        dowel::SourceRecord source;
        source.path = element.element.source;
        source.status = "ok";
        const std::vector<dowel::ElementRecord> records{{element.element, *element.solid, {}}};
        catalog.put(source, records);
      }
    }
    session.use_catalog(
        std::make_shared<const Catalog>(folder / "catalog.db", Catalog::Access::ReadOnly));
    session.place("T/plate-5x3", "PLATE", Pose(), "place");
    session.set_grounded("PLATE", true, "ground");
  }

  double top_of(const std::string& name) { return session.feature({name, "top"}).origin_W().z(); }
};

}  // namespace

TEST_CASE("a stack stands on its hole, mated piece by piece, and is one command") {
  Workshop shop;
  const auto plan = plan_stack(shop.session, 70, {"PLATE", "B2"});
  REQUIRE(plan.ways.size() >= 2);
  CHECK(plan.ways[0].size() == 3);  // 40 + 20 + 10
  const auto would = stack(shop.session, plan, 0, std::nullopt);
  CHECK(would.size() == 3);
  CHECK(shop.session.state().instances.size() == 1);
  const auto reports = stack(shop.session, plan, 0, "stack");
  for (const MoveReport& report : reports) CHECK_FALSE(report.refused);
  CHECK(shop.session.state().instances.size() == 4);
  CHECK(shop.session.state().mates.size() == 3);
  CHECK(shop.top_of(reports[2].instance) == Approx(110.0).margin(testing::kExact_mm));
  CHECK(shop.session.freedoms(reports[0].instance).freedoms.size() == 1);
  CHECK(dowel::worst(shop.session.check_all()) == dowel::Verdict::Contact);
  shop.session.undo(1);
  CHECK(shop.session.state().instances.size() == 1);
  CHECK(shop.session.state().mates.empty());
  CHECK_THROWS_WITH(plan_stack(shop.session, 73, {"PLATE", "B2"}), Catch::Contains("10, 20, 40"));
  CHECK_THROWS_AS(plan_stack(shop.session, 70, {"PLATE", "top"}), Error);
}

TEST_CASE("a stack that is in the way of something is refused as a whole") {
  Workshop shop;
  shop.session.place("T/block-40", "BLOCK", Pose::from_translation({-40, 0, 120}), "place");
  const auto before = shop.session.state();
  const auto plan = plan_stack(shop.session, 70, {"PLATE", "B2"});
  const auto reports = stack(shop.session, plan, 0, "stack");
  for (const MoveReport& report : reports) CHECK(report.refused);
  CHECK(shop.session.state() == before);
}

TEST_CASE("a screw is chosen for what it goes through, with a washer on a face") {
  Workshop shop;
  shop.session.place_at("T/riser-60x60x40", "RISER", Pose::from_translation({0, 0, 40}),
                        {"PLATE", "B3"}, "place");
  const auto plan = plan_fastening(shop.session, {"RISER", "h1"});
  // 2.5 + 40 + 15 to the thread and 12 in it: 69.5; the thread ends at 82.5, less 1.75.
  REQUIRE(plan.ways.size() == 2);
  CHECK(plan.ways[0].screw.element == "T/screw-M12x70");
  CHECK(plan.ways[1].screw.element == "T/screw-M12x80");
  CHECK(plan.ways[0].engagement_mm == Approx(12.5));
  CHECK(plan.ways[0].spare_mm == Approx(12.5));
  CHECK(plan.holes.at(plan.ways[0].thread).text() == "PLATE.B3");
  const auto reports = fasten(shop.session, plan, 0, "fasten");
  REQUIRE(reports.size() == 2);
  for (const MoveReport& report : reports) {
    INFO((report.touches.empty() ? std::string() : report.touches[0].with));
    CHECK_FALSE(report.refused);
  }
  CHECK(dowel::worst(shop.session.check_all()) == dowel::Verdict::Contact);
  CHECK(shop.session.state().mates.size() == 3);
  // The head stands on the washer.
  const auto head = shop.session.feature({reports[1].instance, "pin1"});
  CHECK(head.origin_W().z() == Approx(82.5).margin(testing::kExact_mm));
}

TEST_CASE("a nut goes behind where nothing has a thread, or the numbers are told") {
  Workshop shop;
  shop.session.place("T/riser-60x60x40", "RISER", Pose::from_translation({500, 0, 40}), "place");
  // 2.5 + 40 + 10.8 + 1.75 to 2.5 + 40 + 10.8 + 10.5: there is no such screw.
  CHECK_THROWS_WITH(plan_fastening(shop.session, {"RISER", "h1"}),
                    Catch::Contains("55.05") && Catch::Contains("63.8"));
  shop.session.place_at("T/spacer-10", "SPACER", Pose::from_translation({500, 0, 80}),
                        {"RISER", "h1"}, "place");
  const auto plan = plan_fastening(shop.session, {"SPACER", "h1"});
  REQUIRE_FALSE(plan.ways.empty());
  CHECK(plan.ways[0].screw.element == "T/screw-M12x70");
  const auto reports = fasten(shop.session, plan, 0, "fasten");
  REQUIRE(reports.size() == 3);
  for (const MoveReport& report : reports) CHECK_FALSE(report.refused);
  // The nut hangs below the riser: its face towards it is at z = 40.
  const auto nut = shop.session.instance(reports[2].instance);
  CHECK(nut.element == "T/nut-M12");
  const double high_mm = std::max(shop.session.feature({nut.name, "top"}).origin_W().z(),
                                  shop.session.feature({nut.name, "bottom"}).origin_W().z());
  CHECK(high_mm == Approx(40.0).margin(testing::kExact_mm));
  CHECK(dowel::worst(shop.session.check_all()) == dowel::Verdict::Contact);
}
