#include "sheet_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dowel {
namespace {

constexpr std::size_t kMostNames = 16;
constexpr double kSteps_per_kg = 1000.0;

std::string diameter_text(double diameter_mm) {
  return "⌀" + sheet_number(diameter_mm);
}

std::string steps_text(const Feature& hole) {
  std::string text;
  for (const HoleSegment& segment : hole.segments) {
    text += (text.empty() ? "" : ", ") + diameter_text(segment.diameter_mm);
    if (segment.type == HoleSegment::Type::Cone) {
      text += " to " + diameter_text(segment.diameter_end_mm);
    }
    text += " at " + sheet_number(segment.from_mm) + " to " + sheet_number(segment.to_mm);
  }
  return text;
}

std::string thread_text(const Feature& feature) {
  if (feature.thread.empty()) return "";
  return ", " + std::string(feature.thread_is_guess ? "likely " : "") + feature.thread;
}

std::string describe_hole(const Feature& hole) {
  std::string text = "hole " + diameter_text(hole.diameter_mm);
  if (!hole.fit.empty()) text += " " + hole.fit;
  text += thread_text(hole);
  text += std::string(hole.through ? ", through " : ", blind ") + sheet_number(hole.depth_mm);
  if (hole.segments.size() > 1) text += " (" + steps_text(hole) + ")";
  return text;
}

std::string describe_slot(const Feature& feature) {
  std::string text = "slot";
  if (feature.slot) {
    const SlotShape& slot = *feature.slot;
    text = slot.type == SlotShape::Type::Tee       ? "T-slot"
           : slot.type == SlotShape::Type::Through ? "slotted hole"
                                                   : "slot";
    if (slot.nominal_mm != 0) text += " " + std::to_string(slot.nominal_mm) + " (ISO 299)";
    text += ", " + sheet_number(slot.length_mm) + " long";
  }
  text += ", " + sheet_number(feature.diameter_mm) + " wide, " + sheet_number(feature.depth_mm) +
          " deep";
  return feature.fit.empty() ? text : text + ", " + feature.fit;
}

std::string describe(const Feature& feature) {
  std::string text;
  if (feature.kind == FeatureKind::Hole) {
    text = describe_hole(feature);
  } else if (feature.kind == FeatureKind::Slot) {
    text = describe_slot(feature);
  } else {
    text = "shaft " + diameter_text(feature.diameter_mm);
    if (!feature.fit.empty()) text += " " + feature.fit;
    text += thread_text(feature) + ", " + sheet_number(feature.depth_mm) + " long";
  }
  return feature.use.empty() ? text : text + ", " + feature.use;
}

std::string rounded_number(double value, double steps_per_unit) {
  return sheet_number(std::round(value * steps_per_unit) / steps_per_unit);
}

std::string size_text(const Element& element) {
  constexpr double kSteps_per_mm = 100.0;
  const Eigen::Vector3d size = 2.0 * element.obb.half_extents_mm;
  std::string text;
  for (const double side : size) {
    text += (text.empty() ? "" : " × ") + rounded_number(side, kSteps_per_mm);
  }
  return text + " mm";
}

}  // namespace

std::string sheet_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::vector<std::pair<std::string, std::string>> element_facts(const Element& element) {
  const auto mass_kg = element.mass_kg();
  const TriangleCounts& triangles = element.triangles;
  std::vector<std::pair<std::string, std::string>> facts{
      {"size", size_text(element)},
      {"mass", mass_kg ? rounded_number(*mass_kg, kSteps_per_kg) + " kg" : ""},
      {"material", element.material},
      {"role", element.role},
      {"shape", std::string(to_string(element.shape))},
      {"dimensions", element.dimensions_by},
      {"facets", std::to_string(triangles.total) + ": " + std::to_string(triangles.plane) +
                     " plane, " + std::to_string(triangles.hole) + " hole, " +
                     std::to_string(triangles.other) + " other"},
      {"licence", element.licence},
      {"source", element.source}};
  std::erase_if(facts, [](const auto& fact) { return fact.second.empty(); });
  return facts;
}

std::vector<FeatureGroup> feature_groups(const Element& element) {
  std::vector<FeatureGroup> groups;
  for (std::size_t i = 0; i < element.features.size(); ++i) {
    const Feature& feature = element.features[i];
    if (feature.kind == FeatureKind::Face) continue;
    std::string description = describe(feature);
    const auto same = std::ranges::find(groups, description, &FeatureGroup::description);
    if (same != groups.end()) {
      same->members.push_back(i);
    } else {
      groups.push_back({std::move(description), {i}});
    }
  }
  return groups;
}

std::string member_names(const Element& element, const FeatureGroup& group) {
  const std::vector<std::size_t>& members = group.members;
  const auto name = [&](std::size_t i) { return element.features[members[i]].name; };
  if (members.size() > kMostNames) return name(0) + " … " + name(members.size() - 1);
  std::string names;
  for (std::size_t i = 0; i < members.size(); ++i) names += (i == 0 ? "" : " ") + name(i);
  return names;
}

}  // namespace dowel
