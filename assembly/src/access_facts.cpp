// Facts about what tools reach.

#include <cmath>
#include <numbers>

#include "fact_source.h"

namespace dowel {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

/// NULL of nuts, and of screws without a head.
FactValue length_mm(FactSource& source, const std::string& fastener) {
  const auto& drive = source.drive(source.state().find(fastener)->element);
  if (!drive || drive->is_nut || !std::isfinite(drive->seat_mm)) return {};
  return drive->seat_mm - drive->low_mm;
}

FactRows wrenches(FactSource& source) {
  FactRows rows;
  for (const WrenchAccess& access : source.wrenches()) {
    rows.push_back({access.fastener, access.wrench, truth(access.before_workpiece),
                    truth(access.is_free), text_or_null(access.blocked_by), access.lever_mm,
                    kDegrees_per_rad * access.swing_rad,
                    access.comes_in ? truth(*access.comes_in) : FactValue(),
                    text_or_null(access.stopped_by), length_mm(source, access.fastener)});
  }
  return rows;
}

FactRows cutters(FactSource& source) {
  FactRows rows;
  const FixtureDesign& design = source.state().design;
  const double clearance_mm = design.limit("cutter_clearance_mm");
  for (const auto& [name, point] : design.points) {
    const auto diameter_mm = design.stated_value("cutter_mm", name);
    const auto length_mm = design.stated_value("cutter_length_mm", name);
    if (!diameter_mm || !length_mm) {
      rows.push_back({name, FactValue(), FactValue(), FactValue(), FactValue()});
      continue;
    }
    std::string all;
    for (const std::string& part :
         source.in_way_of_cutter(point, *diameter_mm + 2.0 * clearance_mm, *length_mm)) {
      all += (all.empty() ? "" : ", ") + part;
    }
    rows.push_back({name, *diameter_mm, *length_mm, truth(all.empty()), text_or_null(all)});
  }
  return rows;
}

constexpr unsigned kFromFixture = FromParts | FromMates | FromDesign | FromTolerance;

}  // namespace

std::vector<FactTable> access_facts() {
  return {
      {"cutters",
       "Cutters that come down to critical points, with limit cutter_clearance_mm around them.",
       {{"point", "name"},
        {"cutter_mm", "diameter, as `design POINT cutter_mm` states it; NULL where it does not"},
        {"length_mm", "of cutter and holder, as `design POINT cutter_length_mm` states it"},
        {"free", "1: clear of all parts but the workpiece; NULL where a size is not stated"},
        {"in_way", "instances; NULL where there is none"}},
       FromParts | FromDesign | FromTolerance,
       cutters},
      {"wrenches",
       "Screws and nuts with a hexagon, and the wrench that turns each: hexagon key, socket or "
       "spanner. Those of clamps are tightened with the workpiece in its place, others before it "
       "and before what stands on the part that they hold.",
       {{"instance", "screw or nut"},
        {"wrench", "kind and width across flats in mm"},
        {"before_workpiece", "1: it is tightened before the workpiece is there"},
        {"free", "1: the wrench goes onto it along its axis"},
        {"blocked_by", "the first part in its way; NULL where there is none"},
        {"lever_mm", "length of the lever"},
        {"swing_deg", "the widest angle through which the lever turns freely"},
        {"comes_in", "1: the screw comes straight along its axis; NULL of nuts"},
        {"stopped_by", "the first part in the screw's way; NULL where there is none"},
        {"length_mm", "of a screw from under its head to its tip; NULL without head, and of nuts"}},
       kFromFixture,
       wrenches},
  };
}

}  // namespace dowel
