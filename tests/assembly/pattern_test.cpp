#include "dowel/assembly/pattern.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "fixture_elements.h"
#include "random_geometry.h"

using dowel::Element;
using dowel::feet_of;
using dowel::pattern_ways;
using dowel::PatternWay;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// 20 thick, with through holes of 13 mm at `feet` and a thread in its middle.
Element block_on(const Points& feet) {
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  Element element;
  element.features = {testing::face_feature("bottom", {0, 0, -5}, down, 4000),
                      testing::face_feature("top", {0, 0, 15}, -down, 4000),
                      testing::hole_feature("node", {11, 7, 15}, down, {{10.106, 20}}, true),
                      testing::hole_feature("pocket", {9, 9, 15}, down, {{8, 5}}, false)};
  for (std::size_t i = 0; i < feet.size(); ++i) {
    element.features.push_back(testing::hole_feature(
        "h" + std::to_string(i + 1), {feet[i].x(), feet[i].y(), 15}, down, {{13, 20}}, true));
  }
  return element;
}

/// Holes 40 mm apart, `columns` by `rows`, named by their place: "3 2". Its top is `X_BN`'s plane.
Element grid(int columns, int rows, const Pose& X_BN) {
  Element element;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      element.features.push_back(testing::hole_feature(
          std::to_string(column) + " " + std::to_string(row),
          X_BN * Eigen::Vector3d(40.0 * column, 40.0 * row, 0),
          X_BN.rotation() * -Eigen::Vector3d::UnitZ(), {{12, 15}, {10.106, 25}}, true));
    }
  }
  // A hole from the side is no node.
  element.features.push_back(testing::hole_feature("side", X_BN * Eigen::Vector3d(-20, 0, 0),
                                                   X_BN.rotation() * Eigen::Vector3d::UnitX(),
                                                   {{12, 15}}, false));
  return element;
}

/// Every way has its feet where it says, its bottom on the plane, and none is there twice.
void check_ways(const std::vector<PatternWay>& ways, const Element& element, const Element& part,
                const std::string& at) {
  std::set<std::string> known;
  for (const PatternWay& way : ways) {
    CHECK(way.pairs.size() == feet_of(element).size());
    bool is_on_node = false;
    std::string text;
    for (const dowel::FeaturePair& pair : way.pairs) {
      const dowel::Feature& foot = *element.find_feature(pair.moving);
      const dowel::Feature& hole = *part.find_feature(pair.fixed);
      const Eigen::Vector3d end = foot.origin + foot.depth_mm * foot.direction;
      CHECK((way.X_BE * end - hole.origin).norm() < testing::kExact_mm);
      CHECK((way.X_BE.rotation() * foot.direction - hole.direction).norm() < 1e-12);
      is_on_node = is_on_node || pair.fixed == at;
      text += pair.moving + "-" + pair.fixed + ",";
    }
    CHECK(is_on_node);
    CHECK(known.insert(text).second);
    CHECK(matching_pairs(element, way.X_BE, part) == way.pairs);
  }
}

std::size_t count_ways(const Points& feet, int columns, int rows, const std::string& at,
                       const Pose& X_BN) {
  const Element element = block_on(feet);
  const Element part = grid(columns, rows, X_BN);
  const auto ways = pattern_ways(element, part, *part.find_feature(at));
  check_ways(ways, element, part, at);
  return ways.size();
}

}  // namespace

TEST_CASE("all ways of standing holes on a grid are found, counted by hand", "[property]") {
  const unsigned seed = GENERATE(range(0U, 12U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Pose X_BN = seed == 0 ? Pose() : random.pose(300);
  const Points square{{-20, -20}, {20, -20}, {-20, 20}, {20, 20}};
  // Four corners in four turns inside, one cell at a corner of the grid.
  CHECK(count_ways(square, 5, 5, "2 2", X_BN) == 16);
  CHECK(count_ways(square, 5, 5, "0 0", X_BN) == 4);
  CHECK(count_ways(square, 5, 5, "0 2", X_BN) == 8);
  // A bar over two pitches: to and fro along x, and along y where there is room.
  const Points bar{{-40, 0}, {40, 0}};
  CHECK(count_ways(bar, 5, 3, "2 1", X_BN) == 4);
  CHECK(count_ways(bar, 5, 5, "2 2", X_BN) == 8);
  // Five pitches: also along the twelve ways of 3-4-5.
  const Points long_bar{{-100, 0}, {100, 0}};
  CHECK(count_ways(long_bar, 11, 11, "5 5", X_BN) == 24);
  // An L has no symmetry: three feet in four turns, on a grid without borders nearby.
  CHECK(count_ways({{0, 0}, {40, 0}, {0, 80}}, 9, 9, "4 4", X_BN) == 12);
  // One foot, no foot, another pitch.
  CHECK(count_ways({{7, 3}}, 5, 5, "2 2", X_BN) == 1);
  CHECK(count_ways({}, 5, 5, "2 2", X_BN) == 0);
  CHECK(count_ways({{-20, 0}, {20.1, 0}}, 5, 5, "2 2", X_BN) == 0);
  CHECK(count_ways({{-20, 0}, {20, 0}, {0, 25}}, 5, 5, "2 2", X_BN) == 0);
}

TEST_CASE("ways are sorted by turn, a quarter turn is one to the bit") {
  const Element element = block_on({{-20, -20}, {20, -20}, {-20, 20}, {20, 20}});
  const Element part = grid(5, 5, Pose());
  const auto ways = pattern_ways(element, part, *part.find_feature("2 2"));
  REQUIRE(ways.size() == 16);
  for (std::size_t i = 0; i < 16; ++i) {
    CHECK(ways[i].turn_rad == Approx(static_cast<double>(i / 4) * std::numbers::pi / 2));
    // Coordinates that are whole stay so.
    const Eigen::Vector3d t = ways[i].X_BE.translation();
    CHECK((t - t.array().round().matrix()).norm() < 1e-13);
  }
  CHECK(ways[0].pairs[0].fixed == "2 2");
  CHECK(ways[0].X_BE == Pose::from_translation({100, 100, 5}));
}

TEST_CASE("holes of whole millimetres stand on nodes, unless they cannot and may be threads") {
  const Element part = grid(5, 5, Pose());
  const auto& at = *part.find_feature("2 2");
  Element element = block_on({{-20, -20}, {20, -20}, {-20, 20}, {20, 20}});
  element.features[4].segments[0].diameter_mm = 12.0;  // a fit, or the tap drill of M14
  element.features[4].diameter_mm = 12.0;
  CHECK(pattern_ways(element, part, at).size() == 16);
  CHECK(pattern_ways(element, part, at)[0].pairs.size() == 4);
  element.features[4].origin.x() += 3.0;
  const auto ways = pattern_ways(element, part, at);
  CHECK(ways.size() == 12);
  CHECK(ways[0].pairs.size() == 3);
}

TEST_CASE("a part is held by the pair that was asked for and the one farthest from it") {
  const Element element = block_on({{0, 0}, {40, 0}, {120, 0}});
  const Element part = grid(5, 5, Pose());
  const auto pairs = matching_pairs(element, Pose::from_translation({40, 0, 5}), part);
  REQUIRE(pairs.size() == 3);
  const auto held = holding_pairs(pairs, element, "2 0");
  REQUIRE(held.size() == 2);
  CHECK(held[0].moving == "h2");
  CHECK(held[1].moving == "h3");
  CHECK(holding_pairs({}, element, "2 0").empty());
}
