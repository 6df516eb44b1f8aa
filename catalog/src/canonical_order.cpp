#include "canonical_order.h"

#include <algorithm>
#include <numeric>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// The side from which a feature is seen: out of the opening of a hole or slot, off a face.
Eigen::Vector3d outward(const Feature& feature) {
  const bool is_opening = feature.kind == FeatureKind::Hole || feature.kind == FeatureKind::Slot;
  return is_opening ? Eigen::Vector3d(-feature.direction) : feature.direction;
}

double length_mm(const Feature& feature) {
  return feature.slot ? feature.slot->length_mm : 0.0;
}

template <class Value>
std::vector<std::size_t> ranks_of(const std::vector<Feature>& features, double tolerance,
                                  Value value) {
  std::vector<double> values;
  values.reserve(features.size());
  for (const Feature& feature : features) values.push_back(value(feature));
  return ranks(values, tolerance);
}

}  // namespace

std::vector<std::size_t> ranks(const std::vector<double>& values, double tolerance) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::size_t> result(values.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const bool is_next = values[order[i]] - values[order[i - 1]] > tolerance;
    result[order[i]] = result[order[i - 1]] + (is_next ? 1 : 0);
  }
  return result;
}

std::vector<std::size_t> canonical_order(const std::vector<Feature>& features, OrderBy first) {
  std::vector<std::vector<std::size_t>> keys;
  const auto add = [&](double tolerance, auto value) {
    keys.push_back(ranks_of(features, tolerance, value));
  };
  if (first == OrderBy::Diameter) {
    add(kSameFeature_mm, [](const Feature& f) { return f.diameter_mm; });
  }
  for (const Eigen::Index i : {2, 1, 0}) {
    add(kCoaxial_rad, [i](const Feature& f) { return -outward(f)[i]; });
  }
  add(kSameFeature_mm, [](const Feature& f) { return -f.origin.z(); });
  add(kSameFeature_mm, [](const Feature& f) { return f.origin.y(); });
  add(kSameFeature_mm, [](const Feature& f) { return f.origin.x(); });
  // What shares its place differs in size; nothing else may decide.
  add(kSameFeature_mm, [](const Feature& f) { return f.diameter_mm; });
  add(kSameFeature_mm, [](const Feature& f) { return f.depth_mm; });
  add(kSameFeature_mm, [](const Feature& f) { return f.area_mm2; });
  add(kSameFeature_mm, &length_mm);
  for (const Eigen::Index i : {0, 1, 2}) {
    add(kCoaxial_rad, [i](const Feature& f) { return f.slot ? -f.slot->run[i] : 0.0; });
  }

  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    for (const std::vector<std::size_t>& key : keys) {
      if (key[a] != key[b]) return key[a] < key[b];
    }
    return false;
  });
  return order;
}

}  // namespace dowel
