#pragma once

// Examples that shipped rules pass and fail, one rule at a time.

#include <map>
#include <set>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "dowel/assembly/rules.h"
#include "fixture_projects.h"

namespace dowel::testing {

/// By rule: whether some subject passed, and some failed, in any example.
using Seen = std::map<std::string, std::pair<bool, bool>>;

// By file, for the test that no rule is without examples.
void stated_examples(Seen& seen);
void slot_examples(Seen& seen);
void tool_examples(Seen& seen);
void catalogue_part_examples(Seen& seen);

/// What a shipped rule says of a project, and notes it.
inline RuleResult result_of(const FixtureBuilder& builder, const std::string& id, Seen& seen) {
  RuleSet rules = shipped_rules();
  std::erase_if(rules.rules, [&](const Rule& rule) { return rule.id != id; });
  REQUIRE(rules.rules.size() == 1);
  const auto session = builder.session();
  const RuleReport report = RuleChecker(*session, rules).check();
  const RuleResult& result = report.results.at(0);
  if (result.broken) FAIL_CHECK(id << ": " << result.broken->message);
  for (const RuleFinding& finding : result.findings) {
    UNSCOPED_INFO(id << " " << finding.subject << ": " << to_string(finding.state) << " "
                     << finding.message);
    for (const auto& [name, value] : finding.values) UNSCOPED_INFO("  " << name << " " << value);
  }
  auto& [passes, fails] = seen[id];
  passes = passes || result.count(RuleState::Pass) > 0;
  fails = fails || result.count(RuleState::Fail) > 0;
  return result;
}

/// The worst that a shipped rule says of a project.
inline RuleState state_of(const FixtureBuilder& builder, const std::string& id, Seen& seen) {
  return result_of(builder, id, seen).state();
}

inline void state(FixtureBuilder& builder, const std::string& subject, const std::string& quantity,
                  double value) {
  builder.state.design.stated[{quantity, subject}] = {value, "by the test"};
}

inline Element& element_called(FixtureBuilder& builder, const std::string& name) {
  for (ProjectElement& candidate : builder.elements) {
    if (candidate.element.name == name) return candidate.element;
  }
  throw std::logic_error("there is no element " + name);
}

}  // namespace dowel::testing
