#pragma once

#include <array>
#include <memory>
#include <optional>

#include "dowel/collision/verdict.h"
#include "scenario.h"

namespace dowel::bench {

/// What a method says of a pose. Triangle libraries know hit or no hit only.
struct Answer {
  bool hit = false;                ///< dowel: interference; others: surfaces meet
  std::optional<Verdict> verdict;  ///< dowel: worst over all elements
};

/// One collision method with a scene of its own. Elements that are one object share their
/// structures, as the method allows it.
class Checker {
 public:
  Checker() = default;
  Checker(const Checker&) = delete;
  Checker& operator=(const Checker&) = delete;
  virtual ~Checker() = default;

  /// Prepares what is built once for an element, so that `add` costs what one more instance does.
  virtual void prepare(const ElementPtr& element) = 0;
  virtual void add(const Placed& placed) = 0;
  /// Takes away what was added last.
  virtual void remove_last() = 0;
  virtual void set_moving(const ElementPtr& element) = 0;
  /// Called once after the last `add`, before the first `check`.
  virtual void finish() {}
  virtual Answer check(const Pose& X_WM) = 0;
  /// The gap to the nearest other element, negative: a depth, where the method measures one.
  virtual std::optional<double> measured_gap_mm(const Pose& /*X_WM*/) { return {}; }

  /// N_b and N_p since the last call, where the method counts them.
  struct Counters {
    std::uint64_t box_tests = 0;
    std::uint64_t triangle_tests = 0;
    std::array<std::uint64_t, kSkipCount> skips{};  ///< of dowel: how often each was used
  };
  virtual std::optional<Counters> take_counters() { return {}; }
};

}  // namespace dowel::bench
