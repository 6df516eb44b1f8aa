#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "dowel/assembly/rules.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "fact_database.h"
#include "fact_source.h"

namespace dowel {
namespace {

/// Numbers as people read them: six digits.
std::string text_of(const FactValue& value) {
  if (const auto* const integer = std::get_if<std::int64_t>(&value)) {
    return std::to_string(*integer);
  }
  if (const auto* const real = std::get_if<double>(&value)) {
    std::array<char, 32> buffer{};
    constexpr int kDigits = 6;
    const double shown = *real == 0.0 ? 0.0 : *real;  // no -0
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), shown,
                                   std::chars_format::general, kDigits)
                         .ptr;
    return {buffer.data(), end};
  }
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  return "unknown";
}

/// Throws FactQueryError for a column that is not there.
std::size_t column_called(const FactAnswer& answer, const std::string& name) {
  const auto found = std::ranges::find(answer.columns, name);
  if (found == answer.columns.end()) {
    throw FactQueryError{"its query has no column \"" + name + "\"", 0, false};
  }
  return static_cast<std::size_t>(found - answer.columns.begin());
}

std::string filled(const std::string& message, const FactAnswer& answer, const FactRow& row) {
  std::string text;
  for (std::size_t i = 0; i < message.size(); ++i) {
    if (message[i] != '{') {
      text += message[i];
      continue;
    }
    const std::size_t end = message.find('}', i);
    text += text_of(row[column_called(answer, message.substr(i + 1, end - i - 1))]);
    i = end;
  }
  return text;
}

RuleState state_of(const FactValue& ok) {
  if (std::holds_alternative<std::monostate>(ok)) return RuleState::NotEvaluated;
  const auto* const truth = std::get_if<std::int64_t>(&ok);
  if (truth == nullptr || (*truth != 0 && *truth != 1)) {
    throw FactQueryError{"its column \"ok\" is to be 1, 0 or NULL, not " + text_of(ok), 0, false};
  }
  return *truth == 1 ? RuleState::Pass : RuleState::Fail;
}

std::vector<RuleFinding> findings_of(const Rule& rule, const FactAnswer& answer) {
  const std::size_t subject = column_called(answer, "subject");
  const std::size_t ok = column_called(answer, "ok");
  const auto reason = std::ranges::find(answer.columns, "reason");
  // An unknown place in the message is an error even where nothing is found.
  filled(rule.message, answer, FactRow(answer.columns.size()));
  std::vector<RuleFinding> findings;
  for (const FactRow& row : answer.rows) {
    RuleFinding finding;
    finding.state = state_of(row[ok]);
    finding.subject = text_of(row[subject]);
    if (finding.state == RuleState::Fail) finding.message = filled(rule.message, answer, row);
    if (finding.state == RuleState::NotEvaluated) {
      finding.message = "a value it needs is not known";
      if (reason != answer.columns.end()) {
        finding.message = text_of(row[static_cast<std::size_t>(reason - answer.columns.begin())]);
      }
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == subject || i == ok || answer.columns[i] == "reason") continue;
      finding.values.emplace_back(answer.columns[i], text_of(row[i]));
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::size_t line_at(const std::string& text, std::size_t offset) {
  return 1 + static_cast<std::size_t>(std::count(
                 text.begin(),
                 text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size())), '\n'));
}

}  // namespace

struct RuleChecker::Impl {
  struct Facts {
    FactRows rows;
    bool is_stale = true;
    std::uint64_t changes = 0;            ///< times that it was made and had changed
    std::vector<std::uint64_t> versions;  ///< by column: the last of these that changed it
    std::uint64_t count_version = 0;      ///< the last that changed the number of rows
  };
  struct Prepared {
    std::unique_ptr<FactDatabase::Query> query;
    std::map<std::size_t, std::uint64_t> versions;  ///< of the facts that the last run read
    std::map<std::size_t, std::uint64_t> calls;     ///< versions of the functions that it calls
    bool has_run = false;
    RuleResult result;
  };

  Impl(Session& session, const RuleSet& given)
      : source(session),
        rules(given),
        facts(fact_tables().size()),
        function_versions(fact_functions().size()),
        database([this](std::size_t table) -> const FactRows& { return rows(table); },
                 [this](std::size_t function, std::span<const FactValue> arguments) {
                   return fact_functions()[function].call(source, arguments);
                 }),
        prepared(given.rules.size()) {}

  /// Rows of a table, made or made anew where they may have changed.
  const FactRows& rows(std::size_t table) {
    Facts& known = facts[table];
    if (known.is_stale) {
      FactRows now = fact_tables()[table].rows(source);
      known.is_stale = false;
      take(table, std::move(now));
    }
    return known.rows;
  }

  /// Keeps what indices of the database and rules know of columns that are as they were.
  void take(std::size_t table, FactRows now) {
    Facts& known = facts[table];
    const std::size_t columns = fact_tables()[table].columns.size();
    DOWEL_EXPECTS(
        std::ranges::all_of(now, [&](const FactRow& row) { return row.size() == columns; }));
    const bool is_first = known.versions.empty();
    const bool is_resized = now.size() != known.rows.size();
    std::set<std::size_t> changed;
    for (std::size_t column = 0; column < columns; ++column) {
      if (is_first || is_resized ||
          !std::ranges::equal(now, known.rows, [&](const auto& a, const auto& b) {
            return a[column] == b[column];
          })) {
        changed.insert(column);
      }
    }
    if (changed.empty()) return;
    ++known.changes;
    known.versions.resize(columns);
    for (const std::size_t column : changed) known.versions[column] = known.changes;
    if (is_first || is_resized) known.count_version = known.changes;
    known.rows = std::move(now);
    database.forget(table, changed);
  }

  /// Of the columns, and of how many rows there are.
  std::uint64_t version(std::size_t table, const std::set<std::size_t>& columns) {
    rows(table);
    std::uint64_t last = facts[table].count_version;
    for (const std::size_t column : columns) last = std::max(last, facts[table].versions[column]);
    return last;
  }

  bool must_run(Prepared& rule) {
    if (!rule.has_run) return true;
    if (rule.query == nullptr) return false;  // broken for good
    if (std::ranges::any_of(rule.calls, [&](const auto& call) {
          return function_versions[call.first] != call.second;
        })) {
      return true;
    }
    try {
      return std::ranges::any_of(rule.query->reads(), [&](const auto& read) {
        return version(read.first, read.second) != rule.versions.at(read.first);
      });
    } catch (const Error&) {
      return true;  // running it tells
    }
  }

  void run(const Rule& rule, Prepared& prepared_rule);
  void judge(RuleResult& result, RuleReport& report);

  FactSource source;
  const RuleSet& rules;
  std::vector<Facts> facts;
  std::vector<std::uint64_t> function_versions;  ///< times that what they reckon with changed
  FactDatabase database;
  std::vector<Prepared> prepared;
  std::size_t ran = 0;
};

/// Whatever goes wrong in a rule is that rule's own.
void RuleChecker::Impl::run(const Rule& rule, Prepared& prepared_rule) {
  ++ran;
  prepared_rule.has_run = true;
  RuleResult& result = prepared_rule.result;
  prepared_rule.versions.clear();
  prepared_rule.calls.clear();
  result = {};
  result.rule = rule;
  try {
    if (prepared_rule.query == nullptr) prepared_rule.query = database.prepare(rule.sql);
    for (const auto& [table, columns] : prepared_rule.query->reads()) {
      result.facts.emplace_back(fact_tables()[table].name);
      prepared_rule.versions[table] = version(table, columns);
    }
    for (const std::size_t function : prepared_rule.query->calls()) {
      result.facts.emplace_back(std::string(fact_functions()[function].name) + "()");
      prepared_rule.calls[function] = function_versions[function];
    }
    result.findings = findings_of(rule, database.run(*prepared_rule.query));
  } catch (const FactQueryError& error) {
    result.broken = BrokenRule{
        rule.id, rule.file, error.has_offset ? line_at(rule.sql, error.offset) : 1, error.message};
  } catch (const Error& error) {
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
    result.override_ = change->second;
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

RuleReport RuleChecker::check() {
  Impl& self = *impl_;
  const unsigned changed = self.source.update();
  for (std::size_t i = 0; i < self.facts.size(); ++i) {
    if ((fact_tables()[i].inputs & changed) != 0) self.facts[i].is_stale = true;
  }
  for (std::size_t i = 0; i < self.function_versions.size(); ++i) {
    if ((fact_functions()[i].inputs & changed) != 0) ++self.function_versions[i];
  }
  self.ran = 0;
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
  for (const auto& [key, waiver] : design.waivers) {
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
