// Reports for other programs: SARIF, JUnit, HTML.

#include <array>
#include <cstdio>
#include <map>
#include <vector>

#include "rule_report.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// For XML and HTML. Control characters have no place in either.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string_view sarif_level(const RuleResult& result) {
  switch (result.severity) {
    case RuleSeverity::Error:
      return "error";
    case RuleSeverity::Warning:
      return "warning";
    case RuleSeverity::Info:
      break;
  }
  return "note";
}

/// Stable from run to run: what is found, not where it stands in a list.
std::string fingerprint(const std::string& rule, const std::string& subject) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : rule + "\n" + subject) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

Json sarif_result(const RuleResult& result, std::size_t index, const RuleFinding& finding) {
  const bool counts = finding.state == RuleState::Fail || finding.state == RuleState::Waived;
  Json json{{"ruleId", result.rule.id},
            {"ruleIndex", index},
            {"kind", counts                                     ? "fail"
                     : finding.state == RuleState::NotEvaluated ? "open"
                                                                : "pass"},
            {"level", counts ? sarif_level(result) : "none"},
            {"message", {{"text", finding.message}}},
            {"partialFingerprints",
             {{"ruleAndSubject/v1", fingerprint(result.rule.id, finding.subject)}}}};
  Json locations = Json::array();
  std::string word;
  for (const char c : finding.subject + " ") {
    if (c != ' ') {
      word += c;
      continue;
    }
    if (!word.empty()) {
      locations.push_back({{"logicalLocations", {{{"name", word}, {"kind", "object"}}}}});
    }
    word.clear();
  }
  json["locations"] = std::move(locations);
  if (finding.state == RuleState::Waived) {
    json["suppressions"] = {{{"kind", "external"}, {"justification", finding.waiver->reason}}};
  }
  return json;
}

std::string_view state_class(RuleState state) {
  switch (state) {
    case RuleState::Fail:
      return "fail";
    case RuleState::Waived:
      return "waived";
    case RuleState::NotEvaluated:
      return "open";
    default:
      return "pass";
  }
}

constexpr std::string_view kStyle =
    R"(body{font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:70em;color:#222}
table{border-collapse:collapse;width:100%;margin:.5em 0 1.5em}td,th{border-bottom:1px solid #ddd;padding:.3em .6em;text-align:left;vertical-align:top}
.id{white-space:nowrap;font-weight:600}.fail{color:#b00020}.waived{color:#8a6d00}.open{color:#666}.pass{color:#1b6e2e}
.small{color:#666;font-size:.85em}h2{margin-top:1.5em})";

void add_rows(std::string& html, const RuleReport& report, RuleState state) {
  for (const RuleSeverity severity :
       {RuleSeverity::Error, RuleSeverity::Warning, RuleSeverity::Info}) {
    for (const RuleResult& result : report.results) {
      if (result.is_off || result.severity != severity) continue;
      for (const RuleFinding& finding : result.findings) {
        if (finding.state != state) continue;
        std::string note;
        if (finding.waiver) {
          note = finding.waiver_is_stale ? "stale waiver: " + finding.waiver->reason
                                         : "waived: " + finding.waiver->reason;
        }
        html += "<tr><td class=\"id " + std::string(state_class(state)) + "\">" +
                escaped(result.rule.id) + "</td><td>" + std::string(to_string(severity)) +
                "</td><td>" + escaped(finding.subject) + "</td><td>" + escaped(finding.message) +
                (note.empty() ? "" : "<div class=\"small\">" + escaped(note) + "</div>") +
                "<div class=\"small\">" + escaped(result.rule.title) + " (" +
                escaped(result.rule.reference) + ")</div></td></tr>\n";
      }
    }
  }
}

bool has_any(const RuleReport& report, RuleState state) {
  for (const RuleResult& result : report.results) {
    if (!result.is_off && result.count(state) > 0) return true;
  }
  return false;
}

std::string rule_overview(const RuleReport& report) {
  std::string html =
      "<h2>Rules</h2>\n<table><tr><th>rule</th><th>severity</th><th>state</th><th>subjects</th>"
      "<th>title</th></tr>\n";
  for (const RuleResult& result : report.results) {
    const std::string state = result.is_off   ? "off"
                              : result.broken ? "broken"
                                              : std::string(to_string(result.state()));
    html += "<tr><td class=\"id\">" + escaped(result.rule.id) + "</td><td>" +
            std::string(to_string(result.severity)) + "</td><td class=\"" +
            std::string(result.broken ? "fail" : state_class(result.state())) + "\">" + state +
            "</td><td>" + std::to_string(result.findings.size()) + "</td><td>" +
            escaped(result.rule.title) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string report_sarif(const RuleReport& report, const ReportOptions&) {
  Json rules = Json::array();
  Json results = Json::array();
  for (std::size_t i = 0; i < report.results.size(); ++i) {
    const RuleResult& result = report.results[i];
    rules.push_back(
        {{"id", result.rule.id},
         {"shortDescription", {{"text", result.rule.title}}},
         {"help", {{"text", result.rule.reference}}},
         {"defaultConfiguration", {{"enabled", !result.is_off}, {"level", sarif_level(result)}}},
         {"properties", {{"family", result.rule.family}}}});
    if (result.is_off) continue;
    for (const RuleFinding& finding : result.findings) {
      if (finding.state != RuleState::Pass) results.push_back(sarif_result(result, i, finding));
    }
  }
  Json notes = Json::array();
  for (const BrokenRule& broken : report.broken) {
    notes.push_back(
        {{"level", "error"},
         {"message",
          {{"text", broken.file + ":" + std::to_string(broken.line) + ": " + broken.message}}}});
  }
  const Json sarif{
      {"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
      {"version", "2.1.0"},
      {"runs",
       {{{"tool", {{"driver", {{"name", "dowel"}, {"version", DOWEL_VERSION}, {"rules", rules}}}}},
         {"invocations",
          {{{"executionSuccessful", report.broken.empty()},
            {"toolConfigurationNotifications", notes}}}},
         {"results", results}}}}};
  return to_line(sarif);
}

std::string report_junit(const RuleReport& report, const ReportOptions& options) {
  struct Suite {
    std::string cases;
    std::size_t tests = 0;
    std::size_t failures = 0;
    std::size_t skipped = 0;
    std::size_t errors = 0;
  };
  std::map<std::string, Suite> suites;
  for (const RuleResult& result : report.results) {
    if (result.is_off) continue;
    Suite& suite = suites[result.rule.family];
    if (result.broken) {
      ++suite.tests;
      ++suite.errors;
      suite.cases += "<testcase classname=\"" + escaped(result.rule.id) +
                     "\" name=\"rule\"><error " + "message=\"" + escaped(result.broken->message) +
                     "\"/></testcase>\n";
    }
    for (const RuleFinding& finding : result.findings) {
      ++suite.tests;
      suite.cases += "<testcase classname=\"" + escaped(result.rule.id) + "\" name=\"" +
                     escaped(finding.subject) + "\">";
      const bool fails = finding.state == RuleState::Fail && result.severity >= options.gate;
      if (fails) {
        ++suite.failures;
        suite.cases += "<failure type=\"" + std::string(to_string(result.severity)) +
                       "\" message=\"" + escaped(finding.message) + "\"/>";
      } else if (finding.state == RuleState::Fail) {
        suite.cases += "<system-out>" + std::string(to_string(result.severity)) + ": " +
                       escaped(finding.message) + "</system-out>";
      } else if (finding.state != RuleState::Pass) {
        ++suite.skipped;
        suite.cases += "<skipped message=\"" + std::string(to_string(finding.state)) + ": " +
                       escaped(finding.message) + "\"/>";
      }
      suite.cases += "</testcase>\n";
    }
  }
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"dowel\">\n";
  for (const auto& [family, suite] : suites) {
    xml += "<testsuite name=\"" + escaped(family) + "\" tests=\"" + std::to_string(suite.tests) +
           "\" failures=\"" + std::to_string(suite.failures) + "\" errors=\"" +
           std::to_string(suite.errors) + "\" skipped=\"" + std::to_string(suite.skipped) +
           "\">\n" + suite.cases + "</testsuite>\n";
  }
  return xml + "</testsuites>";
}

std::string report_html(const RuleReport& report, const ReportOptions& options) {
  std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     escaped(options.project) + ": design rules</title><style>" +
                     std::string(kStyle) + "</style></head><body>\n<h1>" +
                     escaped(options.project) + ": design rules</h1>\n";
  std::string summary = report_text(report, options);
  summary = summary.substr(summary.rfind('\n') + 1);
  html += "<p>" + escaped(summary) + "</p>\n";
  for (const BrokenRule& broken : report.broken) {
    html += "<p class=\"fail\">broken rule: " + escaped(broken.file) + ":" +
            std::to_string(broken.line) + ": " + escaped(broken.message) + "</p>\n";
  }
  const std::array<std::pair<RuleState, const char*>, 3> sections{
      {{RuleState::Fail, "Findings"},
       {RuleState::Waived, "Waived"},
       {RuleState::NotEvaluated, "Not evaluated"}}};
  for (const auto& [state, title] : sections) {
    if (!has_any(report, state)) continue;
    html += "<h2>" + std::string(title) +
            "</h2>\n<table><tr><th>rule</th><th>severity</th><th>subject</th><th>what</th></tr>\n";
    add_rows(html, report, state);
    html += "</table>\n";
  }
  for (const auto& [rule, subject] : report.stale_waivers) {
    html += "<p class=\"waived\">stale waiver: " + escaped(rule + " for " + subject) + "</p>\n";
  }
  return html + rule_overview(report) + "</body></html>";
}

}  // namespace dowel::tools
