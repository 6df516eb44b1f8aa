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

/// "slides along x", "turns about z at 20 0 40"
std::string freedom_text(const Freedom& freedom);
/// "slides along x; turns about z at 20 0 40 (against PLATE1)", "cannot move"
std::string freedoms_text(const FreedomReport& report);
/// "mate R1.h2 with PLATE1.C5 (align) cannot hold: it misses by 2.5 mm and 0 deg; against mate 1:
/// ..."
std::string conflict_text(const MateConflict& conflict);

Json to_json(const Pose& pose);
Json to_json(const Touch& touch);
Json to_json(const Mate& mate);
Json to_json(const Instance& instance);
Json to_json(const FreedomReport& report);

/// "interference with BLOCK1 (depth 2.5 mm at 10 0 30), contact with PLATE1"
std::string touches_text(const std::vector<Touch>& touches);

/// Reply to a placement or move. `done`: what stands before the place, "moved to".
Reply to_reply(const MoveReport& report, std::string_view done);

}  // namespace dowel::tools
