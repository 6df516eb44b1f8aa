#include "rule_report.h"

#include <algorithm>
#include <array>

#include "table.h"

namespace dowel::tools {
namespace {

constexpr std::array kWorstFirst{RuleSeverity::Error, RuleSeverity::Warning, RuleSeverity::Info};

std::string place_of(const BrokenRule& broken) {
  return broken.file + (broken.line > 0 ? ":" + std::to_string(broken.line) : "");
}

std::string broken_text(const BrokenRule& broken) {
  return place_of(broken) + ": broken rule" + (broken.id.empty() ? "" : " " + broken.id) + ": " +
         broken.message;
}

struct Counts {
  std::size_t rules = 0;
  std::size_t passed = 0;
  std::size_t not_applicable = 0;
  std::size_t off = 0;
  std::array<std::size_t, 3> failed{};  ///< findings, by severity
  std::size_t waived = 0;
  std::size_t not_evaluated = 0;
};

Counts counts_of(const RuleReport& report) {
  Counts counts;
  for (const RuleResult& result : report.results) {
    ++counts.rules;
    if (result.is_off) {
      ++counts.off;
      continue;
    }
    if (result.broken) continue;
    if (result.state() == RuleState::Pass) ++counts.passed;
    if (result.state() == RuleState::NotApplicable) ++counts.not_applicable;
    counts.failed[static_cast<std::size_t>(result.severity)] += result.count(RuleState::Fail);
    counts.waived += result.count(RuleState::Waived);
    counts.not_evaluated += result.count(RuleState::NotEvaluated);
  }
  return counts;
}

std::string summary_text(const RuleReport& report) {
  const Counts counts = counts_of(report);
  return counted(counts.rules, "rule") + ": " + std::to_string(counts.passed) + " pass, " +
         std::to_string(counts.not_applicable) + " not applicable; " +
         counted(counts.failed[2], "error") + ", " + counted(counts.failed[1], "warning") + ", " +
         std::to_string(counts.failed[0]) + " info, " + std::to_string(counts.waived) +
         " waived, " + std::to_string(counts.not_evaluated) + " not evaluated" +
         (counts.off > 0 ? ", " + std::to_string(counts.off) + " off" : "") +
         (report.broken.empty() ? "" : ", " + std::to_string(report.broken.size()) + " broken");
}

Json finding_json(const RuleFinding& finding) {
  Json json{{"subject", finding.subject},
            {"state", to_string(finding.state)},
            {"message", finding.message}};
  for (const auto& [name, value] : finding.values) json["values"][name] = value;
  if (finding.waiver) {
    json["waiver"] = {{"reason", finding.waiver->reason},
                      {"by", finding.waiver->by},
                      {"stale", finding.waiver_is_stale}};
  }
  return json;
}

void add_findings(std::string& text, const RuleReport& report, RuleState state) {
  for (const RuleSeverity severity : kWorstFirst) {
    for (const RuleResult& result : report.results) {
      if (result.is_off || result.severity != severity) continue;
      for (const RuleFinding& finding : result.findings) {
        if (finding.state != state) continue;
        text += state == RuleState::Fail ? std::string(to_string(severity))
                                         : std::string(to_string(state));
        text += " " + result.rule.id + " " +
                (state == RuleState::Fail ? "" : finding.subject + ": ") + finding.message;
        if (finding.waiver) {
          text += finding.waiver_is_stale ? " (the waiver is stale: the geometry has changed)"
                                          : " (waived: " + finding.waiver->reason + ")";
        }
        text += "\n";
      }
    }
  }
}

/// Rules that ask for the same thing that nobody said would fill the screen: one line each.
void add_not_evaluated(std::string& text, const RuleReport& report) {
  for (const RuleResult& result : report.results) {
    const std::size_t count = result.count(RuleState::NotEvaluated);
    if (result.is_off || count == 0) continue;
    const auto first =
        std::ranges::find(result.findings, RuleState::NotEvaluated, &RuleFinding::state);
    text += "not evaluated " + result.rule.id + " for " + counted(count, "subject") + ": " +
            first->message + "\n";
  }
}

}  // namespace

std::string report_text(const RuleReport& report, const ReportOptions&) {
  std::string text;
  for (const BrokenRule& broken : report.broken) text += broken_text(broken) + "\n";
  add_findings(text, report, RuleState::Fail);
  add_findings(text, report, RuleState::Waived);
  add_not_evaluated(text, report);
  for (const auto& [rule, subject] : report.stale_waivers) {
    text += "stale waiver of " + rule + " for " + subject +
            ": the geometry has changed, or there is nothing to waive\n";
  }
  for (const RuleResult& result : report.results) {
    if (!result.overridden_by) continue;
    text += "override " + result.rule.id + ": " + std::string(to_string(result.rule.severity)) +
            " counts as " + result.overridden_by->severity + " (" + result.overridden_by->reason +
            ")\n";
  }
  for (const std::string& rule : report.unknown_overrides) {
    text += "override of " + rule + ": there is no such rule\n";
  }
  return text + summary_text(report);
}

Json report_json(const RuleReport& report, const ReportOptions& options) {
  const Counts counts = counts_of(report);
  Json json;
  json["gate"] = to_string(options.gate);
  json["findings_at_gate"] = report.findings_at(options.gate, options.strict);
  json["counts"] = {{"rules", counts.rules},
                    {"pass", counts.passed},
                    {"not_applicable", counts.not_applicable},
                    {"error", counts.failed[2]},
                    {"warning", counts.failed[1]},
                    {"info", counts.failed[0]},
                    {"waived", counts.waived},
                    {"not_evaluated", counts.not_evaluated},
                    {"off", counts.off},
                    {"broken", report.broken.size()}};
  json["rules"] = Json::array();
  for (const RuleResult& result : report.results) {
    Json rule{{"id", result.rule.id},
              {"family", result.rule.family},
              {"severity", result.is_off ? "off" : std::string(to_string(result.severity))},
              {"title", result.rule.title},
              {"reference", result.rule.reference},
              {"state", result.broken ? "broken" : std::string(to_string(result.state()))},
              {"facts", result.facts}};
    if (result.overridden_by) {
      rule["override"] = {{"severity", result.overridden_by->severity},
                          {"reason", result.overridden_by->reason}};
    }
    rule["subjects"] = Json::array();
    for (const RuleFinding& finding : result.findings) {
      rule["subjects"].push_back(finding_json(finding));
    }
    json["rules"].push_back(std::move(rule));
  }
  json["broken"] = Json::array();
  for (const BrokenRule& broken : report.broken) {
    json["broken"].push_back({{"id", broken.id},
                              {"file", broken.file},
                              {"line", broken.line},
                              {"message", broken.message}});
  }
  json["stale_waivers"] = Json::array();
  for (const auto& [rule, subject] : report.stale_waivers) {
    json["stale_waivers"].push_back({{"rule", rule}, {"subject", subject}});
  }
  json["unknown_overrides"] = report.unknown_overrides;
  return json;
}

std::optional<std::string> report_as(std::string_view format, const RuleReport& report,
                                     const ReportOptions& options) {
  if (format == "text") return report_text(report, options);
  if (format == "json") return to_line(report_json(report, options));
  if (format == "sarif") return report_sarif(report, options);
  if (format == "junit") return report_junit(report, options);
  if (format == "html") return report_html(report, options);
  return std::nullopt;
}

std::string explanation_text(const RuleResult& result, const RuleFinding& finding) {
  std::string text = result.rule.id + " (" + std::string(to_string(result.severity)) +
                     "): " + result.rule.title + "\n  " + finding.subject + ": " +
                     std::string(to_string(finding.state));
  if (finding.state != RuleState::Pass) text += ", " + finding.message;
  if (finding.waiver) {
    text += "\n  waiver: " + finding.waiver->reason +
            (finding.waiver->by.empty() ? "" : " (" + finding.waiver->by + ")") +
            (finding.waiver_is_stale ? ", stale" : "");
  }
  for (const auto& [name, value] : finding.values) text += "\n  " + name + " = " + value;
  text += "\n  reference: " + result.rule.reference + "\n  facts:";
  for (const std::string& fact : result.facts) text += " " + fact;
  return text + "\n  rule: " + result.rule.file;
}

}  // namespace dowel::tools
