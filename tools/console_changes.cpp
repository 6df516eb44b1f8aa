// The words that change a project.

#include <algorithm>
#include <cmath>
#include <optional>

#include "console_commands.h"
#include "console_read.h"
#include "console_text.h"
#include "console_way.h"
#include "dowel/assembly/suggest.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// The words of `place` behind the element.
struct Placing {
  std::string name;
  std::optional<Pose> X_WI;
  std::optional<FeatureName> at;  ///< with which it is mated
  double turn_rad = 0.0;
  std::optional<Eigen::Vector3d> turn_axis_W;
};

void read_place_at(Console& console, Arguments& arguments, Placing& placing) {
  if (arguments.is_number()) {
    placing.X_WI = Pose::from_translation(arguments.point("three coordinates in mm"));
    return;
  }
  placing.at = read_feature(console, arguments, "three coordinates or a feature");
  placing.X_WI = console.session().pose_at(*placing.at);
}

/// The way that `pattern N` names.
void read_pattern(Console& console, Arguments& arguments, const std::string& element,
                  Placing& placing) {
  if (!placing.at) arguments.fail_at_last("`pattern` goes behind `at INSTANCE.FEATURE`");
  const std::size_t number = arguments.count("the number of a way");
  const std::vector<PatternWay> ways =
      arguments.located([&] { return console.session().pattern(element, *placing.at); });
  if (number > ways.size()) {
    arguments.fail_at_last("there are " + counted(ways.size(), "way") + " of standing " + element +
                           " on " + placing.at->text() + "; `pattern " + element + " at " +
                           placing.at->text() + "` lists them");
  }
  placing.X_WI = console.session().instance(placing.at->instance).X_WI * ways[number - 1].X_BE;
}

Placing read_placing(Console& console, Arguments& arguments, const std::string& element) {
  Placing placing;
  bool is_turned = false;
  bool has_pattern = false;
  while (!arguments.at_end()) {
    if (placing.name.empty() && arguments.take("as")) {
      placing.name = arguments.word("a name for the instance");
      if (placing.name.empty()) arguments.fail_at_last("a name is not empty");
    } else if (!placing.X_WI && arguments.take("at")) {
      read_place_at(console, arguments, placing);
    } else if (!has_pattern && arguments.take("pattern")) {
      has_pattern = true;
      read_pattern(console, arguments, element, placing);
    } else if (!placing.X_WI && arguments.take("on")) {
      const FeatureName face = arguments.feature("a face");
      placing.X_WI = arguments.located([&] { return console.session().pose_on(element, face); });
    } else if (!is_turned && arguments.take("rot")) {
      is_turned = true;
      placing.turn_rad = read_angle(arguments);
      if (arguments.take("about")) {
        placing.turn_axis_W = take_coordinate_axis(arguments);
        if (!placing.turn_axis_W) arguments.fail("expected x, y or z");
      }
    } else {
      arguments.fail("expected `as`, `at`, `on`, `pattern` or `rot`, each once");
    }
  }
  return placing;
}

}  // namespace

Reply run_catalog(Console& console, Arguments& arguments) {
  const std::string file = arguments.word("a catalogue file");
  arguments.expect_end();
  arguments.located([&] { console.use_catalog(file); });
  Reply reply;
  const std::size_t count = console.session().catalog()->names().size();
  reply.text = file + ": " + counted(count, "element");
  reply.json["file"] = file;
  reply.json["elements"] = count;
  return reply;
}

Reply run_new(Console& console, Arguments& arguments) {
  const std::string file = arguments.word("a project file");
  arguments.expect_end();
  arguments.located([&] { console.create(file); });
  Reply reply;
  reply.text = file + ": new project";
  reply.json["file"] = file;
  return reply;
}

Reply run_open(Console& console, Arguments& arguments) {
  const std::string file = arguments.word("a project file");
  arguments.expect_end();
  arguments.located([&] { console.open(file); });
  Reply reply;
  const std::size_t count = console.session().state().instances.size();
  reply.text = file + ": " + counted(count, "instance");
  reply.json["file"] = file;
  reply.json["instances"] = count;
  return reply;
}

Reply run_save(Console& console, Arguments& arguments) {
  std::filesystem::path file = console.session().project().file();
  if (!arguments.at_end()) {
    file = arguments.word("a project file");
  } else if (file.empty()) {
    arguments.fail("the project has no file yet: expected a file");
  }
  arguments.expect_end();
  arguments.located([&] { console.session().save(file); });
  Reply reply;
  reply.text = file.string() + ": saved";
  reply.json["file"] = file.string();
  return reply;
}

Reply run_place(Console& console, Arguments& arguments) {
  const std::string wanted = arguments.word("an element");
  const std::string element =
      arguments.located([&] { return console.session().element(wanted).name; });
  const Placing placing = read_placing(console, arguments, element);
  Pose X_WI = placing.X_WI.value_or(Pose());
  if (placing.turn_rad != 0.0) {
    // About its own upright axis, which on a tilted face is that face's normal.
    const Eigen::Vector3d axis_W =
        placing.turn_axis_W.value_or(X_WI.rotation() * Eigen::Vector3d::UnitZ());
    X_WI = Pose::about_axis(X_WI.translation(), axis_W.normalized(), placing.turn_rad) * X_WI;
  }
  const MoveReport report =
      placing.at
          ? console.session().place_at(element, placing.name, X_WI, *placing.at, arguments.line())
          : console.session().place(element, placing.name, X_WI, arguments.line());
  Reply reply = to_reply(report, "placed at");
  add_way_in(console.session(), report, reply);
  reply.json["element"] = element;
  return reply;
}

Reply run_insert(Console& console, Arguments& arguments) {
  InsertRequest request;
  request.moving = read_feature(console, arguments, "a feature of the instance that moves");
  arguments.expect("into");
  request.fixed = read_feature(console, arguments, "a feature of the instance that stays");
  const InsertWords words = read_insert_words(console, arguments);
  request.seat = words.seat;
  request.options = words.options;
  const MoveReport report = console.session().insert(request, arguments.line());
  Reply reply = to_reply(report, "inserted at");
  if (report.made && report.made->thread) reply.text += ", threaded";
  add_way_in(console.session(), report, reply);
  return reply;
}

Reply run_move(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  // By value: the move replaces what the reference would point to.
  Eigen::Vector3d to_W = console.session().instance(name).X_WI.translation();
  if (arguments.take("by")) {
    to_W += arguments.point("a distance in mm along x, y and z");
  } else if (arguments.take("to")) {
    to_W = arguments.point("three coordinates in mm");
  } else if (arguments.take("along")) {
    const Axis axis = read_axis(console, arguments);
    to_W += arguments.number("a distance in mm") * axis.direction_W;
  } else {
    arguments.fail("expected `by`, `to` or `along`");
  }
  arguments.expect_end();
  return to_reply(console.session().move(name, to_W, arguments.line()), "moved to");
}

Reply run_rotate(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  const double angle_rad = read_angle(arguments);
  Axis axis;
  if (arguments.take("about")) axis = read_axis(console, arguments);
  arguments.expect_end();
  const Eigen::Vector3d point_W =
      axis.point_W.value_or(console.session().instance(name).X_WI.translation());
  return to_reply(
      console.session().rotate(name, point_W, axis.direction_W, angle_rad, arguments.line()),
      "turned, at");
}

Reply run_remove(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  arguments.expect_end();
  const std::vector<Mate> gone = console.session().remove(name, arguments.line());
  Reply reply;
  reply.text = name + ": removed";
  if (!gone.empty()) reply.text += ", with " + counted(gone.size(), "mate");
  reply.json["instance"] = name;
  reply.json["dropped_mates"] = Json::array();
  for (const Mate& mate : gone) reply.json["dropped_mates"].push_back(to_json(mate));
  return reply;
}

Reply run_ground(Console& console, Arguments& arguments) {
  const std::string name = read_instance(console, arguments);
  const bool grounded = !arguments.take("off");
  arguments.expect_end();
  console.session().set_grounded(name, grounded, arguments.line());
  Reply reply;
  reply.text = name + (grounded ? ": grounded" : ": free to move");
  reply.json["instance"] = name;
  reply.json["grounded"] = grounded;
  return reply;
}

Reply run_mode(Console& console, Arguments& arguments) {
  using enum CheckMode;
  if (!arguments.at_end()) {
    std::optional<CheckMode> mode;
    for (const CheckMode known : {Block, Warn, Off}) {
      if (!mode && arguments.take(to_string(known))) mode = known;
    }
    if (!mode) arguments.fail("expected block, warn or off");
    arguments.expect_end();
    console.session().set_mode(*mode, arguments.line());
  }
  Reply reply;
  reply.text = "mode " + std::string(to_string(console.session().state().mode));
  reply.json["mode"] = to_string(console.session().state().mode);
  return reply;
}

Reply run_tolerance(Console& console, Arguments& arguments) {
  if (!arguments.at_end()) {
    const double tolerance_mm = arguments.number("a tolerance in mm");
    arguments.expect_end();
    arguments.located([&] { console.session().set_tolerance(tolerance_mm, arguments.line()); });
  }
  Reply reply;
  const double present_mm = console.session().state().tolerance_mm;
  reply.text = "tolerance " + Json(present_mm).dump() + " mm";
  reply.json["tolerance_mm"] = present_mm;
  return reply;
}

namespace {

Reply step_reply(const std::vector<std::string>& commands, const std::string& done,
                 const std::string& nothing) {
  Reply reply;
  for (const std::string& command : commands) {
    reply.text.append(reply.text.empty() ? "" : "\n").append(done).append(": ").append(command);
  }
  if (commands.empty()) reply.text = nothing;
  reply.json["commands"] = commands;
  return reply;
}

}  // namespace

Reply run_undo(Console& console, Arguments& arguments) {
  const std::size_t count = arguments.at_end() ? 1 : arguments.count("how many commands to undo");
  arguments.expect_end();
  return step_reply(console.session().undo(count), "undone", "nothing to undo");
}

Reply run_redo(Console& console, Arguments& arguments) {
  const std::size_t count = arguments.at_end() ? 1 : arguments.count("how many commands to redo");
  arguments.expect_end();
  return step_reply(console.session().redo(count), "redone", "nothing to redo");
}

Reply run_expect(Console& console, Arguments& arguments) {
  const std::vector<std::string> outcomes{"clear", "contact", "interference", "refused", "error"};
  const std::string wanted = arguments.word("clear, contact, interference, refused or error");
  if (std::ranges::find(outcomes, wanted) == outcomes.end()) {
    arguments.fail_at_last("expected clear, contact, interference, refused or error, got \"" +
                           wanted + "\"" + did_you_mean(similar_words(wanted, outcomes)));
  }
  if (arguments.at_end()) arguments.fail("expected a command");
  const std::vector<Word> rest(arguments.words().begin() + 2, arguments.words().end());
  Reply reply;
  std::string came;
  try {
    reply = console.run(rest);
    came = reply.outcome == "refused" || reply.verdict.empty() ? reply.outcome : reply.verdict;
    reply.has_findings = false;
  } catch (const CommandError& error) {
    if (wanted != "error") throw;
    came = "error";
    reply.outcome = "error";
    reply.text = std::string("error, as expected: ") + error.what();
    reply.json["error"] = error.what();
  }
  const bool as_expected = came == wanted || (reply.verdict == wanted && came != "refused");
  reply.json["expected"] = wanted;
  reply.json["as_expected"] = as_expected;
  if (!as_expected) {
    reply.text += "\nexpected " + wanted + ", got " + came;
    reply.has_findings = true;
  }
  return reply;
}

Reply run_quit(Console&, Arguments& arguments) {
  arguments.expect_end();
  Reply reply;
  reply.quits = true;
  return reply;
}

}  // namespace dowel::tools
