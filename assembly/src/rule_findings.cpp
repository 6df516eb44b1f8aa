#include "rule_findings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

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

}  // namespace

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

}  // namespace dowel
