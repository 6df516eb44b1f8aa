#pragma once

#include <vector>

#include <Eigen/Core>

#include "part.h"
#include "systems.h"

/// What a turned element is screwed in by: from z = 0 down, in a hole system a shank that locates
/// (not in a slot system), a relief and a thread.
namespace dowel::library {

/// Outline of the foot for `turned`, from its tip on the axis up to z = 0.
std::vector<Eigen::Vector2d> foot_outline(const System& system);

/// Its features: shank, relief and thread.
std::vector<Feature> foot_features(const System& system);

}  // namespace dowel::library
