#pragma once

// Reports of a rule check in the formats that people and other programs read.

#include <string>
#include <string_view>

#include "dowel/assembly/rules.h"
#include "json.h"

namespace dowel::tools {

struct ReportOptions {
  RuleSeverity gate = RuleSeverity::Error;
  bool strict = false;
  std::string project;  ///< title
};

/// Findings first, worst first; then what was waived, not evaluated, and counts.
std::string report_text(const RuleReport& report, const ReportOptions& options);
Json report_json(const RuleReport& report, const ReportOptions& options);
/// SARIF 2.1.0: all rules, results of those that failed, were waived or not evaluated; fingerprints
/// of rule and subject.
std::string report_sarif(const RuleReport& report, const ReportOptions& options);
/// A test suite for each family, a case for each subject.
std::string report_junit(const RuleReport& report, const ReportOptions& options);
/// One page that needs nothing else.
std::string report_html(const RuleReport& report, const ReportOptions& options);

/// By its name: text, json, sarif, junit, html. Nothing where there is none of that name.
std::optional<std::string> report_as(std::string_view format, const RuleReport& report,
                                     const ReportOptions& options);

/// "LOC-04 passed for WORK"; the rule, its reference and every number.
std::string explanation_text(const RuleResult& result, const RuleFinding& finding);

}  // namespace dowel::tools
