// Slots of solids that are moved, mirrored or written otherwise, and what is no slot.

#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "slot_features.h"
#include "variants.h"

using namespace dowel;
using namespace dowel::testing;

TEST_CASE("what is no slot is none") {
  SECTION("a step") {
    CHECK(slots_of(testing::carved(plate(100.0, 60.0, 30.0),
                                   {{{-1.0, 30.0, 20.0}, {101.0, 61.0, 31.0}}}))
              .empty());
  }
  SECTION("two steps") {
    CHECK(slots_of(testing::carved(plate(100.0, 60.0, 30.0),
                                   {{{-1.0, 40.0, 20.0}, {101.0, 61.0, 31.0}},
                                    {{-1.0, -1.0, 20.0}, {101.0, 20.0, 31.0}}}))
              .empty());
  }
  SECTION("a V-groove") {
    CHECK(slots_of(testing::prism({{0.0, 0.0},
                                   {60.0, 0.0},
                                   {60.0, 30.0},
                                   {40.0, 30.0},
                                   {30.0, 20.0},
                                   {20.0, 30.0},
                                   {0.0, 30.0}},
                                  80.0))
              .empty());
  }
  SECTION("a dovetail") {
    CHECK(slots_of(testing::prism({{0.0, 0.0},
                                   {60.0, 0.0},
                                   {60.0, 30.0},
                                   {38.0, 30.0},
                                   {44.0, 18.0},
                                   {16.0, 18.0},
                                   {22.0, 30.0},
                                   {0.0, 30.0}},
                                  80.0))
              .empty());
  }
  SECTION("holes of all kinds") {
    CHECK(slots_of(testing::plate_with_holes({120.0, 80.0, 30.0},
                                             {{-45.0, -20.0, 6.0},
                                              {-15.0, -20.0, 5.0, 18.0},
                                              {15.0, -20.0, 4.5, 0.0, 7.5, 8.0},
                                              {45.0, -20.0, 5.053, 25.0, 6.0, 15.0}},
                                             24))
              .empty());
  }
  SECTION("a tunnel and a closed cavity") {
    CHECK(slots_of(testing::carved(plate(100.0, 60.0, 30.0),
                                   {{{-1.0, 24.0, 10.0}, {101.0, 36.0, 20.0}}}))
              .empty());
    CHECK(slots_of(testing::hollowed(testing::box({100.0, 60.0, 30.0}),
                                     testing::box({60.0, 20.0, 10.0})))
              .empty());
  }
  SECTION("a shallow relief that is wider than long") {
    CHECK(slots_of(
              testing::carved(plate(40.0, 100.0, 30.0), {{{-1.0, 20.0, 28.0}, {41.0, 80.0, 31.0}}}))
              .empty());
  }
  SECTION("an L-shaped undercut on one side") {
    CHECK(slots_of(testing::prism({{0.0, 0.0},
                                   {60.0, 0.0},
                                   {60.0, 40.0},
                                   {37.0, 40.0},
                                   {37.0, 15.0},
                                   {18.0, 15.0},
                                   {18.0, 25.0},
                                   {23.0, 25.0},
                                   {23.0, 40.0},
                                   {0.0, 40.0}},
                                  80.0))
              .empty());
  }
  SECTION("a plain box, a pin and a ball") {
    CHECK(slots_of(testing::box({80.0, 40.0, 20.0})).empty());
    CHECK(slots_of(testing::stepped_pin({{10.0, 8.0}, {6.0, 20.0}}, 24)).empty());
    CHECK(slots_of(testing::sphere(10.0, 16)).empty());
  }
}

TEST_CASE("slots do not depend on pose, order, mirror or unit", "[property]") {
  const auto seed = GENERATE(range(0U, 6U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const std::vector<FacetedSolid> solids{
      grooved_block(),
      cross_of_grooves(),
      testing::oblong_plate({100.0, 60.0, 20.0}, 14.0, 50.0, 0.0, 8 + random.index(9)),
      testing::oblong_plate({100.0, 60.0, 20.0}, 14.0, 50.0, 6.0, 8 + random.index(9)),
      testing::tee_bar(200.0, 60.0, 300.0, tee_18(), {60.0, 140.0}),
      testing::carved(plate(100.0, 60.0, 30.0), {{{30.0, 24.0, 22.0}, {101.0, 36.0, 31.0}}})};
  for (const FacetedSolid& solid : solids) {
    const std::vector<Feature> slots = slots_of(solid);
    REQUIRE_FALSE(slots.empty());
    const Pose X_WB = random.pose(1000.0);
    check_moved(slots, slots_of(testing::transformed(X_WB, solid)), X_WB, 1.0e-8);

    const std::vector<Feature> reordered = slots_of(testing::shuffled(solid, random));
    REQUIRE(reordered.size() == slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i) {
      CHECK(reordered[i].name == slots[i].name);
      CHECK(reordered[i].origin == slots[i].origin);
      CHECK(reordered[i].direction == slots[i].direction);
      CHECK(reordered[i].diameter_mm == slots[i].diameter_mm);
      CHECK(reordered[i].depth_mm == slots[i].depth_mm);
      CHECK(reordered[i].entry == slots[i].entry);
      CHECK(*reordered[i].slot == *slots[i].slot);
    }

    const std::vector<Feature> mirror = slots_of(testing::mirrored(solid));
    REQUIRE(mirror.size() == slots.size());
    std::vector<double> lengths;
    std::vector<double> mirrored_lengths;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      lengths.push_back(slots[i].slot->length_mm + slots[i].depth_mm + slots[i].diameter_mm);
      mirrored_lengths.push_back(mirror[i].slot->length_mm + mirror[i].depth_mm +
                                 mirror[i].diameter_mm);
    }
    std::sort(lengths.begin(), lengths.end());
    std::sort(mirrored_lengths.begin(), mirrored_lengths.end());
    for (std::size_t i = 0; i < slots.size(); ++i) {
      CHECK(mirrored_lengths[i] == Approx(lengths[i]).margin(kSame_mm));
    }
  }
}

TEST_CASE("split and free-form faces change no slot") {
  const std::vector<FacetedSolid> solids{
      cross_of_grooves(), testing::oblong_plate({100.0, 60.0, 20.0}, 14.0, 50.0, 0.0, 16),
      testing::oblong_plate({100.0, 60.0, 20.0}, 14.0, 50.0, 6.0, 16),
      testing::tee_bar(200.0, 60.0, 300.0, tee_18(), {60.0, 140.0})};
  for (const FacetedSolid& solid : solids) {
    const std::vector<Feature> slots = slots_of(solid);
    REQUIRE_FALSE(slots.empty());
    check_moved(slots, slots_of(testing::with_split_faces(solid, 5.0)), Pose(), kSame_mm);
    check_moved(slots, slots_of(testing::with_split_faces(solid, 45.0)), Pose(), kSame_mm);
    check_moved(slots, slots_of(testing::without_surfaces(solid)), Pose(), 1.0e-6);
  }
}

TEST_CASE("planes in many pieces are one face each, also where a solid has nothing but planes") {
  const FacetedSolid solid = cross_of_grooves();
  const std::vector<Feature> slots = slots_of(solid);
  REQUIRE_FALSE(slots.empty());
  const FacetedSolid pieces = testing::in_triangles(solid);
  check_moved(slots, slots_of(pieces), Pose(), kSame_mm);
  const auto count_faces = [](const FacetedSolid& of) {
    const std::vector<Feature> features = recognise_features(of);
    return std::count_if(features.begin(), features.end(),
                         [](const Feature& f) { return f.kind == FeatureKind::Face; });
  };
  CHECK(count_faces(pieces) == count_faces(solid));
}

TEST_CASE("triangle tags and the other features are not those of slots") {
  const FacetedSolid solid = grooved_block();
  const std::vector<Feature> features = recognise_features(solid);
  const std::vector<FacetClass> classes = classify_faces(solid, features);
  CHECK(std::all_of(classes.begin(), classes.end(),
                    [](FacetClass c) { return c == FacetClass::Plane; }));
  CHECK(features.back().name == "slot1");
  CHECK(std::count_if(features.begin(), features.end(),
                      [](const Feature& f) { return f.kind == FeatureKind::Face; }) == 10);
}
