// Facts about the order in which the parts come together.

#include "dowel/assembly/sequence.h"
#include "fact_source.h"

namespace dowel {
namespace {

FactRows assembly_order(FactSource& source) {
  FactRows rows;
  if (source.state().design.limit("assembly_order") == 0.0) return rows;
  const AssemblySequence sequence = plan_sequence(source.session());
  std::int64_t step = 0;
  for (const std::string& part : sequence.base) {
    rows.push_back({part, step, truth(true), FactValue()});
  }
  for (const AssemblyStep& next : sequence.steps) {
    ++step;
    for (const std::string& part : next.parts) {
      rows.push_back({part, step, truth(true), FactValue()});
    }
  }
  for (const BlockedPart& blocked : sequence.blocked) {
    FactValue by;
    if (!blocked.ways.empty() && !blocked.ways.front().blocked_by.empty()) {
      by = blocked.ways.front().blocked_by.front().with;
    }
    rows.push_back({blocked.part, FactValue(), truth(false), by});
  }
  return rows;
}

}  // namespace

std::vector<FactTable> order_facts() {
  return {{"assembly_order",
           "An order in which the parts come to their places on straight ways past those that are "
           "there, as the word `sequence` tells it. It takes sweeps of all parts: there are rows "
           "where limit assembly_order is 1.",
           {{"instance", "part"},
            {"step", "0: there first; NULL: it does not come in"},
            {"free", "1: it comes in"},
            {"blocked_by", "on the first way that was tried; NULL where it comes in"}},
           FromParts | FromMates | FromDesign | FromTolerance,
           assembly_order}};
}

}  // namespace dowel
