#include "dowel/assembly/stack.h"

#include <algorithm>
#include <cmath>

#include "dowel/assembly/pattern.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Piles of `most` pieces from the sorted spacers, tallest first, found by trying each next piece
/// that is no taller than the last.
class Piling {
 public:
  Piling(std::span<const Spacer> spacers, std::size_t count) : spacers_(spacers), count_(count) {}

  void pile(double rest_mm, std::size_t first, std::size_t pieces) {
    if (found_.size() >= count_) return;
    if (pieces == 0) {
      if (std::abs(rest_mm) <= kCoincident_mm) found_.push_back(pile_);
      return;
    }
    const auto left = static_cast<double>(pieces);
    for (std::size_t i = first; i < spacers_.size(); ++i) {
      const double height_mm = spacers_[i].height_mm;
      // The rest can be no taller than this one each, and no lower than the lowest each.
      if (left * height_mm < rest_mm - kCoincident_mm) return;
      if (height_mm + (left - 1.0) * spacers_.back().height_mm > rest_mm + kCoincident_mm) continue;
      pile_.push_back(spacers_[i]);
      pile(rest_mm - height_mm, i, pieces - 1);
      pile_.pop_back();
    }
  }

  const std::vector<std::vector<Spacer>>& found() const { return found_; }

 private:
  std::span<const Spacer> spacers_;
  std::size_t count_;
  std::vector<Spacer> pile_;
  std::vector<std::vector<Spacer>> found_;
};

}  // namespace

std::optional<Spacer> spacer_of(const Element& element) {
  const Feature* bottom = bottom_face(element);
  const std::vector<const Feature*> feet = feet_of(element);
  if (bottom == nullptr || feet.size() != 1 || feet[0]->kind != FeatureKind::Hole) {
    return std::nullopt;
  }
  const Feature& hole = *feet[0];
  if (!hole.through || hole.direction.z() > 0.0) return std::nullopt;
  // The hole opens on a face that looks up, and nothing is higher.
  const bool opens_on_top = std::ranges::any_of(element.features, [&](const Feature& face) {
    return face.kind == FeatureKind::Face && face.direction.z() > 1.0 - kCoaxial_rad &&
           std::abs(face.origin.z() - hole.origin.z()) <= kCoincident_mm;
  });
  const double top_mm =
      element.obb.center.z() +
      (element.obb.axes.row(2).transpose().cwiseAbs().cwiseProduct(element.obb.half_extents_mm))
          .sum();
  if (!opens_on_top || top_mm > hole.origin.z() + kBoxSlack_mm + kCoincident_mm) {
    return std::nullopt;
  }
  return Spacer{element.name, hole.origin.z() - bottom->origin.z(), hole.name};
}

std::vector<std::vector<Spacer>> stack_choices(std::span<const Spacer> spacers, double height_mm,
                                               std::size_t count) {
  std::vector<Spacer> sorted(spacers.begin(), spacers.end());
  std::erase_if(sorted, [](const Spacer& spacer) { return spacer.height_mm <= kCoincident_mm; });
  std::ranges::stable_sort(
      sorted, [](const Spacer& a, const Spacer& b) { return a.height_mm > b.height_mm; });
  Piling piling(sorted, count);
  for (std::size_t pieces = 1; pieces <= kMostStacked && !sorted.empty(); ++pieces) {
    piling.pile(height_mm, 0, pieces);
  }
  return piling.found();
}

}  // namespace dowel
