#include "feature_names.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "canonical_order.h"
#include "dowel/kernel/tolerance.h"
#include "hole_grid.h"

namespace dowel {
namespace {

/// A cone at the mouth this much wider than the bore seats a screw head; a narrower one is a
/// chamfer.
constexpr double kCountersinkRatio = 1.5;

/// A, B, … Z, AA, AB, …
std::string row_letters(std::size_t row) {
  std::string letters;
  for (std::size_t left = row + 1; left > 0; left = (left - 1) / 26) {
    letters.insert(letters.begin(), static_cast<char>('A' + (left - 1) % 26));
  }
  return letters;
}

std::string hole_prefix(const Feature& hole) {
  const HoleSegment& mouth = hole.segments.front();
  const auto first_cylinder = std::find_if(
      hole.segments.begin(), hole.segments.end(),
      [](const HoleSegment& segment) { return segment.type == HoleSegment::Type::Cylinder; });
  if (first_cylinder->diameter_mm > hole.diameter_mm + kSameFeature_mm) return "cb";
  if (mouth.type == HoleSegment::Type::Cone &&
      mouth.diameter_mm >= kCountersinkRatio * hole.diameter_mm - kSameFeature_mm) {
    return "cs";
  }
  return hole.through ? "h" : "b";
}

struct NamedSide {
  const char* name;
  Eigen::Vector3d normal;
};

std::array<NamedSide, 6> sides() {
  return {{{"top", Eigen::Vector3d::UnitZ()},
           {"bottom", -Eigen::Vector3d::UnitZ()},
           {"right", Eigen::Vector3d::UnitX()},
           {"left", -Eigen::Vector3d::UnitX()},
           {"back", Eigen::Vector3d::UnitY()},
           {"front", -Eigen::Vector3d::UnitY()}}};
}

/// The outermost face towards `normal`; of several at the same height the largest.
std::optional<std::size_t> outermost(const std::vector<Feature>& faces,
                                     const Eigen::Vector3d& normal) {
  std::vector<std::size_t> candidates;
  std::vector<double> depths_mm;
  std::vector<double> shrinks_mm2;
  for (const std::size_t i : canonical_order(faces, OrderBy::Direction)) {
    const Feature& face = faces[i];
    if (!(face.direction.dot(normal) > 0.0)) continue;
    if (face.direction.cross(normal).norm() > kCoaxial_rad) continue;
    candidates.push_back(i);
    depths_mm.push_back(-normal.dot(face.origin));
    shrinks_mm2.push_back(-face.area_mm2);
  }
  if (candidates.empty()) return std::nullopt;
  const std::vector<std::size_t> depth = ranks(depths_mm, kSameFeature_mm);
  const std::vector<std::size_t> shrink = ranks(shrinks_mm2, kSameFeature_mm);
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (std::tie(depth[i], shrink[i]) < std::tie(depth[best], shrink[best])) best = i;
  }
  return candidates[best];
}

}  // namespace

std::vector<Feature> named_holes(const std::vector<Feature>& holes) {
  std::vector<Feature> result;
  std::vector<bool> is_named(holes.size(), false);
  const auto add = [&](std::size_t hole, std::string name) {
    result.push_back(holes[hole]);
    result.back().name = std::move(name);
    is_named[hole] = true;
  };
  const std::vector<HoleGrid> grids = find_hole_grids(holes);
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const std::string prefix = g == 0 ? "" : "g" + std::to_string(g + 1) + ".";
    for (const GridPlace& place : grids[g].places) {
      add(place.hole, prefix + row_letters(place.row) + std::to_string(place.column + 1));
    }
  }
  std::map<std::string, int> counts;
  for (const std::size_t i : canonical_order(holes, OrderBy::Direction)) {
    if (is_named[i]) continue;
    const std::string prefix = hole_prefix(holes[i]);
    add(i, prefix + std::to_string(++counts[prefix]));
  }
  return result;
}

std::vector<Feature> named_shafts(const std::vector<Feature>& shafts) {
  std::vector<Feature> result;
  for (const std::size_t i : canonical_order(shafts, OrderBy::Diameter)) {
    result.push_back(shafts[i]);
    result.back().name = "pin" + std::to_string(result.size());
  }
  return result;
}

std::vector<Feature> named_slots(const std::vector<Feature>& slots) {
  std::vector<Feature> result;
  for (const std::size_t i : canonical_order(slots, OrderBy::Direction)) {
    result.push_back(slots[i]);
    result.back().name = "slot" + std::to_string(result.size());
  }
  return result;
}

std::vector<Feature> named_faces(const std::vector<Feature>& faces) {
  std::vector<Feature> result;
  std::vector<bool> is_named(faces.size(), false);
  for (const NamedSide& side : sides()) {
    if (const std::optional<std::size_t> face = outermost(faces, side.normal)) {
      result.push_back(faces[*face]);
      result.back().name = side.name;
      is_named[*face] = true;
    }
  }
  int count = 0;
  for (const std::size_t i : canonical_order(faces, OrderBy::Direction)) {
    if (is_named[i]) continue;
    result.push_back(faces[i]);
    result.back().name = "f" + std::to_string(++count);
  }
  return result;
}

}  // namespace dowel
