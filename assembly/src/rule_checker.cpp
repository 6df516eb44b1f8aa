#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "dowel/assembly/rules.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "fact_database.h"
#include "fact_source.h"
#include "kept_facts.h"
#include "rule_findings.h"
#include "rule_parts.h"

namespace dowel {
namespace {

std::size_t line_at(const std::string& text, std::size_t offset) {
  return 1 + static_cast<std::size_t>(std::count(
                 text.begin(),
                 text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size())), '\n'));
}

}  // namespace

struct RuleChecker::Impl {
  struct Prepared {
    std::unique_ptr<FactDatabase::Query> query;
    FactReads reads;
    FactColumns each;                               ///< none: evaluated whole
    std::map<std::size_t, std::uint64_t> versions;  ///< of the facts that the last run read
    std::map<std::size_t, std::uint64_t> calls;     ///< versions of the functions that it calls
    bool has_run = false;
    bool has_parts = false;  ///< `parts` are those of `versions`
    RuleParts parts;
    RuleResult result;
  };

  Impl(Session& session, const RuleSet& given)
      : source(session),
        rules(given),
        facts(source,
              [this](std::size_t table, const std::set<std::size_t>& columns) {
                database.forget(table, columns);
              }),
        function_versions(fact_functions().size()),
        database([this](std::size_t table) -> const FactRows& { return facts.rows(table); },
                 [this](std::size_t function, std::span<const FactValue> arguments) {
                   return fact_functions()[function].call(source, arguments);
                 }),
        prepared(given.rules.size()) {}

  bool calls_changed(const Prepared& rule) const {
    return std::ranges::any_of(
        rule.calls, [&](const auto& call) { return function_versions[call.first] != call.second; });
  }

  bool must_run(Prepared& rule) {
    if (!rule.has_run) return true;
    if (rule.query == nullptr) return false;  // broken for good
    if (calls_changed(rule)) return true;
    try {
      return std::ranges::any_of(rule.reads, [&](const auto& read) {
        return facts.version(read.first, read.second) != rule.versions.at(read.first);
      });
    } catch (const Error&) {
      return true;  // running it tells
    }
  }

  void prepare(const Rule& rule, Prepared& prepared_rule);
  std::set<std::string> texts_to_run(const Prepared& rule);
  void run_parts(const Rule& rule, Prepared& prepared_rule);
  void run(const Rule& rule, Prepared& prepared_rule);
  void judge(RuleResult& result, RuleReport& report);

  FactSource source;
  const RuleSet& rules;
  KeptFacts facts;
  std::vector<std::uint64_t> function_versions;  ///< times that what they reckon with changed
  FactDatabase database;
  std::vector<Prepared> prepared;
  std::size_t ran = 0;
  std::size_t queries = 0;
};

void RuleChecker::Impl::prepare(const Rule& rule, Prepared& prepared_rule) {
  auto query = database.prepare(rule.sql);
  prepared_rule.reads = query->reads();
  prepared_rule.each = each_columns(rule, prepared_rule.reads);
  for (const auto& [table, column] : prepared_rule.each) prepared_rule.reads[table].insert(column);
  // Its form is wrong even where it is evaluated for no text.
  findings_of(rule, {database.columns(*query), {}});
  prepared_rule.query = std::move(query);
}

/// Those whose answer may be another than in its parts.
std::set<std::string> RuleChecker::Impl::texts_to_run(const Prepared& rule) {
  std::set<std::string> texts;
  const auto add_text = [&](const FactRow& row, std::size_t column) {
    if (row.empty()) return;
    if (const auto* const text = std::get_if<std::string>(&row[column])) texts.insert(*text);
  };
  if (!rule.has_parts) {
    texts = rule.parts.texts();
    for (const auto& [table, column] : rule.each) {
      for (const FactRow& row : facts.rows(table)) add_text(row, column);
    }
    return texts;
  }
  for (const auto& [table, columns] : rule.reads) {
    rule.parts.add_touched(table, columns, facts.changes(table), texts);
  }
  for (const auto& [table, column] : rule.each) {
    for (const RowChange& change : facts.changes(table)) add_text(change.after, column);
  }
  return texts;
}

void RuleChecker::Impl::run_parts(const Rule& rule, Prepared& prepared_rule) {
  const std::set<std::string> texts = texts_to_run(prepared_rule);
  prepared_rule.has_parts = false;  // until all went well
  for (const std::string& text : texts) {
    std::string key;
    add_to_key(key, text);
    if (std::ranges::none_of(prepared_rule.each, [&](const auto& column) {
          return database.has({column.first, 1U << column.second, key});
        })) {
      prepared_rule.parts.drop(text);
      continue;
    }
    ++queries;
    RulePart part;
    part.findings = findings_of(
        rule, database.run_on(*prepared_rule.query, prepared_rule.each, text, part.lookups));
    prepared_rule.parts.put(text, std::move(part));
  }
  prepared_rule.has_parts = true;
  prepared_rule.result.findings = prepared_rule.parts.findings();
}

/// Whatever goes wrong in a rule is that rule's own.
void RuleChecker::Impl::run(const Rule& rule, Prepared& prepared_rule) {
  ++ran;
  RuleResult& result = prepared_rule.result;
  result = {};
  result.rule = rule;
  prepared_rule.has_run = true;
  if (calls_changed(prepared_rule)) prepared_rule.has_parts = false;
  try {
    if (prepared_rule.query == nullptr) prepare(rule, prepared_rule);
    for (const auto& [table, columns] : prepared_rule.reads) {
      result.facts.emplace_back(fact_tables()[table].name);
      prepared_rule.versions[table] = facts.version(table, columns);
    }
    for (const std::size_t function : prepared_rule.query->calls()) {
      result.facts.emplace_back(std::string(fact_functions()[function].name) + "()");
      prepared_rule.calls[function] = function_versions[function];
    }
    if (prepared_rule.each.empty()) {
      ++queries;
      result.findings = findings_of(rule, database.run(*prepared_rule.query));
    } else {
      run_parts(rule, prepared_rule);
    }
  } catch (const FactQueryError& error) {
    prepared_rule.has_parts = false;
    result.broken = BrokenRule{
        rule.id, rule.file, error.has_offset ? line_at(rule.sql, error.offset) : 1, error.message};
  } catch (const Error& error) {
    prepared_rule.has_parts = false;
    result.broken =
        BrokenRule{rule.id, rule.file, 1, std::string("facts it reads: ") + error.what()};
    prepared_rule.has_run = false;  // the next edit may mend them
  }
}

/// Overrides and waivers: they cost no query.
void RuleChecker::Impl::judge(RuleResult& result, RuleReport& report) {
  const FixtureDesign& design = source.state().design;
  result.severity = result.rule.severity;
  const auto change = design.overrides.find(result.rule.id);
  if (change != design.overrides.end()) {
    result.overridden_by = change->second;
    result.is_off = change->second.severity == "off";
    result.severity = rule_severity_from(change->second.severity).value_or(result.severity);
  }
  for (RuleFinding& finding : result.findings) {
    const auto waiver = design.waivers.find({result.rule.id, finding.subject});
    if (waiver == design.waivers.end()) continue;
    finding.waiver = waiver->second;
    if (finding.state == RuleState::Pass) continue;
    finding.waiver_is_stale =
        waiver->second.digest != geometry_digest(source.session(), finding.subject);
    if (!finding.waiver_is_stale) finding.state = RuleState::Waived;
  }
  if (result.broken) report.broken.push_back(*result.broken);
}

RuleChecker::RuleChecker(Session& session, const RuleSet& rules)
    : impl_(std::make_unique<Impl>(session, rules)) {}
RuleChecker::~RuleChecker() = default;

std::size_t RuleChecker::last_run() const {
  return impl_->ran;
}

std::size_t RuleChecker::last_queries() const {
  return impl_->queries;
}

RuleReport RuleChecker::check() {
  Impl& self = *impl_;
  const unsigned changed = self.source.update();
  self.facts.expire(changed);
  for (std::size_t i = 0; i < self.function_versions.size(); ++i) {
    if ((fact_functions()[i].inputs & changed) != 0) ++self.function_versions[i];
  }
  self.ran = 0;
  self.queries = 0;
  RuleReport report;
  report.broken = self.rules.broken;
  const FixtureDesign& design = self.source.state().design;
  for (std::size_t i = 0; i < self.rules.rules.size(); ++i) {
    const Rule& rule = self.rules.rules[i];
    if (self.must_run(self.prepared[i])) self.run(rule, self.prepared[i]);
    RuleResult result = self.prepared[i].result;
    self.judge(result, report);
    report.results.push_back(std::move(result));
  }
  for (const auto& entry : design.waivers) {
    const auto& key = entry.first;
    const bool is_in_use = std::ranges::any_of(report.results, [&](const RuleResult& result) {
      return result.rule.id == key.first &&
             std::ranges::any_of(result.findings, [&](const RuleFinding& finding) {
               return finding.subject == key.second && finding.state == RuleState::Waived;
             });
    });
    if (!is_in_use) report.stale_waivers.push_back(key);
  }
  for (const auto& [rule, change] : design.overrides) {
    if (std::ranges::find(self.rules.rules, rule, &Rule::id) == self.rules.rules.end()) {
      report.unknown_overrides.push_back(rule);
    }
  }
  return report;
}

RuleState RuleResult::state() const {
  RuleState worst = RuleState::NotApplicable;
  for (const RuleFinding& finding : findings) {
    if (worst == RuleState::NotApplicable || finding.state > worst) worst = finding.state;
  }
  return worst;
}

std::size_t RuleResult::count(RuleState of) const {
  return static_cast<std::size_t>(std::ranges::count(findings, of, &RuleFinding::state));
}

std::size_t RuleReport::findings_at(RuleSeverity least, bool strict) const {
  std::size_t count = 0;
  for (const RuleResult& result : results) {
    if (result.is_off || result.severity < least) continue;
    count += result.count(RuleState::Fail);
    if (strict) count += result.count(RuleState::NotEvaluated);
  }
  return count;
}

std::string_view to_string(RuleSeverity severity) {
  switch (severity) {
    case RuleSeverity::Info:
      return "info";
    case RuleSeverity::Warning:
      return "warning";
    case RuleSeverity::Error:
      return "error";
  }
  DOWEL_EXPECTS(false && "a known severity");
  return {};
}

std::optional<RuleSeverity> rule_severity_from(std::string_view text) {
  for (const RuleSeverity severity :
       {RuleSeverity::Info, RuleSeverity::Warning, RuleSeverity::Error}) {
    if (to_string(severity) == text) return severity;
  }
  return std::nullopt;
}

std::string_view to_string(RuleState state) {
  switch (state) {
    case RuleState::Pass:
      return "pass";
    case RuleState::NotApplicable:
      return "not applicable";
    case RuleState::Waived:
      return "waived";
    case RuleState::NotEvaluated:
      return "not evaluated";
    case RuleState::Fail:
      return "fail";
  }
  DOWEL_EXPECTS(false && "a known state");
  return {};
}

std::vector<FactDescription> describe_facts() {
  std::vector<FactDescription> descriptions;
  for (const FactTable& table : fact_tables()) {
    FactDescription& description = descriptions.emplace_back();
    description.table = table.name;
    description.meaning = table.meaning;
    for (const FactColumn& column : table.columns) {
      description.columns.emplace_back(column.name, column.meaning);
    }
  }
  return descriptions;
}

std::vector<FunctionDescription> describe_functions() {
  std::vector<FunctionDescription> descriptions;
  for (const FactFunction& function : fact_functions()) {
    descriptions.push_back({function.name, function.arguments, function.meaning});
  }
  return descriptions;
}

std::string geometry_digest(Session& session, const std::string& subject) {
  // FNV-1a: tells a change from none, keeps no secret.
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&](const std::string& text) {
    for (const char c : text + '\n') {
      hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    }
  };
  /// Steps of a hundredth of a micrometre: what stays the same does so to rounding.
  const auto add_number = [&](double value) {
    constexpr double kSteps = 1.0e5;
    add(std::to_string(std::llround(value * kSteps)));
  };
  std::istringstream words(subject);
  std::string word;
  const Instance* first = nullptr;
  while (words >> word) {
    const Instance* instance = session.state().find(word.substr(0, word.find('.')));
    add(word);
    if (instance == nullptr) continue;
    if (first == nullptr) first = instance;
    const Element& element = session.element(instance->element);
    add(element.name);
    add(element.sha256);
    add_number(element.volume_mm3);
    const Pose X_FI = (first->X_WI.inverse() * instance->X_WI).canonical();
    for (const double value :
         {X_FI.translation().x(), X_FI.translation().y(), X_FI.translation().z()}) {
      add_number(value);
    }
    // An angle counts at 100 mm.
    for (const double value : X_FI.rotation().coeffs()) add_number(100.0 * value);
  }
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

}  // namespace dowel
