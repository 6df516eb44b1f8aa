// Facts about the workpiece: what locates, clamps and loads it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fact_source.h"
#include "fixture_result.h"

namespace dowel {
namespace {

/// NULL where it is no number: not every quantity exists in every fixture.
FactValue finite_or_null(double value) {
  return std::isfinite(value) ? FactValue(value) : FactValue();
}

FactRows workpiece_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    const Locating locating = analyse_locating(model.locators, model.frame);
    const auto supports = support_points(model);
    const auto polygon = convex_polygon(supports);
    const double margin_mm = supports.empty()
                                 ? std::numeric_limits<double>::quiet_NaN()
                                 : support_margin_mm(supports, model.center_of_mass.head<2>());
    std::string redundant;
    for (const std::size_t index : locating.redundant) {
      redundant += (redundant.empty() ? "" : ", ") + model.locators[index].name;
    }
    rows.push_back({model.workpiece, model.mass_kg ? FactValue(*model.mass_kg) : FactValue(),
                    model.frame.length_mm, std::int64_t(model.locators.size()),
                    std::int64_t{locating.rank}, finite_or_null(locating.condition),
                    std::int64_t(locating.redundant.size()), text_or_null(redundant),
                    polygon_area_mm2(polygon), finite_or_null(margin_mm),
                    truth(has_form_closure(all_wrenches(model)))});
  }
  return rows;
}

FactRows locator_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    const Locating locating = analyse_locating(model.locators, model.frame);
    const auto seating = seating_of(model, source.state().design);
    for (std::size_t i = 0; i < model.locators.size(); ++i) {
      const LocatingPoint& point = model.locators[i];
      const bool is_redundant =
          std::ranges::find(locating.redundant, i) != locating.redundant.end();
      rows.push_back({model.workpiece, point.name, point.at.x(), point.at.y(), point.at.z(),
                      point.normal.x(), point.normal.y(), point.normal.z(), truth(point.two_sided),
                      point.error_mm, truth(is_redundant),
                      seating ? FactValue(seating->forces_N[i]) : FactValue()});
    }
  }
  return rows;
}

FactRows workpiece_contacts(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const WorkpieceContact& contact : model.contacts) {
      rows.push_back({model.workpiece, contact.instance, std::string(to_string(contact.role)),
                      contact.at.x(), contact.at.y(), contact.at.z(), contact.normal.x(),
                      contact.normal.y(), contact.normal.z(), contact.area_mm2});
    }
  }
  return rows;
}

FactRows clamp_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const WorkpieceContact& contact : model.contacts) {
      if (contact.role != Role::Clamp) continue;
      const auto force = source.state().design.clamp_forces_N.find(contact.instance);
      double best = std::numeric_limits<double>::infinity();
      for (const LocatingPoint& point : model.locators) {
        best = std::min(best, contact.normal.dot(point.normal));
      }
      rows.push_back({model.workpiece, contact.instance, contact.at.x(), contact.at.y(),
                      contact.at.z(), contact.normal.x(), contact.normal.y(), contact.normal.z(),
                      contact.area_mm2,
                      force != source.state().design.clamp_forces_N.end() ? FactValue(force->second)
                                                                          : FactValue(),
                      finite_or_null(best), finite_or_null(clamp_margin_mm(model, contact))});
    }
  }
  return rows;
}

FactRows point_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const PointAnalysis& point : analyse_points(model, source.state().design)) {
      rows.push_back({point.name, model.workpiece, point.point.at.x(), point.point.at.y(),
                      point.point.at.z(), point.point.tolerance_mm,
                      finite_or_null(point.error.worst_mm), finite_or_null(point.error.p95_mm)});
    }
  }
  return rows;
}

FactRows load_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const LoadAnalysis& load : analyse_loads(model, source.state().design)) {
      const Eigen::Vector3d& force_N = load.load.force_N;
      rows.push_back({load.name, model.workpiece, force_N.norm(), force_N.x(), force_N.y(),
                      force_N.z(), truth(load.holds), load.factor, load.residual_N});
    }
  }
  return rows;
}

FactRows unloading_rows(FactSource& source) {
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    const UnloadAnalysis& unloading = source.unloading(model);
    rows.push_back({model.workpiece, truth(unloading.is_free), unloading.direction.x(),
                    unloading.direction.y(), unloading.direction.z(), unloading.lift_mm,
                    unloading.free_share, text_or_null(unloading.blocked_by)});
  }
  return rows;
}

FactRows orientation_rows(FactSource& source) {
  constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
  FactRows rows;
  for (const FixtureModel& model : source.fixtures()) {
    for (const WrongOrientation& wrong : source.foolproof(model).wrong) {
      rows.push_back({model.workpiece, std::round(wrong.angle_rad * kDegrees_per_rad),
                      wrong.axis_W.x(), wrong.axis_W.y(), wrong.axis_W.z(), truth(wrong.seats),
                      text_or_null(wrong.against)});
    }
  }
  return rows;
}

constexpr unsigned kFromAll = FromParts | FromDesign | FromTolerance;

}  // namespace

std::vector<FactTable> locating_facts() {
  return {
      {"clamps",
       "Where clamps touch the workpiece.",
       {{"workpiece", "instance"},
        {"instance", "clamp"},
        {"x_mm", "middle of the contact"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"nx", "normal into the workpiece, the way it presses; unit"},
        {"ny", ""},
        {"nz", ""},
        {"area_mm2", "0: along a line or at a point"},
        {"force_N", "as given by `force`; NULL where it is not"},
        {"toward", "least product of its normal with that of a locator; -1: straight at one"},
        {"support_margin_mm",
         "how far inside the supports its line of force meets their plane; NULL where it presses "
         "sideways"}},
       kFromAll,
       clamp_rows},
      {"loads",
       "Cutting loads as given by `load`.",
       {{"load", "name"},
        {"workpiece", "instance"},
        {"force_N", "its size"},
        {"fx_N", "as it acts on the workpiece"},
        {"fy_N", ""},
        {"fz_N", ""},
        {"holds", "1: held by friction with the factor `safety`"},
        {"factor", "the largest that holds, up to 100"},
        {"unbalanced_N", "at the factor `safety`"}},
       kFromAll,
       load_rows},
      {"locators",
       "Points that settle where the workpiece is. A wide area counts as two or three.",
       {{"workpiece", "instance"},
        {"instance", "locator or support"},
        {"x_mm", "point"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"nx", "normal into the workpiece; unit"},
        {"ny", ""},
        {"nz", ""},
        {"two_sided", "1: a pin in a hole, which pushes either way"},
        {"error_mm", "plus or minus, along the normal; of a pin with half its play"},
        {"redundant", "1: adds nothing to those before it"},
        {"seating_N",
         "force on it under clamps and weight, without friction; NULL without clamp "
         "forces"}},
       kFromAll,
       locator_rows},
      {"orientations",
       "Quarter, third and half turns of a workpiece with rank 6 about the axes of its box in "
       "which "
       "it looks different, each pushed towards the locators, clamps off.",
       {{"workpiece", "instance"},
        {"angle_deg", "of the turn"},
        {"dx", "its axis; unit"},
        {"dy", ""},
        {"dz", ""},
        {"seats", "1: on all locators, clear of everything"},
        {"against", "what it is in, or the locator that it does not reach; NULL where it seats"}},
       kFromAll,
       orientation_rows},
      {"points",
       "Critical points as given by `point`, and what the errors of the locators make of them.",
       {{"point", "name"},
        {"workpiece", "instance"},
        {"x_mm", ""},
        {"y_mm", ""},
        {"z_mm", ""},
        {"tolerance_mm", "plus or minus"},
        {"worst_mm", "error, worst case; NULL where the locators do not settle the workpiece"},
        {"p95_mm", "error that 95 of 100 fixtures stay below"}},
       kFromAll,
       point_rows},
      {"unloading",
       "Whether the workpiece comes out, clamps taken off.",
       {{"workpiece", "instance"},
        {"free", "1: along the direction, as far as limit lift_mm"},
        {"dx", "direction; unit"},
        {"dy", ""},
        {"dz", ""},
        {"lift_mm", "tried"},
        {"free_share", "of the way"},
        {"blocked_by", "instance; NULL where nothing is"}},
       kFromAll,
       unloading_rows},
      {"workpiece_contacts",
       "All that touches the workpiece.",
       {{"workpiece", "instance"},
        {"instance", "what touches it"},
        {"role", "of that"},
        {"x_mm", "middle"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"nx", "normal into the workpiece; unit"},
        {"ny", ""},
        {"nz", ""},
        {"area_mm2", "0: along a line or at a point"}},
       kFromAll,
       workpiece_contacts},
      {"workpieces",
       "Parts to be machined, and how the locators settle them.",
       {{"workpiece", "instance"},
        {"mass_kg", "NULL where its density is not known"},
        {"length_mm", "half the diagonal of its box"},
        {"points", "rows in `locators`"},
        {"rank", "of the locator matrix: 6 settles it"},
        {"condition", "of the locator matrix; NULL below rank 6"},
        {"redundant", "points that add nothing"},
        {"redundant_names", "theirs; NULL where there is none"},
        {"support_area_mm2", "of the polygon around the supports, from above"},
        {"support_margin_mm", "centre of mass inside that polygon; below 0: outside"},
        {"form_closure", "1: held by all contacts without friction"}},
       kFromAll,
       workpiece_rows},
  };
}

const std::vector<FactTable>& fact_tables() {
  static const std::vector<FactTable> kTables = [] {
    std::vector<FactTable> all;
    for (const auto& make :
         {part_facts, mate_facts, pair_facts, axis_facts, locating_facts, design_facts,
          stated_facts, slot_facts, access_facts, washer_facts, order_facts}) {
      for (FactTable& table : make()) all.push_back(std::move(table));
    }
    std::ranges::sort(all, [](const FactTable& a, const FactTable& b) {
      return std::string_view(a.name) < std::string_view(b.name);
    });
    return all;
  }();
  return kTables;
}

}  // namespace dowel
