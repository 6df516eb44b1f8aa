#pragma once

// How the console words what a shaft and a hole are to each other.

#include <string>

#include "console.h"
#include "dowel/assembly/fit.h"

namespace dowel::tools {

/// "12 H7/g6: clearance fit, clearance 6 to 35 um"
std::string fit_text(const Fit& fit);
Json to_json(const Fit& fit);

/// The same of a shaft and a hole: by the classes that the catalogue states, else by those that the
/// diameters as drawn tell, as a thread, or by the play between them.
std::string drawn_fit_text(const Feature& shaft, const Feature& hole);
Json drawn_fit_json(const Feature& shaft, const Feature& hole);

/// What shaft and hole of a mate are to each other, with the length of a thread that is in use;
/// empty where it is of no shaft and hole.
std::string mate_fit_text(Session& session, const Mate& mate);

}  // namespace dowel::tools
