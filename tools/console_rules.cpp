// The words that check the design by rules.

#include <algorithm>

#include "console_commands.h"
#include "dowel/assembly/suggest.h"
#include "dowel/io/file.h"
#include "rule_desk.h"
#include "rule_report.h"
#include "table.h"

namespace dowel::tools {
namespace {

struct CheckWords {
  std::optional<RuleSeverity> gate;
  bool strict = false;
  std::vector<std::string> folders;
  std::string format;
  std::string file;
};

/// The words behind `rules check` and `export FILE`, each once but for `rules`.
CheckWords read_check_words(Arguments& arguments, bool with_format) {
  CheckWords words;
  while (!arguments.at_end()) {
    if (!words.gate && arguments.take("gate")) {
      words.gate = rule_severity_from(arguments.word("error, warning or info"));
      if (!words.gate) arguments.fail_at_last("expected error, warning or info");
    } else if (!words.strict && arguments.take("strict")) {
      words.strict = true;
    } else if (arguments.take("rules")) {
      words.folders.push_back(arguments.word("a folder of rules"));
    } else if (with_format && words.format.empty() && arguments.take("format")) {
      words.format = arguments.word("text, json, sarif, junit or html");
    } else if (with_format && words.file.empty() && arguments.take("to")) {
      words.file = arguments.word("a file");
    } else {
      arguments.fail(with_format ? "expected gate, strict, rules, format or to, each once"
                                 : "expected gate, strict or rules, each once");
    }
  }
  return words;
}

std::vector<std::string> read_folders(Arguments& arguments) {
  std::vector<std::string> folders;
  while (!arguments.at_end()) {
    arguments.expect("rules");
    folders.push_back(arguments.word("a folder of rules"));
  }
  return folders;
}

const RuleResult& result_of(const Arguments& arguments, const RuleReport& report,
                            const std::string& id) {
  const auto found = std::ranges::find_if(
      report.results, [&](const RuleResult& result) { return result.rule.id == id; });
  if (found != report.results.end()) return *found;
  std::vector<std::string> names;
  for (const RuleResult& result : report.results) names.push_back(result.rule.id);
  arguments.fail_at_last("no rule is called \"" + id + "\"" +
                         did_you_mean(similar_words(id, names)));
}

std::string title_of(Console& console) {
  const std::string stem = console.session().project().file().stem().string();
  return stem.empty() ? "assembly" : stem;
}

Reply check(Console& console, Arguments& arguments) {
  const CheckWords words = read_check_words(arguments, true);
  const ReportOptions options{words.gate.value_or(RuleSeverity::Error), words.strict,
                              title_of(console)};
  const RuleReport report = console.rules().check(words.folders);
  Reply reply;
  reply.json = report_json(report, options);
  const std::string format = words.format.empty() ? "text" : words.format;
  const auto text = report_as(format, report, options);
  if (!text) arguments.fail("format \"" + format + "\": expected text, json, sarif, junit or html");
  if (words.file.empty()) {
    reply.text = *text;
  } else {
    write_file(words.file, *text + "\n");
    const std::string all = report_text(report, options);
    reply.text = words.file + ": written\n" + all.substr(all.rfind('\n') + 1);
    reply.json["file"] = words.file;
  }
  reply.has_findings = report.findings_at(options.gate, options.strict) > 0;
  reply.has_bad_input = !report.broken.empty();
  return reply;
}

Reply list(Console& console, Arguments& arguments) {
  const RuleSet& rules = console.rules().load(read_folders(arguments));
  const FixtureDesign& design = console.session().state().design;
  Table table({{"rule"}, {"severity"}, {"family"}, {"what has to be true"}});
  Reply reply;
  reply.json["rules"] = Json::array();
  for (const Rule& rule : rules.rules) {
    const auto change = design.overrides.find(rule.id);
    std::string severity(to_string(rule.severity));
    if (change != design.overrides.end()) severity += " -> " + change->second.severity;
    table.add({rule.id, severity, rule.family, rule.title});
    reply.json["rules"].push_back({{"id", rule.id},
                                   {"severity", to_string(rule.severity)},
                                   {"family", rule.family},
                                   {"title", rule.title},
                                   {"reference", rule.reference},
                                   {"file", rule.file}});
  }
  reply.text = table.text();
  for (const BrokenRule& broken : rules.broken) {
    reply.text +=
        "\n" + broken.file + ":" + std::to_string(broken.line) + ": broken rule: " + broken.message;
  }
  reply.has_bad_input = !rules.broken.empty();
  return reply;
}

Reply facts(Arguments& arguments) {
  Reply reply;
  const std::vector<FactDescription> all = describe_facts();
  if (arguments.at_end()) {
    Table table({{"table"}, {"what it holds"}});
    reply.json["tables"] = Json::array();
    for (const FactDescription& fact : all) {
      table.add({fact.table, fact.meaning});
      reply.json["tables"].push_back({{"table", fact.table}, {"meaning", fact.meaning}});
    }
    Table functions({{"function"}, {"what it gives"}});
    reply.json["functions"] = Json::array();
    for (const FunctionDescription& function : describe_functions()) {
      functions.add({function.name + "(" + function.arguments + ")", function.meaning});
      reply.json["functions"].push_back({{"function", function.name},
                                         {"arguments", function.arguments},
                                         {"meaning", function.meaning}});
    }
    reply.text = table.text() + "\n" + functions.text() +
                 "\n`rules facts TABLE` tells the columns of a table.";
    return reply;
  }
  const std::string name = arguments.word("a table");
  arguments.expect_end();
  const auto fact = std::ranges::find(all, name, &FactDescription::table);
  if (fact == all.end()) {
    std::vector<std::string> names;
    names.reserve(all.size());
    for (const FactDescription& known : all) names.push_back(known.table);
    arguments.fail_at_last("no facts are called \"" + name + "\"" +
                           did_you_mean(similar_words(name, names)));
  }
  Table table({{"column"}, {"meaning"}});
  reply.json["table"] = name;
  reply.json["columns"] = Json::array();
  for (const auto& [column, meaning] : fact->columns) {
    table.add({column, meaning});
    reply.json["columns"].push_back({{"column", column}, {"meaning", meaning}});
  }
  reply.text = fact->meaning + "\n" + table.text();
  return reply;
}

Reply explain(Console& console, Arguments& arguments) {
  const std::string id = arguments.word("a rule");
  std::string subject;
  while (!arguments.at_end() && !arguments.take("rules")) {
    subject += (subject.empty() ? "" : " ") + arguments.word("a subject");
  }
  std::vector<std::string> folders;
  if (!arguments.at_end()) folders.push_back(arguments.word("a folder of rules"));
  arguments.expect_end();
  const RuleReport report = console.rules().check(folders);
  const RuleResult& result = result_of(arguments, report, id);
  Reply reply;
  reply.json["rule"] = id;
  reply.json["sql"] = result.rule.sql;
  if (result.broken) {
    reply.text = result.rule.file + ":" + std::to_string(result.broken->line) +
                 ": broken rule: " + result.broken->message;
    reply.has_bad_input = true;
    return reply;
  }
  bool found = false;
  for (const RuleFinding& finding : result.findings) {
    if (!subject.empty() && finding.subject != subject) continue;
    reply.text += (found ? "\n" : "") + explanation_text(result, finding);
    found = true;
  }
  reply.json["result"] = report_json(RuleReport{{result}, {}, {}, {}}, {})["rules"][0];
  if (found) return reply;
  if (!subject.empty()) {
    std::vector<std::string> names;
    for (const RuleFinding& finding : result.findings) names.push_back(finding.subject);
    arguments.fail_at_last(id + " does not look at \"" + subject + "\"" +
                           did_you_mean(similar_words(subject, names)));
  }
  reply.text = id + ": " + result.rule.title + "\n  not applicable: it has no subject here";
  return reply;
}

/// Words up to `reason`.
std::string read_subject(Arguments& arguments) {
  std::string subject = arguments.word("a subject, as `rules check` names it");
  while (!arguments.at_end() && !arguments.take("reason")) {
    subject += " " + arguments.word("a subject");
  }
  return subject;
}

/// Of a rule of a folder nothing is known where it is changed.
std::string unless_shipped(const std::string& id) {
  const RuleSet shipped = shipped_rules();
  if (std::ranges::find(shipped.rules, id, &Rule::id) != shipped.rules.end()) return {};
  return "; no rule of this name is shipped: it counts where a folder of rules has it";
}

Reply waive(Console& console, Arguments& arguments) {
  const std::string id = arguments.word("a rule");
  const std::string subject = read_subject(arguments);
  Waiver waiver;
  waiver.reason = arguments.word("a reason, in quotes");
  if (waiver.reason.empty()) arguments.fail_at_last("expected a reason");
  if (arguments.take("by")) waiver.by = arguments.word("a name");
  arguments.expect_end();
  const RuleReport report = console.rules().check({});
  // Of a rule of a folder nothing is known here: its findings are not looked at.
  const auto known = std::ranges::find_if(
      report.results, [&](const RuleResult& result) { return result.rule.id == id; });
  if (known != report.results.end()) {
    const auto finding = std::ranges::find(known->findings, subject, &RuleFinding::subject);
    if (finding == known->findings.end() || finding->state == RuleState::Pass) {
      arguments.fail(id + " has no finding on \"" + subject + "\" to waive");
    }
  }
  waiver.digest = geometry_digest(console.session(), subject);
  FixtureDesign design = console.session().state().design;
  design.waivers[{id, subject}] = waiver;
  console.session().set_design(design, arguments.line());
  Reply reply;
  reply.text =
      id + " is waived for " + subject + " as long as its geometry stays" + unless_shipped(id);
  return reply;
}

Reply unwaive(Console& console, Arguments& arguments) {
  const std::string id = arguments.word("a rule");
  std::string subject = arguments.word("a subject");
  while (!arguments.at_end()) subject += " " + arguments.word("a subject");
  FixtureDesign design = console.session().state().design;
  if (design.waivers.erase({id, subject}) == 0) {
    arguments.fail_at_last("there is no waiver of " + id + " for \"" + subject + "\"");
  }
  console.session().set_design(design, arguments.line());
  Reply reply;
  reply.text = id + " counts again for " + subject;
  return reply;
}

Reply override_rule(Console& console, Arguments& arguments) {
  const std::string id = arguments.word("a rule");
  RuleOverride change;
  change.severity = arguments.word("error, warning, info or off");
  if (change.severity != "off" && !rule_severity_from(change.severity)) {
    arguments.fail_at_last("expected error, warning, info or off");
  }
  arguments.expect("reason");
  change.reason = arguments.word("a reason, in quotes");
  if (change.reason.empty()) arguments.fail_at_last("expected a reason");
  arguments.expect_end();
  FixtureDesign design = console.session().state().design;
  design.overrides[id] = change;
  console.session().set_design(design, arguments.line());
  Reply reply;
  reply.text = id + " counts as " + change.severity + unless_shipped(id);
  return reply;
}

Reply restore(Console& console, Arguments& arguments) {
  const std::string id = arguments.word("a rule");
  arguments.expect_end();
  FixtureDesign design = console.session().state().design;
  if (design.overrides.erase(id) == 0) arguments.fail_at_last("rule " + id + " is not overridden");
  console.session().set_design(design, arguments.line());
  Reply reply;
  reply.text = id + " counts as it is shipped";
  return reply;
}

}  // namespace

Reply run_rules(Console& console, Arguments& arguments) {
  if (arguments.take("check")) return check(console, arguments);
  if (arguments.take("list")) return list(console, arguments);
  if (arguments.take("facts")) return facts(arguments);
  if (arguments.take("explain")) return explain(console, arguments);
  if (arguments.take("waive")) return waive(console, arguments);
  if (arguments.take("unwaive")) return unwaive(console, arguments);
  if (arguments.take("override")) return override_rule(console, arguments);
  if (arguments.take("restore")) return restore(console, arguments);
  arguments.fail("expected check, list, facts, explain, waive, unwaive, override or restore");
}

std::optional<Reply> refused_by_gate(Console& console, Arguments& arguments) {
  const CheckWords words = read_check_words(arguments, false);
  if (!words.gate) return std::nullopt;
  const RuleReport report = console.rules().check(words.folders);
  const std::size_t findings = report.findings_at(*words.gate, words.strict);
  if (findings == 0 && report.broken.empty()) return std::nullopt;
  const ReportOptions options{*words.gate, words.strict, {}};
  Reply reply;
  reply.outcome = "refused";
  reply.text = "nothing was written: rules have " + counted(findings, "finding") + " at " +
               std::string(to_string(*words.gate)) + " or above\n" + report_text(report, options);
  reply.json = report_json(report, options);
  reply.has_findings = findings > 0;
  reply.has_bad_input = !report.broken.empty();
  return reply;
}

}  // namespace dowel::tools
