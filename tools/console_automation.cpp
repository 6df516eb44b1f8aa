// The words that choose standard parts and place them.

#include <cmath>
#include <optional>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "dowel/assembly/automation.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// `way N` and `dry-run`, each once.
struct WayWords {
  std::size_t way = 0;  ///< from 0
  bool dry_run = false;
};

WayWords read_way(Arguments& arguments) {
  WayWords words;
  bool has_way = false;
  while (!arguments.at_end()) {
    if (!has_way && arguments.take("way")) {
      has_way = true;
      words.way = arguments.count("the number of a way") - 1;
    } else if (!words.dry_run && (arguments.take("dry-run") || arguments.take("--dry-run"))) {
      words.dry_run = true;
    } else {
      arguments.fail("expected `way` or `dry-run`, each once");
    }
  }
  return words;
}

void expect_way(const Arguments& arguments, std::size_t way, std::size_t count) {
  if (way >= count) {
    arguments.fail_at_last("there " + std::string(count == 1 ? "is " : "are ") +
                           counted(count, "way"));
  }
}

std::string stack_text(const std::vector<Spacer>& way) {
  std::string text;
  for (const Spacer& spacer : way) text += (text.empty() ? "" : " + ") + spacer.element;
  return text;
}

std::string fastening_text(const Fastening& way, const FasteningPlan& plan) {
  constexpr double kHundredths = 100.0;
  const auto rounded = [](double value) { return std::round(kHundredths * value) / kHundredths; };
  const auto mm_text = [&](double length_mm) { return length_text(rounded(length_mm)) + " mm"; };
  const bool is_bolt = way.screw.kind == Fastener::Kind::TeeBolt;
  std::string text = way.screw.element;
  if (is_bolt) text += " in " + plan.holes.at(way.thread).text();
  if (way.nut && is_bolt) text += " with " + way.nut->element;
  if (way.washer) text += " on " + way.washer->element;
  if (way.conical_seat) text += " in " + way.conical_seat->element;
  if (way.nut && !is_bolt) text += " with " + way.nut->element;
  text += ": grip " + mm_text(way.grip_mm) + ", ";
  if (way.nut) return text + "looks out of the nut by " + mm_text(way.spare_mm);
  const std::string in_diameters = short_number(rounded(way.engagement_mm / way.screw.nominal_mm));
  return text + mm_text(way.engagement_mm) + " (" + in_diameters + " d) in the thread of " +
         (way.tee_nut ? way.tee_nut->element + " in " : std::string()) +
         plan.holes.at(way.thread).text() + ", " + mm_text(way.spare_mm) +
         (way.tee_nut ? " above the slot's floor" : " before its end");
}

Json to_json(const Fastening& way, const FasteningPlan& plan) {
  const bool is_bolt = way.screw.kind == Fastener::Kind::TeeBolt;
  Json json{{is_bolt ? "tee_bolt" : "screw", way.screw.element},
            {"grip_mm", way.grip_mm},
            {"engagement_mm", way.engagement_mm},
            {"spare_mm", way.spare_mm}};
  if (way.washer) json["washer"] = way.washer->element;
  if (way.conical_seat) json["conical_seat"] = way.conical_seat->element;
  if (way.tee_nut) json["tee_nut"] = way.tee_nut->element;
  if (way.nut) json["nut"] = way.nut->element;
  if (is_bolt) {
    json["slot"] = plan.holes.at(way.thread).text();
  } else if (!way.nut) {
    json["thread"] = plan.holes.at(way.thread).text();
  }
  return json;
}

/// What became of several placements: `chosen` says why these.
Reply placed_reply(const std::vector<MoveReport>& reports, const std::string& chosen,
                   bool dry_run) {
  Reply reply;
  reply.text = (dry_run ? "would take " : "") + chosen;
  reply.json["dry_run"] = dry_run;
  reply.json["placed"] = Json::array();
  Verdict verdict = Verdict::Clear;
  for (const MoveReport& report : reports) {
    Reply one = to_reply(report, dry_run ? "would be placed at" : "placed at");
    if (report.refused && report.touches.empty())
      one.text = report.instance + ": refused with the others";
    reply.text += "\n" + one.text;
    reply.json["placed"].push_back(std::move(one.json));
    if (report.refused) reply.outcome = "refused";
    verdict = std::max(verdict, report.verdict);
    if (report.checked) reply.verdict = to_string(verdict);
  }
  return reply;
}

}  // namespace

Reply run_stack(Console& console, Arguments& arguments) {
  const double height_mm = arguments.number("a height in mm");
  if (!(height_mm > 0.0)) arguments.fail_at_last("a height is more than 0 mm");
  arguments.expect("at");
  const FeatureName on = read_feature(console, arguments, "a hole");
  const StackPlan plan =
      arguments.located([&] { return plan_stack(console.session(), height_mm, on); });
  const WayWords words = read_way(arguments);
  expect_way(arguments, words.way, plan.ways.size());
  std::optional<std::string> command;
  if (!words.dry_run) command = arguments.line();
  const auto reports = stack(console.session(), plan, words.way, command);
  const std::vector<Spacer>& chosen = plan.ways[words.way];
  Reply reply = placed_reply(reports,
                             stack_text(chosen) + ": " + length_text(height_mm) + " mm with " +
                                 counted(chosen.size(), "piece") +
                                 (words.way == 0 ? ", as few as there are" : ""),
                             words.dry_run);
  reply.json["ways"] = Json::array();
  for (std::size_t i = 0; i < plan.ways.size(); ++i) {
    Json pieces = Json::array();
    for (const Spacer& spacer : plan.ways[i]) pieces.push_back(spacer.element);
    reply.json["ways"].push_back(std::move(pieces));
    if (i != words.way) {
      reply.text += "\nway " + std::to_string(i + 1) + ": " + stack_text(plan.ways[i]);
    }
  }
  return reply;
}

Reply run_fasten(Console& console, Arguments& arguments) {
  const FeatureName hole = read_feature(console, arguments, "the hole under the screw's head");
  const FasteningPlan plan =
      arguments.located([&] { return plan_fastening(console.session(), hole); });
  const WayWords words = read_way(arguments);
  expect_way(arguments, words.way, plan.ways.size());
  std::optional<std::string> command;
  if (!words.dry_run) command = arguments.line();
  const auto reports = fasten(console.session(), plan, words.way, command);
  Reply reply = placed_reply(reports,
                             fastening_text(plan.ways[words.way], plan) +
                                 (words.way == 0 ? "; the shortest that holds" : ""),
                             words.dry_run);
  reply.json["ways"] = Json::array();
  for (std::size_t i = 0; i < plan.ways.size(); ++i) {
    reply.json["ways"].push_back(to_json(plan.ways[i], plan));
    if (i != words.way) {
      reply.text += "\nway " + std::to_string(i + 1) + ": " + fastening_text(plan.ways[i], plan);
    }
  }
  return reply;
}

}  // namespace dowel::tools
