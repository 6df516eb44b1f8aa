// The AS1 assembly as two systems wrote it: one in millimetres, one in inches, with the same
// numbers.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "dowel/io/import.h"

namespace {

using namespace dowel;

/// All lengths in the unit of the file, so that both files' are the same numbers. Lists are sorted.
struct PartFeatures {
  std::vector<double> hole_diameters;
  std::vector<double> hole_depths;
  std::size_t through_holes = 0;
  std::vector<double> shaft_diameters;
  std::vector<double> shaft_lengths;
  std::vector<double> face_areas;
  std::vector<double> circle_diameters;
  std::vector<double> distances;  ///< between the openings of all pairs of holes
  double volume = 0.0;
};

PartFeatures features_of(const ImportedPart& part, double unit_mm) {
  PartFeatures result;
  std::vector<Eigen::Vector3d> openings;
  for (const Feature& feature : part.features) {
    if (feature.kind == FeatureKind::Hole) {
      result.hole_diameters.push_back(feature.diameter_mm / unit_mm);
      result.hole_depths.push_back(feature.depth_mm / unit_mm);
      result.through_holes += feature.through ? 1 : 0;
      for (const Eigen::Vector3d& other : openings) {
        result.distances.push_back((feature.origin - other).norm() / unit_mm);
      }
      openings.push_back(feature.origin);
    } else if (feature.kind == FeatureKind::Shaft) {
      result.shaft_diameters.push_back(feature.diameter_mm / unit_mm);
      result.shaft_lengths.push_back(feature.depth_mm / unit_mm);
    } else if (feature.kind == FeatureKind::Face) {
      result.face_areas.push_back(feature.area_mm2 / (unit_mm * unit_mm));
    }
  }
  for (const BoltCircle& circle : part.bolt_circles) {
    result.circle_diameters.push_back(circle.diameter_mm / unit_mm);
  }
  for (std::vector<double>* list :
       {&result.hole_diameters, &result.hole_depths, &result.shaft_diameters, &result.shaft_lengths,
        &result.face_areas, &result.circle_diameters, &result.distances}) {
    std::ranges::sort(*list);
  }
  result.volume = part.volume_mm3 / std::pow(unit_mm, 3);
  return result;
}

std::map<std::string, PartFeatures> parts_of(const std::filesystem::path& file, double unit_mm) {
  const ImportResult result = import_file(file, {});
  REQUIRE(result.status == ImportResult::Status::Ok);
  std::map<std::string, PartFeatures> parts;
  for (const ImportedPart& part : result.parts) {
    std::string name = part.name;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    parts[name] = features_of(part, unit_mm);
  }
  return parts;
}

void check_same(const std::vector<double>& a, const std::vector<double>& b) {
  CHECK_THAT(a, Catch::Approx(b).margin(1e-3));
}

}  // namespace

TEST_CASE(
    "the AS1 parts have the same features from both systems, but for the length of the bolt") {
  const std::filesystem::path folder = std::filesystem::path(DOWEL_SHARED_STEP) / "pythonocc_core";
  if (!std::filesystem::exists(folder)) {
    WARN("no folder of real STEP files here: " << DOWEL_SHARED_STEP);
    return;
  }
  constexpr double kInch_mm = 25.4;
  const auto metric = parts_of(folder / "as1-oc-214.stp", 1.0);
  const auto inch = parts_of(folder / "as1_pe_203.stp", kInch_mm);
  REQUIRE(metric.size() == 5);
  REQUIRE(inch.size() == 5);
  for (const auto& [name, part] : metric) {
    CAPTURE(name);
    REQUIRE(inch.count(name) == 1);
    const PartFeatures& other = inch.at(name);
    check_same(part.hole_diameters, other.hole_diameters);
    check_same(part.hole_depths, other.hole_depths);
    CHECK(part.through_holes == other.through_holes);
    check_same(part.shaft_diameters, other.shaft_diameters);
    check_same(part.circle_diameters, other.circle_diameters);
    check_same(part.distances, other.distances);
    if (name == "bolt") {
      // Drawn 37 long by the one and 40 by the other, the heads alike.
      CHECK(part.shaft_lengths.front() == Approx(other.shaft_lengths.front()).margin(1e-3));
      CHECK(other.volume - part.volume == Approx(std::acos(-1.0) * 25.0 * 3.0).epsilon(1e-3));
      continue;
    }
    check_same(part.shaft_lengths, other.shaft_lengths);
    check_same(part.face_areas, other.face_areas);
    CHECK(part.volume == Approx(other.volume).epsilon(1e-4));
  }
}
