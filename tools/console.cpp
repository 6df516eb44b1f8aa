#include "console.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "console_commands.h"
#include "dowel/assembly/suggest.h"
#include "rule_desk.h"

namespace dowel::tools {
namespace {

constexpr std::array kCommands{
    Command{"catalog", "FILE", "Takes elements from this catalogue.", "catalog h40.db", false,
            run_catalog},
    Command{"new", "FILE", "Starts a project in a new file; what was open is closed.",
            "new fixture.dwp", true, run_new},
    Command{"open", "FILE", "Goes on with the project of a file; what was open is closed.",
            "open fixture.dwp", false, run_open},
    Command{"save", "[FILE]",
            "Writes a copy of the project; one that has no file yet goes on in FILE.",
            "save variant.dwp", true, run_save},
    Command{"place",
            "ELEMENT [as NAME] [at X Y Z | at INST.FEATURE [pattern N] | on INST.FACE] "
            "[rot DEG [about x|y|z]]",
            "Places an element: with its origin at a point, or at a feature and mated with what it "
            "meets there, or standing on a face. Tells where no straight way leads in.",
            "place H40-12/riser-80x80x40 as R1 on PLATE1.top rot 90", true, run_place},
    Command{
        "insert",
        "INST.FEATURE into INST.FEATURE [seat INST.FACE on INST.FACE] [offset MM] [rot DEG] "
        "[flip]",
        "Moves the first instance so that axis goes on axis, or face on face; the second stays.",
        "insert PIN1.pin1 into R1.h1 offset 2", true, run_insert},
    Command{"mate",
            "insert INST.FEATURE INST.FEATURE [seat INST.FACE on INST.FACE] [offset MM] [rot DEG] "
            "[flip] | align INST.FEATURE INST.FEATURE | seat INST.FACE INST.FACE [offset MM] | "
            "slot INST.FEATURE INST.SLOT [offset MM] | angle INST.FEATURE INST.FEATURE DEG | "
            "fix INST INST",
            "Makes a mate beside those that are there and keeps them; the first instance moves. "
            "Tells where no straight way leads in.",
            "mate align R1.h2 PLATE1.C5", true, run_mate},
    Command{"unmate", "NUMBER | INST INST",
            "Takes out a mate by its number, or all between two instances; nothing moves.",
            "unmate R1 PLATE1", true, run_unmate},
    Command{"freedoms", "INST", "Tells how an instance can still move, and which mates hold it.",
            "freedoms R1", true, run_freedoms},
    Command{"pattern", "ELEMENT at INST.HOLE",
            "Lists the ways of standing an element with all its holes on holes, for `place`.",
            "pattern H40-12/riser-80x80x40 at PLATE1.C4", true, run_pattern},
    Command{"fit", "MM HOLE/SHAFT | INST.SHAFT INST.HOLE",
            "Tells the clearance of an ISO 286 fit, or what a shaft is to a hole.", "fit 12 H7/g6",
            true, run_fit},
    Command{"stack", "MM at INST.HOLE [way N] [dry-run]",
            "Reaches a height from the spacers of the catalogue, with the fewest pieces.",
            "stack 85 at PLATE1.E5", true, run_stack},
    Command{"fasten", "INST.HOLE [way N] [dry-run]",
            "Chooses a screw that holds and does not bottom, with washer and nut where need be, or "
            "T-nut or T-bolt over a slot; tells other ways, and places the parts.",
            "fasten R1.cb1", true, run_fasten},
    Command{"move", "NAME by DX DY DZ | to X Y Z | along x|y|z|INST.FEATURE MM",
            "Moves an instance on a straight line and checks the way.", "move R1 along x -40", true,
            run_move},
    Command{"rotate", "NAME DEG [about x|y|z|INST.FEATURE]",
            "Turns an instance about its origin (z unless told) or about a feature's axis.",
            "rotate R1 90 about PLATE1.C4", true, run_rotate},
    Command{"drag",
            "INST by DX DY DZ | to X Y Z | along x|y|z|INST.FEATURE MM | "
            "turn DEG [about x|y|z|INST.FEATURE]; then [block|slide|warn|off]",
            "Moves an instance along what its mates leave free, with its unit and all that hangs "
            "on it, to the first touch; `slide` goes on along what it meets. Where it is part of a "
            "linkage, the others follow.",
            "drag R1 by 60 0 0 slide", true, run_drag},
    Command{"snap", "INST [within MM] [take [N]]",
            "Lists the mates that fit for an instance near its goal, best first, or takes one.",
            "snap PIN1 take 1", true, run_snap},
    Command{"where", "ELEMENT", "Lists the places where an element can go and is in nothing's way.",
            "where H40-12/pin-round-12", true, run_where},
    Command{"recognise", "[dry-run]",
            "Makes the mates that parts stand in already, as those of a STEP assembly do.",
            "recognise", true, run_recognise},
    Command{"way", "INST [all]",
            "Tells by which straight ways an instance (all: with what hangs on it) can be brought "
            "in and taken out, and what blocks the others.",
            "way R1", true, run_way},
    Command{"sequence", "",
            "Tells an order in which all parts can be brought in, or which block each other.",
            "sequence", true, run_sequence},
    Command{"unit", "INST [INST ...]",
            "Fixes instances together so that they move as one, or tells what one is fixed to.",
            "unit CLAMP1 SCREW1", true, run_unit},
    Command{"save-unit", "INST FILE",
            "Writes an instance with all that hangs on it as a project for `insert-unit`.",
            "save-unit CLAMP1 clamp.dwp", true, run_save_unit},
    Command{"insert-unit", "FILE [as NAME] [at X Y Z | at INST.FEATURE]",
            "Places all instances of another project as one unit.",
            "insert-unit clamp.dwp as LEFT at PLATE1.B2", true, run_insert_unit},
    Command{"diff", "FILE [FILE]",
            "Tells what differs from one project to another, or to the one at hand; exit code 1 "
            "where anything does.",
            "diff old.dwp new.dwp", true, run_diff},
    Command{"remove", "NAME", "Takes an instance and its mates out of the project.", "remove R1",
            true, run_remove},
    Command{"ground", "NAME [off]", "Holds an instance in its place, or lets it go.",
            "ground PLATE1", true, run_ground},
    Command{"mode", "[block|warn|off]",
            "What becomes of a move that interferes: taken back, reported, or not looked at.",
            "mode warn", true, run_mode},
    Command{"tolerance", "[MM]", "Tolerance between contact and interference.", "tolerance 0.02",
            true, run_tolerance},
    Command{"undo", "[N]", "Takes back the last N commands that changed something (1).", "undo 2",
            true, run_undo},
    Command{"redo", "[N]", "Does again what was undone (1).", "redo", true, run_redo},
    Command{"list", "[instances|elements|mates|features NAME]",
            "Lists what there is; NAME is an instance or an element.", "list features PLATE1", true,
            run_list},
    Command{"show", "NAME", "Tells all about an instance or an element.", "show R1", true,
            run_show},
    Command{"bom", "[FILE.csv]", "Bill of materials, on the screen or as CSV.", "bom parts.csv",
            true, run_bom},
    Command{"check", "", "Checks all pairs; exit code 1 where any interferes.", "check", true,
            run_check},
    Command{"role", "INST ROLE|off",
            "Says what an instance is in the fixture, where its element's role is not it.",
            "role WORK workpiece", true, run_role},
    Command{"force", "CLAMP N|off", "Says with how many newtons a clamp presses.",
            "force STRAP1 6000", true, run_force},
    Command{"load", "NAME FX FY FZ at X Y Z [torque TX TY TZ] | NAME off",
            "A cutting force on the workpiece, in N and mm.", "load MILL 400 0 -200 at 0 0 120",
            true, run_load},
    Command{"point", "NAME at X Y Z tolerance MM | NAME off",
            "A point of the workpiece that has to be where it is meant to be.",
            "point BORE at 20 0 110 tolerance 0.1", true, run_point},
    Command{"accuracy", "INST MM|off", "Says how far off a locator may stand, plus or minus.",
            "accuracy REST1 0.005", true, run_accuracy},
    Command{"limit", "[NAME [NUMBER|off]]", "Tells or changes what rules compare with.",
            "limit friction 0.2", true, run_limit},
    Command{"design", "[INST|INST.FEATURE|ELEMENT|POINT QUANTITY NUMBER reason TEXT | ... off]",
            "States what geometry does not tell (stroke, preload, stock, cutter), or lists it.",
            "design STRAP1 stroke_mm 12 reason \"maker's sheet\"", true, run_design},
    Command{"analyse", "[FILE.svg]",
            "How the workpiece is located, clamped and held; as a drawing, too.",
            "analyse fixture.svg", true, run_analyse},
    Command{
        "rules",
        "check [gate error|warning|info] [strict] [rules DIR] [format "
        "text|json|sarif|junit|html] [to FILE] | list [rules DIR] | facts [TABLE] | explain "
        "RULE [SUBJECT] [rules DIR] | waive RULE SUBJECT reason TEXT [by NAME] | unwaive RULE "
        "SUBJECT | override RULE error|warning|info|off reason TEXT | restore RULE",
        "Checks the design by rules; exit code 1 where findings reach the gate (error), 3 where "
        "a rule is broken.",
        "rules check gate warning", true, run_rules},
    Command{"export", "FILE.step|.glb|.html|.png|.csv|.dowel [gate error|warning]",
            "Writes the assembly (STEP, GLB, 3D page, picture), the bill of materials or the "
            "commands as a script; with a gate, only where no rule has findings at it.",
            "export fixture.step", true, run_export},
    Command{"history", "", "The commands that made the project; undone ones are marked.", "history",
            true, run_history},
    Command{"expect", "clear|contact|interference|refused|error COMMAND",
            "Runs a command that is to end like that; anything else fails the script.",
            "expect refused move R1 by 0 0 -5", false, run_expect},
    Command{"help", "[WORD]", "Explains a command, or lists all.", "help insert", false, run_help},
    Command{"quit", "", "Leaves; everything is saved already.", "quit", false, run_quit},
};

/// Keywords of a command: the lower-case words in its arguments.
std::vector<std::string> keywords(const Command& command) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : command.arguments) {
    if (c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    // "FILE.step" and "x" hold no keyword worth completing.
    if (c != '.' && word.size() > 1) words.push_back(word);
    word.clear();
  }
  if (word.size() > 1) words.push_back(word);
  return words;
}

}  // namespace

std::span<const Command> commands() {
  return kCommands;
}

const Command* find_command(std::string_view word) {
  const auto* const found = std::ranges::find(kCommands, word, &Command::word);
  return found == kCommands.end() ? nullptr : found;
}

const Command& command_for(const Word& word) {
  if (const Command* found = find_command(word.text)) return *found;
  std::vector<std::string> names;
  names.reserve(kCommands.size());
  for (const Command& command : kCommands) names.emplace_back(command.word);
  const std::vector<std::string> similar = similar_words(word.text, names);
  throw CommandError(ErrorCode::InvalidInput,
                     "unknown command \"" + word.text + "\"" +
                         (similar.empty() ? "; `help` lists all" : did_you_mean(similar)),
                     word.column);
}

Console::Console() {
  adopt(Project());
}

Console::~Console() = default;

RuleDesk& Console::rules() {
  if (rules_ == nullptr) rules_ = std::make_unique<RuleDesk>(session());
  return *rules_;
}

void Console::adopt(Project project) {
  rules_.reset();
  session_ = std::make_unique<Session>(std::move(project));
  session_->use_catalog(catalog_);
}

void Console::create(const std::filesystem::path& file) {
  adopt(Project::create(file));
}

void Console::open(const std::filesystem::path& file) {
  adopt(Project::open(file));
}

void Console::use_catalog(const std::filesystem::path& file) {
  catalog_ = std::make_shared<const Catalog>(file, Catalog::Access::ReadOnly);
  session_->use_catalog(catalog_);
}

Reply Console::run(const std::vector<Word>& words) {
  const Command& command = command_for(words.front());
  Arguments arguments(words);
  try {
    return command.run(*this, arguments);
  } catch (const CommandError&) {
    throw;
  } catch (const Error& error) {
    throw CommandError(error.code(), error.what(), words.front().column);
  }
}

std::vector<std::string> Console::completions(const std::vector<Word>& before,
                                              std::string_view start) {
  std::set<std::string> candidates;
  const Command* command = before.empty() ? nullptr : find_command(before.front().text);
  const std::size_t dot = start.find('.');
  if (before.empty() || before.back().text == "help") {
    for (const Command& known : kCommands) candidates.emplace(known.word);
  } else if (command != nullptr) {
    const std::vector<std::string> words = keywords(*command);
    candidates.insert(words.begin(), words.end());
    if (command->arguments.find("ELEMENT") != std::string_view::npos || command->word == "show" ||
        command->word == "list") {
      const std::vector<std::string> elements = session_->element_names();
      candidates.insert(elements.begin(), elements.end());
    }
    const Instance* owner =
        dot == std::string_view::npos ? nullptr : session_->state().find(start.substr(0, dot));
    if (owner != nullptr) {
      for (const Feature& feature : session_->element(owner->element).features) {
        candidates.insert(owner->name + "." + feature.name);
      }
    }
    for (const auto& [name, instance] : session_->state().instances) candidates.insert(name);
  }
  std::vector<std::string> result;
  std::ranges::copy_if(candidates, std::back_inserter(result),
                       [&](const std::string& name) { return name.starts_with(start); });
  return result;
}

}  // namespace dowel::tools
