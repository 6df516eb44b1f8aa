#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <malloc.h>
#include <time.h>

namespace dowel::bench {

namespace {

using Clock = std::chrono::steady_clock;

double elapsed_us(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double, std::micro>(end - start).count();
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<Pose> every(std::span<const Pose> poses, std::size_t stride) {
  std::vector<Pose> result;
  for (std::size_t i = 0; i < poses.size(); i += stride) result.push_back(poses[i]);
  return result;
}

/// Hits are summed up and kept, so that no check is optimised away.
volatile std::size_t g_hits = 0;

}  // namespace

std::size_t heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

double processor_us() {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1.0e6 * static_cast<double>(now.tv_sec) + 1.0e-3 * static_cast<double>(now.tv_nsec);
}

double clock_us() {
  constexpr int kReadings = 10'000;
  double best_us = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    const Clock::time_point start = Clock::now();
    Clock::time_point end = start;
    for (int i = 0; i < kReadings; ++i) end = Clock::now();
    best_us = std::min(best_us, elapsed_us(start, end) / kReadings);
  }
  return best_us;
}

Run blank_run(std::size_t poses) {
  Run run;
  run.answers.resize(poses);
  run.times_us.assign(poses, std::numeric_limits<double>::infinity());
  run.batch_mean_us = std::numeric_limits<double>::infinity();
  return run;
}

void run_timed(Checker& checker, std::span<const Pose> poses, Run& run) {
  Clock::time_point start = Clock::now();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Answer answer = checker.check(poses[i]);
    const Clock::time_point end = Clock::now();
    run.answers[i] = answer;
    run.times_us[i] = std::min(run.times_us[i], elapsed_us(start, end));
    start = Clock::now();
  }
}

void run_batch(Checker& checker, std::span<const Pose> poses, Run& run) {
  std::size_t hits = 0;
  const double start_us = processor_us();
  for (const Pose& pose : poses) hits += checker.check(pose).hit ? 1U : 0U;
  const double taken_us = processor_us() - start_us;
  g_hits = g_hits + hits;
  run.batch_mean_us = std::min(run.batch_mean_us, taken_us / static_cast<double>(poses.size()));
}

Statistics statistics(std::span<const Run* const> runs) {
  std::vector<double> times;
  double sum = 0.0;
  for (const Run* run : runs) {
    times.insert(times.end(), run->times_us.begin(), run->times_us.end());
    sum += run->batch_mean_us * static_cast<double>(run->times_us.size());
  }
  if (times.empty()) return {};
  return {quantile(times, 0.5), quantile(times, 0.99), sum / static_cast<double>(times.size())};
}

Score score_interference(std::span<const Run* const> runs) {
  Score score;
  for (const Run* run : runs) {
    for (std::size_t i = 0; i < run->answers.size(); ++i) {
      if (!run->truth[i].verdict) continue;
      ++score.known;
      const bool truth = run->truth[i].verdict == Verdict::Interference;
      if (run->answers[i].hit && !truth) ++score.false_yes;
      if (!run->answers[i].hit && truth) ++score.false_no;
    }
  }
  return score;
}

Score score_own_question(std::span<const Run* const> runs) {
  Score score;
  for (const Run* run : runs) {
    for (std::size_t i = 0; i < run->answers.size(); ++i) {
      const Answer& answer = run->answers[i];
      const Truth& truth = run->truth[i];
      if (answer.verdict && truth.verdict) {
        ++score.known;
        if (answer.verdict == truth.verdict) continue;
        if (answer.verdict == Verdict::Interference) {
          ++score.false_yes;
        } else if (truth.verdict == Verdict::Interference) {
          ++score.false_no;
        } else {
          ++score.other;
        }
      } else if (!answer.verdict && truth.surfaces_meet) {
        ++score.known;
        if (answer.hit && !*truth.surfaces_meet) ++score.false_yes;
        if (!answer.hit && *truth.surfaces_meet) ++score.false_no;
      }
    }
  }
  return score;
}

std::vector<Run> run_scenario(const Scenario& scenario, std::span<const Method> methods,
                              const Plan& plan) {
  std::vector<std::unique_ptr<Checker>> checkers;
  for (const Method& method : methods) {
    checkers.push_back(method.make());
    for (const Placed& placed : scenario.elements) checkers.back()->add(placed);
    checkers.back()->set_moving(scenario.moving);
    checkers.back()->finish();
  }
  std::vector<Run> runs;
  std::vector<std::vector<Pose>> poses;
  for (const MotionKind kind : plan.kinds) {
    const Motion motion = motion_of(scenario, kind, plan.poses);
    for (const Method& method : methods) {
      poses.push_back(every(motion.poses, method.stride));
      Run run = blank_run(poses.back().size());
      run.scenario = scenario.name;
      run.kind = kind;
      run.method = method.name;
      for (std::size_t i = 0; i < motion.truth.size(); i += method.stride) {
        run.truth.push_back(motion.truth[i]);
      }
      runs.push_back(std::move(run));
    }
  }
  for (std::size_t round = 0; round < plan.rounds; ++round) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      Checker& checker = *checkers[i % methods.size()];
      checker.take_counters();
      run_timed(checker, poses[i], runs[i]);
      runs[i].counters = checker.take_counters();
      run_batch(checker, poses[i], runs[i]);
    }
  }
  return runs;
}

ScalePoint run_scale(std::size_t count, const Method& method, const Plan& plan) {
  const Scenario scenario = field_of_elements(count);
  const std::vector<Pose> poses = field_path(scenario, plan.poses);
  const std::unique_ptr<Checker> checker = method.make();
  for (const Placed& placed : scenario.elements) checker->prepare(placed.element);
  checker->prepare(scenario.moving);

  ScalePoint point;
  point.count = count;
  point.method = method.name;
  const std::size_t last_half = count / 2;
  const std::size_t last_tenth = count - std::max<std::size_t>(count / 10, 1);
  std::size_t bytes = heap_bytes();
  const double begin_us = processor_us();
  double start_us = begin_us;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == last_half) bytes = heap_bytes();
    if (i == last_tenth) start_us = processor_us();
    checker->add(scenario.elements[i]);
  }
  point.add_us = (processor_us() - start_us) / static_cast<double>(count - last_tenth);
  point.build_ms = 1.0e-3 * (processor_us() - begin_us);
  checker->set_moving(scenario.moving);
  checker->finish();
  (void)checker->check(poses.front());  // builds what is built on demand
  const auto grown = static_cast<double>(heap_bytes()) - static_cast<double>(bytes);
  point.bytes_per_element = grown / static_cast<double>(count - last_half);

  Run run = blank_run(poses.size());
  for (std::size_t round = 0; round < plan.rounds; ++round) {
    run_timed(*checker, poses, run);
    run_batch(*checker, poses, run);
  }
  // What a method puts off until it is asked counts, too.
  constexpr std::size_t kMore = 50;
  std::vector<double> times_us;
  for (std::size_t i = 0; i < kMore; ++i) {
    const Placed& pattern = scenario.elements[i * 7919 % count];
    const Eigen::Vector3d aside(60.0, 60.0, -100.0 - static_cast<double>(i));  // below all moves
    const Placed more = placed(pattern.element, Pose::from_translation(aside) * pattern.X_WE);
    const Clock::time_point start = Clock::now();
    checker->add(more);
    (void)checker->check(poses[i % poses.size()]);
    times_us.push_back(elapsed_us(start, Clock::now()));
  }
  point.add_and_move_us = quantile(times_us, 0.5);
  times_us.clear();
  for (std::size_t i = 0; i < kMore; ++i) {
    const Clock::time_point start = Clock::now();
    checker->remove_last();
    (void)checker->check(poses[i % poses.size()]);
    times_us.push_back(elapsed_us(start, Clock::now()));
  }
  point.remove_us = quantile(times_us, 0.5);
  point.move_us = quantile(run.times_us, 0.5);
  point.move_mean_us = run.batch_mean_us;
  return point;
}

SizePoint run_size(double size_mm, const Method& method, const Plan& plan) {
  Scenario scenario = field_of_elements(1000);
  scenario.moving = share(block("block", Eigen::Vector3d::Constant(size_mm)));
  const std::unique_ptr<Checker> checker = method.make();
  for (const Placed& placed : scenario.elements) checker->add(placed);
  checker->set_moving(scenario.moving);
  checker->finish();
  double pin_top_mm = 0.0;
  for (const Placed& p : scenario.elements) pin_top_mm = std::max(pin_top_mm, p.box_W.max.z());
  std::vector<Pose> poses;
  for (const Pose& pose : field_path(scenario, plan.poses)) {
    // Above the pins, which stand out of the risers, and not down between them.
    Eigen::Vector3d p = pose.translation();
    p.z() = pin_top_mm + std::max(p.z() - scenario.stage.max.z(), 0.05);
    poses.emplace_back(pose.rotation(), p);
  }
  poses = every(poses, method.stride);
  Run run = blank_run(poses.size());
  for (std::size_t round = 0; round < plan.rounds; ++round) run_batch(*checker, poses, run);
  return {std::string(method.name), size_mm, run.batch_mean_us};
}

}  // namespace dowel::bench
