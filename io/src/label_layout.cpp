#include "label_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace dowel {
namespace {

using Eigen::Vector2d;

constexpr double kLargestFont_px = 11.0;
constexpr double kSmallestFont_px = 4.0;
/// Letters of a sans-serif font are this much of its size wide, taken generously.
constexpr double kLetterWidth = 0.62;
/// Of the distance between neighbours, what a name's height may take up.
constexpr double kFontOverSpacing = 0.5;

struct Rectangle {
  Vector2d center;
  Vector2d half;

  bool overlaps(const Rectangle& other) const {
    return ((center - other.center).cwiseAbs().array() < (half + other.half).array()).all();
  }
};

/// Median distance of the points that must be named from their nearest neighbours.
double spacing_px(std::span<const Label> labels) {
  std::vector<double> nearest;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!labels[i].must_show) continue;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < labels.size(); ++j) {
      if (j == i || !labels[j].must_show) continue;
      distance = std::min(distance, (labels[i].at - labels[j].at).norm());
    }
    if (std::isfinite(distance)) nearest.push_back(distance);
  }
  if (nearest.empty()) return std::numeric_limits<double>::infinity();
  std::sort(nearest.begin(), nearest.end());
  return nearest[nearest.size() / 2];
}

Vector2d half_size(const Label& label, double font_px) {
  return {0.5 * kLetterWidth * font_px * static_cast<double>(label.text.size()), 0.5 * font_px};
}

class Layout {
 public:
  Layout(std::span<const Label> labels, double width_px, double height_px)
      : labels_(labels), size_(width_px, height_px) {
    // A few crowded pairs do not make all letters small: many names do.
    const bool is_crowded = labels.size() > 12;
    const double wanted_px = is_crowded ? kFontOverSpacing * spacing_px(labels) : kLargestFont_px;
    font_px_ = std::clamp(wanted_px, kSmallestFont_px, kLargestFont_px);
  }

  std::vector<PlacedLabel> run() && {
    std::vector<PlacedLabel> placed;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (auto found = place(i)) placed.push_back(*found);
    }
    return placed;
  }

 private:
  std::optional<PlacedLabel> place(std::size_t index) {
    const Label& label = labels_[index];
    const Vector2d half = half_size(label, font_px_);
    for (const double ring : {0.0, 1.0, 2.0, 3.5, 5.0}) {
      if (ring > 1.0 && !label.must_show) break;
      for (const Vector2d& center : places_around(label, half, ring)) {
        if (!is_free({center, half}, index)) continue;
        taken_.push_back({center, half});
        return PlacedLabel{index, center, font_px_, ring > 1.0};
      }
    }
    if (!label.must_show) return std::nullopt;
    taken_.push_back({label.at, half});
    return PlacedLabel{index, label.at, font_px_, false};
  }

  /// In the point itself, then around it: above, right, below, left, then between.
  std::vector<Vector2d> places_around(const Label& label, const Vector2d& half, double ring) const {
    if (ring == 0.0) {
      // In a mouth that is too small, a name would hide what it names.
      constexpr double kMostOfMouth = 0.75;
      const bool fits = label.radius_px == 0.0 || half.norm() < kMostOfMouth * label.radius_px;
      return fits ? std::vector<Vector2d>{label.at} : std::vector<Vector2d>{};
    }
    const double gap_px = 0.8 * label.radius_px + (ring == 1.0 ? 0.5 : ring * font_px_);
    std::vector<Vector2d> places;
    constexpr std::array<std::array<double, 2>, 8> kDirections{
        {{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0.7, -0.7}, {0.7, 0.7}, {-0.7, 0.7}, {-0.7, -0.7}}};
    for (const auto& [x, y] : kDirections) {
      places.push_back(label.at + Vector2d(x * (gap_px + half.x()), y * (gap_px + half.y())));
    }
    return places;
  }

  bool is_free(const Rectangle& wanted, std::size_t index) const {
    const bool is_inside = ((wanted.center - wanted.half).array() >= 0.0).all() &&
                           ((wanted.center + wanted.half).array() <= size_.array()).all();
    if (!is_inside) return false;
    if (std::ranges::any_of(taken_, [&](const Rectangle& r) { return r.overlaps(wanted); })) {
      return false;
    }
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (i == index || !labels_[i].must_show) continue;
      const Vector2d half = Vector2d::Constant(std::min(0.5 * labels_[i].radius_px, font_px_));
      if (wanted.overlaps({labels_[i].at, half})) return false;
    }
    return true;
  }

  std::span<const Label> labels_;
  Vector2d size_;
  double font_px_ = kLargestFont_px;
  std::vector<Rectangle> taken_;
};

}  // namespace

std::vector<PlacedLabel> place_labels(std::span<const Label> labels, double width_px,
                                      double height_px) {
  return Layout(labels, width_px, height_px).run();
}

}  // namespace dowel
