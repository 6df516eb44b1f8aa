#include "judged_moves.h"

#include <array>
#include <iterator>
#include <string>

namespace dowel::bench {

namespace {

constexpr std::uint64_t kVariants = 5;

/// What a designer would call the situation.
struct Situation {
  const char* name;
  std::vector<MotionKind> kinds;
};

const std::array<Situation, 5>& situations() {
  static const std::array<Situation, 5> kAll{{{"touching", {MotionKind::Contact}},
                                              {"near", {MotionKind::Free, MotionKind::Near}},
                                              {"penetrating", {MotionKind::Insert}},
                                              {"pin in hole", {MotionKind::Fit, MotionKind::Tight}},
                                              {"contained", {MotionKind::Contained}}}};
  return kAll;
}

Score& operator+=(Score& sum, const Score& more) {
  sum.known += more.known;
  sum.false_yes += more.false_yes;
  sum.false_no += more.false_no;
  sum.other += more.other;
  return sum;
}

std::string cell(const Score& score) {
  std::string result = std::to_string(score.false_yes) + " / " + std::to_string(score.false_no);
  if (score.other != 0) result += " / " + std::to_string(score.other);
  return result + " of " + std::to_string(score.known);
}

/// Answers of one method to the motions of one situation.
std::vector<Run> answers(const Scenario& scene, const Situation& situation, const Method& method,
                         std::uint64_t variant, std::size_t poses) {
  const std::unique_ptr<Checker> checker = method.make();
  for (const Placed& placed : scene.elements) checker->add(placed);
  checker->set_moving(scene.moving);
  checker->finish();
  std::vector<Run> runs;
  for (const MotionKind kind : situation.kinds) {
    const Motion motion = motion_of(scene, kind, poses, variant);
    Run run;
    for (std::size_t i = 0; i < motion.poses.size(); i += method.stride) {
      run.answers.push_back(checker->check(motion.poses[i]));
      run.truth.push_back(motion.truth[i]);
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace

JudgedMoves run_judged_moves(const std::vector<Method>& methods, const Plan& plan) {
  std::vector<std::array<Score, 5>> verdicts(methods.size());
  for (std::uint64_t variant = 0; variant < kVariants; ++variant) {
    for (const Scenario& scene : paper_scenarios(variant)) {
      for (std::size_t m = 0; m < methods.size(); ++m) {
        for (std::size_t s = 0; s < situations().size(); ++s) {
          for (const Run& run :
               answers(scene, situations().at(s), methods[m], variant, plan.poses)) {
            const Run* const one[] = {&run};
            const bool has_verdict = run.answers.front().verdict.has_value();
            verdicts[m].at(s) += has_verdict ? score_own_question(one) : score_interference(one);
          }
        }
      }
    }
  }
  JudgedMoves result;
  result.table = {
      "Verdicts of 100,000 moves",
      "All motions in five variants of each scene, each pose asked once. Wrong answers to \"is "
      "there interference?\", false yes / false no (/ of dowel: contact and clear mixed up) of the "
      "poses whose truth is known by construction and outside a twentieth of the tolerance about "
      "it. Touching: sliding on tops; near: free and near; pin in hole: fit and tight.",
      {"method"},
      {}};
  for (const Situation& situation : situations()) result.table.columns.emplace_back(situation.name);
  result.table.columns.emplace_back("all");
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::vector<std::string> row{std::string(methods[m].name)};
    Score all;
    for (const Score& score : verdicts[m]) {
      row.push_back(cell(score));
      all += score;
    }
    row.push_back(cell(all));
    result.table.rows.push_back(std::move(row));
    if (methods[m].name == "dowel" || methods[m].name == "dowel first") {
      result.dowel_wrong += all.false_yes + all.false_no + all.other;
    }
  }
  return result;
}

}  // namespace dowel::bench
