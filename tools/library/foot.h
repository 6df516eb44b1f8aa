#pragma once

#include <vector>

#include <Eigen/Core>

#include "part.h"

/// What screws an element into a node: a shank of 12g6 that locates, a relief and an M12 thread,
/// from z = 0 down.
namespace dowel::library {

/// Outline of the spigot for `turned`, from its tip on the axis up to the shank at z = 0.
std::vector<Eigen::Vector2d> spigot_outline();

/// Its features: the shank and the thread.
std::vector<DesignedFeature> spigot_features();

}  // namespace dowel::library
