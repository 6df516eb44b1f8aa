#include "scenario.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "random_geometry.h"

namespace dowel::bench {

namespace {

using testing::DrilledHole;

constexpr double kCell_mm = 80.0;  // risers and supports are this wide
constexpr double kHole_mm = 6.0;   // radius of a locating hole
constexpr double kClearanceHole_mm = 6.75;
constexpr double kShank_mm = kHole_mm - kFitClearance_mm;

/// Locating hole in the middle, and clearance holes around it or none.
std::vector<DrilledHole> riser_holes(bool has_clearance_holes) {
  std::vector<DrilledHole> holes;
  if (has_clearance_holes) holes = testing::hole_grid(2, 2, 40.0, kClearanceHole_mm);
  DrilledHole middle;
  middle.radius_mm = kHole_mm;
  holes.push_back(middle);
  return holes;
}

Pose at(double x, double y, double z) {
  return Pose::from_translation({x, y, z});
}

/// The elements of one scenario.
struct Kit {
  ElementPtr base;  ///< top at z = 0
  ElementPtr riser, support, wall, foot, adaptor, strap, post, stud, nut, washer, screw, pin,
      weight;
};

struct Density {
  std::uint32_t holes = 24;   ///< segments of a hole
  std::uint32_t rounds = 24;  ///< segments of pins, screws, nuts
};

/// `columns` x `columns` holes in a support: how densely the scenario's elements are drilled.
Kit kit_of(bool has_slots, bool has_full_risers, std::uint32_t columns, const Density& density) {
  const std::uint32_t h = density.holes;
  const std::uint32_t n = density.rounds;
  Kit kit;
  if (has_slots) {
    kit.base = share(slotted_plate(400.0, 320.0, 40.0, 10, 40.0));
  } else {
    Element plate = drilled_plate("base plate", {400.0, 320.0, 40.0},
                                  testing::hole_grid(10, 8, 40.0, kHole_mm), h);
    kit.base = share(std::move(plate));
  }
  const double pitch_mm = 60.0 / columns;
  kit.riser =
      share(drilled_plate("riser", {kCell_mm, kCell_mm, 40.0}, riser_holes(has_full_risers), h));
  kit.support =
      share(drilled_plate("support", {kCell_mm, kCell_mm, 20.0},
                          testing::hole_grid(columns, columns, pitch_mm, 0.3 * pitch_mm), h));
  kit.wall =
      share(drilled_plate("wall", {kCell_mm, 100.0, 16.0},
                          testing::hole_grid(columns, columns, pitch_mm, 0.3 * pitch_mm), h));
  kit.foot = share(drilled_plate("foot", {kCell_mm, 40.0, 20.0},
                                 testing::hole_grid(2, 1, 40.0, kClearanceHole_mm), h));
  kit.adaptor = share(drilled_plate("adaptor", {60.0, 60.0, 15.0},
                                    testing::hole_grid(2, 2, 30.0, kClearanceHole_mm), h));
  kit.strap = share(drilled_plate("strap", {30.0, 80.0, 16.0},
                                  testing::hole_grid(1, 3, 25.0, kClearanceHole_mm), h));
  kit.post = share(turned("post",
                          {{0.0, 0.0},
                           {30.0, 0.0},
                           {30.0, 10.0},
                           {18.0, 10.0},
                           {18.0, 60.0},
                           {15.0, 63.0},
                           {0.0, 63.0}},
                          n));
  kit.stud =
      share(turned("stud", {{0.0, 0.0}, {6.0, 0.0}, {6.0, 60.0}, {5.0, 61.0}, {0.0, 61.0}}, n));
  kit.nut = share(hexagon_nut(6.0, 19.0, 10.0, n));
  kit.washer = share(tube("washer", 6.5, 12.0, 2.5, n));
  kit.screw = share(turned("screw",
                           {{0.0, 0.0},
                            {5.0, 0.0},
                            {6.0, 1.0},
                            {6.0, 20.0},
                            {9.0, 20.0},
                            {9.0, 31.0},
                            {8.0, 32.0},
                            {0.0, 32.0}},
                           n));
  kit.pin = share(turned(
      "pin", {{0.0, 0.0}, {5.5, 0.0}, {6.0, 0.5}, {6.0, 29.5}, {5.5, 30.0}, {0.0, 30.0}}, n));
  kit.weight = share(block("weight", {76.0, 76.0, 80.0}));
  return kit;
}

Eigen::Vector2d cell(int column, int row) {
  return {kCell_mm * (column - 2), kCell_mm * (row - 1.5)};
}

struct Layout {
  std::string name;
  std::string title;
  std::size_t static_triangles = 0;
  std::size_t moving_triangles = 0;
  bool has_slots = false;
  bool has_full_risers = true;  ///< risers with five holes, not one
  std::uint32_t columns = 3;    ///< of holes in supports and walls
  std::uint64_t seed = 0;
  std::function<Element()> moving;
};

Scenario assemble(const Layout& layout, const Density& density) {
  const Kit kit = kit_of(layout.has_slots, layout.has_full_risers, layout.columns, density);
  Scenario scene;
  scene.name = layout.name;
  scene.title = layout.title;
  scene.paper_static_triangles = layout.static_triangles;
  scene.paper_moving_triangles = layout.moving_triangles;
  scene.moving = share(layout.moving());
  const auto put = [&](const ElementPtr& element, const Pose& X_WE) {
    scene.elements.push_back(placed(element, X_WE));
  };
  put(kit.base, layout.has_slots ? Pose() : at(0.0, 0.0, -40.0));

  // The stage: four risers side by side at the right.
  for (const int column : {3, 4}) {
    for (const int row : {1, 2}) {
      const Eigen::Vector2d c = cell(column, row);
      put(kit.riser, at(c.x(), c.y(), 0.0));
    }
  }
  scene.stage = box_of(kCell_mm * 0.5, -kCell_mm, 0.0, kCell_mm * 2.5, kCell_mm, 40.0);
  // The aisle: the middle column but for its far end, where a stud stands.
  scene.aisle = box_of(-0.5 * kCell_mm, -2.0 * kCell_mm, -40.0, 0.5 * kCell_mm, kCell_mm, 0.0);
  const Eigen::Vector2d stud = cell(2, 3);
  put(kit.stud, at(stud.x(), stud.y(), 0.0));

  // Stacks in all other cells; what stands where is drawn by lot.
  testing::RandomGeometry random(layout.seed);
  std::vector<Eigen::Vector2d> cells;
  for (const int column : {0, 1, 3, 4}) {
    for (const int row : {0, 1, 2, 3}) {
      if (column < 2 || row == 0 || row == 3) cells.push_back(cell(column, row));
    }
  }
  for (std::size_t i = cells.size(); i > 1; --i) {
    std::swap(cells[i - 1], cells[random.index(static_cast<std::uint32_t>(i))]);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double x = cells[i].x();
    const double y = cells[i].y();
    if (i == 0) {
      put(kit.weight, at(x, y, 0.0));
      scene.solid_W = scene.elements.back().box_W;
      continue;
    }
    switch (i % 4) {
      case 0:
        put(kit.riser, at(x, y, 0.0));
        put(kit.support, at(x, y, 40.0));
        put(kit.pin, at(x, y, 60.0));
        put(kit.screw, at(x - 20.0, y - 20.0, 40.0));
        put(kit.screw, at(x + 20.0, y + 20.0, 40.0));
        break;
      case 1:
        put(kit.riser, at(x, y, 0.0));
        put(kit.riser, at(x, y, 40.0));
        put(kit.strap, at(x, y, 80.0));
        put(kit.stud, at(x, y, 60.0));
        put(kit.washer, at(x, y, 96.0));
        put(kit.nut, at(x, y, 98.5));
        break;
      case 2: {
        put(kit.foot, at(x, y, 0.0));
        const double quarter = std::numbers::pi / 2.0;
        const Pose upright(Eigen::Quaterniond(Eigen::AngleAxisd(quarter, Eigen::Vector3d::UnitX())),
                           {x, y + 8.0, 70.0});
        put(kit.wall, upright);
        put(kit.screw, at(x - 20.0, y, 0.0));
        put(kit.screw, at(x + 20.0, y, 0.0));
        break;
      }
      default:
        put(kit.post, at(x, y, 0.0));
        put(kit.adaptor, at(x, y, 63.0));
        put(kit.support, at(x, y, 78.0));
        put(kit.pin, at(x + 15.0, y + 15.0, 70.0));
        break;
    }
  }

  const bool is_nut = scene.moving->name == "nut";
  scene.fit.partner = is_nut ? 5 : 1;
  if (is_nut) {
    scene.fit.top = {stud.x(), stud.y(), 61.0};
    scene.fit.travel_mm = 50.0;
  } else {
    const Eigen::Vector2d c = cell(3, 1);
    scene.fit.top = {c.x(), c.y(), 40.0};
    scene.fit.travel_mm = 18.0;
  }
  return scene;
}

double relative_error(std::size_t found, std::size_t wanted) {
  return std::abs(static_cast<double>(found) / static_cast<double>(wanted) - 1.0);
}

/// The segment counts of holes and round parts are chosen such that the triangles add up.
Scenario tuned(const Layout& layout) {
  Density best;
  double best_error = 1.0e9;
  for (std::uint32_t holes = 20; holes <= 32; ++holes) {
    for (std::uint32_t rounds = 18; rounds <= 32; rounds += 2) {
      // Counting is linear in both, but assembling is quick enough.
      const Scenario scene = assemble(layout, {holes, rounds});
      const double error = relative_error(static_triangles(scene), layout.static_triangles);
      if (error < best_error) {
        best_error = error;
        best = {holes, rounds};
      }
    }
  }
  Scenario scene = assemble(layout, best);
  if (best_error > 0.02 ||
      relative_error(scene.moving->solid->triangles.size(), layout.moving_triangles) > 0.02) {
    throw std::logic_error("scenario " + layout.name + " misses the paper's triangle counts: " +
                           std::to_string(static_triangles(scene)) + ", " +
                           std::to_string(scene.moving->solid->triangles.size()));
  }
  return scene;
}

}  // namespace

Placed placed(ElementPtr element, const Pose& X_WE) {
  const auto in_world = [&](const Aabb& box) {
    const Obb obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
    return bounds(transformed(X_WE, obb));
  };
  Placed result{std::move(element), X_WE, {}, {}};
  result.box_W = in_world(result.element->box);
  for (const Aabb& box : result.element->core) result.core_W.push_back(in_world(box));
  return result;
}

std::size_t static_triangles(const Scenario& scenario) {
  std::size_t count = 0;
  for (const Placed& p : scenario.elements) count += p.element->solid->triangles.size();
  return count;
}

std::vector<Scenario> paper_scenarios(std::uint64_t variant) {
  std::vector<Layout> layouts{
      {"a", "slots, nut", 11316, 215, true, false, 2, 1,
       [] { return hexagon_nut(6.0 + kFitClearance_mm, 19.0, 10.0, 48); }},
      {"b", "holes, locator", 31296, 948, false, true, 3, 2, [] { return locator(kShank_mm, 48); }},
      {"c", "slots, bolt", 18004, 220, true, true, 2, 3,
       [] { return hexagon_bolt(kShank_mm, 30.0, 19.0, 8.0, 33); }},
      {"d", "slots, rhombus pin", 29452, 236, true, true, 4, 4,
       [] { return rhombus_pin(kShank_mm, std::numbers::pi / 6.0, 30.0, 30); }}};
  std::vector<Scenario> result;
  result.reserve(layouts.size());
  for (Layout& layout : layouts) {
    layout.seed += 100 * variant;
    result.push_back(tuned(layout));
  }
  return result;
}

Scenario field_of_elements(std::size_t count) {
  const Kit kit = kit_of(false, true, 2, {24, 24});
  Scenario scene;
  scene.name = "field";
  scene.title = std::to_string(count) + " elements";
  scene.moving = share(locator(kShank_mm, 48));
  const auto side =
      static_cast<std::size_t>(std::ceil(std::sqrt(0.5 * static_cast<double>(count))));
  constexpr double kPitch_mm = 120.0;  // aisles of 40 mm between the risers
  const double start = -0.5 * kPitch_mm * static_cast<double>(side - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = i / 2;
    const std::size_t row = place / side;
    const double x = start + kPitch_mm * static_cast<double>(place % side);
    const double y = start + kPitch_mm * static_cast<double>(row);
    const bool is_pin = i % 2 == 1;
    scene.elements.push_back(placed(is_pin ? kit.pin : kit.riser, at(x, y, is_pin ? 25.0 : 0.0)));
  }
  const double reach = start + kPitch_mm * static_cast<double>(side - 1);
  scene.stage = box_of(start - 40.0, start - 40.0, 0.0, reach + 40.0, reach + 40.0, 40.0);
  return scene;
}

}  // namespace dowel::bench
