#pragma once

// Steps of the fixture analysis that rules ask for one by one. Internal to both.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dowel/assembly/fixture_analysis.h"

namespace dowel {

class FactSource;
class PlacedBodies;

/// What is taken off before the workpiece comes out: clamps, and fasteners that touch one.
std::set<std::string> taken_off(const ProjectState& state, Session& session,
                                const std::vector<Touch>& touches);

/// Columns: a unit force at each locating point and each clamp contact.
Eigen::MatrixXd all_wrenches(const FixtureModel& model);

/// Nothing without clamp forces, or where the points do not settle the workpiece.
std::optional<Seating> seating_of(const FixtureModel& model, const FixtureDesign& design);

/// How far inside the polygon of the supports the line of a clamp's force meets their mean plane;
/// not a number where it presses up or sideways (within 45 degrees), or there are no supports.
double clamp_margin_mm(const FixtureModel& model, const WorkpieceContact& clamp);

/// Errors are not a number where the locators do not settle the workpiece.
std::vector<PointAnalysis> analyse_points(const FixtureModel& model, const FixtureDesign& design);

std::vector<LoadAnalysis> analyse_loads(const FixtureModel& model, const FixtureDesign& design);

/// The workpiece, and what comes nearer than `reach_mm` to the middle of its box when clamps are
/// off.
ProjectState opened_around(const FixtureModel& model, FactSource& source, double reach_mm);

/// What the question whether a workpiece comes out hangs on.
struct Unloading {
  std::string workpiece;
  ProjectState opened;                ///< what it can reach when clamps are off; no more than parts
  std::vector<Eigen::Vector3d> ways;  ///< to try
  double lift_mm = 0.0;
  double tolerance_mm = 0.0;

  bool operator==(const Unloading& other) const {
    return workpiece == other.workpiece && opened.instances == other.opened.instances &&
           ways == other.ways && lift_mm == other.lift_mm && tolerance_mm == other.tolerance_mm;
  }
};

Unloading unloading_of(const FixtureModel& model, FactSource& source);
/// `models`: of the elements.
UnloadAnalysis analyse_unloading(const Unloading& unloading, const PlacedBodies& models);

}  // namespace dowel
