#include "console_text.h"

#include <cmath>

#include "table.h"

namespace dowel::tools {
namespace {

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
  std::string text = mate.moving.text() + " into " + mate.fixed.text();
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
            {"moving", mate.moving.text()},
            {"fixed", mate.fixed.text()}};
  if (mate.has_seat()) {
    json["seat"] = Json::array({mate.moving_face.text(), mate.fixed_face.text()});
  }
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
    for (const Touch& touch : touches) {
      if (touch.pair.verdict != verdict) continue;
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

Reply to_reply(const MoveReport& report, std::string_view done) {
  Reply reply;
  reply.outcome = report.refused ? "refused" : "done";
  if (report.checked) reply.verdict = to_string(report.verdict);

  const bool on_the_way = report.free_share > 0.0 && report.free_share < 1.0;
  reply.text = report.instance + ": ";
  if (report.refused) {
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
  if (report.made) reply.json["mate"] = to_json(*report.made);
  if (!report.dropped.empty()) {
    Json dropped = Json::array();
    for (const Mate& mate : report.dropped) dropped.push_back(to_json(mate));
    reply.json["dropped_mates"] = std::move(dropped);
  }
  return reply;
}

}  // namespace dowel::tools
