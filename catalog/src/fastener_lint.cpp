#include "fastener_lint.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// By this part a box may be smaller than that of the next smaller size: neither is the smallest.
constexpr double kBoxSideSlack = 1.0e-3;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Length of the number that `text` starts with, "1.5" or "20"; 0 where there is none.
std::size_t number_length(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size() && is_digit(text[length])) ++length;
  if (length == 0 || length + 1 >= text.size() || text[length] != '.') return length;
  if (!is_digit(text[length + 1])) return length;
  ++length;
  while (length < text.size() && is_digit(text[length])) ++length;
  return length;
}

/// An element's name by what stands between its numbers: "H40-12/screw-M#x#" and 10, 30.
struct SizedName {
  std::string series;
  std::vector<double> sizes;
  double thread_mm = 0.0;  ///< nominal, of the first thread in the name; 0: there is none
};

SizedName sized_name(std::string_view name) {
  // A screw as short as that has no thread left: what follows the diameter is its pitch.
  constexpr double kLongestPitchShare = 0.25;
  SizedName sized;
  // The family's numbers are no sizes.
  const std::size_t start = name.rfind('/') + 1;  // npos + 1 is 0
  sized.series = name.substr(0, start);
  double diameter_mm = 0.0;  // of the thread designation that ends here
  for (std::size_t i = start; i < name.size();) {
    const std::size_t length = number_length(name.substr(i));
    if (length == 0) {
      if (name[i] != 'x') diameter_mm = 0.0;
      sized.series += name[i++];
      continue;
    }
    double size = 0.0;
    std::from_chars(name.data() + i, name.data() + i + length, size);
    if (size < kLongestPitchShare * diameter_mm) {
      sized.series += name.substr(i, length);
      diameter_mm = 0.0;
    } else {
      const bool is_thread = i > start && name[i - 1] == 'M' &&
                             (i - 1 == start || name[i - 2] == '-' || name[i - 2] == '_');
      diameter_mm = is_thread ? size : 0.0;
      if (sized.thread_mm == 0.0) sized.thread_mm = diameter_mm;
      sized.series += '#';
      sized.sizes.push_back(size);
    }
    i += length;
  }
  return sized;
}

const std::string& called(const Feature& feature) {
  return feature.use.empty() ? feature.name : feature.use;
}

bool is_coaxial(const Feature& a, const Feature& b) {
  return a.direction.cross(b.direction).norm() <= kStoredAxisSlack &&
         a.direction.cross(b.origin - a.origin).norm() <= kBoxSlack_mm;
}

std::optional<std::string> thin_head(const Element& element) {
  for (const Feature& head : element.features) {
    if (head.kind != FeatureKind::Shaft || head.use != "head") continue;
    for (const Feature& shank : element.features) {
      if (shank.kind != FeatureKind::Shaft || shank.use == "head" || !is_coaxial(head, shank) ||
          shank.diameter_mm < head.diameter_mm) {
        continue;
      }
      return "its head " + head.name + " is " + number(head.diameter_mm) + " mm thick, its " +
             called(shank) + " " + shank.name + " " + number(shank.diameter_mm) + " mm";
    }
  }
  return std::nullopt;
}

/// A thread of another size than the name says; of what has no thread, holes that are too narrow.
std::optional<std::string> other_size_than_named(const Element& element) {
  const double named_mm = sized_name(element.name).thread_mm;
  if (named_mm == 0.0) return std::nullopt;
  std::string other_thread;
  double widest_mm = 0.0;
  for (const Feature& feature : element.features) {
    if (!feature.thread.empty()) {
      if (sized_name(feature.thread).thread_mm == named_mm) return std::nullopt;
      other_thread = feature.thread;
    }
    if (feature.kind == FeatureKind::Hole && feature.through) {
      widest_mm = std::max(widest_mm, feature.diameter_mm);
    }
  }
  const std::string by_name = "by its name it is for M" + number(named_mm);
  if (!other_thread.empty()) return by_name + ", but its thread is " + other_thread;
  if (widest_mm == 0.0 || widest_mm > named_mm) return std::nullopt;
  return by_name + ", but its widest through hole is " + number(widest_mm) + " mm";
}

/// Diameters of shafts and holes by what they are called; those of one name are left out.
std::map<std::string, double> diameters_mm(const Element& element) {
  std::map<std::string, int> counts;
  std::map<std::string, double> diameters;
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Shaft && feature.kind != FeatureKind::Hole) continue;
    const std::string key = std::string(to_string(feature.kind)) + " \"" + called(feature) + "\"";
    diameters[key] = feature.diameter_mm;
    ++counts[key];
  }
  std::erase_if(diameters, [&](const auto& entry) { return counts[entry.first] > 1; });
  return diameters;
}

Eigen::Vector3d sorted_sides_mm(const Element& element) {
  Eigen::Vector3d sides_mm = 2.0 * element.obb.half_extents_mm;
  std::sort(sides_mm.begin(), sides_mm.end());
  return sides_mm;
}

/// Where `larger` is smaller than `smaller`, the next size below it.
std::optional<std::string> shrinkage(const Element& smaller, const Element& larger) {
  const std::string next_smaller = " of " + smaller.name + ", the next smaller size, ";
  const auto before = diameters_mm(smaller);
  for (const auto& [called, diameter_mm] : diameters_mm(larger)) {
    const auto same = before.find(called);
    if (same == before.end() || diameter_mm >= same->second - kBoxSlack_mm) continue;
    std::string fault = "its " + called + " is " + number(diameter_mm) + " mm thick, that";
    return fault.append(next_smaller).append(number(same->second)).append(" mm");
  }
  const Eigen::Vector3d from_mm = sorted_sides_mm(smaller);
  const Eigen::Vector3d to_mm = sorted_sides_mm(larger);
  if ((to_mm.array() >= (1.0 - kBoxSideSlack) * from_mm.array()).all()) return std::nullopt;
  const auto sides = [](const Eigen::Vector3d& mm) {
    return number(mm.x()) + " x " + number(mm.y()) + " x " + number(mm.z()) + " mm";
  };
  return "it measures " + sides(to_mm) + ", that" + next_smaller + sides(from_mm);
}

/// Elements whose names differ in one number, with that number.
using Series = std::vector<std::pair<double, const Element*>>;

std::map<std::string, Series> series_of(std::span<const Element> elements) {
  std::map<std::string, Series> all;
  for (const Element& element : elements) {
    const SizedName name = sized_name(element.name);
    for (std::size_t varied = 0; varied < name.sizes.size(); ++varied) {
      std::string key = name.series;
      for (std::size_t i = 0; i < name.sizes.size(); ++i) {
        key += i == varied ? " *" : " " + number(name.sizes[i]);
      }
      all[key].emplace_back(name.sizes[varied], &element);
    }
  }
  return all;
}

}  // namespace

std::vector<std::string> fastener_contradictions(const Element& element) {
  std::vector<std::string> found;
  if (element.role != "fastener") return found;
  for (const auto& fault : {thin_head(element), other_size_than_named(element)}) {
    if (fault) found.push_back(*fault);
  }
  return found;
}

std::vector<SizeFault> size_faults(std::span<const Element> fasteners) {
  std::map<std::string, std::string> message_of;  // one of an element tells enough
  for (auto& [key, series] : series_of(fasteners)) {
    std::ranges::stable_sort(series, {}, &Series::value_type::first);
    for (std::size_t i = 1; i < series.size(); ++i) {
      if (series[i - 1].first == series[i].first) continue;
      const Element& larger = *series[i].second;
      if (auto message = shrinkage(*series[i - 1].second, larger)) {
        message_of.try_emplace(larger.name, std::move(*message));
      }
    }
  }
  std::vector<SizeFault> faults;
  faults.reserve(message_of.size());
  for (auto& [name, message] : message_of) faults.push_back({name, std::move(message)});
  return faults;
}

}  // namespace dowel
