// The words that find where parts go: near where they are, in the whole project, as they stand.

#include <cmath>
#include <map>
#include <numbers>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "console_way.h"
#include "dowel/assembly/snap.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// More lines than this nobody reads; JSON has them all.
constexpr std::size_t kMostLines = 20;

std::string mates_text(const std::vector<Mate>& mates) {
  std::string text;
  for (const Mate& mate : mates) {
    text += (text.empty() ? "" : "; ") +
            (mate.moving.instance.empty() ? mate.moving.feature : mate.moving.text()) +
            (mate.kind == MateKind::FaceOnFace ? " on " : " to ") + mate.fixed.text();
  }
  return text;
}

std::string match_text(const SnapOffer& offer) {
  std::string text(to_string(offer.match));
  if (offer.clearance_mm && offer.match != FeatureMatch::Thread) {
    text += ", " + length_text(*offer.clearance_mm) + " mm play";
  }
  return text;
}

Json to_json(const SnapOffer& offer) {
  Json json{{"match", to_string(offer.match)},
            {"pose", tools::to_json(offer.X_WI)},
            {"mates", Json::array()}};
  for (const Mate& mate : offer.mates) json["mates"].push_back(tools::to_json(mate));
  if (offer.clearance_mm) json["clearance_mm"] = *offer.clearance_mm;
  return json;
}

SnapReach read_reach(Arguments& arguments) {
  SnapReach reach;
  if (arguments.take("within")) {
    reach.reach_mm = arguments.number("a distance in mm");
    if (!(reach.reach_mm > 0.0) || reach.reach_mm > kMaxCoordinate_mm) {
      arguments.fail_at_last("a distance is more than 0 and at most " +
                             short_number(kMaxCoordinate_mm) + " mm");
    }
  }
  return reach;
}

Reply list_offers(const std::string& name, const std::vector<SnapOffer>& offers) {
  Reply reply;
  reply.json["instance"] = name;
  reply.json["offers"] = Json::array();
  Table table({{"offer", Table::Align::Right},
               {"goes by mm", Table::Align::Right},
               {"turns deg", Table::Align::Right},
               {"match"},
               {"mates"}});
  for (const SnapOffer& offer : offers) {
    Json json = to_json(offer);
    json["travel_mm"] = offer.travel_mm;
    json["turn_deg"] = offer.turn_rad * 180.0 / std::numbers::pi;
    reply.json["offers"].push_back(std::move(json));
    if (reply.json["offers"].size() > kMostLines) continue;
    table.add({std::to_string(reply.json["offers"].size()), length_text(offer.travel_mm),
               length_text(offer.turn_rad * 180.0 / std::numbers::pi), match_text(offer),
               mates_text(offer.mates)});
  }
  if (offers.empty()) {
    reply.text =
        name + ": nothing that it goes with is near; `snap " + name + " within MM` looks further";
    return reply;
  }
  reply.text = table.text();
  if (offers.size() > kMostLines) {
    reply.text += "\nand " + std::to_string(offers.size() - kMostLines) + " more";
  }
  reply.text += "\n`snap " + name + " take N` takes one of them";
  return reply;
}

}  // namespace

Reply run_snap(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  const SnapReach reach = read_reach(arguments);
  const std::vector<SnapOffer> offers =
      arguments.located([&] { return snap_offers(console.session(), name, reach); });
  if (arguments.at_end()) return list_offers(name, offers);
  arguments.expect("take");
  const std::size_t number = arguments.at_end() ? 1 : arguments.count("the number of an offer");
  if (number > offers.size()) {
    arguments.fail_at_last("there " + std::string(offers.size() == 1 ? "is " : "are ") +
                           counted(offers.size(), "offer") + "; `snap " + name + "` lists them");
  }
  arguments.expect_end();
  const SnapOffer& offer = offers[number - 1];
  const MoveReport report = console.session().put(name, offer.X_WI, offer.mates, arguments.line());
  Reply reply = to_reply(report, "snapped to");
  add_way_in(console.session(), report, reply);
  return reply;
}

Reply run_where(Console& console, Arguments& arguments) {
  const std::string wanted = arguments.word("an element");
  const std::string element =
      arguments.located([&] { return console.session().element(wanted).name; });
  arguments.expect_end();
  const std::vector<SnapOffer> places = places_for(console.session(), element);
  Reply reply;
  reply.json["element"] = element;
  reply.json["places"] = Json::array();
  Table table(
      {{"at"}, {"by"}, {"turned deg", Table::Align::Right}, {"match"}, {"there"}, {"origin"}});
  for (const SnapOffer& place : places) {
    Json json = to_json(place);
    json["verdict"] = to_string(place.verdict);
    reply.json["places"].push_back(std::move(json));
    if (reply.json["places"].size() > kMostLines) continue;
    const Mate& mate = place.mates.front();
    table.add({mate.fixed.text(), mate.moving.feature,
               length_text(place.turn_rad * 180.0 / std::numbers::pi),
               std::string(to_string(place.match)), std::string(to_string(place.verdict)),
               point_text(place.X_WI.translation())});
  }
  if (places.empty()) {
    reply.text = element + ": there is no place for it";
    return reply;
  }
  reply.text = counted(places.size(), "place") + "\n" + table.text();
  if (places.size() > kMostLines) {
    reply.text += "\nand " + std::to_string(places.size() - kMostLines) + " more";
  }
  return reply;
}

Reply run_recognise(Console& console, Arguments& arguments) {
  const bool is_dry = arguments.take("dry-run") || arguments.take("--dry-run");
  arguments.expect_end();
  std::vector<Mate> mates = recognise_mates(console.session());
  const std::size_t found = mates.size();
  if (!is_dry) mates = console.session().adopt(mates, arguments.line());
  Reply reply;
  reply.json["found"] = found;
  reply.json["dry_run"] = is_dry;
  reply.json["mates"] = Json::array();
  reply.text = counted(found, "pair") + " of features that are mated as they stand";
  if (!is_dry) {
    reply.text +=
        ", " + counted(mates.size(), "mate") + " made; the others hold no more than these";
  }
  for (const Mate& mate : mates) {
    reply.json["mates"].push_back(tools::to_json(mate));
    if (reply.json["mates"].size() <= kMostLines) reply.text += "\n  " + mate_text(mate);
  }
  if (mates.size() > kMostLines) {
    reply.text += "\n  and " + std::to_string(mates.size() - kMostLines) + " more";
  }
  return reply;
}

}  // namespace dowel::tools
