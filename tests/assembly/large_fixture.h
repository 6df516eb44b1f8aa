#pragma once

// A fixture of as many instances as one likes.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fixture_elements.h"

namespace dowel::testing {

inline Pose large_fixture_plate(std::size_t plate) {
  const std::size_t row = plate / 12;
  const std::size_t column = plate % 12;
  return Pose::from_translation(
      {250.0 * static_cast<double>(column), 170.0 * static_cast<double>(row), 0.0});
}

/// Where the place `height_mm` over the bottom of a plate's last hole, C5, is.
inline Pose over_last_hole(std::size_t plate, double height_mm) {
  return large_fixture_plate(plate) * Pose::from_translation({80, 40, height_mm});
}

/// Plates, one for each sixteen instances, each with a pin mated into all of its holes but the
/// last; every second one has a block above it, and more blocks stand beside them.
inline ProjectState large_fixture(std::size_t instances) {
  constexpr int kHoles = 15;
  ProjectState state;
  std::uint32_t number = 0;
  const auto add = [&](const std::string& name, const std::string& element, const Pose& X_WI) {
    Instance instance;
    instance.number = ++number;
    instance.name = name;
    instance.element = element;
    instance.X_WI = X_WI;
    instance.grounded = element == "T/plate-5x3";
    state.instances.emplace(name, instance);
  };
  for (std::size_t plate = 0; plate < instances / 16; ++plate) {
    const Pose X_WP = large_fixture_plate(plate);
    const std::string plate_name = "PLATE" + std::to_string(plate);
    add(plate_name, "T/plate-5x3", X_WP);
    for (int hole = 0; hole + 1 < kHoles; ++hole) {
      const int row = hole / 5;
      const int column = hole % 5;
      const std::string name = "PIN" + std::to_string(plate) + "-" + std::to_string(hole);
      add(name, "T/pin-12",
          X_WP * Pose::from_translation({40.0 * (column - 2), 40.0 * (row - 1), 25}));
      Mate mate;
      mate.number = number;
      mate.moving = {name, "pin1"};
      mate.fixed = {plate_name,
                    std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1)};
      mate.offset_mm = 15.0;
      state.mates.emplace(mate.number, mate);
    }
    if (plate % 2 == 0) {
      add("BLOCK" + std::to_string(plate), "T/block-40",
          X_WP * Pose::from_translation({-90, 0, 180}));
    }
  }
  for (int more = 0; number < instances; ++more) {
    add("MORE" + std::to_string(more), "T/block-40",
        Pose::from_translation({45.0 * more, -200.0, 20.0}));
  }
  return state;
}

inline void write_large_fixture(const std::filesystem::path& file, std::size_t instances) {
  Project project = Project::create(file);
  const std::vector<ProjectElement> copies{plate_element(), pin_element(), block_element()};
  project.commit("large", large_fixture(instances), copies);
}

}  // namespace dowel::testing
