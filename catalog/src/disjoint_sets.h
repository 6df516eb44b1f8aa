#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace dowel {

/// Partition of 0 … n-1 that starts with singletons.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  /// Smallest member of the set of `a`.
  std::size_t root(std::size_t a) {
    while (parent_[a] != a) {
      parent_[a] = parent_[parent_[a]];
      a = parent_[a];
    }
    return a;
  }

  bool are_joined(std::size_t a, std::size_t b) { return root(a) == root(b); }

  /// All sets, by their smallest members, each sorted.
  std::vector<std::vector<std::size_t>> sets() {
    std::vector<std::vector<std::size_t>> result;
    std::vector<std::size_t> place(parent_.size());
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      if (root(i) == i) {
        place[i] = result.size();
        result.emplace_back();
      }
      result[place[root(i)]].push_back(i);
    }
    return result;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace dowel
