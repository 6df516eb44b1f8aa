#pragma once

// Whether the workpiece seats in a wrong orientation. Internal to the fixture analysis.

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dowel/assembly/fixture_analysis.h"
#include "placed_bodies.h"

namespace dowel {

class FactSource;

/// What the question hangs on.
struct FoolproofQuestion {
  std::string workpiece;
  LocatingFrame frame;
  std::vector<LocatingPoint> locators;
  ProjectState opened;  ///< the workpiece and what it can reach when clamps are off; parts alone
  std::map<std::string, Eigen::AlignedBox3d> boxes_W;  ///< around these parts
  double tolerance_mm = 0.0;

  bool operator==(const FoolproofQuestion& other) const {
    return workpiece == other.workpiece && frame == other.frame && locators == other.locators &&
           opened.instances == other.opened.instances && tolerance_mm == other.tolerance_mm;
  }
};

FoolproofQuestion foolproof_question(const FixtureModel& model, FactSource& source);

/// One orientation, and all the room that was looked at to tell.
struct OrientationTry {
  bool looks_same = false;
  WrongOrientation result;
  Eigen::AlignedBox3d room_W;
};

/// A question and its answer, orientation by orientation, always in the same order.
struct FoolproofAnswer {
  FoolproofQuestion question;
  std::vector<OrientationTry> tries;

  FoolproofAnalysis analysis() const;
};

/// Tries those orientations again where something changed in the room that `known` looked at.
FoolproofAnswer analyse_foolproof(FoolproofQuestion question, const FoolproofAnswer& known,
                                  const Element& workpiece, PlacedBodies& models);

}  // namespace dowel
