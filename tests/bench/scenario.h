#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dowel/kernel/pose.h"
#include "element.h"

/// Scenes like the four test scenarios of Peng et al. 2009, section 7, made in code from a fixed
/// seed: the paper gives their triangle counts and pictures, not their data.
namespace dowel::bench {

struct Placed {
  ElementPtr element;
  Pose X_WE;
  Aabb box_W;
  std::vector<Aabb> core_W;
};

Placed placed(ElementPtr element, const Pose& X_WE);

/// Where the moving element fits, with kFitClearance_mm around it: pin or bolt in a hole, nut on a
/// stud.
struct Fit {
  std::size_t partner = 0;                        ///< index into Scenario::elements
  Eigen::Vector3d top = Eigen::Vector3d::Zero();  ///< mouth of the hole, end of the stud
  double travel_mm = 0.0;                         ///< along -z from there without touching
};

inline constexpr double kFitClearance_mm = 0.15;

struct Scenario {
  std::string name;
  std::string title;
  std::size_t paper_static_triangles = 0;
  std::size_t paper_moving_triangles = 0;
  std::vector<Placed> elements;
  ElementPtr moving;  ///< stands on its z = 0
  Fit fit;
  Aabb stage;    ///< flat top of risers (its max z) with nothing on it
  Aabb aisle;    ///< flat top of the base plate (its max z) with nothing on it
  Aabb solid_W;  ///< all material, larger than the moving element
};

std::size_t static_triangles(const Scenario& scenario);

/// (a) nut, (b) locator, (c) bolt, (d) rhombus pin. What stands where is drawn by lot, another lot
/// for each `variant`.
std::vector<Scenario> paper_scenarios(std::uint64_t variant = 0);

/// `count` risers and pins side by side on a square, the pins in the risers' holes, with the moving
/// element of scenario (b).
Scenario field_of_elements(std::size_t count);

}  // namespace dowel::bench
