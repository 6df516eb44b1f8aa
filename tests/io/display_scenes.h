#pragma once

// Scenes that the tests of GLB, page and picture share.

#include <memory>
#include <string>
#include <utility>

#include "dowel/io/scene_page.h"
#include "solids.h"

namespace dowel::testing {

inline std::shared_ptr<const FacetedSolid> shared(FacetedSolid solid) {
  return std::make_shared<const FacetedSolid>(std::move(solid));
}

/// One instance of `solid` in the world's frame.
inline DisplayScene scene_of(FacetedSolid solid) {
  DisplayScene scene;
  scene.title = "one part";
  scene.meshes.push_back({"part", shared(std::move(solid))});
  scene.instances.push_back({"part 1", 0, Pose(), DisplayState::Normal, ""});
  return scene;
}

/// A plate with bores, three pins of one part in all three states, a cone; placed and turned.
inline DisplayScene small_fixture() {
  DisplayScene scene;
  scene.title = "small fixture";
  scene.meshes.push_back({"plate",
                          shared(plate_with_holes({120, 80, 20}, hole_grid(3, 2, 40, 6), 32)),
                          {0.6, 0.64, 0.7}});
  scene.meshes.push_back(
      {"pin", shared(stepped_pin({{6, 18}, {9, 10}, {4, 6}}, 24)), {0.8, 0.65, 0.3}});
  scene.meshes.push_back({"cone", shared(cone(10, 15, 20))});
  const Pose tilted = Pose::about_axis({0, 0, 0}, Eigen::Vector3d(1, 2, 2).normalized(), 0.7);
  scene.instances = {
      {"plate 1", 0, Pose::from_translation({0, 0, -20}), DisplayState::Normal, ""},
      {"pin 1", 1, Pose::from_translation({-40, -20, -18}), DisplayState::Contact, "in plate 1"},
      {"pin 2", 1, Pose::from_translation({40, -20, -18}), DisplayState::Normal, ""},
      {"pin 3", 1, Pose::from_translation({0, 25, -5}) * tilted, DisplayState::Colliding,
       "plate 1: 3.2 mm"},
      {"pin 4", 1, Pose::from_translation({-1000, 500, 250}) * tilted, DisplayState::Normal, ""},
      {"cone 1", 2, tilted, DisplayState::Normal, ""}};
  return scene;
}

}  // namespace dowel::testing
