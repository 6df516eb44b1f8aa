// The word that states what geometry does not tell of single parts, features, elements and points.

#include "console_commands.h"
#include "console_text.h"
#include "dowel/assembly/fixture_design.h"
#include "dowel/assembly/suggest.h"
#include "table.h"

namespace dowel::tools {
namespace {

Reply list_stated(Console& console) {
  const FixtureDesign& design = console.session().state().design;
  Table table({{"subject"}, {"quantity"}, {"value", Table::Align::Right}, {"reason"}});
  Reply reply;
  reply.json["stated"] = Json::array();
  for (const auto& [key, stated] : design.stated) {
    table.add({key.second, key.first, short_number(stated.value), stated.reason});
    reply.json["stated"].push_back({{"subject", key.second},
                                    {"quantity", key.first},
                                    {"value", stated.value},
                                    {"reason", stated.reason}});
  }
  Table known({{"quantity"}, {"of"}, {"meaning"}});
  reply.json["quantities"] = Json::array();
  for (const StatedQuantity& quantity : stated_quantities()) {
    known.add(
        {std::string(quantity.name), std::string(quantity.of), std::string(quantity.meaning)});
    reply.json["quantities"].push_back(
        {{"name", quantity.name}, {"of", quantity.of}, {"meaning", quantity.meaning}});
  }
  reply.text = (design.stated.empty() ? "nothing is stated\n" : table.text() + "\n") +
               "what can be stated:\n" + known.text();
  return reply;
}

/// Instances, their features, elements in use, critical points.
bool is_subject(const ProjectState& state, Session& session, const std::string& name) {
  if (state.design.points.contains(name)) return true;
  const std::size_t dot = name.find('.');
  for (const auto& [instance_name, instance] : state.instances) {
    if (instance.element == name || instance_name == name) return true;
    if (dot != std::string::npos && instance_name == name.substr(0, dot) &&
        session.element(instance.element).find_feature(name.substr(dot + 1)) != nullptr) {
      return true;
    }
  }
  return false;
}

std::string read_subject(Console& console, Arguments& arguments) {
  std::string name = arguments.word("an instance, INSTANCE.FEATURE, element or point");
  const ProjectState& state = console.session().state();
  if (is_subject(state, console.session(), name)) return name;
  std::vector<std::string> names;
  for (const auto& [instance_name, instance] : state.instances) names.push_back(instance_name);
  for (const auto& [point, critical] : state.design.points) names.push_back(point);
  arguments.fail_at_last("\"" + name +
                         "\" is no instance, INSTANCE.FEATURE, element in use or point" +
                         did_you_mean(similar_words(name, names)));
}

const StatedQuantity& read_quantity(Arguments& arguments) {
  const std::string name = arguments.word("a quantity, as `design` lists them");
  if (const StatedQuantity* quantity = find_stated_quantity(name)) return *quantity;
  std::vector<std::string> names;
  for (const StatedQuantity& quantity : stated_quantities()) names.emplace_back(quantity.name);
  arguments.fail_at_last("no quantity is called \"" + name + "\"" +
                         did_you_mean(similar_words(name, names)));
}

}  // namespace

Reply run_design(Console& console, Arguments& arguments) {
  if (arguments.at_end()) return list_stated(console);
  const std::string subject = read_subject(console, arguments);
  const StatedQuantity& quantity = read_quantity(arguments);
  const std::pair<std::string, std::string> key(quantity.name, subject);
  FixtureDesign design = console.session().state().design;
  Reply reply;
  if (arguments.take("off")) {
    arguments.expect_end();
    if (design.stated.erase(key) == 0) {
      arguments.fail_at_last(key.first + " of " + subject + " is not stated");
    }
    reply.text = subject + ": " + key.first + " is not stated any more";
  } else {
    StatedValue stated;
    stated.value = arguments.number("a number");
    if (stated.value < quantity.least || stated.value > quantity.most) {
      arguments.fail_at_last("expected " + short_number(quantity.least) + " to " +
                             short_number(quantity.most));
    }
    arguments.expect("reason");
    stated.reason = arguments.word("a reason, in quotes");
    if (stated.reason.empty()) arguments.fail_at_last("expected a reason");
    arguments.expect_end();
    design.stated[key] = stated;
    reply.text = subject + ": " + key.first + " " + short_number(stated.value);
  }
  console.session().set_design(design, arguments.line());
  return reply;
}

}  // namespace dowel::tools
