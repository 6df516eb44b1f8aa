#include "library_manifest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <system_error>

#include "dowel/kernel/tolerance.h"
#include "json_node.h"
#include "sha256.h"

namespace dowel {
namespace {

constexpr const char* kFileName = "library.json";
constexpr const char* kFormat = "dowel-library/1";

std::string optional_text(const JsonNode& node, const std::string& key) {
  return node.has(key) ? node.at(key).text() : "";
}

Eigen::Vector3d vector_from(const JsonNode& node) {
  const std::array<double, 3> values = node.numbers<3>();
  return {values[0], values[1], values[2]};
}

FeatureKind kind_from(const JsonNode& node) {
  constexpr std::array kKinds{FeatureKind::Hole, FeatureKind::Shaft, FeatureKind::Face,
                              FeatureKind::Slot};
  const std::string name = node.text();
  for (const FeatureKind kind : kKinds) {
    if (to_string(kind) == name) return kind;
  }
  node.fail("expected hole, shaft, face or slot, found \"" + name + "\"");
}

Feature feature_from(const JsonNode& node) {
  node.expect_object();
  Feature feature;
  feature.name = optional_text(node, "name");
  feature.kind = kind_from(node.require("kind"));
  feature.use = optional_text(node, "use");
  feature.thread = optional_text(node, "thread");
  feature.fit = optional_text(node, "fit");
  const JsonNode axis = node.require("axis");
  axis.expect_object();
  feature.origin = vector_from(axis.require("origin"));
  feature.direction = vector_from(axis.require("direction"));
  if (!(std::abs(feature.direction.norm() - 1.0) <= kStoredAxisSlack)) {
    axis.at("direction").fail("expected a vector of unit length");
  }
  if (feature.kind == FeatureKind::Slot) {
    feature.diameter_mm = node.require("width").number();
  } else if (feature.kind != FeatureKind::Face) {
    feature.diameter_mm = node.require("diameter").number();
  }
  return feature;
}

ElementDesign design_from(const JsonNode& node) {
  ElementDesign design;
  design.family = optional_text(node, "family");
  design.licence = optional_text(node, "licence");
  design.role = optional_text(node, "role");
  design.description = optional_text(node, "description");
  design.material = optional_text(node, "material");
  design.dimensions_by = optional_text(node, "source");
  if (node.has("density_kg_per_m3")) {
    design.density_kg_per_m3 = node.at("density_kg_per_m3").number();
    if (design.density_kg_per_m3 <= 0.0) {
      node.at("density_kg_per_m3").fail("expected a density above 0");
    }
  }
  if (!node.has("features")) return design;
  const JsonNode features = node.at("features");
  features.expect_list();
  for (std::size_t i = 0; i < features.value.size(); ++i) {
    design.features.push_back(feature_from(features.at(i)));
  }
  return design;
}

/// How far `feature` lies from where the stated one is; nothing where it is another.
std::optional<double> distance_from(const Feature& stated, const Feature& feature) {
  if (feature.kind != stated.kind) return std::nullopt;
  if ((feature.direction - stated.direction).norm() > kCoaxial_rad) return std::nullopt;
  if (std::abs(feature.diameter_mm - stated.diameter_mm) > kCoaxial_mm) return std::nullopt;
  const Eigen::Vector3d offset = feature.origin - stated.origin;
  // Of a face the middle may be anywhere, its plane may not.
  const double error_mm =
      stated.kind == FeatureKind::Face ? std::abs(offset.dot(stated.direction)) : offset.norm();
  if (!(error_mm <= kCoaxial_mm)) return std::nullopt;
  return offset.norm();
}

Feature* matching_feature(const Feature& stated, std::vector<Feature>& features) {
  Feature* best = nullptr;
  double least_mm = std::numeric_limits<double>::infinity();
  for (Feature& feature : features) {
    const std::optional<double> distance_mm = distance_from(stated, feature);
    if (!distance_mm || *distance_mm >= least_mm) continue;
    least_mm = *distance_mm;
    best = &feature;
  }
  return best;
}

/// Other programs have files of this name, too.
bool is_ours(const nlohmann::json& json) {
  return json.is_object() && json.contains("format") && json["format"].is_string() &&
         json["format"].get<std::string>().starts_with("dowel-library/");
}

}  // namespace

LibraryManifest::LibraryManifest(const std::filesystem::path& file)
    : folder_(file.parent_path()), sha256_(sha256_of_file(file)) {
  const nlohmann::json json = parse_json_file(file);
  const JsonNode top{json, file.string() + ": ", "library", ""};
  if (!is_ours(json)) return;
  const JsonNode format = top.at("format");
  if (format.text() != kFormat) {
    format.fail(std::string("expected \"") + kFormat + "\", found \"" + format.text() + "\"");
  }
  if (top.has("unit") && top.at("unit").text() != "mm") {
    top.at("unit").fail("expected \"mm\", found \"" + top.at("unit").text() + "\"");
  }
  const JsonNode elements = top.require("elements");
  elements.expect_list();
  for (std::size_t i = 0; i < elements.value.size(); ++i) {
    const JsonNode node = elements.at(i);
    node.expect_object();
    const JsonNode name = node.require("file");
    const auto key = std::filesystem::path(name.text()).lexically_normal().generic_string();
    if (!designs_.emplace(key, design_from(node)).second) name.fail("is listed twice");
  }
}

const ElementDesign* LibraryManifest::find(const std::filesystem::path& element_file) const {
  const auto found = designs_.find(element_file.lexically_relative(folder_.empty() ? "." : folder_)
                                       .lexically_normal()
                                       .generic_string());
  return found == designs_.end() ? nullptr : &found->second;
}

std::optional<std::filesystem::path> manifest_beside(const std::filesystem::path& element_file) {
  const std::filesystem::path folder = element_file.parent_path();
  for (const std::filesystem::path& place : {folder, folder.parent_path()}) {
    const std::filesystem::path manifest = place / kFileName;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(manifest, ignored)) return manifest;
  }
  return std::nullopt;
}

std::optional<std::string> add_design(const ElementDesign& design, Element& element) {
  if (!design.family.empty()) element.family = design.family;
  if (element.licence.empty()) element.licence = design.licence;
  element.role = design.role;
  element.description = design.description;
  element.material = design.material;
  element.dimensions_by = design.dimensions_by;
  element.density_kg_per_m3 = design.density_kg_per_m3;
  for (const Feature& stated : design.features) {
    Feature* const feature = matching_feature(stated, element.features);
    if (feature == nullptr) {
      return "the library states a " + std::string(to_string(stated.kind)) + " \"" + stated.name +
             "\" that the solid does not have";
    }
    feature->use = stated.use;
    feature->fit = stated.fit;
    feature->thread = stated.thread;
    feature->thread_is_guess = false;
  }
  return std::nullopt;
}

}  // namespace dowel
