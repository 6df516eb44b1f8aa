#include "contact_suite.h"

#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "solids.h"

namespace dowel::testing {
namespace {

using std::numbers::pi;
using Cases = std::vector<ContactCase>;
using Outline = std::vector<Eigen::Vector2d>;

Pose lifted(double z) {
  return Pose::from_translation({0, 0, z});
}

Pose turned(double angle_rad, const Eigen::Vector3d& about, const Eigen::Vector3d& to) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, about.normalized())), to};
}

FacetedSolid block() {
  return box({40, 30, 20}, {0, 0, 10});
}

FacetedSolid table() {
  return box({100, 100, 20}, {0, 0, -10});
}

Cases flat_cases() {
  const FacetedSolid riser = plate_with_holes({78, 78, 20}, hole_grid(2, 2, 40, 6.75), 24);
  const FacetedSolid plate =
      transformed(lifted(-20), plate_with_holes({160, 160, 20}, hole_grid(4, 4, 40, 6.0), 20));
  const auto sink = [](double d) { return lifted(-d); };
  return {
      {"flat on flat", block(), table(), sink, true},
      {"riser with holes on a plate with holes", riser, plate, sink, true},
      {"flush boxes, side by side", block(), block(),
       [](double d) {
         return Pose::from_translation({40 - d, 0, 0});
       },
       true},
      {"boxes that share an edge", block(), block(),
       [](double d) {
         return Pose::from_translation({40 - d, 30 - d, 0});
       }},
      {"gussets that share an edge", prism({{0, 0}, {30, 0}, {0, 20}}, 20),
       prism({{0, 0}, {-30, 0}, {0, -20}}, 20),
       [](double d) {
         const double each = d > 0 ? d : d / std::sqrt(2.0);
         return Pose::from_translation({-each, -each, 0});
       },
       true},
      {"boxes that share a corner", block(), block(),
       [](double d) {
         return Pose::from_translation({40 - d, 30 - d, 20 - d});
       }},
  };
}

Cases round_cases() {
  const FacetedSolid bored = plate_with_holes({60, 60, 40}, {{0, 0, 6.0, 25.0}}, 30);
  const FacetedSolid drilled = plate_with_holes({60, 60, 20}, {{0, 0, 6.6}}, 18);
  return {
      {"cylinder standing on a plane", cylinder(6, 20, 26), table(),
       [](double d) { return lifted(-d); }, true},
      {"cylinder lying on a plane", cylinder(6, 20, 26, 0.05), table(),
       [](double d) {
         return turned(pi / 2, {1, 0, 0}, {0, 0, 6 - d});
       },
       true},
      {"cylinders side by side", cylinder(6, 20, 26), cylinder(9, 30, 31),
       [](double d) {
         return Pose::from_translation({15 - d, 0, 5});
       },
       true},
      {"crossed cylinders", cylinder(6, 40, 26), transformed(lifted(-15), cylinder(9, 30, 31)),
       [](double d) {
         return turned(pi / 2, {1, 0, 0}, {15 - d, 20, 0});
       },
       true},
      {"ball on a plane", sphere(8, 20), table(), [](double d) { return lifted(8 - d); }, true},
      {"pin seated in a blind hole", cylinder(5.994, 30, 26, 0.1), bored,
       [](double d) { return lifted(15 - d); }},
      {"pin pushed against the wall of its hole", cylinder(5.9, 60, 26, 0.1),
       plate_with_holes({60, 60, 40}, {{0, 0, 6.0}}, 30),
       [](double d) {
         return Pose::from_translation({0.1 + d, 0, -10});
       },
       true},
      {"screw head on the edge of its clearance hole", stepped_pin({{5.0, 30}, {8.0, 8}}, 22),
       drilled,
       [](double d) {
         return Pose::from_translation({1.0, 0.5, -10 - d});
       }},
  };
}

/// A wedge of `angle_rad` standing on its edge along x, tip at the origin.
FacetedSolid tip_bar(double angle_rad, double flank_mm) {
  const Pose edge_along_x(Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(pi - angle_rad / 2, Eigen::Vector3d::UnitZ()),
                          {-20, 0, 0});
  return transformed(edge_along_x, wedge(angle_rad, flank_mm, 40));
}

Cases tip_cases(double degrees) {
  const double angle = degrees * pi / 180;
  const double sine = std::sin(angle / 2);
  const std::string of = " of " + std::to_string(degrees) + " degrees";
  const FacetedSolid bar = tip_bar(angle, 30);
  const FacetedSolid upside_down = transformed(turned(pi, {1, 0, 0}, {0, 0, 0}), bar);
  return {
      {"wedge edge on a face" + of, bar, table(),
       [angle](double d) { return lifted(-tip_height_mm(d, angle / 2)); }, true},
      {"crossed edges" + of, bar, transformed(turned(pi, {1, 1, 0}, {0, 0, 0}), bar),
       [sine](double d) { return lifted(d > 0 ? -d / sine : -d); }, true},
      {"edge on edge" + of, bar, upside_down,
       [sine](double d) { return lifted(d > 0 ? -d / sine : -d); }, true},
      // Flanks on each other from the common edge on: moved inwards they overhang it.
      {"wedges beside each other with a common edge" + of, wedge(angle, 30, 40),
       transformed(turned(pi, {1, 0, 0}, {0, 0, 40}), wedge(angle, 30, 40)),
       [](double d) {
         return Pose::from_translation({0, -d, 0});
       },
       true},
  };
}

Cases cone_cases() {
  const double half = std::atan2(8.0, 20.0);
  return {{"cone tip on a face", transformed(turned(pi, {1, 0, 0}, {0, 0, 20}), cone(8, 20, 32)),
           table(), [half](double d) { return lifted(-tip_height_mm(d, half)); }, true}};
}

Cases slot_cases() {
  const double height = 5.0 * std::sqrt(3.0);
  const FacetedSolid tail = prism({{-10, 0}, {10, 0}, {15, height}, {-15, height}}, 60);
  const FacetedSolid groove = prism({{-40, -10},
                                     {40, -10},
                                     {40, height},
                                     {15, height},
                                     {10, 0},
                                     {-10, 0},
                                     {-15, height},
                                     {-40, height}},
                                    60);
  const Outline nut{{-10.8, 0}, {10.8, 0},  {10.8, 7.8}, {6.8, 7.8},
                    {6.8, 14},  {-6.8, 14}, {-6.8, 7.8}, {-10.8, 7.8}};
  const Outline filling{{-11, -2}, {11, -2}, {11, 8}, {7, 8}, {7, 16}, {-7, 16}, {-7, 8}, {-11, 8}};
  const FacetedSolid slot = prism({{-30, -20},
                                   {30, -20},
                                   {30, 16},
                                   {7, 16},
                                   {7, 8},
                                   {11, 8},
                                   {11, -2},
                                   {-11, -2},
                                   {-11, 8},
                                   {-7, 8},
                                   {-7, 16},
                                   {-30, 16}},
                                  100);
  return {
      {"dovetail pressed into its groove", tail, groove,
       [](double d) {
         return Pose::from_translation({0, -d, 0});
       }},
      {"dovetail pressed against one flank of its groove", tail, groove,
       [](double d) {
         return Pose::from_translation({d / std::cos(pi / 6), 0, 0});
       }},
      // Both walls 0.2 mm off, the flanges flush.
      {"T-nut drawn up in its slot", prism(nut, 25), slot,
       [](double d) {
         return Pose::from_translation({0, 0.2 + d, 40});
       },
       true},
      {"T-nut that fills its slot", prism(filling, 25), slot,
       [](double d) {
         return Pose::from_translation({0, d, 40});
       }},
  };
}

}  // namespace

double tip_height_mm(double depth_mm, double half_angle_rad) {
  const double sine = std::sin(half_angle_rad);
  return depth_mm > 0 ? 0.5 * depth_mm * (1.0 + sine) / sine : depth_mm;
}

std::vector<ContactCase> contact_suite() {
  Cases result;
  const auto append = [&result](Cases cases) {
    std::move(cases.begin(), cases.end(), std::back_inserter(result));
  };
  append(flat_cases());
  append(round_cases());
  for (const double degrees : {5.0, 15.0, 30.0, 45.0, 90.0}) append(tip_cases(degrees));
  append(cone_cases());
  append(slot_cases());
  return result;
}

}  // namespace dowel::testing
