#include "rule_desk.h"

#include <algorithm>

namespace dowel::tools {
namespace {

bool is_same(const Rule& a, const Rule& b) {
  return a.id == b.id && a.family == b.family && a.file == b.file && a.sql == b.sql;
}

}  // namespace

const RuleSet& RuleDesk::load(const std::vector<std::string>& folders) {
  auto read = std::make_unique<RuleSet>(shipped_rules());
  for (const std::string& folder : folders) add_rules(*read, folder);
  if (rules_ != nullptr && std::ranges::equal(rules_->rules, read->rules, is_same)) {
    rules_->broken = read->broken;
  } else {
    checker_.reset();
    rules_ = std::move(read);
  }
  return *rules_;
}

RuleReport RuleDesk::check(const std::vector<std::string>& folders) {
  load(folders);
  if (checker_ == nullptr) checker_ = std::make_unique<RuleChecker>(session_, *rules_);
  return checker_->check();
}

}  // namespace dowel::tools
