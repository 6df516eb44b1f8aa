#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "methods.h"
#include "motion.h"

namespace dowel::bench {

/// One method on one motion in one scenario.
struct Run {
  std::string scenario;
  MotionKind kind = MotionKind::Free;
  std::string method;
  std::vector<double>
      times_us;  ///< by pose, the fastest of all rounds, with one reading of the clock
  double batch_mean_us = 0.0;  ///< all poses in one go, processor time
  std::vector<Answer> answers;
  std::vector<Truth> truth;
  std::optional<Checker::Counters> counters;
};

/// With room for the answers and times of `poses` poses.
Run blank_run(std::size_t poses);

/// One round, pose by pose, and one in one go: the run keeps the fastest.
void run_timed(Checker& checker, std::span<const Pose> poses, Run& run);
void run_batch(Checker& checker, std::span<const Pose> poses, Run& run);

struct Statistics {
  double median_us = 0.0;
  double p99_us = 0.0;
  double mean_us = 0.0;  ///< of batches
};

/// Of the poses of all `runs` together.
Statistics statistics(std::span<const Run* const> runs);

/// Right and wrong answers where the truth is known.
struct Score {
  std::size_t known = 0;      ///< poses
  std::size_t false_yes = 0;  ///< says interference, or that surfaces meet
  std::size_t false_no = 0;
  std::size_t other = 0;  ///< contact for clear or clear for contact
};

/// By the designer's question: is there interference? A hit counts as yes.
Score score_interference(std::span<const Run* const> runs);

/// By the method's own question: the verdict, or whether surfaces meet.
Score score_own_question(std::span<const Run* const> runs);

struct Plan {
  std::size_t poses = 1000;
  std::size_t rounds = 3;
  std::vector<MotionKind> kinds;
};

/// All methods on the motions of one scenario, taking turns.
std::vector<Run> run_scenario(const Scenario& scenario, std::span<const Method> methods,
                              const Plan& plan);

/// Cost of growth: `count` elements, then moves among them.
struct ScalePoint {
  std::size_t count = 0;
  std::string method;
  double add_us = 0.0;           ///< mean of adding the last tenth of the elements
  double build_ms = 0.0;         ///< adding all of them, one by one
  double remove_us = 0.0;        ///< median of taking one away and the first move after it
  double add_and_move_us = 0.0;  ///< median of adding one more and the first move after it
  double move_us = 0.0;          ///< median
  double move_mean_us = 0.0;
  double bytes_per_element = 0.0;  ///< heap of the last half of the elements
};

ScalePoint run_scale(std::size_t count, const Method& method, const Plan& plan);

/// Mean time of a move over a field of 1,000 elements, by the size of the moving block.
struct SizePoint {
  std::string method;
  double size_mm = 0.0;
  double mean_us = 0.0;
};

SizePoint run_size(double size_mm, const Method& method, const Plan& plan);

/// Time that this thread has had a processor: what other programs take does not count. Reading it
/// takes longer than a check, so that it serves for batches only.
double processor_us();

/// What a reading of the clock takes that single checks are timed with; the fastest of some rounds.
double clock_us();

/// That this process holds at the moment.
std::size_t heap_bytes();

}  // namespace dowel::bench
