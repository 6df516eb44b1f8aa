#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

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
  virtual void set_moving(const ElementPtr& element) = 0;
  /// Called once after the last `add`, before the first `check`.
  virtual void finish() {}
  virtual Answer check(const Pose& X_WM) = 0;

  /// N_b and N_p since the last call, where the method counts them.
  struct Counters {
    std::uint64_t box_tests = 0;
    std::uint64_t triangle_tests = 0;
  };
  virtual std::optional<Counters> take_counters() { return {}; }
};

/// Names: "dowel", "dowel first" (stops at the first interference), "dowel paper" (hole triangles
/// dropped), "published" (the paper's method as it stands there), and of the peers that were found
/// at build time "FCL OBBRSS", "FCL OBB float", "ODE", "Bullet", "CGAL". The slow ones get fewer
/// poses.
struct Method {
  std::string_view name;
  std::unique_ptr<Checker> (*make)() = nullptr;
  std::size_t stride = 1;  ///< checks every stride-th pose only
};

std::unique_ptr<Checker> make_dowel();
std::unique_ptr<Checker> make_dowel_first();
std::unique_ptr<Checker> make_dowel_paper();
std::unique_ptr<Checker> make_published();
std::unique_ptr<Checker> make_fcl_obbrss();
std::unique_ptr<Checker> make_fcl_obb_float();
std::unique_ptr<Checker> make_ode();
std::unique_ptr<Checker> make_bullet();
std::unique_ptr<Checker> make_cgal();

}  // namespace dowel::bench
