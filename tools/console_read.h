#pragma once

// Arguments that several words of the console read.

#include <optional>
#include <string>
#include <string_view>

#include "console.h"

namespace dowel::tools {

/// An angle in degrees, at most a full turn either way, as radians.
double read_angle(Arguments& arguments);

/// An instance that there is.
std::string read_instance(Console& console, Arguments& arguments);

/// A feature that there is. `what` says in errors what is expected.
FeatureName read_feature(Console& console, Arguments& arguments, std::string_view what);

/// x, y or z, where it comes next.
std::optional<Eigen::Vector3d> take_coordinate_axis(Arguments& arguments);

/// A line in the world; without a point where the words name a direction alone.
struct Axis {
  std::optional<Eigen::Vector3d> point_W;
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitZ();
};

/// x, y, z or a feature.
Axis read_axis(Console& console, Arguments& arguments);

/// The words behind the features of an insert: `seat ... on ...`, `offset`, `rot`, `flip`, each
/// once.
struct InsertWords {
  std::optional<std::pair<FeatureName, FeatureName>> seat;
  MateOptions options;
};

InsertWords read_insert_words(Console& console, Arguments& arguments);

}  // namespace dowel::tools
