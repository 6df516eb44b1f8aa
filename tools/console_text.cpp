#include "console_text.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "dowel/kernel/tolerance.h"
#include "table.h"

namespace dowel::tools {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

double rounded(double length_mm) {
  constexpr double kSteps_per_mm = 1.0e4;
  // Adding zero turns a negative zero into zero.
  return std::round(length_mm * kSteps_per_mm) / kSteps_per_mm + 0.0;
}

}  // namespace

std::string length_text(double length_mm) {
  return short_number(rounded(length_mm));
}

std::string point_text(const Eigen::Vector3d& point) {
  return length_text(point.x()) + " " + length_text(point.y()) + " " + length_text(point.z());
}

std::string mate_text(const Mate& mate) {
  if (mate.kind == MateKind::Fix) {
    return mate.moving.instance + " to " + mate.fixed.instance + " (fix)";
  }
  std::string text = mate.moving.text();
  if (mate.kind == MateKind::Angle) {
    return text + " at " + length_text(mate.angle_rad * kDegrees_per_rad) + " deg to " +
           mate.fixed.text() + " (angle)";
  }
  text += (mate.kind == MateKind::Align ? " with " : " into ") + mate.fixed.text();
  if (mate.has_seat()) text += " seat " + mate.moving_face.text() + " on " + mate.fixed_face.text();
  if (mate.offset_mm != 0.0) text += " offset " + length_text(mate.offset_mm);
  return text + " (" + std::string(to_string(mate.kind)) + (mate.thread ? ", thread)" : ")");
}

Json to_json(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  return {{"q", Json::array({q.w(), q.x(), q.y(), q.z()})}, {"t", to_json(pose.translation())}};
}

Json to_json(const Touch& touch) {
  Json json{{"with", touch.with},
            {"verdict", to_string(touch.pair.verdict)},
            {"method", to_string(touch.pair.method)}};
  if (touch.pair.verdict == Verdict::Interference) {
    json["depth_mm"] = touch.pair.depth_mm;
  } else {
    json["gap_mm"] = touch.pair.gap_mm;
  }
  json["at"] = to_json(touch.pair.witness_W);
  return json;
}

Json to_json(const Mate& mate) {
  Json json{{"number", mate.number},
            {"kind", to_string(mate.kind)},
            {"moving", mate.kind == MateKind::Fix ? mate.moving.instance : mate.moving.text()},
            {"fixed", mate.kind == MateKind::Fix ? mate.fixed.instance : mate.fixed.text()}};
  if (mate.has_seat()) {
    json["seat"] = Json::array({mate.moving_face.text(), mate.fixed_face.text()});
  }
  if (mate.kind == MateKind::Angle) json["angle_deg"] = mate.angle_rad * kDegrees_per_rad;
  json["offset_mm"] = mate.offset_mm;
  json["flip"] = mate.flip;
  json["thread"] = mate.thread;
  return json;
}

Json to_json(const Instance& instance) {
  return {{"name", instance.name},
          {"element", instance.element},
          {"pose", to_json(instance.X_WI)},
          {"grounded", instance.grounded}};
}

std::string touches_text(const std::vector<Touch>& touches) {
  std::string text;
  for (const Verdict verdict : {Verdict::Interference, Verdict::Contact}) {
    std::string names;
    std::set<std::string> told;  // several parts of a unit can touch one
    for (const Touch& touch : touches) {
      if (touch.pair.verdict != verdict || !told.insert(touch.with).second) continue;
      names += (names.empty() ? "" : ", ") + touch.with;
      if (verdict == Verdict::Interference) {
        names += " (depth " + short_number(touch.pair.depth_mm) + " mm or more at " +
                 point_text(touch.pair.witness_W) + ")";
      }
    }
    if (names.empty()) continue;
    text += (text.empty() ? "" : "; ") + std::string(to_string(verdict)) + " with " + names;
  }
  return text;
}

std::string freedom_text(const Freedom& freedom) {
  const std::array<std::pair<Eigen::Vector3d, const char*>, 3> axes{
      {{Eigen::Vector3d::UnitX(), "x"},
       {Eigen::Vector3d::UnitY(), "y"},
       {Eigen::Vector3d::UnitZ(), "z"}}};
  std::string axis = point_text(freedom.axis_W);
  for (const auto& [direction, name] : axes) {
    if ((freedom.axis_W - direction).norm() < kParallel_rad) axis = name;
  }
  if (freedom.kind == Freedom::Kind::Slide) return "slides along " + axis;
  std::string text = "turns about " + axis + " at " + point_text(freedom.point_W);
  const double slide_mm = 2.0 * std::numbers::pi * freedom.slide_mm_per_rad;
  if (length_text(slide_mm) != "0") {
    text += ", sliding " + length_text(slide_mm) + " mm a turn";
  }
  return text;
}

std::string freedoms_text(const FreedomReport& report) {
  constexpr std::size_t kAll = 6;
  std::string text;
  for (const Freedom& freedom : report.freedoms) {
    text += (text.empty() ? "" : "; ") + freedom_text(freedom);
  }
  if (report.freedoms.empty()) text = "cannot move";
  if (report.freedoms.size() == kAll) text = "free to move every way";
  if (!report.relative_to.empty()) text += " (against " + report.relative_to + ")";
  return text;
}

Json to_json(const FreedomReport& report) {
  Json json{{"freedoms", Json::array()}};
  for (const Freedom& freedom : report.freedoms) {
    Json one{{"kind", freedom.kind == Freedom::Kind::Slide ? "slide" : "turn"},
             {"axis", to_json(freedom.axis_W)}};
    if (freedom.kind == Freedom::Kind::Turn) {
      one["at"] = to_json(freedom.point_W);
      one["slide_mm_per_rad"] = freedom.slide_mm_per_rad;
    }
    json["freedoms"].push_back(std::move(one));
  }
  if (!report.relative_to.empty()) json["relative_to"] = report.relative_to;
  return json;
}

std::string conflict_text(const MateConflict& conflict) {
  std::string text = "mate " + mate_text(conflict.mate);
  if (conflict.is_nearly_redundant) {
    text += " would place it by next to nothing, it is almost redundant";
  } else {
    text += " cannot hold: it misses by " + length_text(conflict.off_mm) + " mm";
    const std::string off_deg = length_text(conflict.off_rad * kDegrees_per_rad);
    if (off_deg != "0") text += " and " + off_deg + " deg";
  }
  for (const Mate& other : conflict.against) {
    text += (&other == &conflict.against.front() ? "; against mate " : ", ") +
            std::to_string(other.number) + ": " + mate_text(other);
  }
  return text;
}

namespace {

Json conflict_json(const MateConflict& conflict) {
  Json json{{"mate", to_json(conflict.mate)},
            {"off_mm", conflict.off_mm},
            {"off_deg", conflict.off_rad * kDegrees_per_rad},
            {"nearly_redundant", conflict.is_nearly_redundant},
            {"against", Json::array()}};
  for (const Mate& other : conflict.against) json["against"].push_back(other.number);
  return json;
}

/// What a report says of mates.
void add_mates(const MoveReport& report, Json& json) {
  if (report.made) json["mate"] = to_json(*report.made);
  for (const Mate& mate : report.held_by) json["mates"].push_back(to_json(mate));
  if (report.conflict) json["conflict"] = conflict_json(*report.conflict);
  if (report.is_redundant) json["redundant"] = true;
  if (!report.moved_along.empty()) json["moved_along"] = report.moved_along;
  if (report.dropped.empty()) return;
  Json dropped = Json::array();
  for (const Mate& mate : report.dropped) dropped.push_back(to_json(mate));
  json["dropped_mates"] = std::move(dropped);
}

}  // namespace

Reply to_reply(const MoveReport& report, std::string_view done) {
  Reply reply;
  reply.outcome = report.refused ? "refused" : "done";
  if (report.checked) reply.verdict = to_string(report.verdict);

  const bool on_the_way = report.free_share > 0.0 && report.free_share < 1.0;
  reply.text = report.instance + ": ";
  if (report.conflict) {
    reply.text += "refused, " + conflict_text(*report.conflict);
  } else if (report.refused) {
    reply.text += "refused, " + touches_text(report.touches);
    if (on_the_way) {
      reply.text += "; free for " + short_number(100.0 * report.free_share) + " % of the way, to " +
                    point_text(report.X_WI_free.translation());
    }
  } else {
    reply.text += std::string(done) + " " + point_text(report.X_WI.translation());
    if (!report.checked) {
      reply.text += ", not checked";
    } else {
      reply.text += ", " + (report.touches.empty() ? "clear" : touches_text(report.touches));
      if (on_the_way) reply.text += " (on the way)";
    }
  }
  for (const Mate& mate : report.held_by) reply.text += "\nmated: " + mate_text(mate);
  for (const Mate& mate : report.dropped) {
    reply.text += "\n" + report.instance + ": mate no longer holds: " + mate_text(mate);
  }

  reply.json["instance"] = report.instance;
  reply.json["pose"] = to_json(report.X_WI);
  if (report.checked) {
    Json pairs = Json::array();
    for (const Touch& touch : report.touches) pairs.push_back(to_json(touch));
    reply.json["pairs"] = std::move(pairs);
    reply.json["free_share"] = report.free_share;
    reply.json["free_pose"] = to_json(report.X_WI_free);
  }
  add_mates(report, reply.json);
  return reply;
}

}  // namespace dowel::tools
