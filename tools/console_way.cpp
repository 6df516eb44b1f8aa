#include "console_way.h"

#include "console_text.h"

namespace dowel::tools {

std::string names_text(const std::vector<Touch>& touches) {
  std::string text;
  for (const Touch& touch : touches) text += (text.empty() ? "" : ", ") + touch.with;
  return text;
}

std::string way_text(const WayOut& way) {
  std::string text = "along " + way.along + " (" + point_text(way.direction_W) + "): ";
  if (way.blocked_by.empty()) return text + "free, " + length_text(way.way_mm) + " mm to clear";
  return text + "blocked by " + names_text(way.blocked_by) + " after " + length_text(way.free_mm) +
         " of " + length_text(way.way_mm) + " mm";
}

Json to_json(const WayOut& way) {
  Json json{{"along", way.along},
            {"direction", tools::to_json(way.direction_W)},
            {"free", way.blocked_by.empty()},
            {"way_mm", way.way_mm},
            {"free_mm", way.free_mm},
            {"blocked_by", Json::array()}};
  for (const Touch& touch : way.blocked_by) json["blocked_by"].push_back(touch.with);
  return json;
}

void add_way_in(Session& session, const MoveReport& report, Reply& reply) {
  if (report.refused || !report.checked || report.verdict == Verdict::Interference) return;
  // What hangs on the part comes in with it.
  const std::vector<WayOut> ways = session.ways_out(
      report.instance,
      {.without = {}, .with_sub_assembly = true, .first_free = true, .by_mates_alone = true});
  if (ways.empty()) return;
  const bool is_free = ways.front().blocked_by.empty();
  reply.json["way_in"] = {{"free", is_free}, {"ways", Json::array()}};
  for (const WayOut& way : ways) reply.json["way_in"]["ways"].push_back(to_json(way));
  if (is_free) return;
  reply.text += "\n" + report.instance + ": no straight way in along its mates";
  for (const WayOut& way : ways) reply.text += "\n  " + way_text(way);
}

}  // namespace dowel::tools
