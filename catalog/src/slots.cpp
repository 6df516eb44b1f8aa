#include "slots.h"

#include <algorithm>
#include <array>

#include "canonical_order.h"
#include "dowel/kernel/tolerance.h"
#include "grooves.h"
#include "slotted_holes.h"

namespace dowel {
namespace {

/// Width of a T-slot's throat and what it may be wider by (H12, ISO 286), mm.
struct TeeSize {
  std::uint32_t nominal_mm;
  double above_mm;
};

/// ISO 299.
constexpr std::array<TeeSize, 7> kTeeSizes{
    {{8, 0.15}, {10, 0.15}, {12, 0.18}, {14, 0.18}, {18, 0.18}, {22, 0.21}, {28, 0.21}}};

std::uint32_t nominal_size(const Feature& slot) {
  if (slot.slot->type != SlotShape::Type::Tee) return 0;
  for (const TeeSize& size : kTeeSizes) {
    const double excess_mm = slot.diameter_mm - size.nominal_mm;
    if (excess_mm >= -kSameFeature_mm && excess_mm <= size.above_mm + kSameFeature_mm) {
      return size.nominal_mm;
    }
  }
  return 0;
}

bool have_common(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  return std::ranges::any_of(
      a, [&b](std::size_t value) { return std::binary_search(b.begin(), b.end(), value); });
}

bool share_walls(const SlotFinding& a, const SlotFinding& b) {
  return (have_common(a.walls[0], b.walls[0]) && have_common(a.walls[1], b.walls[1])) ||
         (have_common(a.walls[0], b.walls[1]) && have_common(a.walls[1], b.walls[0]));
}

/// Of slots between the same walls the longest: a groove with a wall at its end is also a pocket
/// that goes into the part from its other end.
std::vector<SlotFinding> without_doubles(const std::vector<SlotFinding>& found) {
  std::vector<Feature> features;
  std::vector<double> shrinks_mm;
  for (const SlotFinding& slot : found) {
    features.push_back(slot.feature);
    shrinks_mm.push_back(-slot.feature.slot->length_mm);
  }
  std::vector<std::size_t> order = canonical_order(features, OrderBy::Direction);
  const std::vector<std::size_t> shrink = ranks(shrinks_mm, kSameFeature_mm);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shrink[a] < shrink[b]; });
  std::vector<SlotFinding> result;
  for (const std::size_t i : order) {
    const bool is_double = std::ranges::any_of(
        result, [&](const SlotFinding& longer) { return share_walls(longer, found[i]); });
    if (!is_double) result.push_back(found[i]);
  }
  return result;
}

}  // namespace

std::vector<SlotFinding> find_slots(const FacetedSolid& solid, const std::vector<FaceNode>& graph) {
  const PatchGraph patches = patch_graph(solid, graph);
  const SolidView view{solid, graph, patches};
  std::vector<SlotFinding> found = find_grooves(view);
  for (SlotFinding& slot : find_slotted_holes(view)) found.push_back(std::move(slot));
  std::vector<SlotFinding> result = without_doubles(found);
  for (SlotFinding& slot : result) slot.feature.slot->nominal_mm = nominal_size(slot.feature);
  return result;
}

}  // namespace dowel
