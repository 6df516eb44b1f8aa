#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/mate.h"
#include "dowel/catalog/element.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// How a feature of a moving part goes with one of a placed part, the best first.
enum class FeatureMatch : std::uint8_t {
  Thread,     ///< screw and core hole
  Fit,        ///< shaft in a bore of its size, within 0.1 mm; key in a slot
  Clearance,  ///< shaft or screw through a wider bore
  Bore,       ///< hole on hole that one pin or screw goes through
  Seat,       ///< face on face
};

/// "thread", "fit", "clearance", "hole on hole", "seat".
std::string_view to_string(FeatureMatch match);

/// How two features go together by kind and size alone, wherever they are; nothing where they do
/// not. A shaft goes into a bore up to a quarter wider than itself (ISO 273, coarse, is less); two
/// holes go together where a pin or screw of one nominal diameter fits both.
std::optional<FeatureMatch> match_of(const Feature& moving, const Feature& fixed);

/// Features of placed parts, found by kind, size and place.
///
/// A hole is listed under each diameter of its cylinders, a shaft under its own, a slot under its
/// width; faces have no size. Each size has its features in cells of space by their origins, so
/// that a search looks at what has about the right size and is about in the right place.
class FeatureIndex {
 public:
  struct Entry {
    std::string instance;
    const Feature* feature = nullptr;  ///< of the element, which outlives the index
    Pose X_WI;
  };

  void add(const std::string& instance, const Element& element, const Pose& X_WI);

  const std::vector<Entry>& entries() const { return entries_; }

  /// Indices of entries that `moving` goes with (see `match_of`) and whose origin is within
  /// `reach_mm` of `center_W`; ascending.
  std::vector<std::size_t> near(const Feature& moving, const Eigen::Vector3d& center_W,
                                double reach_mm) const;

  /// The same wherever they are.
  std::vector<std::size_t> anywhere(const Feature& moving) const;

  /// `near` by looking at all entries. Reference for tests.
  std::vector<std::size_t> near_brute_force(const Feature& moving, const Eigen::Vector3d& center_W,
                                            double reach_mm) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Bucket {
    std::map<Cell, std::vector<std::size_t>> cells;
    std::vector<std::size_t> all;
  };

  void file(FeatureKind kind, double size_mm, std::size_t entry);
  std::vector<const Bucket*> buckets_for(const Feature& moving) const;
  bool is_near(const Entry& entry, const Eigen::Vector3d& center_W, double reach_mm) const;

  std::vector<Entry> entries_;
  std::map<FeatureKind, std::map<double, Bucket>> by_size_;
};

}  // namespace dowel
