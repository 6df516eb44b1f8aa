// The word that analyses how the workpiece is located and held.

#include <cmath>
#include <filesystem>
#include <numbers>

#include "analysis_drawing.h"
#include "console_commands.h"
#include "console_text.h"
#include "dowel/io/file.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// Whole degrees: orientations are quarter, third and half turns.
double whole_degrees(double angle_rad) {
  return std::round(angle_rad * 180.0 / std::numbers::pi);
}

/// To four digits: no force or error is known better.
std::string rough(double value) {
  constexpr double kDigits = 1.0e4;
  if (value == 0.0 || !std::isfinite(value)) return short_number(value);
  const double scale = kDigits / std::pow(10.0, std::ceil(std::log10(std::abs(value))));
  return short_number(std::round(value * scale) / scale);
}

/// JSON has no infinity.
Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

std::string locating_text(const FixtureAnalysis& analysis) {
  const Locating& locating = analysis.locating;
  std::string text = "located by " + counted(analysis.model.locators.size(), "point") + ": rank " +
                     std::to_string(locating.rank) + " of 6";
  if (locating.is_deterministic()) text += ", condition " + rough(locating.condition);
  if (!locating.redundant.empty()) {
    text += "\n  redundant:";
    for (const std::size_t i : locating.redundant) text += " " + analysis.model.locators[i].name;
  }
  for (Eigen::Index i = 0; i < locating.free_motions.cols(); ++i) {
    const Eigen::VectorXd motion = locating.free_motions.col(i);
    text += "\n  free: slides along " + point_text(motion.head<3>()) + ", turns about " +
            point_text(motion.tail<3>()) + " (over half the diagonal)";
  }
  return text;
}

std::string contact_table(const FixtureAnalysis& analysis, const FixtureDesign& design) {
  Table table({{"contact"},
               {"role"},
               {"place"},
               {"normal"},
               {"force N", Table::Align::Right},
               {"area mm2", Table::Align::Right}});
  const auto area_of = [&](const LocatingPoint& point) {
    for (const WorkpieceContact& contact : analysis.model.contacts) {
      if (contact.instance == point.name && contact.at == point.at) return rough(contact.area_mm2);
    }
    return std::string();  // one of several points of an area
  };
  for (std::size_t i = 0; i < analysis.model.locators.size(); ++i) {
    const LocatingPoint& point = analysis.model.locators[i];
    table.add({point.name, "locating", point_text(point.at), point_text(point.normal),
               analysis.seating ? rough(analysis.seating->forces_N[i]) : "", area_of(point)});
  }
  for (const WorkpieceContact& contact : analysis.model.contacts) {
    if (is_locating(contact.role)) continue;
    const auto force = design.clamp_forces_N.find(contact.instance);
    table.add({contact.instance, std::string(to_string(contact.role)), point_text(contact.at),
               point_text(contact.normal),
               force != design.clamp_forces_N.end() ? rough(force->second) : "",
               rough(contact.area_mm2)});
  }
  return table.text();
}

std::string foolproof_text(const FoolproofAnalysis& analysis) {
  if (analysis.wrong.empty() && analysis.same == 0) return "foolproof: not told below rank 6";
  std::string text =
      "foolproof: none of " + counted(analysis.wrong.size(), "wrong orientation") + " seats";
  if (!analysis.is_foolproof()) {
    text = "foolproof: no, it seats when it is turned";
    for (const WrongOrientation& wrong : analysis.wrong) {
      if (!wrong.seats) continue;
      text += "\n  " + short_number(whole_degrees(wrong.angle_rad)) + " degrees about " +
              point_text(wrong.axis_W);
    }
  }
  if (analysis.same > 0) {
    text += "\n  it looks the same in " + counted(analysis.same, "other orientation");
  }
  return text;
}

std::string wrench_text(const WrenchAccess& access) {
  const std::string what = access.fastener + ": " + access.wrench;
  if (!access.is_free) return what + " is stopped by " + access.blocked_by;
  return what + " swings by " + short_number(whole_degrees(access.swing_rad)) + " degrees";
}

std::string wrenches_text(const std::vector<WrenchAccess>& wrenches, double least_deg) {
  std::size_t reached = 0;
  std::string others;
  for (const WrenchAccess& access : wrenches) {
    if (access.is_free && whole_degrees(access.swing_rad) >= least_deg) {
      ++reached;
    } else {
      others += "\n  " + wrench_text(access);
    }
  }
  return "wrenches: " + std::to_string(reached) + " of " + std::to_string(wrenches.size()) +
         " screws and nuts are reached" + others;
}

std::string analysis_text(const FixtureAnalysis& analysis, const FixtureDesign& design) {
  const FixtureModel& model = analysis.model;
  std::string text = "workpiece " + model.workpiece + ": " +
                     (model.mass_kg ? rough(*model.mass_kg) + " kg" : "mass not known") +
                     ", centre of mass " + point_text(model.center_of_mass) + "\n";
  text += locating_text(analysis) + "\n";
  if (!model.contacts.empty()) text += contact_table(analysis, design) + "\n";
  text += "supports: " + rough(analysis.support_area_mm2) + " mm2, centre of mass " +
          (analysis.support_margin_mm >= 0.0
               ? rough(analysis.support_margin_mm) + " mm inside of them"
               : "outside of them by " + rough(-analysis.support_margin_mm) + " mm") +
          "\n";
  if (analysis.seating) {
    text += "seating without friction: least force " + rough(analysis.seating->least_N) +
            " N, unbalanced " + rough(analysis.seating->residual_N) + " N\n";
  } else {
    text += "seating: not told without clamp forces (`force CLAMP N`) and rank 6\n";
  }
  text += analysis.has_form_closure ? "form closure: held without friction\n"
                                    : "form closure: none, clamps hold by friction\n";
  for (const LoadAnalysis& load : analysis.loads) {
    text += "load " + load.name + ": " + (load.holds ? "holds" : "slips") + " at safety " +
            short_number(design.limit("safety")) + "; the most that holds is " +
            rough(load.factor) + " times the load\n";
  }
  for (const PointAnalysis& point : analysis.points) {
    text += "point " + point.name + ": " + rough(point.error.worst_mm) +
            " mm off at worst, 95 of 100 within " + rough(point.error.p95_mm) + " mm; tolerance " +
            short_number(point.point.tolerance_mm) + " mm\n";
  }
  const UnloadAnalysis& out = analysis.unloading;
  text += "unloading: ";
  if (out.is_free) {
    text += "free along " + point_text(out.direction) + " for " + rough(out.lift_mm) + " mm";
  } else {
    text += "blocked" + (out.blocked_by.empty() ? std::string() : " by " + out.blocked_by) +
            " after " + rough(out.free_share * out.lift_mm) + " of " + rough(out.lift_mm) + " mm";
  }
  text += "\n" + foolproof_text(analysis.foolproof);
  text += "\n" + wrenches_text(analysis.wrenches, design.limit("swing_deg"));
  return text;
}

Json contacts_json(const FixtureAnalysis& analysis) {
  Json contacts = Json::array();
  for (const WorkpieceContact& contact : analysis.model.contacts) {
    contacts.push_back({{"instance", contact.instance},
                        {"role", to_string(contact.role)},
                        {"at", to_json(contact.at)},
                        {"normal", to_json(contact.normal)},
                        {"area_mm2", contact.area_mm2}});
  }
  return contacts;
}

Json foolproof_json(const FoolproofAnalysis& analysis) {
  Json wrong = Json::array();
  for (const WrongOrientation& one : analysis.wrong) {
    wrong.push_back({{"axis", to_json(one.axis_W)},
                     {"angle_deg", whole_degrees(one.angle_rad)},
                     {"seats", one.seats},
                     {"against", one.against}});
  }
  return {{"same", analysis.same}, {"wrong", std::move(wrong)}};
}

Json analysis_json(const FixtureAnalysis& analysis) {
  const FixtureModel& model = analysis.model;
  Json json{{"workpiece", model.workpiece},
            {"mass_kg", model.mass_kg ? Json(*model.mass_kg) : Json()},
            {"center_of_mass", to_json(model.center_of_mass)},
            {"length_mm", model.frame.length_mm},
            {"rank", analysis.locating.rank},
            {"condition", number_json(analysis.locating.condition)},
            {"singular_values", analysis.locating.singular_values},
            {"form_closure", analysis.has_form_closure},
            {"support_area_mm2", analysis.support_area_mm2},
            {"support_margin_mm", number_json(analysis.support_margin_mm)}};
  json["contacts"] = contacts_json(analysis);
  json["locators"] = Json::array();
  for (std::size_t i = 0; i < model.locators.size(); ++i) {
    Json point{{"instance", model.locators[i].name},
               {"at", to_json(model.locators[i].at)},
               {"normal", to_json(model.locators[i].normal)},
               {"error_mm", model.locators[i].error_mm}};
    point["seating_N"] = analysis.seating ? Json(analysis.seating->forces_N[i]) : Json();
    json["locators"].push_back(std::move(point));
  }
  json["redundant"] = analysis.locating.redundant;
  json["loads"] = Json::array();
  for (const LoadAnalysis& load : analysis.loads) {
    json["loads"].push_back({{"name", load.name},
                             {"holds", load.holds},
                             {"factor", load.factor},
                             {"unbalanced_N", load.residual_N}});
  }
  json["points"] = Json::array();
  for (const PointAnalysis& point : analysis.points) {
    json["points"].push_back({{"name", point.name},
                              {"worst_mm", number_json(point.error.worst_mm)},
                              {"mean_mm", number_json(point.error.mean_mm)},
                              {"p95_mm", number_json(point.error.p95_mm)},
                              {"tolerance_mm", point.point.tolerance_mm}});
  }
  json["unloading"] = {{"free", analysis.unloading.is_free},
                       {"direction", to_json(analysis.unloading.direction)},
                       {"lift_mm", analysis.unloading.lift_mm},
                       {"free_share", analysis.unloading.free_share},
                       {"blocked_by", analysis.unloading.blocked_by}};
  json["foolproof"] = foolproof_json(analysis.foolproof);
  json["wrenches"] = Json::array();
  for (const WrenchAccess& access : analysis.wrenches) {
    json["wrenches"].push_back({{"fastener", access.fastener},
                                {"wrench", access.wrench},
                                {"before_workpiece", access.before_workpiece},
                                {"free", access.is_free},
                                {"blocked_by", access.blocked_by},
                                {"lever_mm", access.lever_mm},
                                {"swing_deg", whole_degrees(access.swing_rad)}});
  }
  return json;
}

}  // namespace

Reply run_analyse(Console& console, Arguments& arguments) {
  std::string file;
  if (!arguments.at_end()) file = arguments.word("a file that ends in .svg");
  arguments.expect_end();
  if (!file.empty() && std::filesystem::path(file).extension() != ".svg") {
    arguments.fail_at_last("expected a file that ends in .svg");
  }
  const FixtureAnalysis analysis = analyse_fixture(console.session());
  Reply reply;
  reply.text = analysis_text(analysis, console.session().state().design);
  reply.json = analysis_json(analysis);
  if (!file.empty()) {
    write_file(file, analysis_drawing(console.session(), analysis));
    reply.text += "\n" + file + ": written";
    reply.json["file"] = file;
  }
  return reply;
}

}  // namespace dowel::tools
