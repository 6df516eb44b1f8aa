#pragma once

// How the console words places, verdicts and moves.

#include <string>
#include <string_view>
#include <vector>

#include "console.h"

namespace dowel::tools {

/// To a tenth of a micrometre, so that rounding does not show: "12.5 0 -30".
std::string point_text(const Eigen::Vector3d& point);

std::string length_text(double length_mm);

/// "insert PIN1.pin1 into PLATE1.C4 (shaft in hole)"
std::string mate_text(const Mate& mate);

Json to_json(const Pose& pose);
Json to_json(const Touch& touch);
Json to_json(const Mate& mate);
Json to_json(const Instance& instance);

/// "interference with BLOCK1 (depth 2.5 mm at 10 0 30), contact with PLATE1"
std::string touches_text(const std::vector<Touch>& touches);

/// Reply to a placement or move. `done`: what stands before the place, "moved to".
Reply to_reply(const MoveReport& report, std::string_view done);

}  // namespace dowel::tools
