// The words that mate parts with each other, and tell what that leaves free.

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "console_commands.h"
#include "console_fit.h"
#include "console_read.h"
#include "console_text.h"
#include "console_way.h"
#include "dowel/assembly/fit.h"
#include "table.h"

namespace dowel::tools {
namespace {

MateRequest read_insert(Console& console, Arguments& arguments) {
  MateRequest request;
  request.moving = read_feature(console, arguments, "a feature of the instance that moves");
  request.fixed = read_feature(console, arguments, "a feature of the instance that stays");
  const InsertWords words = read_insert_words(console, arguments);
  request.seat = words.seat;
  request.options = words.options;
  return request;
}

MateRequest read_pair(Console& console, Arguments& arguments, MateKind kind) {
  MateRequest request;
  request.kind = kind;
  request.moving = read_feature(console, arguments, "a feature of the instance that moves");
  request.fixed = read_feature(console, arguments, "a feature of the instance that stays");
  const bool may_lift = kind == MateKind::FaceOnFace || kind == MateKind::KeyInSlot;
  if (may_lift && arguments.take("offset")) {
    request.options.offset_mm = arguments.number("an offset in mm");
  }
  if (kind == MateKind::Angle) {
    request.angle_rad = read_angle(arguments);
    if (request.angle_rad < 0.0 || request.angle_rad > std::numbers::pi) {
      arguments.fail_at_last("an angle between two directions is 0 to 180 degrees");
    }
  }
  return request;
}

MateRequest read_fix(Console& console, Arguments& arguments) {
  MateRequest request;
  request.kind = MateKind::Fix;
  request.moving.instance = read_instance(console, arguments);
  request.fixed.instance = read_instance(console, arguments);
  return request;
}

MateRequest read_request(Console& console, Arguments& arguments) {
  if (arguments.take("insert")) return read_insert(console, arguments);
  if (arguments.take("align")) return read_pair(console, arguments, MateKind::Align);
  if (arguments.take("seat")) return read_pair(console, arguments, MateKind::FaceOnFace);
  if (arguments.take("slot")) return read_pair(console, arguments, MateKind::KeyInSlot);
  if (arguments.take("angle")) return read_pair(console, arguments, MateKind::Angle);
  if (arguments.take("fix")) return read_fix(console, arguments);
  arguments.fail("expected insert, align, seat, slot, angle or fix");
}

/// The mates that the words of `unmate` name.
std::vector<std::uint32_t> read_mates(Console& console, Arguments& arguments) {
  const auto& mates = console.session().state().mates;
  std::vector<std::uint32_t> numbers;
  if (arguments.is_number()) {
    const std::size_t number = arguments.count("the number of a mate");
    arguments.expect_end();
    const auto wanted = static_cast<std::uint32_t>(number);
    if (!mates.contains(wanted)) {
      arguments.fail_at_last("there is no mate " + std::to_string(number) + "; `list mates` tells");
    }
    return {wanted};
  }
  const std::string first = read_instance(console, arguments);
  const std::string second = read_instance(console, arguments);
  arguments.expect_end();
  for (const auto& [number, mate] : mates) {
    const bool is_between = (mate.moving.instance == first && mate.fixed.instance == second) ||
                            (mate.moving.instance == second && mate.fixed.instance == first);
    if (is_between) numbers.push_back(number);
  }
  if (numbers.empty()) arguments.fail_at_last("no mate is between " + first + " and " + second);
  return numbers;
}

}  // namespace

Reply run_mate(Console& console, Arguments& arguments) {
  const MateRequest request = read_request(console, arguments);
  arguments.expect_end();
  const Pose X_WI_before = console.session().instance(request.moving.instance).X_WI;
  const MoveReport report = console.session().mate(request, arguments.line());
  Reply reply = to_reply(report, "mated at");
  if (report.refused) return reply;
  if (report.made->thread) reply.text += ", threaded";
  if (report.is_redundant) reply.text += "\nredundant: earlier mates hold all of this";
  for (const std::string& name : report.moved_along) {
    reply.text += "\n" + name + ": moved along to " +
                  point_text(console.session().instance(name).X_WI.translation());
  }
  const FreedomReport left = console.session().freedoms(report.instance);
  reply.text += "\n" + report.instance + ": " + freedoms_text(left);
  reply.json.update(to_json(left));
  // What was there already did not come in now.
  if (!(report.X_WI == X_WI_before)) add_way_in(console.session(), report, reply);
  return reply;
}

Reply run_unmate(Console& console, Arguments& arguments) {
  const std::vector<std::uint32_t> numbers = read_mates(console, arguments);
  Reply reply;
  reply.json["dropped_mates"] = Json::array();
  for (const std::uint32_t number : numbers) {
    const Mate& mate = console.session().state().mates.at(number);
    reply.text += (reply.text.empty() ? "" : "\n") + std::string("mate ") + std::to_string(number) +
                  ": taken out: " + mate_text(mate);
    reply.json["dropped_mates"].push_back(to_json(mate));
  }
  console.session().unmate(numbers, arguments.line());
  return reply;
}

Reply run_pattern(Console& console, Arguments& arguments) {
  const std::string wanted = arguments.word("an element");
  const std::string element =
      arguments.located([&] { return console.session().element(wanted).name; });
  arguments.expect("at");
  const FeatureName at = read_feature(console, arguments, "a hole");
  const std::vector<PatternWay> ways =
      arguments.located([&] { return console.session().pattern(element, at); });
  arguments.expect_end();
  Table table({{"way", Table::Align::Right}, {"turned", Table::Align::Right}, {"holes on holes"}});
  Reply reply;
  reply.json["ways"] = Json::array();
  for (const PatternWay& way : ways) {
    const double turn_deg = way.turn_rad * 180.0 / std::numbers::pi;
    std::string pairs;
    Json json{{"turn_deg", turn_deg}, {"pairs", Json::array()}};
    for (const FeaturePair& pair : way.pairs) {
      pairs += (pairs.empty() ? "" : ", ") + pair.moving + " on " + pair.fixed;
      json["pairs"].push_back({pair.moving, pair.fixed});
    }
    json["pose"] = to_json(console.session().instance(at.instance).X_WI * way.X_BE);
    reply.json["ways"].push_back(std::move(json));
    table.add({std::to_string(reply.json["ways"].size()), length_text(turn_deg) + " deg", pairs});
  }
  if (ways.empty()) {
    const std::size_t feet = feet_of(console.session().element(element)).size();
    reply.text = "no way: " + element + " has " + counted(feet, "hole or shaft") +
                 " to stand on, and they do not all fall on holes around " + at.text();
  } else {
    reply.text =
        table.text() + "\n`place " + element + " at " + at.text() + " pattern N` takes one of them";
  }
  return reply;
}

Reply run_fit(Console& console, Arguments& arguments) {
  std::optional<Fit> fit;
  Reply reply;
  if (arguments.is_number()) {
    const double nominal_mm = arguments.number("a nominal size in mm");
    if (!is_nominal_size(nominal_mm)) {
      arguments.fail_at_last("a nominal size is over 3 and at most 80 mm");
    }
    const std::string text = arguments.word("a hole and a shaft, such as H7/g6");
    fit = fit_from(nominal_mm, text);
    if (!fit) {
      arguments.fail_at_last(
          "expected a hole of F, G or H over a shaft of f, g, h, k, m, n or p in grades 5 to 11, "
          "such as H7/g6");
    }
    arguments.expect_end();
  } else {
    const FeatureName shaft = read_feature(console, arguments, "a nominal size or a shaft");
    const FeatureName hole = read_feature(console, arguments, "a hole");
    arguments.expect_end();
    const Feature& shaft_feature = *console.session().feature(shaft).feature;
    const Feature& hole_feature = *console.session().feature(hole).feature;
    if (shaft_feature.kind != FeatureKind::Shaft || hole_feature.kind != FeatureKind::Hole) {
      arguments.fail_at_last("expected a shaft and then a hole, but " + shaft.text() + " is a " +
                             std::string(to_string(shaft_feature.kind)) + " and " + hole.text() +
                             " is a " + std::string(to_string(hole_feature.kind)));
    }
    reply.text = drawn_fit_text(shaft_feature, hole_feature);
    reply.json = drawn_fit_json(shaft_feature, hole_feature);
    return reply;
  }
  reply.text = fit_text(*fit);
  reply.json = to_json(*fit);
  return reply;
}

Reply run_freedoms(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  arguments.expect_end();
  const FreedomReport report = console.session().freedoms(name);
  Reply reply;
  const bool is_grounded = console.session().instance(name).grounded;
  reply.text = name + ": " + (is_grounded ? "cannot move, it is grounded" : freedoms_text(report));
  reply.json["instance"] = name;
  reply.json.update(to_json(report));
  reply.json["mates"] = Json::array();
  for (const FreedomReport::MateShare& share : report.mates) {
    const bool is_redundant = share.verdict.status == MateStatus::Redundant;
    reply.text +=
        "\n  mate " + std::to_string(share.mate.number) + ": " + mate_text(share.mate) +
        (is_redundant ? ", redundant"
                      : ", takes " + std::to_string(share.verdict.freedoms_taken) + " of 6");
    const std::string fit = mate_fit_text(console.session(), share.mate);
    if (!fit.empty()) reply.text += "; " + fit;
    Json json = to_json(share.mate);
    json["takes"] = share.verdict.freedoms_taken;
    json["redundant"] = is_redundant;
    reply.json["mates"].push_back(std::move(json));
  }
  return reply;
}

}  // namespace dowel::tools
