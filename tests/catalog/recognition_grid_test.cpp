#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "solids.h"
#include "variants.h"

using namespace dowel;

namespace {

std::vector<Feature> holes_of(const FacetedSolid& solid) {
  std::vector<Feature> features = recognise_features(solid);
  features.erase(std::remove_if(features.begin(), features.end(),
                                [](const Feature& f) { return f.kind != FeatureKind::Hole; }),
                 features.end());
  return features;
}

std::string names(const std::vector<Feature>& features) {
  std::string result;
  for (const Feature& f : features) result += (result.empty() ? "" : " ") + f.name;
  return result;
}

Eigen::Vector3d position(const std::vector<Feature>& features, const std::string& name) {
  const auto found = std::find_if(features.begin(), features.end(),
                                  [&](const Feature& f) { return f.name == name; });
  INFO("no hole is called " << name);
  REQUIRE(found != features.end());
  return found->origin;
}

FacetedSolid plate(const std::vector<testing::DrilledHole>& holes) {
  return testing::plate_with_holes({400.0, 300.0, 20.0}, holes, 8);
}

}  // namespace

TEST_CASE("grid holes are named by row from below and column from the left") {
  const std::vector<Feature> holes = holes_of(plate(testing::hole_grid(4, 3, 40.0, 6.0)));
  CHECK(names(holes) == "A1 A2 A3 A4 B1 B2 B3 B4 C1 C2 C3 C4");
  CHECK((position(holes, "A1") - Eigen::Vector3d(-60.0, -40.0, 20.0)).norm() < 1.0e-9);
  CHECK((position(holes, "C4") - Eigen::Vector3d(60.0, 40.0, 20.0)).norm() < 1.0e-9);
}

TEST_CASE("a missing hole leaves the names of the others") {
  std::vector<testing::DrilledHole> drilled = testing::hole_grid(4, 3, 40.0, 6.0);
  drilled.erase(drilled.begin() + 5);  // B2
  CHECK(names(holes_of(plate(drilled))) == "A1 A2 A3 A4 B1 B3 B4 C1 C2 C3 C4");
}

TEST_CASE("fewer than three by two holes are no grid") {
  CHECK(names(holes_of(plate(testing::hole_grid(2, 2, 40.0, 6.0)))) == "h1 h2 h3 h4");
  CHECK(names(holes_of(plate(testing::hole_grid(6, 1, 40.0, 6.0)))) == "h1 h2 h3 h4 h5 h6");
  CHECK(names(holes_of(plate(testing::hole_grid(2, 3, 40.0, 6.0)))) == "A1 A2 B1 B2 C1 C2");
}

TEST_CASE("of two grids the larger has the plain names, of equal ones that of the smaller holes") {
  std::vector<testing::DrilledHole> drilled = testing::hole_grid(4, 3, 40.0, 6.0);
  std::vector<testing::DrilledHole> between = testing::hole_grid(3, 2, 40.0, 5.0);
  drilled.insert(drilled.end(), between.begin(), between.end());
  const std::vector<Feature> holes = holes_of(plate(drilled));
  CHECK(position(holes, "A1").x() == -60.0);
  CHECK(position(holes, "g2.A1").x() == -40.0);
  CHECK(names(holes).find("g2.B3") != std::string::npos);
  CHECK(holes.size() == 18);

  drilled = testing::hole_grid(4, 3, 80.0, 6.0);
  for (testing::DrilledHole& hole : drilled) hole.x -= 20.0;
  between = testing::hole_grid(4, 3, 80.0, 5.0);
  for (testing::DrilledHole& hole : between) hole.x += 20.0;
  drilled.insert(drilled.end(), between.begin(), between.end());
  CHECK(position(holes_of(plate(drilled)), "A1").x() == -100.0);
}

TEST_CASE("a chequered grid keeps the names of its empty places free") {
  std::vector<testing::DrilledHole> drilled;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      if ((row + column) % 2 == 0)
        drilled.push_back({40.0 * column - 120.0, 40.0 * row - 80.0, 6.0});
    }
  }
  const std::vector<Feature> holes = holes_of(plate(drilled));
  CHECK(names(holes) == "A1 A3 A5 A7 B2 B4 B6 C1 C3 C5 C7 D2 D4 D6 E1 E3 E5 E7");
}

TEST_CASE("equal holes outside the grid are named apart from it") {
  std::vector<testing::DrilledHole> drilled = testing::hole_grid(4, 3, 40.0, 6.0);
  drilled.push_back({180.0, 120.0, 6.0});
  drilled.push_back({-181.0, -121.0, 6.0});
  const std::vector<Feature> holes = holes_of(plate(drilled));
  CHECK(names(holes) == "A1 A2 A3 A4 B1 B2 B3 B4 C1 C2 C3 C4 h1 h2");
  CHECK((position(holes, "h1") - Eigen::Vector3d(-181.0, -121.0, 20.0)).norm() < 1.0e-9);
}

TEST_CASE("six holes on a circle are no grid") {
  std::vector<testing::DrilledHole> drilled;
  for (int i = 0; i < 6; ++i) {
    const double a = std::numbers::pi / 3.0 * i;
    drilled.push_back({60.0 * std::cos(a), 60.0 * std::sin(a), 5.0});
  }
  CHECK(names(holes_of(plate(drilled))) == "h1 h2 h3 h4 h5 h6");
}

TEST_CASE("a hole in the middle of a bolt circle of equal holes makes it no grid") {
  const int count = GENERATE(4, 5, 6, 8, 12);
  const double turned_rad = GENERATE(0.0, 0.5, std::numbers::pi / 6.0);
  CAPTURE(count, turned_rad);
  std::vector<testing::DrilledHole> drilled{{0.0, 0.0, 5.0}};
  for (int i = 0; i < count; ++i) {
    const double a = turned_rad + 2.0 * std::numbers::pi / count * i;
    drilled.push_back({60.0 * std::cos(a), 60.0 * std::sin(a), 5.0});
  }
  const std::vector<Feature> holes = holes_of(plate(drilled));
  const std::vector<BoltCircle> circles = find_bolt_circles(holes);
  REQUIRE(circles.size() == 1);
  CHECK(circles[0].holes.size() == static_cast<std::size_t>(count));
  CHECK(circles[0].diameter_mm == Approx(120.0));
  for (const Feature& hole : holes) CHECK(hole.name.front() == 'h');
}

TEST_CASE("a chequered grid of seven holes is one, though it is a hexagon drawn out") {
  std::vector<testing::DrilledHole> drilled;
  for (const auto& [x, y] :
       {std::pair(-40, 40), std::pair(40, 40), std::pair(-80, 0), std::pair(0, 0), std::pair(80, 0),
        std::pair(-40, -40), std::pair(40, -40)}) {
    drilled.push_back({static_cast<double>(x), static_cast<double>(y), 6.0});
  }
  CHECK(names(holes_of(plate(drilled))) == "A2 A4 B1 B3 B5 C2 C4");
}

TEST_CASE("a bolt circle tells its pitch circle, its count and its holes, from the right around") {
  struct Case {
    int count;
    double diameter_mm;
    double turned_rad;
  };
  const Case c = GENERATE(Case{3, 60.0, 0.4}, Case{4, 66.675, 0.785398}, Case{5, 90.0, 0.0},
                          Case{6, 120.0, 0.0}, Case{7, 80.0, 0.5}, Case{12, 180.0, 0.1});
  CAPTURE(c.count);
  const Eigen::Vector2d center(35.0, -20.0);
  std::vector<testing::DrilledHole> drilled{{-150.0, -100.0, 5.0}, {150.0, 100.0, 5.0}};
  for (int i = 0; i < c.count; ++i) {
    const double a = c.turned_rad + 2.0 * std::numbers::pi * i / c.count;
    drilled.push_back({center.x() + 0.5 * c.diameter_mm * std::cos(a),
                       center.y() + 0.5 * c.diameter_mm * std::sin(a), 5.0});
  }
  drilled.push_back({center.x(), center.y(), 8.0});
  const std::vector<Feature> holes = holes_of(plate(drilled));
  const std::vector<BoltCircle> circles = find_bolt_circles(holes);
  REQUIRE(circles.size() == 1);
  CHECK(circles[0].diameter_mm == Approx(c.diameter_mm).margin(1.0e-6));
  CHECK(circles[0].hole_diameter_mm == Approx(10.0).margin(1.0e-9));
  CHECK((circles[0].center - Eigen::Vector3d(center.x(), center.y(), 20.0)).norm() < 1.0e-6);
  CHECK(circles[0].direction == Eigen::Vector3d(0.0, 0.0, -1.0));
  REQUIRE(circles[0].holes.size() == static_cast<std::size_t>(c.count));
  for (int i = 0; i < c.count; ++i) {
    const testing::DrilledHole& hole = drilled[static_cast<std::size_t>(i) + 2];
    const auto& name = circles[0].holes[static_cast<std::size_t>(i)];
    CHECK((position(holes, name) - Eigen::Vector3d(hole.x, hole.y, 20.0)).norm() < 1.0e-6);
  }
}

TEST_CASE("two flanges on one plate are two circles") {
  std::vector<testing::DrilledHole> drilled;
  for (int i = 0; i < 8; ++i) {
    const double a = std::numbers::pi / 4.0 * i;
    drilled.push_back({-90.0 + 40.0 * std::cos(a), 40.0 * std::sin(a), 4.0});
    if (i % 2 == 0) drilled.push_back({100.0 + 30.0 * std::cos(a), 30.0 * std::sin(a), 4.0});
  }
  const std::vector<BoltCircle> circles = find_bolt_circles(holes_of(plate(drilled)));
  REQUIRE(circles.size() == 2);
  CHECK(circles[0].holes.size() == 8);
  CHECK(circles[0].diameter_mm == Approx(80.0).margin(1.0e-6));
  CHECK(circles[1].holes.size() == 4);
  CHECK(circles[1].diameter_mm == Approx(60.0).margin(1.0e-6));
}

TEST_CASE("what is no bolt circle is none") {
  SECTION("a grid") {
    CHECK(find_bolt_circles(holes_of(plate(testing::hole_grid(4, 3, 40.0, 6.0)))).empty());
  }
  SECTION("the corners of a rectangle") {
    CHECK(
        find_bolt_circles(
            holes_of(plate(
                {{-60.0, -30.0, 5.0}, {60.0, -30.0, 5.0}, {60.0, 30.0, 5.0}, {-60.0, 30.0, 5.0}})))
            .empty());
  }
  SECTION("holes on a circle, not evenly spaced or not alike") {
    std::vector<testing::DrilledHole> drilled;
    for (const double a : {0.0, 1.1, 2.0, 4.0}) {
      drilled.push_back({60.0 * std::cos(a), 60.0 * std::sin(a), 5.0});
    }
    CHECK(find_bolt_circles(holes_of(plate(drilled))).empty());
    drilled.clear();
    for (int i = 0; i < 4; ++i) {
      const double a = 0.5 * std::numbers::pi * i;
      drilled.push_back({60.0 * std::cos(a), 60.0 * std::sin(a), i == 0 ? 5.1 : 5.0});
    }
    CHECK(find_bolt_circles(holes_of(plate(drilled))).empty());
  }
}

TEST_CASE("rows go on after Z with AA") {
  const std::vector<Feature> holes = holes_of(
      testing::plate_with_holes({40.0, 300.0, 10.0}, testing::hole_grid(2, 28, 10.0, 3.0), 6));
  CHECK(holes.size() == 56);
  CHECK(position(holes, "Z1").y() == Approx(115.0));
  CHECK(position(holes, "AA2").y() == Approx(125.0));
  CHECK(position(holes, "AB1").y() == Approx(135.0));
}

TEST_CASE("a grid on a side is read by someone who looks at that side", "[property]") {
  struct View {
    Eigen::Vector3d normal, right, up;
  };
  const View view =
      GENERATE(View{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, View{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
               View{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, View{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}});
  Eigen::Matrix3d turn;
  turn << view.right, view.up, view.normal;
  // Counterbored from that side, so that the holes open there.
  std::vector<testing::DrilledHole> drilled = testing::hole_grid(4, 3, 40.0, 6.0);
  for (testing::DrilledHole& hole : drilled) {
    hole.counterbore_radius_mm = 9.0;
    hole.counterbore_depth_mm = 5.0;
  }
  const std::vector<Feature> holes = holes_of(testing::transformed(
      Pose::from_matrix(turn, Eigen::Vector3d(5.0, 6.0, 7.0)), plate(drilled)));
  REQUIRE(holes.size() == 12);
  const Eigen::Vector3d column = position(holes, "A2") - position(holes, "A1");
  const Eigen::Vector3d row = position(holes, "B1") - position(holes, "A1");
  CHECK((column - 40.0 * view.right).norm() < 1.0e-8);
  CHECK((row - 40.0 * view.up).norm() < 1.0e-8);
}

TEST_CASE("a grid that stands askew in its frame is still a grid") {
  const double angle_rad = GENERATE(0.3, -0.5, 0.7);
  const FacetedSolid turned = testing::transformed(
      Pose::about_axis(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), angle_rad),
      plate(testing::hole_grid(4, 3, 40.0, 6.0)));
  const std::vector<Feature> holes = holes_of(turned);
  CHECK(names(holes) == "A1 A2 A3 A4 B1 B2 B3 B4 C1 C2 C3 C4");
  const Eigen::Vector3d column = position(holes, "A2") - position(holes, "A1");
  CHECK(column.x() == Approx(40.0 * std::cos(angle_rad)));
  CHECK(column.y() == Approx(40.0 * std::sin(angle_rad)));
}

TEST_CASE("rounding noise in the positions changes no name", "[property]") {
  const auto seed = GENERATE(range(0U, 5U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  std::vector<testing::DrilledHole> drilled = testing::hole_grid(4, 3, 40.0, 6.0);
  drilled.push_back({180.0, 120.0, 4.0});
  drilled.push_back({180.0, -120.0, 4.0});
  drilled.push_back({-180.0, -120.0, 4.0});
  const std::vector<Feature> expected = holes_of(plate(drilled));
  for (testing::DrilledHole& hole : drilled) {
    hole.x += random.uniform(-1.0e-6, 1.0e-6);
    hole.y += random.uniform(-1.0e-6, 1.0e-6);
  }
  const std::vector<Feature> holes = holes_of(plate(drilled));
  REQUIRE(names(holes) == names(expected));
  for (std::size_t i = 0; i < holes.size(); ++i) {
    CHECK((holes[i].origin - expected[i].origin).norm() < 1.0e-5);
  }
}
