#include "dowel/assembly/sequence.h"

#include <algorithm>
#include <map>
#include <set>

namespace dowel {
namespace {

/// Takes a fixture apart.
class Dismantler {
 public:
  explicit Dismantler(Session& session) : session_(session) {
    const auto placed = session.state().in_order();
    for (const Instance* part : placed) {
      if (part->grounded) base_.push_back(part->name);
    }
    if (base_.empty() && !placed.empty()) base_.push_back(placed.front()->name);
    std::set<std::string> seen(base_.begin(), base_.end());
    // What is fixed to the base stays with it.
    for (const std::string& name : base_) {
      for (const std::string& other : session.unit(name)) seen.insert(other);
    }
    for (const Instance* part : placed) {
      if (!seen.insert(part->name).second) continue;
      const std::vector<std::string> unit = session.unit(part->name);
      seen.insert(unit.begin(), unit.end());
      left_.push_back(part->name);  // one for each unit, by order of placing
    }
  }

  AssemblySequence run() {
    AssemblySequence sequence;
    sequence.base = base_;
    while (!left_.empty()) {
      auto step = next_step(false);
      if (!step) step = next_step(true);
      if (!step) break;
      for (const std::string& part : step->parts) {
        gone_.insert(part);
        std::erase(left_, part);
      }
      sequence.steps.push_back(std::move(*step));
    }
    std::ranges::reverse(sequence.steps);
    for (const std::string& part : left_) {
      sequence.blocked.push_back({part, session_.ways_out(part, {.without = gone_})});
    }
    if (!left_.empty()) sequence.entered = entered();
    return sequence;
  }

 private:
  std::vector<Touch> entered() const {
    std::vector<Touch> all = session_.check_all();
    std::erase_if(all, [&](const Touch& touch) {
      return touch.pair.verdict != Verdict::Interference || gone_.contains(touch.instance) ||
             gone_.contains(touch.with);
    });
    return all;
  }

  /// The part to go next, alone or with what hangs on it; nothing where all are blocked.
  std::optional<AssemblyStep> next_step(bool with_sub_assembly) {
    for (const bool may_carry : {false, true}) {
      for (auto part = left_.rbegin(); part != left_.rend(); ++part) {
        if (carries(*part) != may_carry) continue;
        if (with_sub_assembly && !may_carry) continue;  // tried alone already
        if (auto step = step_of(*part, with_sub_assembly)) return step;
      }
    }
    return std::nullopt;
  }

  std::optional<AssemblyStep> step_of(const std::string& part, bool with_sub_assembly) {
    auto& still = with_sub_assembly ? blocked_together_by_ : blocked_by_;
    const auto known = still.find(part);
    // As long as one blocker of each way is there, nothing has changed.
    if (known != still.end() && std::ranges::all_of(known->second, [&](const auto& blockers) {
          return std::ranges::none_of(
              blockers, [&](const std::string& name) { return gone_.contains(name); });
        })) {
      return std::nullopt;
    }
    const std::vector<WayOut> ways = session_.ways_out(
        part, {.without = gone_, .with_sub_assembly = with_sub_assembly, .first_free = true});
    if (!ways.empty() && ways.front().blocked_by.empty()) {
      AssemblyStep step{{part}, ways.front()};
      const auto along = with_sub_assembly ? session_.sub_assembly(part) : session_.unit(part);
      for (const std::string& name : along) {
        if (name != part && !gone_.contains(name)) step.parts.push_back(name);
      }
      return step;
    }
    std::vector<std::vector<std::string>> blockers;
    for (const WayOut& way : ways) {
      blockers.emplace_back();
      for (const Touch& touch : way.blocked_by) blockers.back().push_back(touch.with);
    }
    still[part] = std::move(blockers);
    return std::nullopt;
  }

  /// Something that is left is mated on the part.
  bool carries(const std::string& part) const {
    const std::vector<std::string> unit = session_.unit(part);
    return std::ranges::any_of(session_.state().mates, [&](const auto& entry) {
      const Mate& mate = entry.second;
      const auto is_in = [&](const std::string& name) {
        return std::ranges::binary_search(unit, name);
      };
      return is_in(mate.fixed.instance) && !is_in(mate.moving.instance) &&
             !gone_.contains(mate.moving.instance);
    });
  }

  Session& session_;
  std::vector<std::string> base_;
  std::vector<std::string> left_;
  std::set<std::string> gone_;
  std::map<std::string, std::vector<std::vector<std::string>>> blocked_by_;
  std::map<std::string, std::vector<std::vector<std::string>>> blocked_together_by_;
};

}  // namespace

AssemblySequence plan_sequence(Session& session) {
  return Dismantler(session).run();
}

}  // namespace dowel
