#include "dowel/assembly/snap.h"

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "random_geometry.h"
#include "workshop.h"

using dowel::FeatureMatch;
using dowel::MateKind;
using dowel::Pose;
using dowel::SnapOffer;
using dowel::Verdict;
using dowel::testing::kExact_mm;
using dowel::testing::RandomGeometry;
using dowel::testing::Workshop;
using Eigen::Vector3d;

TEST_CASE("a pin near a bore is offered that bore first, and goes in exactly") {
  Workshop shop;
  // Its goal is at z = 25, standing on the step of B3.
  const Pose X_WI(Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Vector3d::UnitX())), {3, -2, 29});
  shop.session.set_mode(dowel::CheckMode::Off, "mode off");
  shop.session.place("T/pin-12", "PIN", X_WI, "place");
  shop.session.set_mode(dowel::CheckMode::Block, "mode block");
  const auto offers = dowel::snap_offers(shop.session, "PIN", {});
  REQUIRE_FALSE(offers.empty());
  const SnapOffer& best = offers.front();
  CHECK(best.match == FeatureMatch::Fit);
  REQUIRE(best.clearance_mm);
  CHECK(*best.clearance_mm == Approx(0.02));
  REQUIRE(best.mates.size() == 1);
  CHECK(best.mates.front().moving.text() == "PIN.pin1");
  CHECK(best.mates.front().fixed.text() == "PLATE.B3");
  CHECK(best.turn_rad == Approx(0.05));
  CHECK((best.X_WI.translation() - Vector3d(0, 0, 25)).norm() < kExact_mm);

  const auto report = shop.session.put("PIN", best.X_WI, best.mates, "snap");
  CHECK_FALSE(report.refused);
  CHECK(report.verdict == Verdict::Contact);
  CHECK(shop.session.state().mates.size() == 1);
  CHECK(shop.session.undo(1).size() == 1);
  CHECK(shop.session.state().mates.empty());
}

TEST_CASE("what is too thick or too far is not offered") {
  Workshop shop;
  shop.place("T/bolt-20", "BOLT", {0, 0, 45});
  for (const SnapOffer& offer : dowel::snap_offers(shop.session, "BOLT", {})) {
    CHECK(offer.match == FeatureMatch::Seat);
  }
  shop.place("T/pin-12", "PIN", {0, 0, 200});
  CHECK(dowel::snap_offers(shop.session, "PIN", {}).empty());
  CHECK_FALSE(dowel::snap_offers(shop.session, "PIN", {.reach_mm = 200.0}).empty());
}

TEST_CASE("the index offers what trying everything does") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {0, 0, 140});
  shop.insert({"RISER", "h1"}, {"PLATE", "B3"});
  shop.stand_block("BLOCK", -80, 30);
  shop.session.set_mode(dowel::CheckMode::Off, "mode off");
  RandomGeometry random(11);
  std::size_t offered = 0;
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const char* const element = std::array{"T/pin-12", "T/screw-M12x65", "T/riser-60x60x40",
                                           "T/block-40"}[static_cast<std::size_t>(round % 4)];
    const Pose X_WI(
        Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(-0.3, 0.3), random.direction())),
        random.point(60.0) + Vector3d(0, 0, 50));
    shop.session.place(element, "PART", X_WI, "place");
    const dowel::SnapReach reach{.reach_mm = random.uniform(5.0, 70.0)};
    const auto offers = dowel::snap_offers(shop.session, "PART", reach);
    const auto all = dowel::snap_offers_brute_force(shop.session, "PART", reach);
    REQUIRE(offers.size() == all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      REQUIRE(offers[i].X_WI == all[i].X_WI);
      REQUIRE(offers[i].mates == all[i].mates);
    }
    offered += offers.size();
    shop.session.remove("PART", "remove");
  }
  CHECK(offered > 60);
}

TEST_CASE("a riser with two holes near its pattern is turned onto it") {
  Workshop shop;
  // A plate of holes over another: 15 on 15, off by a little and turned by a little.
  shop.session.place(
      "T/plate-5x3", "UPPER",
      Pose(Eigen::Quaterniond(Eigen::AngleAxisd(0.02, Vector3d::UnitZ())), {2, 1, 45}), "place");
  const auto offers = dowel::snap_offers(shop.session, "UPPER", {.reach_mm = 10.0});
  REQUIRE_FALSE(offers.empty());
  CHECK(offers.front().mates.size() == 2);
  CHECK((offers.front().X_WI.translation() - Vector3d(0, 0, 40)).norm() < 1e-6);
  CHECK(offers.front().X_WI.rotation().angularDistance(Eigen::Quaterniond::Identity()) < 1e-9);
  CHECK_FALSE(shop.session.put("UPPER", offers.front().X_WI, offers.front().mates, "snap").refused);
  CHECK(shop.session.freedoms("UPPER").freedoms.empty());
}

TEST_CASE("where an element can go is every free hole that it fits") {
  Workshop shop;
  CHECK(dowel::places_for(shop.session, "T/pin-12").size() == 15);
  shop.stand_block("BLOCK", 0, 0);  // over B3 alone
  const auto places = dowel::places_for(shop.session, "T/pin-12");
  CHECK(places.size() == 14);
  for (const SnapOffer& place : places) {
    CHECK(place.mates.front().fixed.feature != "B3");
    CHECK(place.verdict == Verdict::Contact);
  }
  CHECK(dowel::places_for(shop.session, "T/bolt-20").empty());
  // 60 wide over holes 40 apart: 13 mm through the one hole on each of the 14 others would meet the
  // block where it stands next to it.
  const auto risers = dowel::places_for(shop.session, "T/riser-60x60x40");
  for (const SnapOffer& place : risers) {
    const Vector3d off = place.X_WI.translation();
    CHECK((std::abs(off.x()) >= 50.0 - 1e-6 || std::abs(off.y()) >= 50.0 - 1e-6));
  }
  CHECK(risers.size() == 6);  // columns 1 and 5
}

TEST_CASE("parts that stand mated are recognised, without what adds nothing") {
  Workshop shop;
  shop.place("T/riser-60x60x40", "RISER", {40, 0, 40});
  shop.place("T/screw-M12x65", "SCREW", {40, 0, 15});
  const std::vector<dowel::Mate> found = dowel::recognise_mates(shop.session);
  const auto has = [&](MateKind kind, const char* moving, const char* fixed) {
    return std::ranges::any_of(found, [&](const dowel::Mate& mate) {
      return mate.kind == kind && mate.moving.text() == moving && mate.fixed.text() == fixed;
    });
  };
  CHECK(has(MateKind::FaceOnFace, "RISER.bottom", "PLATE.top"));
  CHECK(has(MateKind::Align, "RISER.h1", "PLATE.B4"));
  CHECK(has(MateKind::FaceOnFace, "SCREW.seat", "RISER.top"));
  CHECK(has(MateKind::Align, "SCREW.pin1", "RISER.h1"));
  CHECK(has(MateKind::Align, "SCREW.pin1", "PLATE.B4"));
  CHECK(found.size() == 5);

  const auto made = shop.session.adopt(found, "recognise");
  CHECK(made.size() == 4);  // screw in riser and riser on the hole leave nothing to screw in plate
  const auto freedoms = shop.session.freedoms("SCREW").freedoms;
  REQUIRE(freedoms.size() == 1);
  CHECK(freedoms.front().kind == dowel::Freedom::Kind::Turn);
  CHECK(dowel::recognise_mates(shop.session).size() == 1);
  CHECK((shop.where("SCREW") - Vector3d(40, 0, 15)).norm() == 0.0);
  dowel::Mate wrong = found.front();
  wrong.fixed = {"PLATE", "bottom"};
  CHECK_THROWS_AS(shop.session.adopt(std::vector<dowel::Mate>{wrong}, "recognise"), dowel::Error);
}
