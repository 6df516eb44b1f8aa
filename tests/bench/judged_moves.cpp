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

/// Peers are asked at every fifth pose of those they are timed at: their wrong answers are many.
std::size_t stride(const Method& method) {
  return method.name.starts_with("dowel") ? 1 : 5 * method.stride;
}

/// Answers of one method to one motion.
Run answers(Checker& checker, const Motion& motion, std::size_t stride) {
  Run run;
  for (std::size_t i = 0; i < motion.poses.size(); i += stride) {
    run.answers.push_back(checker.check(motion.poses[i]));
    run.truth.push_back(motion.truth[i]);
  }
  return run;
}

/// Adds what a method answers in one scene, by situation.
void judge(const Scenario& scene, const Method& method, std::uint64_t variant, std::size_t poses,
           std::array<Score, 5>& scores) {
  const std::unique_ptr<Checker> checker = method.make();
  for (const Placed& placed : scene.elements) checker->add(placed);
  checker->set_moving(scene.moving);
  checker->finish();
  for (std::size_t s = 0; s < scores.size(); ++s) {
    for (const MotionKind kind : situations().at(s).kinds) {
      const Run run = answers(*checker, motion_of(scene, kind, poses, variant), stride(method));
      const Run* const one[] = {&run};
      const bool has_verdict = run.answers.front().verdict.has_value();
      scores.at(s) += has_verdict ? score_own_question(one) : score_interference(one);
    }
  }
}

}  // namespace

JudgedMoves run_judged_moves(const std::vector<Method>& methods, const Plan& plan) {
  std::vector<std::array<Score, 5>> verdicts(methods.size());
  for (std::uint64_t variant = 0; variant < kVariants; ++variant) {
    for (const Scenario& scene : paper_scenarios(variant)) {
      for (std::size_t m = 0; m < methods.size(); ++m) {
        judge(scene, methods[m], variant, plan.poses, verdicts[m]);
      }
    }
  }
  JudgedMoves result;
  result.table = {
      "Verdicts of 100,000 moves",
      "All motions in five variants of each scene, each pose asked once, the slower methods and "
      "the "
      "peers at a part of them. Wrong answers to \"is "
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
