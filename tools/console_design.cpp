// The words that say what a fixture is for: roles, forces, loads, critical points, limits.

#include <functional>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "dowel/assembly/fixture_design.h"
#include "dowel/assembly/suggest.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// Changes the design by one command.
Reply change(Console& console, const Arguments& arguments, const std::string& text,
             const std::function<void(FixtureDesign&)>& edit) {
  FixtureDesign design = console.session().state().design;
  edit(design);
  console.session().set_design(design, arguments.line());
  Reply reply;
  reply.text = text;
  return reply;
}

double positive(Arguments& arguments, std::string_view what) {
  const double value = arguments.number(what);
  if (value <= 0.0) arguments.fail_at_last("expected " + std::string(what) + " above 0");
  return value;
}

std::string role_names() {
  return "base plate, riser, locator, support, adjustable support, clamp, fastener, workpiece or "
         "other";
}

const Limit& limit_called(const Arguments& arguments, const std::string& name) {
  if (const Limit* limit = find_limit(name)) return *limit;
  std::vector<std::string> names;
  for (const Limit& limit : limits()) names.emplace_back(limit.name);
  arguments.fail_at_last("no limit is called \"" + name + "\"" +
                         did_you_mean(similar_words(name, names)));
}

Reply list_limits(Console& console) {
  const FixtureDesign& design = console.session().state().design;
  Table table({{"limit"}, {"value", Table::Align::Right}, {"given"}, {"meaning"}});
  Reply reply;
  reply.json["limits"] = Json::array();
  for (const Limit& limit : limits()) {
    const bool given = design.limits.contains(std::string(limit.name));
    const double value = design.limit(limit.name);
    table.add({std::string(limit.name), short_number(value), given ? "given" : "",
               std::string(limit.meaning)});
    reply.json["limits"].push_back(
        {{"name", limit.name}, {"value", value}, {"given", given}, {"meaning", limit.meaning}});
  }
  reply.text = table.text();
  return reply;
}

/// A name for a load or point: what a subject of a rule can be.
std::string read_label(Arguments& arguments, std::string_view what) {
  const std::string name = arguments.word(what);
  if (name.find_first_of(" \t\r\n") != std::string::npos || name.empty()) {
    arguments.fail_at_last("expected a name without blanks");
  }
  return name;
}

}  // namespace

Reply run_role(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  std::string text = arguments.word("a role: " + role_names());
  while (!arguments.at_end()) text += " " + arguments.word("a role");
  if (text == "off") {
    return change(console, arguments, name + ": the role of its element",
                  [&](FixtureDesign& design) { design.roles.erase(name); });
  }
  const auto role = role_from(text);
  if (!role) {
    arguments.fail_at_last("\"" + text + "\" is no role: expected " + role_names() + ", or off");
  }
  return change(console, arguments, name + ": " + text,
                [&](FixtureDesign& design) { design.roles[name] = *role; });
}

Reply run_force(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  if (arguments.take("off")) {
    arguments.expect_end();
    return change(console, arguments, name + ": no force",
                  [&](FixtureDesign& design) { design.clamp_forces_N.erase(name); });
  }
  const double force_N = positive(arguments, "a force in N");
  arguments.expect_end();
  const std::string element = console.session().instance(name).element;
  Reply reply = change(console, arguments, name + ": presses with " + short_number(force_N) + " N",
                       [&](FixtureDesign& design) { design.clamp_forces_N[name] = force_N; });
  const auto given = console.session().state().design.roles.find(name);
  const bool is_clamp = given != console.session().state().design.roles.end()
                            ? given->second == Role::Clamp
                            : console.session().element(element).role == "clamp";
  if (!is_clamp) reply.text += "; it counts once `role " + name + " clamp` is given";
  return reply;
}

Reply run_accuracy(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  if (arguments.take("off")) {
    arguments.expect_end();
    return change(console, arguments, name + ": the usual accuracy",
                  [&](FixtureDesign& design) { design.locator_errors_mm.erase(name); });
  }
  const double error_mm = positive(arguments, "an error in mm");
  arguments.expect_end();
  return change(console, arguments, name + ": within " + short_number(error_mm) + " mm",
                [&](FixtureDesign& design) { design.locator_errors_mm[name] = error_mm; });
}

Reply run_load(Console& console, Arguments& arguments) {
  const std::string name = read_label(arguments, "a name for the load");
  if (arguments.take("off")) {
    arguments.expect_end();
    return change(console, arguments, name + ": no load",
                  [&](FixtureDesign& design) { design.loads.erase(name); });
  }
  Load load;
  load.force_N = arguments.point("a force in N, as x y z");
  arguments.expect("at");
  load.at = arguments.point("a point");
  if (arguments.take("torque")) load.torque_Nmm = arguments.point("a torque in N mm, as x y z");
  arguments.expect_end();
  if (load.force_N.isZero() && load.torque_Nmm.isZero()) {
    arguments.fail_at_last("expected a force or a torque other than 0");
  }
  return change(console, arguments,
                name + ": " + short_number(load.force_N.norm()) + " N at " + point_text(load.at),
                [&](FixtureDesign& design) { design.loads[name] = load; });
}

Reply run_point(Console& console, Arguments& arguments) {
  const std::string name = read_label(arguments, "a name for the point");
  if (arguments.take("off")) {
    arguments.expect_end();
    return change(console, arguments, name + ": no critical point",
                  [&](FixtureDesign& design) { design.points.erase(name); });
  }
  CriticalPoint point;
  arguments.expect("at");
  point.at = arguments.point("a point");
  arguments.expect("tolerance");
  point.tolerance_mm = positive(arguments, "a tolerance in mm");
  arguments.expect_end();
  return change(
      console, arguments,
      name + ": within " + short_number(point.tolerance_mm) + " mm at " + point_text(point.at),
      [&](FixtureDesign& design) { design.points[name] = point; });
}

Reply run_limit(Console& console, Arguments& arguments) {
  if (arguments.at_end()) return list_limits(console);
  const std::string name = arguments.word("a limit");
  const Limit& limit = limit_called(arguments, name);
  const double now = console.session().state().design.limit(name);
  if (arguments.at_end()) {
    Reply reply;
    reply.text = name + ": " + short_number(now) + ", " + std::string(limit.meaning);
    reply.json = {{"name", name}, {"value", now}};
    return reply;
  }
  if (arguments.take("off")) {
    arguments.expect_end();
    return change(console, arguments, name + ": " + short_number(limit.value) + ", as usual",
                  [&](FixtureDesign& design) { design.limits.erase(name); });
  }
  const double value = arguments.number("a number");
  if (value < limit.least || value > limit.most) {
    arguments.fail_at_last("expected " + short_number(limit.least) + " to " +
                           short_number(limit.most));
  }
  arguments.expect_end();
  return change(console, arguments, name + ": " + short_number(value),
                [&](FixtureDesign& design) { design.limits[name] = value; });
}

}  // namespace dowel::tools
