#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "slot_features.h"

using namespace dowel;
using namespace dowel::testing;
using End = SlotShape::End;
using Type = SlotShape::Type;

TEST_CASE("a groove through a block is one slot with its sizes") {
  const auto [width_mm, depth_mm] = GENERATE(std::pair(12.0, 8.0), std::pair(3.2, 1.5),
                                             std::pair(50.0, 25.0), std::pair(4.0, 20.0));
  CAPTURE(width_mm, depth_mm);
  const std::vector<Feature> slots = slots_of(grooved_block(width_mm, depth_mm));
  REQUIRE(slots.size() == 1);
  CHECK(slots[0].name == "slot1");
  check_slot(slots[0], {.origin = {50.0, 30.0, 30.0},
                        .width_mm = width_mm,
                        .depth_mm = depth_mm,
                        .length_mm = 100.0});
}

TEST_CASE("a groove that ends in a wall is open at one end only") {
  const FacetedSolid solid =
      testing::carved(plate(100.0, 60.0, 30.0), {{{30.0, 24.0, 22.0}, {101.0, 36.0, 31.0}}});
  const std::vector<Feature> slots = slots_of(solid);
  REQUIRE(slots.size() == 1);
  check_slot(slots[0], {.origin = {65.0, 30.0, 30.0},
                        .width_mm = 12.0,
                        .depth_mm = 8.0,
                        .length_mm = 70.0,
                        .ends = {End::Flat, End::Open}});
}

TEST_CASE("a pocket with four walls is a slot where it is much longer than wide") {
  const auto pocket = [](double length_mm) {
    return slots_of(testing::carved(plate(100.0, 60.0, 30.0),
                                    {{{10.0, 24.0, 22.0}, {10.0 + length_mm, 36.0, 31.0}}}));
  };
  const std::vector<Feature> slots = pocket(40.0);
  REQUIRE(slots.size() == 1);
  check_slot(slots[0], {.origin = {30.0, 30.0, 30.0},
                        .width_mm = 12.0,
                        .depth_mm = 8.0,
                        .length_mm = 40.0,
                        .ends = {End::Flat, End::Flat}});
  CHECK(slots[0].entry == "top");
  CHECK(pocket(12.0).empty());
  CHECK(pocket(16.0).empty());
}

TEST_CASE("a pocket with round ends is one slot over its whole length") {
  const auto [width_mm, length_mm] =
      GENERATE(std::pair(10.0, 40.0), std::pair(16.0, 20.0), std::pair(3.0, 60.0));
  const std::vector<Feature> features =
      recognise_features(testing::oblong_plate({100.0, 60.0, 20.0}, width_mm, length_mm, 7.0));
  CHECK(std::none_of(features.begin(), features.end(),
                     [](const Feature& f) { return f.kind == FeatureKind::Hole; }));
  REQUIRE(features.back().kind == FeatureKind::Slot);
  check_slot(features.back(), {.origin = {0.0, 0.0, 20.0},
                               .width_mm = width_mm,
                               .depth_mm = 7.0,
                               .length_mm = length_mm,
                               .ends = {End::Round, End::Round}});
  CHECK(features.back().entry == "top");
  CHECK(features.back().name == "slot1");
}

TEST_CASE("a slotted hole is one slot through the plate") {
  const auto [width_mm, length_mm] =
      GENERATE(std::pair(13.5, 40.0), std::pair(18.0, 24.0), std::pair(5.0, 80.0));
  const std::vector<Feature> slots =
      slots_of(testing::oblong_plate({100.0, 60.0, 20.0}, width_mm, length_mm, 0.0));
  REQUIRE(slots.size() == 1);
  check_slot(slots[0], {.type = Type::Through,
                        .origin = {0.0, 0.0, 20.0},
                        .width_mm = width_mm,
                        .depth_mm = 20.0,
                        .length_mm = length_mm,
                        .ends = {End::Round, End::Round}});
  CHECK(slots[0].entry == "top");
}

TEST_CASE("T-slots carry their ISO 299 size, throat and undercut") {
  struct Size {
    std::uint32_t nominal_mm;
    testing::TeeOutline outline;
  };
  const auto [nominal_mm, outline] =
      GENERATE(Size{8, {8.0, 15.0, 7.5, 16.0}}, Size{10, {10.0, 17.0, 7.5, 19.0}},
               Size{12, {12.0, 20.0, 8.5, 22.0}}, Size{14, {14.0, 24.0, 10.0, 25.0}},
               Size{18, {18.0, 31.0, 13.0, 33.0}}, Size{22, {22.0, 38.0, 17.0, 40.0}},
               Size{28, {28.0, 48.0, 21.0, 52.0}}, Size{14, {14.18, 24.0, 10.0, 25.0}},
               Size{0, {14.3, 24.0, 10.0, 25.0}}, Size{0, {13.9, 24.0, 10.0, 25.0}},
               Size{0, {16.0, 26.0, 10.0, 25.0}});
  CAPTURE(nominal_mm, outline.throat_mm);
  const std::vector<Feature> slots =
      slots_of(testing::tee_bar(320.0, 60.0, 300.0, outline, {80.0, 160.0, 240.0}));
  REQUIRE(slots.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(slots[i].name == "slot" + std::to_string(i + 1));
    check_slot(slots[i], {.type = Type::Tee,
                          .origin = {80.0 * static_cast<double>(i + 1), 60.0, 150.0},
                          .direction = {0.0, -1.0, 0.0},
                          .run = {0.0, 0.0, 1.0},
                          .width_mm = outline.throat_mm,
                          .depth_mm = outline.depth_mm,
                          .length_mm = 300.0});
    const SlotShape& slot = *slots[i].slot;
    CHECK(slot.nominal_mm == nominal_mm);
    CHECK(slot.undercut_width_mm == Approx(outline.undercut_mm).margin(kSame_mm));
    CHECK(slot.undercut_height_mm == Approx(outline.undercut_height_mm).margin(kSame_mm));
    CHECK(slot.throat_depth_mm ==
          Approx(outline.depth_mm - outline.undercut_height_mm).margin(kSame_mm));
  }
}

TEST_CASE("crossing grooves are two slots, however deep they are") {
  const std::vector<Feature> level = slots_of(cross_of_grooves());
  REQUIRE(level.size() == 2);
  check_slot(level[0], {.origin = {45.0, 30.0, 30.0},
                        .run = {0.0, 1.0, 0.0},
                        .width_mm = 10.0,
                        .depth_mm = 8.0,
                        .length_mm = 60.0});
  check_slot(level[1],
             {.origin = {50.0, 30.0, 30.0}, .width_mm = 12.0, .depth_mm = 8.0, .length_mm = 100.0});

  const std::vector<Feature> stepped = slots_of(testing::carved(
      plate(100.0, 60.0, 30.0),
      {{{-1.0, 24.0, 22.0}, {101.0, 36.0, 31.0}}, {{40.0, -1.0, 12.0}, {50.0, 61.0, 31.0}}}));
  REQUIRE(stepped.size() == 2);
  CHECK(stepped[0].depth_mm == 18.0);
  CHECK(stepped[0].slot->length_mm == 60.0);
  CHECK(stepped[1].depth_mm == 8.0);
  CHECK(stepped[1].slot->length_mm == 100.0);
}

TEST_CASE("a plate with a lattice of grooves has one slot a groove") {
  std::vector<Block> grooves;
  for (const double at : {20.0, 80.0, 140.0, 200.0}) {
    grooves.push_back({{-1.0, at, 40.0}, {241.0, at + 12.0, 61.0}});
    grooves.push_back({{at, -1.0, 40.0}, {at + 12.0, 241.0, 61.0}});
  }
  const std::vector<Feature> slots = slots_of(testing::carved(plate(240.0, 240.0, 60.0), grooves));
  REQUIRE(slots.size() == 8);
  for (const Feature& slot : slots) {
    CHECK(slot.diameter_mm == 12.0);
    CHECK(slot.depth_mm == 20.0);
    CHECK(slot.slot->length_mm == 240.0);
  }
}

TEST_CASE("crossing T-slots are two slots") {
  const auto tee = [](double low, bool along_x) {
    const auto block = [&](double from, double to, double bottom, double top) {
      return along_x ? Block{{-1.0, from, bottom}, {201.0, to, top}}
                     : Block{{from, -1.0, bottom}, {to, 201.0, top}};
    };
    return std::array{block(low + 5.0, low + 19.0, 35.0, 61.0), block(low, low + 24.0, 35.0, 45.0)};
  };
  std::vector<Block> removed;
  for (const bool along_x : {true, false}) {
    for (const Block& block : tee(80.0, along_x)) removed.push_back(block);
  }
  const std::vector<Feature> slots = slots_of(testing::carved(plate(200.0, 200.0, 60.0), removed));
  REQUIRE(slots.size() == 2);
  for (const Feature& slot : slots) {
    CHECK(slot.slot->type == Type::Tee);
    CHECK(slot.slot->nominal_mm == 14);
    CHECK(slot.slot->length_mm == 200.0);
    CHECK(slot.depth_mm == 25.0);
  }
}

TEST_CASE("what cuts the walls of a slot does not cut the slot") {
  SECTION("a pit that is wider than the slot") {
    const std::vector<Feature> slots = slots_of(testing::carved(
        plate(100.0, 60.0, 30.0),
        {{{-1.0, 24.0, 22.0}, {101.0, 36.0, 31.0}}, {{30.0, 20.0, 10.0}, {50.0, 40.0, 31.0}}}));
    REQUIRE(slots.size() == 1);
    check_slot(
        slots[0],
        {.origin = {50.0, 30.0, 30.0}, .width_mm = 12.0, .depth_mm = 8.0, .length_mm = 100.0});
  }
  SECTION("a hole through one wall, below the top") {
    const std::vector<Feature> slots = slots_of(testing::carved(
        plate(100.0, 60.0, 30.0),
        {{{-1.0, 24.0, 18.0}, {101.0, 36.0, 31.0}}, {{20.0, -1.0, 20.0}, {26.0, 30.0, 26.0}}}));
    REQUIRE(slots.size() == 1);
    CHECK(slots[0].slot->length_mm == 100.0);
    CHECK(slots[0].depth_mm == 12.0);
  }
  SECTION("a groove into one wall") {
    const std::vector<Feature> slots = slots_of(testing::carved(
        plate(100.0, 60.0, 30.0),
        {{{-1.0, 24.0, 22.0}, {101.0, 36.0, 31.0}}, {{40.0, -1.0, 22.0}, {50.0, 30.0, 31.0}}}));
    REQUIRE(slots.size() == 2);
    CHECK(slots[0].slot->length_mm == 24.0);
    CHECK(slots[1].slot->length_mm == 100.0);
  }
  SECTION("holes through floor and top") {
    // A T-slot from above, its floor drilled through by a square hole.
    const std::vector<Feature> slots = slots_of(
        testing::carved(plate(100.0, 60.0, 40.0), {{{-1.0, 23.0, 15.0}, {101.0, 37.0, 41.0}},
                                                   {{-1.0, 18.0, 15.0}, {101.0, 42.0, 25.0}},
                                                   {{40.0, 20.0, -1.0}, {60.0, 40.0, 41.0}}}));
    REQUIRE(slots.size() == 1);
    CHECK(slots[0].slot->type == Type::Tee);
    CHECK(slots[0].slot->length_mm == 100.0);
  }
}

TEST_CASE("two pockets in line are two slots") {
  const std::vector<Feature> slots = slots_of(testing::carved(
      plate(100.0, 60.0, 30.0),
      {{{10.0, 24.0, 22.0}, {40.0, 36.0, 31.0}}, {{45.0, 24.0, 22.0}, {80.0, 36.0, 31.0}}}));
  REQUIRE(slots.size() == 2);
  CHECK(slots[0].slot->length_mm == 30.0);
  CHECK(slots[1].slot->length_mm == 35.0);
}

TEST_CASE("a stepped groove is a wide slot with a narrow one in its floor") {
  const std::vector<Feature> slots = slots_of(testing::carved(
      plate(100.0, 60.0, 30.0),
      {{{-1.0, 20.0, 22.0}, {101.0, 40.0, 31.0}}, {{-1.0, 26.0, 12.0}, {101.0, 34.0, 31.0}}}));
  REQUIRE(slots.size() == 2);
  CHECK(slots[0].diameter_mm == 20.0);
  CHECK(slots[0].depth_mm == 8.0);
  CHECK(slots[1].diameter_mm == 8.0);
  CHECK(slots[1].depth_mm == 10.0);
}

TEST_CASE("a chamfered mouth is part of the depth") {
  const FacetedSolid solid = testing::prism({{0.0, 0.0},
                                             {60.0, 0.0},
                                             {60.0, 30.0},
                                             {37.0, 30.0},
                                             {36.0, 29.0},
                                             {36.0, 20.0},
                                             {24.0, 20.0},
                                             {24.0, 29.0},
                                             {23.0, 30.0},
                                             {0.0, 30.0}},
                                            80.0);
  const std::vector<Feature> slots = slots_of(solid);
  REQUIRE(slots.size() == 1);
  CHECK(slots[0].diameter_mm == 12.0);
  CHECK(slots[0].depth_mm == 10.0);
  CHECK(slots[0].origin.y() == 30.0);
}
