// Rules as files.

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

#include "dowel/assembly/rules.h"
#include "dowel/kernel/error.h"
#include "shipped_rules.h"

namespace dowel {
namespace {

/// No rule needs more; a file of another kind in the folder may have it.
constexpr std::uintmax_t kMaxBytes = 100'000;

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

bool is_id(std::string_view id) {
  return !id.empty() && id.size() <= 40 && std::ranges::all_of(id, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

/// Where a message names a column, both braces are there.
bool has_sound_places(std::string_view message) {
  bool open = false;
  for (const char c : message) {
    if (c == '{' && open) return false;
    if (c == '}' && !open) return false;
    if (c == '{' || c == '}') open = !open;
  }
  return !open;
}

void add(RuleSet& rules, std::variant<Rule, BrokenRule> read) {
  if (auto* const broken = std::get_if<BrokenRule>(&read)) {
    rules.broken.push_back(std::move(*broken));
    return;
  }
  Rule& rule = std::get<Rule>(read);
  const auto known = std::ranges::find(rules.rules, rule.id, &Rule::id);
  if (known != rules.rules.end()) {
    rules.broken.push_back({rule.id, rule.file, 1,
                            "a rule " + rule.id + " is there already, in " + known->file +
                                ": expected another id (`rules override` changes a rule)"});
    return;
  }
  rules.rules.push_back(std::move(rule));
}

std::vector<std::filesystem::path> sorted_entries(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> entries;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  if (error) {
    throw Error(ErrorCode::FileUnreadable,
                folder.string() + ": expected a folder of rules: " + error.message());
  }
  std::ranges::sort(entries);
  return entries;
}

void add_file(RuleSet& rules, const std::filesystem::path& file, const std::string& family) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  const auto bytes = std::filesystem::file_size(file, ignored);
  if (!stream || ignored || bytes > kMaxBytes) {
    rules.broken.push_back({{}, file.string(), 0, "cannot be read as a rule of up to 100 kB"});
    return;
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  add(rules, read_rule(text, file.string(), family));
}

}  // namespace

std::variant<Rule, BrokenRule> read_rule(const std::string& text, const std::string& file,
                                         const std::string& family) {
  Rule rule;
  rule.file = file;
  rule.family = family;
  rule.sql = text;
  std::string severity;
  const std::array<std::pair<std::string_view, std::string*>, 6> fields{
      {{"id", &rule.id},
       {"severity", &severity},
       {"title", &rule.title},
       {"message", &rule.message},
       {"reference", &rule.reference},
       {"each", &rule.each}}};
  std::istringstream lines(text);
  std::string line;
  std::size_t number = 0;
  const auto broken = [&](std::size_t at, const std::string& message) {
    return BrokenRule{is_id(rule.id) ? rule.id : std::string(), file, at, message};
  };
  std::string* last = nullptr;
  while (std::getline(lines, line) && line.starts_with("--")) {
    ++number;
    const std::string content = trimmed(std::string_view(line).substr(2));
    const std::size_t colon = content.find(':');
    const auto* const field = std::ranges::find_if(fields, [&](const auto& known) {
      return colon != std::string::npos && content.substr(0, colon) == known.first;
    });
    if (field != fields.end()) {
      if (!field->second->empty())
        return broken(number, "a second \"" + std::string(field->first) + ":\"");
      *field->second = trimmed(std::string_view(content).substr(colon + 1));
      last = field->second;
    } else if (last != nullptr && line.starts_with("--   ")) {
      *last += " " + content;  // a long one goes on in the next line, indented
    } else {
      last = nullptr;  // a comment
    }
  }
  for (const auto& [name, value] : fields) {
    if (value->empty() && value != &rule.each) {
      return broken(1, "expected a line \"-- " + std::string(name) + ": ...\" in its header");
    }
  }
  if (!is_id(rule.id)) return broken(1, "its id is to be made of letters, digits and - _ .");
  const auto known = rule_severity_from(severity);
  if (!known) {
    return broken(1, "severity \"" + severity + "\": expected error, warning or info");
  }
  rule.severity = *known;
  if (!has_sound_places(rule.message)) {
    return broken(1, "its message has a { without a }, or the other way round");
  }
  return rule;
}

RuleSet shipped_rules() {
  RuleSet rules;
  for (const ShippedRule& shipped : kShippedRules) {
    add(rules, read_rule(shipped.text, shipped.file, shipped.family));
  }
  std::ranges::sort(rules.rules, {}, &Rule::id);
  return rules;
}

void add_rules(RuleSet& rules, const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error(ErrorCode::FileUnreadable, folder.string() + ": expected a folder of rules");
  }
  const std::string own = std::filesystem::absolute(folder).lexically_normal().filename().string();
  for (const std::filesystem::path& entry : sorted_entries(folder)) {
    if (std::filesystem::is_directory(entry, ignored)) {
      for (const std::filesystem::path& file : sorted_entries(entry)) {
        if (file.extension() == ".sql") add_file(rules, file, entry.filename().string());
      }
    } else if (entry.extension() == ".sql") {
      add_file(rules, entry, own);
    }
  }
  std::ranges::sort(rules.rules, {}, &Rule::id);
}

}  // namespace dowel
