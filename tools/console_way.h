#pragma once

// How the console tells of the ways by which parts come and go.

#include <string>
#include <vector>

#include "console.h"

namespace dowel::tools {

/// "along PLATE.C4 (0 0 1): blocked by ROOF after 12 of 80 mm"
std::string way_text(const WayOut& way);
Json to_json(const WayOut& way);

/// The instances that are touched: "ROOF, POST".
std::string names_text(const std::vector<Touch>& touches);

/// Says in the reply to a placement where no straight way along the part's mates leads from clear
/// to its seat, and what is in the way. Tells nothing of a part without mates, one that was refused
/// and one that interferes or was not checked.
void add_way_in(Session& session, const MoveReport& report, Reply& reply);

}  // namespace dowel::tools
