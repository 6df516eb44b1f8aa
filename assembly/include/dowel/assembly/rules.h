#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dowel/assembly/session.h"

namespace dowel {

enum class RuleSeverity : std::uint8_t { Info, Warning, Error };

/// "info", "warning", "error".
std::string_view to_string(RuleSeverity severity);
std::optional<RuleSeverity> rule_severity_from(std::string_view text);

/// A design rule: an SQL query over facts that answers with a row for each subject it looks at.
/// assembly/README.md tells how one is written.
struct Rule {
  std::string id;      ///< "LOC-02"
  std::string family;  ///< folder of its file
  RuleSeverity severity = RuleSeverity::Error;
  std::string title;      ///< what has to be true
  std::string message;    ///< of a finding; "{column}" stands for a value of its row
  std::string reference;  ///< where it comes from
  /// "TABLE.COLUMN, ...": it is evaluated for each text in these columns by itself and sees of
  /// these tables the rows with it alone. Empty: evaluated whole.
  std::string each;
  std::string file;
  std::string sql;  ///< with its header, so that lines are those of the file
};

/// A rule, or a file, that cannot be used, and why. Others are not affected.
struct BrokenRule {
  std::string id;  ///< empty where not even that is known
  std::string file;
  std::size_t line = 0;  ///< from 1; 0: the whole file
  std::string message;
};

struct RuleSet {
  std::vector<Rule> rules;  ///< by id
  std::vector<BrokenRule> broken;
};

/// Those that come with dowel.
RuleSet shipped_rules();

/// The file's text as a rule.
std::variant<Rule, BrokenRule> read_rule(const std::string& text, const std::string& file,
                                         const std::string& family);

/// Adds the rules of all files FOLDER/*.sql and FOLDER/FAMILY/*.sql. A second rule of one id is
/// broken: a rule is weakened by an override, never by another. Throws Error{FileUnreadable} for
/// what is no folder.
void add_rules(RuleSet& rules, const std::filesystem::path& folder);

enum class RuleState : std::uint8_t { Pass, NotApplicable, Waived, NotEvaluated, Fail };

/// "pass", "not applicable", "waived", "not evaluated", "fail".
std::string_view to_string(RuleState state);

/// What a rule says of one subject.
struct RuleFinding {
  RuleState state = RuleState::Pass;
  std::string subject;  ///< names of instances or features, separated by blanks
  std::string message;  ///< fail: the rule's; not evaluated: why; else empty
  std::vector<std::pair<std::string, std::string>> values;  ///< columns and numbers of its row
  std::optional<Waiver> waiver;
  bool waiver_is_stale = false;  ///< the geometry is another since: the finding counts
};

/// What a rule says of a project.
struct RuleResult {
  Rule rule;
  RuleSeverity severity = RuleSeverity::Error;  ///< in force
  bool is_off = false;
  std::optional<RuleOverride> overridden_by;
  std::optional<BrokenRule> broken;   ///< then there are no findings
  std::vector<RuleFinding> findings;  ///< one a subject, in the rule's order; passes, too
  std::vector<std::string> facts;     ///< tables that it reads

  RuleState state() const;  ///< the worst of its findings; NotApplicable where there is none
  std::size_t count(RuleState of) const;
};

struct RuleReport {
  std::vector<RuleResult> results;  ///< by id
  std::vector<BrokenRule> broken;   ///< files that hold no rule, and rules that failed
  std::vector<std::pair<std::string, std::string>> stale_waivers;  ///< rule and subject
  std::vector<std::string> unknown_overrides;  ///< rules that the project changes and nobody has

  /// Findings (not waived) of rules in force of `least` severity or more; with `strict`, those not
  /// evaluated, too.
  std::size_t findings_at(RuleSeverity least, bool strict = false) const;
};

/// A column or table that rules can read, for documentation.
struct FactDescription {
  std::string table;
  std::string meaning;
  std::vector<std::pair<std::string, std::string>> columns;
};

std::vector<FactDescription> describe_facts();

/// A function that rules can call, for documentation.
struct FunctionDescription {
  std::string name;
  std::string arguments;
  std::string meaning;
};

std::vector<FunctionDescription> describe_functions();

/// Checks rules against a session's project. What a rule reads is known from its query: a check
/// after an edit runs those rules alone whose facts have changed, of these with `each` those texts
/// alone whose rows have, and answers as a first one would.
class RuleChecker {
 public:
  /// Both must outlive it.
  RuleChecker(Session& session, const RuleSet& rules);
  ~RuleChecker();
  RuleChecker(const RuleChecker&) = delete;
  RuleChecker& operator=(const RuleChecker&) = delete;

  RuleReport check();
  /// Rules that the last check ran anew.
  std::size_t last_run() const;
  /// Queries that it took: one a rule, or one for each text of its `each` that may have changed.
  std::size_t last_queries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Digest of the geometry of all instances that a subject names: their elements, and where they are
/// to each other. A fixture that is moved as a whole keeps it to rounding.
std::string geometry_digest(Session& session, const std::string& subject);

}  // namespace dowel
