#include "dowel/assembly/fastening.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "dowel/assembly/thread.h"
#include "fixture_elements.h"
#include "random_geometry.h"

using dowel::BoreStretch;
using dowel::choose_fastening;
using dowel::Fastener;
using dowel::fastener_of;
namespace testing = dowel::testing;

namespace {

Fastener screw(double nominal_mm, double length_mm) {
  Fastener result;
  result.element = "screw-M" + std::to_string(static_cast<int>(nominal_mm)) + "x" +
                   std::to_string(static_cast<int>(length_mm));
  result.nominal_mm = nominal_mm;
  result.length_mm = length_mm;
  result.thread_end_mm = length_mm - 0.875;
  result.head_diameter_mm = 1.5 * nominal_mm;
  return result;
}

Fastener ring(Fastener::Kind kind, double nominal_mm, double height_mm) {
  Fastener result;
  result.kind = kind;
  result.element = kind == Fastener::Kind::Nut ? "nut" : "washer";
  result.nominal_mm = nominal_mm;
  result.length_mm = height_mm;
  return result;
}

/// Lengths of ISO 888 as ISO 4762 has them for M12, and some of M10.
std::vector<Fastener> box_of_screws() {
  std::vector<Fastener> box;
  for (const int length : {20, 25, 30, 35, 40, 45, 50, 55, 60, 70, 80, 90, 100, 110, 120, 150}) {
    box.push_back(screw(12, length));
  }
  for (const int length : {25, 30, 40, 50, 60}) box.push_back(screw(10, length));
  box.push_back(ring(Fastener::Kind::Washer, 12, 2.5));
  box.push_back(ring(Fastener::Kind::Nut, 12, 10.8));
  box.push_back(ring(Fastener::Kind::Nut, 10, 8.4));
  return box;
}

/// The plate of the system, 40 thick, below `grip_mm`: 12 mm bore 15 deep over an M12 thread.
std::vector<BoreStretch> on_plate(double grip_mm) {
  return {{0, grip_mm, 13.5, 0},
          {grip_mm, grip_mm + 15, 12.0, 1},
          {grip_mm + 15, grip_mm + 40, 10.106, 1}};
}

}  // namespace

TEST_CASE("screws are those of the system's own table: risers and vee blocks") {
  // Element, its grip, the screw M12 that its table names.
  struct Row {
    double grip_mm;
    double length_mm;
  };
  for (const Row& row : {Row{27, 55}, Row{67, 100}, Row{72, 100}, Row{12, 40}, Row{17, 45},
                         Row{11, 40}, Row{25, 55}, Row{38, 70}}) {
    CAPTURE(row.grip_mm);
    const auto choices = choose_fastening(on_plate(row.grip_mm), box_of_screws(), {});
    REQUIRE_FALSE(choices.ways.empty());
    CHECK(choices.ways[0].screw.length_mm == row.length_mm);
    CHECK(choices.ways[0].grip_mm == row.grip_mm + 15);
    CHECK(choices.ways[0].thread == 1);
    CHECK_FALSE(choices.ways[0].nut);
  }
}

TEST_CASE("every screw that holds and does not bottom is offered, and no other", "[property]") {
  const unsigned seed = GENERATE(range(0U, 200U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const double grip_mm = random.uniform(5, 90);
  const double depth_mm = random.uniform(8, 50);
  const std::vector<BoreStretch> bore{{0, grip_mm, 13.5, 0},
                                      {grip_mm, grip_mm + depth_mm, 10.2, 3}};
  const auto choices = choose_fastening(bore, box_of_screws(), {});
  std::vector<double> expected;
  for (const Fastener& candidate : box_of_screws()) {
    if (candidate.kind != Fastener::Kind::Screw || candidate.nominal_mm != 12) continue;
    const bool holds = candidate.thread_end_mm - grip_mm >= 12.0;
    const bool is_free = candidate.length_mm <= grip_mm + depth_mm - 1.75;
    if (holds && is_free) expected.push_back(candidate.length_mm);
  }
  REQUIRE(choices.ways.size() == expected.size());
  CHECK(choices.reason.empty() == !expected.empty());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(choices.ways[i].screw.length_mm == expected[i]);
    CHECK(choices.ways[i].engagement_mm == Approx(expected[i] - 0.875 - grip_mm));
    CHECK(choices.ways[i].spare_mm == Approx(grip_mm + depth_mm - expected[i]));
  }
}

TEST_CASE("without a thread a nut goes behind, with a washer under a head on a face") {
  const std::vector<BoreStretch> bore{{0, 20, 13.5, 0}, {20, 45, 13, 1}};
  const auto plain = choose_fastening(bore, box_of_screws(), {});
  REQUIRE_FALSE(plain.ways.empty());
  // 45 and the nut's 10.8 and a pitch of 1.75: 57.55 of thread.
  CHECK(plain.ways[0].screw.length_mm == 60);
  REQUIRE(plain.ways[0].nut);
  CHECK(plain.ways[0].spare_mm == Approx(60 - 55.8));
  CHECK_FALSE(plain.ways[0].washer);
  const std::vector<BoreStretch> longer{{0, 20, 13.5, 0}, {20, 48, 13, 1}};
  const auto washered = choose_fastening(longer, box_of_screws(), {.needs_washer = true});
  REQUIRE_FALSE(washered.ways.empty());
  CHECK(washered.ways[0].washer.value().length_mm == 2.5);
  CHECK(washered.ways[0].grip_mm == 50.5);
  // 50.5 and 10.8 and one to six pitches: 63.05 to 71.8.
  CHECK(washered.ways[0].screw.length_mm == 70);
}

TEST_CASE("a bore of 12 mm is no thread M14 where a screw M12 goes through it") {
  std::vector<Fastener> box = box_of_screws();
  box.push_back(screw(14, 60));
  const std::vector<BoreStretch> bore{{0, 30, 12.0, 0}, {30, 60, 10.2, 1}};
  const auto choices = choose_fastening(bore, box, {});
  REQUIRE_FALSE(choices.ways.empty());
  CHECK(choices.ways[0].screw.nominal_mm == 12);
  // But it is one where it is all there is.
  const std::vector<BoreStretch> tapped{{0, 30, 15.0, 0}, {30, 70, 12.0, 1}};
  box.erase(box.end() - 3, box.end() - 1);  // no nuts
  const auto m14 = choose_fastening(tapped, box, {});
  REQUIRE_FALSE(m14.ways.empty());
  CHECK(m14.ways[0].screw.nominal_mm == 14);
}

TEST_CASE("where no screw does, the numbers are told") {
  const std::vector<BoreStretch> shallow{{0, 30, 13.5, 0}, {30, 40, 10.106, 1}};
  const auto none = choose_fastening(shallow, box_of_screws(), {});
  CHECK(none.ways.empty());
  CHECK(none.reason.find("M12 has to be 42 mm of thread to 38.25 mm long") != std::string::npos);
  // A narrow place before the thread.
  const std::vector<BoreStretch> narrow{{0, 10, 13.5, 0}, {10, 12, 5, 0}, {12, 60, 10.106, 1}};
  CHECK(choose_fastening(narrow, box_of_screws(), {}).ways.empty());
  CHECK_FALSE(choose_fastening({}, box_of_screws(), {}).reason.empty());
  CHECK_FALSE(choose_fastening(on_plate(27), {}, {}).reason.empty());
}

TEST_CASE("a fastener is told by its name and its features") {
  const auto known = fastener_of(testing::screw_element().element);
  REQUIRE(known);
  CHECK(known->nominal_mm == 12.0);
  CHECK(known->length_mm == 65.0);
  CHECK(known->feature == "pin1");
  CHECK_FALSE(fastener_of(testing::pin_element().element));
  CHECK_FALSE(fastener_of(testing::riser_element().element));
}
