#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dowel/kernel/box.h"
#include "dowel/kernel/faceted_solid.h"
#include "plate_with_holes.h"

/// The elements that scenes are made of, with what is known of their exact solids.
namespace dowel::bench {

struct Ball {
  Eigen::Vector3d center;
  double radius_mm = 0.0;
};

/// An element and what is known of its exact solid without any collision test.
struct Element {
  std::string name;
  std::shared_ptr<const FacetedSolid> solid;
  Aabb box;                      ///< of the exact solid, tight
  std::vector<Aabb> core;        ///< boxes that are all material
  std::vector<Ball> core_balls;  ///< balls that are all material; the moving element has them
  std::vector<Aabb> hull;        ///< boxes that together contain the exact solid
  std::vector<std::uint32_t> hole_faces;  ///< walls of holes
};

using ElementPtr = std::shared_ptr<const Element>;

ElementPtr share(Element element);

Aabb box_of(double min_x, double min_y, double min_z, double max_x, double max_y, double max_z);

/// Of nothing is known but its `box`, which contains the exact solid. Bores are its holes.
Element element(std::string name, FacetedSolid solid, const Aabb& box);

// Plates stand on z = 0, but for the slotted one, whose top is z = 0 with T-slots along y.

Element drilled_plate(std::string name, const Eigen::Vector3d& size,
                      const std::vector<testing::DrilledHole>& holes, std::uint32_t segments);
Element block(std::string name, const Eigen::Vector3d& size);
Element slotted_plate(double length_mm, double width_mm, double height_mm, std::uint32_t slots,
                      double pitch_mm);

// Round parts stand on z = 0, their axis is z.

/// A body of revolution that has no bore; `profile` from axis to axis.
Element turned(std::string name, const std::vector<Eigen::Vector2d>& profile,
               std::uint32_t segments);
Element tube(std::string name, double inner_mm, double outer_mm, double height_mm,
             std::uint32_t segments);
/// Locating pin with a flange: shank of `shank_mm` (a radius) down to z = 0, locating diameter up.
Element locator(double shank_mm, std::uint32_t segments);

/// Balls along the rim and the axis of a cylinder, tangent to both of its ends.
void add_cylinder_balls(std::vector<Ball>& balls, double radius_mm, double low_z, double high_z);

// Parts with flats stand on z = 0.

Element hexagon_nut(double bore_mm, double across_flats_mm, double height_mm,
                    std::uint32_t segments);
/// Shank below, with a chamfered end at z = 0, head above.
Element hexagon_bolt(double shank_mm, double shank_length_mm, double across_flats_mm,
                     double head_height_mm, std::uint32_t segments);
/// Two lands of a cylinder, `land_rad` wide to either side of the x axis, and two flats.
Element rhombus_pin(double radius_mm, double land_rad, double height_mm,
                    std::uint32_t points_per_land);

}  // namespace dowel::bench
