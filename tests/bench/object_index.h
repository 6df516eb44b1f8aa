#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "dowel/kernel/box.h"
#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Boxes of placed elements, asked for those that a moving box overlaps: the broad phase alone.
class ObjectIndex {
 public:
  ObjectIndex() = default;
  ObjectIndex(const ObjectIndex&) = delete;
  ObjectIndex& operator=(const ObjectIndex&) = delete;
  virtual ~ObjectIndex() = default;

  virtual void insert(const Aabb& box) = 0;
  virtual void remove_last() = 0;
  /// Number of boxes that overlap `box`.
  virtual std::size_t count_overlaps(const Aabb& box) = 0;
};

struct IndexKind {
  std::string_view name;
  std::function<std::unique_ptr<ObjectIndex>()> make;
  /// It takes time in proportion to all elements, or more, to answer or to change.
  bool is_slow = false;
};

/// dowel's layered projection model, a look at every box, an R-tree (Boost), and of FCL, where it
/// was found, a dynamic AABB tree and sweep and prune (its simple kind: the
/// other one crashes when objects come one by one).
std::vector<IndexKind> index_kinds();
std::unique_ptr<ObjectIndex> make_fcl_tree();
std::unique_ptr<ObjectIndex> make_fcl_sweep_and_prune();

/// Queries along the motions of the paper's scenarios and over fields of 100 to 100,000 elements.
std::vector<Table> run_object_study(const Plan& plan);

}  // namespace dowel::bench
