#pragma once

// Rule checks at the console.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "dowel/assembly/rules.h"

namespace dowel::tools {

/// The shipped rules and those of folders, with what the last check found out.
class RuleDesk {
 public:
  explicit RuleDesk(Session& session) : session_(session) {}

  /// Reads the folders anew. Throws Error{FileUnreadable}.
  const RuleSet& load(const std::vector<std::string>& folders);
  RuleReport check(const std::vector<std::string>& folders);

 private:
  Session& session_;
  std::unique_ptr<RuleSet> rules_;
  std::unique_ptr<RuleChecker> checker_;
};

/// Reads `gate SEVERITY`, `strict`, `rules DIR` to the end; where no gate is given, nothing. Else
/// checks, and answers where findings or broken rules stand against going on.
std::optional<Reply> refused_by_gate(Console& console, Arguments& arguments);

}  // namespace dowel::tools
