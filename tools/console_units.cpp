// The words about several parts at once: units, the order of assembly, what differs from another
// project.

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <system_error>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "console_way.h"
#include "dowel/assembly/names.h"
#include "dowel/assembly/project_diff.h"
#include "dowel/assembly/sequence.h"
#include "dowel/assembly/unit.h"
#include "dowel/kernel/tolerance.h"

namespace dowel::tools {
namespace {

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Where a unit is put: `at X Y Z`, or on a feature.
Pose read_place(Console& console, Arguments& arguments) {
  if (arguments.is_number()) {
    return Pose::from_translation(arguments.point("three coordinates in mm"));
  }
  const FeatureName at = read_feature(console, arguments, "three coordinates or a feature");
  return console.session().pose_at(at);
}

}  // namespace

namespace {

/// Whether a file is that of the open project, which nobody else can open meanwhile.
bool is_at_hand(Console& console, const std::string& file) {
  std::error_code ignored;
  const std::filesystem::path& own = console.session().project().file();
  return !own.empty() && std::filesystem::equivalent(file, own, ignored);
}

}  // namespace

Reply run_unit(Console& console, Arguments& arguments) {
  std::vector<std::string> names;
  while (!arguments.at_end()) {
    names.push_back(read_instance(console, arguments));
    if (std::ranges::count(names, names.back()) > 1) {
      arguments.fail_at_last(names.back() + " is named twice");
    }
  }
  if (names.empty()) arguments.fail("expected an instance");
  Reply reply;
  if (names.size() > 1) {
    const std::vector<Mate> made = console.session().fix(names, arguments.line());
    for (const Mate& mate : made) reply.json["mates"].push_back(to_json(mate));
  }
  const std::vector<std::string> unit = console.session().unit(names.front());
  reply.text =
      unit.size() == 1 ? unit.front() + ": fixed to nothing" : "moves as one: " + names_text(unit);
  reply.json["unit"] = unit;
  return reply;
}

Reply run_save_unit(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  const std::string file = arguments.word("a file for the unit");
  std::vector<std::string> names{name};
  // What hangs on it is part of it.
  for (std::string& other : console.session().sub_assembly(name)) {
    if (other != name) names.push_back(std::move(other));
  }
  arguments.expect_end();
  arguments.located([&] { save_unit(console.session(), names, file); });
  Reply reply;
  reply.text = file + ": " + names_text(names);
  reply.json["file"] = file;
  reply.json["instances"] = names;
  return reply;
}

Reply run_insert_unit(Console& console, Arguments& arguments) {
  const std::string file = arguments.word("the file of a unit");
  if (is_at_hand(console, file)) {
    arguments.fail_at_last(file + " is the project at hand; `save-unit` writes a part of it");
  }
  const Project unit = arguments.located([&] { return Project::open(file); });
  std::string prefix;
  Pose X_WU;
  bool is_placed = false;
  while (!arguments.at_end()) {
    if (prefix.empty() && arguments.take("as")) {
      prefix = arguments.word("a name for the unit");
      if (const auto defect = instance_name_defect(prefix)) {
        arguments.fail_at_last("unit name \"" + prefix + "\" " + *defect);
      }
    } else if (!is_placed && arguments.take("at")) {
      X_WU = read_place(console, arguments);
      is_placed = true;
    } else {
      arguments.fail("expected `as` or `at`, each once");
    }
  }
  if (prefix.empty()) {
    const auto is_taken = [&](const std::string& name) {
      const std::string start = name + "-";
      for (const auto& [other, instance] : console.session().state().instances) {
        if (other.starts_with(start)) return true;
      }
      return false;
    };
    prefix = free_name("unit", is_taken);
  }
  const auto reports = console.session().insert_unit(unit, prefix, X_WU, arguments.line());
  Reply reply;
  Verdict verdict = Verdict::Clear;
  reply.json["unit"] = prefix;
  reply.json["placed"] = Json::array();
  for (const MoveReport& report : reports) {
    Reply one = to_reply(report, "placed at");
    if (report.refused && report.touches.empty()) {
      one.text = report.instance + ": refused with the others";
    }
    reply.text += (reply.text.empty() ? "" : "\n") + one.text;
    reply.json["placed"].push_back(std::move(one.json));
    if (report.refused) reply.outcome = "refused";
    verdict = std::max(verdict, report.verdict);
    if (report.checked) reply.verdict = to_string(verdict);
  }
  return reply;
}

namespace {

/// Interferences of parts as they stand, by the one that was placed first.
void add_entered(const std::vector<Touch>& entered, Reply& reply) {
  reply.json["interfering"] = Json::array();
  std::string last;
  for (const Touch& touch : entered) {
    if (last.empty()) {
      reply.text +=
          "\nthese interfere as they stand, and no way is free for parts that do; `check` tells "
          "where:";
    }
    reply.text += touch.instance == last ? ", " : "\n  " + touch.instance + " with ";
    reply.text += touch.with;
    last = touch.instance;
    reply.json["interfering"].push_back({touch.instance, touch.with});
  }
}

}  // namespace

Reply run_sequence(Console& console, Arguments& arguments) {
  arguments.expect_end();
  const AssemblySequence sequence = plan_sequence(console.session());
  Reply reply;
  reply.json["base"] = sequence.base;
  reply.json["steps"] = Json::array();
  reply.json["blocked"] = Json::array();
  reply.text = sequence.base.empty() ? "there are no parts" : "base: " + names_text(sequence.base);
  const auto& instances = console.session().state().instances;
  if (!sequence.base.empty() && !instances.at(sequence.base.front()).grounded) {
    reply.text += ", placed first; nothing is grounded";
  }
  for (const AssemblyStep& step : sequence.steps) {
    const Eigen::Vector3d in_W = -step.way.direction_W;
    reply.json["steps"].push_back({{"parts", step.parts},
                                   {"along", step.way.along},
                                   {"direction", to_json(in_W)},
                                   {"way_mm", step.way.way_mm}});
    reply.text += "\n" + std::to_string(reply.json["steps"].size()) + ". " +
                  names_text(step.parts) + ": by " + point_text(step.way.way_mm * in_W) +
                  ", along " + step.way.along;
  }
  for (const BlockedPart& part : sequence.blocked) {
    Json json{{"part", part.part}, {"ways", Json::array()}};
    reply.text += "\ncannot be brought in: " + part.part;
    if (part.ways.empty()) reply.text += "; no mate and no base gives it a way";
    for (const WayOut& way : part.ways) {
      json["ways"].push_back(to_json(way));
      reply.text += "\n  " + way_text(way);
    }
    reply.json["blocked"].push_back(std::move(json));
  }
  add_entered(sequence.entered, reply);
  reply.has_findings = !sequence.blocked.empty();
  return reply;
}

namespace {

void add_changes(const std::vector<std::pair<Instance, Instance>>& changed, Reply& reply) {
  for (const auto& [before, after] : changed) {
    reply.text += "\n~ " + before.name + ":";
    if (before.element != after.element) {
      reply.text += " " + before.element + " to " + after.element;
    }
    const double turn_rad = before.X_WI.rotation().angularDistance(after.X_WI.rotation());
    const Eigen::Vector3d by_mm = after.X_WI.translation() - before.X_WI.translation();
    if (by_mm.norm() > 0.0) reply.text += " moved by " + point_text(by_mm);
    if (turn_rad > kRounding)
      reply.text += " turned by " + length_text(turn_rad * 180.0 / std::numbers::pi) + " deg";
    if (before.grounded != after.grounded) reply.text += after.grounded ? " grounded" : " let go";
    reply.json["changed"].push_back({{"before", to_json(before)}, {"after", to_json(after)}});
  }
}

}  // namespace

Reply run_diff(Console& console, Arguments& arguments) {
  const std::string first = arguments.word("a project file");
  const auto state_of = [&](const std::string& file) {
    if (is_at_hand(console, file)) return console.session().state();
    return arguments.located([&] { return read_project_state(file); });
  };
  const ProjectState a = state_of(first);
  ProjectState b = console.session().state();
  if (!arguments.at_end()) {
    b = state_of(arguments.word("another project file"));
  }
  arguments.expect_end();
  const ProjectDiff difference = diff(a, b);
  Reply reply;
  for (const char* key : {"removed", "added", "changed", "mates_removed", "mates_added",
                          "mates_changed", "settings"}) {
    reply.json[key] = Json::array();
  }
  for (const Instance& gone : difference.removed) {
    reply.text += "\n- " + gone.name + " (" + gone.element + ")";
    reply.json["removed"].push_back(to_json(gone));
  }
  for (const Instance& come : difference.added) {
    reply.text +=
        "\n+ " + come.name + " (" + come.element + ") at " + point_text(come.X_WI.translation());
    reply.json["added"].push_back(to_json(come));
  }
  add_changes(difference.changed, reply);
  for (const Mate& gone : difference.mates_removed) {
    reply.text += "\n- mate " + mate_text(gone);
    reply.json["mates_removed"].push_back(to_json(gone));
  }
  for (const Mate& come : difference.mates_added) {
    reply.text += "\n+ mate " + mate_text(come);
    reply.json["mates_added"].push_back(to_json(come));
  }
  for (const auto& [before, after] : difference.mates_changed) {
    reply.text += "\n~ mate " + mate_text(before) + " to " + mate_text(after);
    reply.json["mates_changed"].push_back({{"before", to_json(before)}, {"after", to_json(after)}});
  }
  for (const std::string& setting : difference.settings) {
    reply.text += "\n~ " + setting;
    reply.json["settings"].push_back(setting);
  }
  reply.text = difference.is_empty() ? "no difference" : reply.text.substr(1);
  reply.has_findings = !difference.is_empty();
  return reply;
}

}  // namespace dowel::tools
