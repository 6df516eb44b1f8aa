// The words that tell of a project and write it out.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "console_commands.h"
#include "console_export.h"
#include "console_text.h"
#include "dowel/assembly/suggest.h"
#include "dowel/io/file.h"
#include "element_json.h"
#include "rule_desk.h"
#include "table.h"

namespace dowel::tools {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

using Align = Table::Align;

/// "90 deg about 0 0 1", or "not turned".
std::string turn_text(const Pose& pose) {
  const Eigen::AngleAxisd turn(pose.canonical().rotation());
  const double degrees = turn.angle() * kDegrees_per_rad;
  const std::string text = length_text(degrees);
  return text == "0" ? "not turned" : text + " deg about " + point_text(turn.axis());
}

std::string dimensions_text(const Element& element) {
  const Eigen::Vector3d size = box_size_mm(element);
  return length_text(size.x()) + " x " + length_text(size.y()) + " x " + length_text(size.z());
}

Reply list_instances(Session& session) {
  Table table({{"instance"}, {"element"}, {"place"}, {"turn"}, {"held"}});
  Reply reply;
  reply.json["instances"] = Json::array();
  for (const Instance* instance : session.state().in_order()) {
    table.add({instance->name, instance->element, point_text(instance->X_WI.translation()),
               turn_text(instance->X_WI), instance->grounded ? "grounded" : ""});
    reply.json["instances"].push_back(to_json(*instance));
  }
  reply.text = session.state().instances.empty() ? "no instances" : table.text();
  return reply;
}

Reply list_elements(Session& session) {
  Table table({{"element"}, {"size"}, {"holes", Align::Right}, {"shafts", Align::Right}});
  Reply reply;
  reply.json["elements"] = Json::array();
  const std::vector<std::string> names = session.element_names();
  for (const std::string& name : names) {
    const Element& element = session.element(name);
    table.add({name, dimensions_text(element),
               std::to_string(count_features(element, FeatureKind::Hole)),
               std::to_string(count_features(element, FeatureKind::Shaft))});
    reply.json["elements"].push_back(to_summary_json(element));
  }
  reply.text = names.empty() ? "no elements; `catalog FILE` opens a catalogue" : table.text();
  return reply;
}

Reply list_mates(Session& session) {
  Table table({{"mate", Align::Right}, {"what"}, {"off axis", Align::Right}});
  Reply reply;
  reply.json["mates"] = Json::array();
  for (const auto& [number, mate] : session.state().mates) {
    const MateResidual off = session.residual(mate);
    table.add({std::to_string(number), mate_text(mate), length_text(off.axis_mm) + " mm"});
    Json json = to_json(mate);
    json["off_axis_mm"] = off.axis_mm;
    json["off_angle_deg"] = off.angle_rad * kDegrees_per_rad;
    json["off_along_mm"] = off.along_mm;
    reply.json["mates"].push_back(std::move(json));
  }
  reply.text = session.state().mates.empty() ? "no mates" : table.text();
  return reply;
}

/// The element called `name`, or that of the instance called so.
const Element& element_of(Session& session, const std::string& name) {
  const Instance* instance = session.state().find(name);
  if (instance != nullptr) return session.element(instance->element);
  try {
    return session.element(name);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::NotFound) throw;
    std::vector<std::string> names = session.element_names();
    for (const auto& [known, placed] : session.state().instances) names.push_back(known);
    throw Error(ErrorCode::NotFound, "no instance or element is called \"" + name + "\"" +
                                         did_you_mean(similar_words(name, names)));
  }
}

std::string diameter_text(const Feature& feature) {
  return feature.diameter_mm > 0.0 ? length_text(feature.diameter_mm) : "";
}

std::string depth_text(const Feature& feature) {
  if (feature.kind == FeatureKind::Face) return "";
  return length_text(feature.depth_mm) + (feature.through ? " through" : "");
}

Reply list_features(Session& session, const std::string& name) {
  const Instance* instance = session.state().find(name);
  const Pose X_WI = instance != nullptr ? instance->X_WI : Pose();
  const Element& element = element_of(session, name);
  Table table({{"feature"},
               {"kind"},
               {"diameter", Align::Right},
               {"depth", Align::Right},
               {instance != nullptr ? "place" : "origin"},
               {"direction"}});
  for (const Feature& feature : element.features) {
    const PlacedFeature placed{&feature, X_WI};
    table.add({feature.name, std::string(to_string(feature.kind)), diameter_text(feature),
               depth_text(feature), point_text(placed.origin_W()),
               point_text(placed.direction_W())});
  }
  Reply reply;
  reply.text = element.features.empty() ? "no features" : table.text();
  reply.json["element"] = element.name;
  reply.json["features"] = to_json(element)["features"];
  return reply;
}

}  // namespace

Reply run_list(Console& console, Arguments& arguments) {
  Session& session = console.session();
  if (arguments.take("features")) {
    const std::string name = arguments.word("an instance or element");
    arguments.expect_end();
    return arguments.located([&] { return list_features(session, name); });
  }
  const bool elements = arguments.take("elements");
  const bool mates = !elements && arguments.take("mates");
  if (!elements && !mates && !arguments.take("instances") && !arguments.at_end()) {
    arguments.fail("expected instances, elements, mates or features");
  }
  arguments.expect_end();
  if (elements) return list_elements(session);
  if (mates) return list_mates(session);
  return list_instances(session);
}

Reply run_show(Console& console, Arguments& arguments) {
  Session& session = console.session();
  const std::string name = arguments.word("an instance or element");
  arguments.expect_end();
  const Element& element =
      arguments.located([&]() -> const Element& { return element_of(session, name); });
  Reply reply;
  if (const Instance* instance = session.state().find(name)) {
    reply.text = instance->name + ": " + instance->element + "\n  at " +
                 point_text(instance->X_WI.translation()) + ", " + turn_text(instance->X_WI) +
                 (instance->grounded ? ", grounded" : "");
    reply.json["instance"] = to_json(*instance);
    reply.json["mates"] = Json::array();
    for (const auto& [number, mate] : session.state().mates) {
      if (mate.moving.instance != name && mate.fixed.instance != name) continue;
      reply.text += "\n  " + mate_text(mate);
      reply.json["mates"].push_back(to_json(mate));
    }
    reply.text += "\n";
  }
  reply.text += element.name + ": " + std::string(to_string(element.shape)) + ", " +
                dimensions_text(element) + " mm, " + length_text(element.volume_mm3) + " mm3\n  " +
                counted(count_features(element, FeatureKind::Hole), "hole") + ", " +
                counted(count_features(element, FeatureKind::Shaft), "shaft") + ", " +
                counted(count_features(element, FeatureKind::Face), "face") + ", " +
                counted(count_features(element, FeatureKind::Slot), "slot");
  reply.json["element"] = to_json(element);
  return reply;
}

Reply run_bom(Console& console, Arguments& arguments) {
  std::string file;
  if (!arguments.at_end()) file = arguments.word("a CSV file");
  arguments.expect_end();
  if (!file.empty() && std::filesystem::path(file).extension() != ".csv") {
    arguments.fail_at_last("expected a file that ends in .csv");
  }
  Reply reply;
  const std::vector<BomRow> rows = console.session().bill_of_materials();
  if (!file.empty()) arguments.located([&] { write_file(file, bom_csv(console.session())); });
  Table table({{"count", Align::Right}, {"name"}, {"family"}});
  reply.json["rows"] = Json::array();
  for (const BomRow& row : rows) {
    table.add({std::to_string(row.count), row.element, row.family});
    reply.json["rows"].push_back({{"count", row.count},
                                  {"name", row.element},
                                  {"family", row.family},
                                  {"instances", row.instances}});
  }
  if (file.empty()) {
    reply.text = rows.empty() ? "nothing placed" : table.text();
  } else {
    reply.text = file + ": " + counted(rows.size(), "row");
    reply.json["file"] = file;
  }
  return reply;
}

Reply run_check(Console& console, Arguments& arguments) {
  arguments.expect_end();
  const std::vector<Touch> touches = console.session().check_all();
  Reply reply;
  reply.verdict = to_string(worst(touches));
  reply.json["pairs"] = Json::array();
  std::size_t interferences = 0;
  for (const Verdict verdict : {Verdict::Interference, Verdict::Contact}) {
    for (const Touch& touch : touches) {
      if (touch.pair.verdict != verdict) continue;
      reply.text += touch.instance + ": " + touches_text({touch}) + "\n";
      Json json{{"instance", touch.instance}};
      json.update(to_json(touch));
      reply.json["pairs"].push_back(std::move(json));
      if (verdict == Verdict::Interference) ++interferences;
    }
  }
  reply.text += counted(console.session().state().instances.size(), "instance") + ": " +
                counted(interferences, "interference") + ", " +
                counted(touches.size() - interferences, "contact");
  reply.json["interferences"] = interferences;
  reply.json["contacts"] = touches.size() - interferences;
  reply.has_findings = interferences > 0;
  return reply;
}

Reply run_export(Console& console, Arguments& arguments) {
  const std::string file = arguments.word("a file");
  if (auto refusal = refused_by_gate(console, arguments)) return *refusal;
  arguments.located([&] { export_session(console.session(), file); });
  Reply reply;
  reply.text = file + ": written";
  reply.json["file"] = file;
  return reply;
}

Reply run_history(Console& console, Arguments& arguments) {
  arguments.expect_end();
  Reply reply;
  reply.json["commands"] = Json::array();
  for (const JournalEntry& entry : console.session().project().journal()) {
    reply.text += (reply.text.empty() ? "" : "\n") + std::to_string(entry.number) + "  " +
                  entry.command + (entry.undone ? "  (undone)" : "");
    reply.json["commands"].push_back(
        {{"number", entry.number}, {"command", entry.command}, {"undone", entry.undone}});
  }
  if (reply.text.empty()) reply.text = "nothing done yet";
  return reply;
}

Reply run_help(Console&, Arguments& arguments) {
  Reply reply;
  if (!arguments.at_end()) {
    const std::string word = arguments.word("a command");
    arguments.expect_end();
    const Command& command = command_for(arguments.words()[1]);
    reply.text = word + " " + std::string(command.arguments) + "\n  " + std::string(command.help) +
                 "\n  example: " + std::string(command.example);
    reply.json["word"] = word;
    reply.json["arguments"] = command.arguments;
    reply.json["help"] = command.help;
    reply.json["example"] = command.example;
    return reply;
  }
  Table table({{"command"}, {"what it does"}});
  reply.json["commands"] = Json::array();
  for (const Command& command : commands()) {
    table.add({std::string(command.word), std::string(command.help)});
    reply.json["commands"].push_back(command.word);
  }
  reply.text = table.text() +
               "\n`help WORD` tells more. Names with blanks go in \"quotes\"; # begins a comment.";
  return reply;
}

}  // namespace dowel::tools
