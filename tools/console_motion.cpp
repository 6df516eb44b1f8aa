// The words that move parts within their mates, and tell by which ways they come and go.

#include <cmath>
#include <numbers>
#include <optional>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "console_way.h"
#include "table.h"

namespace dowel::tools {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

/// block, slide, warn or off, where it comes next.
std::optional<DragMode> take_drag_mode(Arguments& arguments) {
  using enum DragMode;
  for (const DragMode mode : {Block, Slide, Warn, Off}) {
    if (arguments.take(to_string(mode))) return mode;
  }
  return std::nullopt;
}

DragRequest read_drag(Console& console, Arguments& arguments) {
  DragRequest request;
  request.instance = read_instance(console, arguments);
  if (arguments.take("by")) {
    request.by_mm_W = arguments.point("a distance in mm along x, y and z");
  } else if (arguments.take("to")) {
    request.by_mm_W = arguments.point("three coordinates in mm") -
                      console.session().instance(request.instance).X_WI.translation();
  } else if (arguments.take("along")) {
    const Axis axis = read_axis(console, arguments);
    request.by_mm_W = arguments.number("a distance in mm") * axis.direction_W;
  } else if (arguments.take("turn")) {
    request.turn_rad = read_angle(arguments);
    if (request.turn_rad == 0.0) arguments.fail_at_last("a turn is not of 0 degrees");
    if (arguments.take("about")) {
      const Axis axis = read_axis(console, arguments);
      request.axis_W = axis.direction_W;
      request.point_W = axis.point_W;
    }
  } else {
    arguments.fail("expected `by`, `to`, `along` or `turn`");
  }
  if (request.turn_rad == 0.0 && request.by_mm_W.norm() <= kCoincident_mm) {
    arguments.fail_at_last(request.instance + " is there already");
  }
  request.mode = take_drag_mode(arguments);
  return request;
}

}  // namespace

Reply run_drag(Console& console, Arguments& arguments) {
  const DragRequest request = read_drag(console, arguments);
  arguments.expect_end();
  const DragReport report = console.session().drag(request, arguments.line());
  const MoveReport& move = report.move;
  MoveReport at_end = move;  // what is told of the way follows
  at_end.free_share = 1.0;
  Reply reply = to_reply(at_end, request.turn_rad != 0.0 ? "turned, at" : "dragged to");
  if (!move.stopped_by.empty() && !move.refused) {
    reply.text += report.slid ? "; slid along " : "; stopped by ";
    reply.text += names_text(move.stopped_by);
    if (!report.slid) {
      constexpr double kPercent = 100.0;
      reply.text += " after " + short_number(kPercent * move.free_share) + " % of the way";
    }
  }
  const double allowed_mm = report.allowed_mm_W.norm();
  if (request.turn_rad == 0.0 &&
      (report.allowed_mm_W - report.asked_mm_W).norm() >= kCoincident_mm) {
    reply.text += "\n" + move.instance + ": its mates leave " + length_text(allowed_mm) + " of " +
                  length_text(report.asked_mm_W.norm()) + " mm, by " +
                  point_text(report.allowed_mm_W);
  }
  // A turn that the mates end, by more than rounding.
  if (!move.refused && std::abs(report.allowed_rad - request.turn_rad) > kParallel_rad) {
    reply.text += "\n" + move.instance + ": its mates leave " +
                  short_number(report.allowed_rad * kDegrees_per_rad) + " of " +
                  short_number(request.turn_rad * kDegrees_per_rad) +
                  " degrees; it can go no further";
  }
  for (const std::string& name : move.moved_along)
    reply.text += "\n" + name + (report.is_linkage ? ": follows" : ": goes along");
  if (move.checked) reply.json["free_share"] = move.free_share;
  reply.json["slid"] = report.slid;
  reply.json["stopped_by"] = Json::array();
  for (const Touch& touch : move.stopped_by) reply.json["stopped_by"].push_back(touch.with);
  if (request.turn_rad == 0.0) reply.json["allowed_mm"] = tools::to_json(report.allowed_mm_W);
  return reply;
}

Reply run_way(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  WayQuery query;
  query.with_sub_assembly = arguments.take("all");
  arguments.expect_end();
  const std::vector<WayOut> ways = console.session().ways_out(name, query);
  Reply reply;
  reply.json["instance"] = name;
  reply.json["ways"] = Json::array();
  const bool is_free = !ways.empty() && ways.front().blocked_by.empty();
  reply.text = name + (is_free ? ": can be brought in and taken out"
                               : ": cannot be brought in or taken out on a straight way");
  for (const WayOut& way : ways) {
    reply.text += "\n  " + way_text(way);
    reply.json["ways"].push_back(to_json(way));
  }
  reply.json["free"] = is_free;
  reply.has_findings = !is_free;
  return reply;
}

}  // namespace dowel::tools
