#include "dowel/collision/layered_projection.h"

#include <algorithm>
#include <cmath>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

struct Interval {
  double low;
  double high;
};

/// Fewest boxes that are worth a cut.
constexpr std::size_t kBoxesPerStretch = 4;

/// Cuts of one axis: places between or at the ends of `intervals` that cut as few of them as can
/// be, at least `min_width` apart and about `stretches` of them.
std::vector<double> choose_cuts(const std::vector<Interval>& intervals, std::size_t stretches,
                                double min_width) {
  std::vector<double> cuts;
  if (intervals.size() <= kBoxesPerStretch || stretches < 2) return cuts;
  std::vector<double> lows;
  std::vector<double> highs;
  for (const Interval& interval : intervals) {
    lows.push_back(interval.low);
    highs.push_back(interval.high);
  }
  std::ranges::sort(lows);
  std::ranges::sort(highs);
  const double width =
      std::max(min_width, (highs.back() - lows.front()) / static_cast<double>(stretches));
  // An interval is cut at x where low < x < high: those begun before x less those ended by x.
  const auto cut_count = [&](double x) {
    const auto begun = std::ranges::lower_bound(lows, x) - lows.begin();
    const auto ended = std::ranges::upper_bound(highs, x) - highs.begin();
    return begun - ended;
  };
  double previous = lows.front();
  auto candidate = highs.begin();
  while (true) {
    candidate = std::lower_bound(candidate, highs.end(), previous + width);
    if (candidate == highs.end()) break;
    auto best = candidate;
    for (auto end = candidate; end != highs.end() && *end <= previous + 2.0 * width; ++end) {
      if (cut_count(*end) < cut_count(*best)) best = end;
    }
    if (*best >= highs.back()) break;
    cuts.push_back(*best);
    previous = *best;
    candidate = best;
  }
  return cuts;
}

struct Stretches {
  std::size_t first;
  std::size_t last;
};

std::size_t cuts_below(const std::vector<double>& cuts, double x) {
  return static_cast<std::size_t>(std::ranges::lower_bound(cuts, x) - cuts.begin());
}
std::size_t cuts_up_to(const std::vector<double>& cuts, double x) {
  return static_cast<std::size_t>(std::ranges::upper_bound(cuts, x) - cuts.begin());
}

/// Stretches in which a box from `low` to `high` is listed: a box that ends at a cut stays on its
/// side, so that a layer holds what stands on the plane and not what it stands on.
Stretches listed_in(const std::vector<double>& cuts, double low, double high) {
  const std::size_t first = cuts_up_to(cuts, low);
  return {first, std::max(first, cuts_below(cuts, high))};
}

/// Stretches that a query looks at: one that ends at a cut looks at both sides.
Stretches met_by(const std::vector<double>& cuts, double low, double high) {
  return {cuts_below(cuts, low), cuts_up_to(cuts, high)};
}

}  // namespace

LayeredProjection::Extent::Extent(const Aabb& box) {
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    min[i] = static_cast<float>(box.min[i]);
    max[i] = static_cast<float>(box.max[i]);
    if (double{min[i]} > box.min[i]) min[i] = std::nextafter(min[i], -kEndless);
    if (double{max[i]} < box.max[i]) max[i] = std::nextafter(max[i], kEndless);
  }
}

template <class Reach, class Visit>
void LayeredProjection::for_each_cell(const Extent& box, const Reach& reach, const Visit& visit) {
  const Stretches layers = reach(z_cuts_, box.min.z(), box.max.z());
  for (std::size_t z = layers.first; z <= layers.last; ++z) {
    Layer& layer = layers_[z];
    const std::size_t rows = layer.y_cuts.size() + 1;
    const Stretches columns = reach(layer.x_cuts, box.min.x(), box.max.x());
    const Stretches lines = reach(layer.y_cuts, box.min.y(), box.max.y());
    for (std::size_t x = columns.first; x <= columns.last; ++x) {
      for (std::size_t y = lines.first; y <= lines.last; ++y) visit(layer.cells[x * rows + y]);
    }
  }
}

void LayeredProjection::insert(std::uint32_t id, const Aabb& box) {
  DOWEL_EXPECTS(box.min.allFinite() && box.max.allFinite() && !box.is_empty());
  if (id >= boxes_.size()) {
    boxes_.resize(id + 1);
    seen_in_.resize(id + 1, 0);
  }
  DOWEL_EXPECTS(boxes_[id].is_empty());
  boxes_[id] = Extent(box);
  omega_.extend(box);
  ++count_;
  if (layers_.empty() || 2 * count_ > 3 * count_at_rebuild_ + 2 * kBoxesPerStretch) {
    rebuild();
  } else {
    for_each_cell(boxes_[id], listed_in, [id](auto& cell) { cell.push_back(id); });
  }
}

void LayeredProjection::remove(std::uint32_t id) {
  DOWEL_EXPECTS(id < boxes_.size() && !boxes_[id].is_empty());
  for_each_cell(boxes_[id], listed_in, [id](auto& cell) {
    const auto entry = std::ranges::find(cell, id);
    *entry = cell.back();
    cell.pop_back();
  });
  boxes_[id] = Extent();
  --count_;
  if (2 * count_ + 2 * kBoxesPerStretch < count_at_rebuild_) rebuild();
}

void LayeredProjection::rebuild() {
  std::vector<std::uint32_t> ids;
  std::vector<Interval> heights;
  omega_ = Aabb{};
  for (std::uint32_t id = 0; id < boxes_.size(); ++id) {
    if (boxes_[id].is_empty()) continue;
    ids.push_back(id);
    heights.push_back({boxes_[id].min.z(), boxes_[id].max.z()});
    omega_.extend(boxes_[id].box());
  }
  count_at_rebuild_ = count_;
  // As many layers as a cube of cells would have; each at least as tall as the middle box.
  const auto cells_wanted = static_cast<double>(count_) / static_cast<double>(kBoxesPerStretch);
  std::vector<double> sizes;
  sizes.reserve(heights.size());
  for (const Interval& height : heights) sizes.push_back(height.high - height.low);
  const auto median = [](std::vector<double>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
  };
  z_cuts_ =
      choose_cuts(heights, static_cast<std::size_t>(std::cbrt(cells_wanted)) + 1, median(sizes));
  layers_.assign(z_cuts_.size() + 1, {});
  for (std::size_t z = 0; z < layers_.size(); ++z) {
    std::vector<Interval> x_intervals;
    std::vector<Interval> y_intervals;
    std::vector<double> x_sizes;
    std::vector<double> y_sizes;
    for (const std::uint32_t id : ids) {
      const Extent& box = boxes_[id];
      const Stretches layers = listed_in(z_cuts_, box.min.z(), box.max.z());
      if (layers.first > z || layers.last < z) continue;
      x_intervals.push_back({box.min.x(), box.max.x()});
      y_intervals.push_back({box.min.y(), box.max.y()});
      x_sizes.push_back(box.max.x() - box.min.x());
      y_sizes.push_back(box.max.y() - box.min.y());
    }
    const auto stretches =
        static_cast<std::size_t>(std::sqrt(static_cast<double>(x_intervals.size()) /
                                           static_cast<double>(kBoxesPerStretch))) +
        1;
    Layer& layer = layers_[z];
    layer.x_cuts = choose_cuts(x_intervals, stretches, 0.5 * median(x_sizes));
    layer.y_cuts = choose_cuts(y_intervals, stretches, 0.5 * median(y_sizes));
    layer.cells.resize((layer.x_cuts.size() + 1) * (layer.y_cuts.size() + 1));
  }
  for (const std::uint32_t id : ids) {
    for_each_cell(boxes_[id], listed_in, [id](auto& cell) { cell.push_back(id); });
  }
}

void LayeredProjection::query(const Aabb& box, std::vector<std::uint32_t>& found) {
  found.clear();
  if (layers_.empty() || !omega_.overlaps(box)) return;
  if (++query_number_ == 0) {  // wrapped around: old marks would look new
    std::ranges::fill(seen_in_, 0);
    query_number_ = 1;
  }
  const Extent wanted(box);
  for_each_cell(wanted, met_by, [&](const auto& cell) {
    for (const std::uint32_t id : cell) {
      if (seen_in_[id] == query_number_) continue;
      seen_in_[id] = query_number_;
      if (boxes_[id].overlaps(wanted)) found.push_back(id);
    }
  });
  std::ranges::sort(found);
}

void LayeredProjection::query_brute_force(const Aabb& box,
                                          std::vector<std::uint32_t>& found) const {
  found.clear();
  const Extent wanted(box);
  for (std::uint32_t id = 0; id < boxes_.size(); ++id) {
    if (!boxes_[id].is_empty() && boxes_[id].overlaps(wanted)) found.push_back(id);
  }
}

std::size_t LayeredProjection::cell_count() const {
  std::size_t count = 0;
  for (const Layer& layer : layers_) count += layer.cells.size();
  return count;
}

std::size_t LayeredProjection::memory_bytes() const {
  std::size_t bytes = boxes_.capacity() * sizeof(Extent) +
                      seen_in_.capacity() * sizeof(std::uint32_t) +
                      layers_.capacity() * sizeof(Layer);
  for (const Layer& layer : layers_) {
    bytes += (layer.x_cuts.capacity() + layer.y_cuts.capacity()) * sizeof(double) +
             layer.cells.capacity() * sizeof(std::vector<std::uint32_t>);
    for (const auto& cell : layer.cells) bytes += cell.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace dowel
