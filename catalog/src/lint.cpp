#include "dowel/catalog/lint.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "checksum.h"
#include "dowel/catalog/metric_thread.h"
#include "dowel/catalog/recognition.h"
#include "dowel/kernel/blob.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "fastener_lint.h"

namespace dowel {
namespace {

/// What a fixture element measures from corner to corner. Beyond, the unit was mistaken.
constexpr double kSmallestDiagonal_mm = 1.0;
constexpr double kLargestDiagonal_mm = 5000.0;

/// Fewer facets around a hole than this do not describe it.
constexpr double kFewestFacetsAround = 8.0;

/// A stored box may be larger than the smallest found by this part of its volume.
constexpr double kBoxVolumeSlack = 1.0e-3;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class ElementLint {
 public:
  ElementLint(const Element& element, const FacetedSolid& solid)
      : element_(element), solid_(solid) {}

  std::vector<LintFinding> run() && {
    check_counts();
    check_features();
    check_box();
    const auto defect = find_defect(solid_);
    if (defect) add("CAT-03", *defect);
    if (!defect) check_volume();
    if (faces_in_range_) check_holes();
    check_box_is_tight();
    check_faces();
    check_unit();
    check_density();
    check_origin();
    return std::move(findings_);
  }

 private:
  void add(const char* rule, std::string message,
           LintFinding::Severity severity = LintFinding::Severity::Error) {
    findings_.push_back({rule, severity, element_.name, std::move(message)});
  }

  void check_counts();
  void check_features();
  void check_hole(const Feature& hole);
  void check_slot(const Feature& slot);
  void check_box();
  void check_volume();
  void check_holes();
  void check_wall(const Feature& hole, const Face& face);
  void check_thread(const Feature& feature);
  void check_fit(const Feature& feature);
  void check_box_is_tight();
  void check_faces();
  bool is_of(const Feature& feature, const Face& face) const;
  void check_density();
  void check_unit();
  void check_origin();

  const Element& element_;
  const FacetedSolid& solid_;
  bool faces_in_range_ = true;
  std::vector<LintFinding> findings_;
};

void ElementLint::check_counts() {
  const TriangleCounts& counts = element_.triangles;
  if (counts.total != solid_.triangles.size()) {
    add("CAT-01", "says it has " + std::to_string(counts.total) + " triangles, its facets are " +
                      std::to_string(solid_.triangles.size()));
  }
  const std::uint64_t sum = std::uint64_t{counts.plane} + counts.hole + counts.other;
  if (sum != counts.total) {
    add("CAT-01", "its plane, hole and other triangles are " + std::to_string(sum) +
                      " together, expected " + std::to_string(counts.total));
  }
  if (element_.solids != solid_.solid_count) {
    add("CAT-01", "says it is of " + std::to_string(element_.solids) +
                      " solids, its facets are of " + std::to_string(solid_.solid_count));
  }
  double facet_error_mm = 0.0;
  for (const Face& face : solid_.faces) {
    facet_error_mm = std::max(facet_error_mm, face.facet_error_mm);
  }
  if (facet_error_mm != element_.facet_error_mm) {
    add("CAT-01", "says its facets are within " + number(element_.facet_error_mm) +
                      " mm, the largest error of a face is " + number(facet_error_mm) + " mm");
  }
}

void ElementLint::check_features() {
  for (const Feature& feature : element_.features) {
    for (const std::uint32_t face : feature.faces) {
      if (face < solid_.faces.size()) continue;
      faces_in_range_ = false;
      add("CAT-01", "feature " + feature.name + " has face " + std::to_string(face) +
                        ", the element has " + std::to_string(solid_.faces.size()));
      break;
    }
    if (!feature.entry.empty()) {
      const Feature* const entry = element_.find_feature(feature.entry);
      if (entry == nullptr || entry->kind != FeatureKind::Face) {
        add("CAT-01", "feature " + feature.name + " opens on \"" + feature.entry +
                          "\", which is no face of the element");
      }
    }
    if (feature.kind == FeatureKind::Hole) check_hole(feature);
    if (feature.kind == FeatureKind::Slot) check_slot(feature);
    check_thread(feature);
    check_fit(feature);
  }
  for (std::string& message : fastener_contradictions(element_)) add("CAT-01", std::move(message));
}

/// A thread is drawn as a cylinder between its minor and its nominal diameter.
void ElementLint::check_thread(const Feature& feature) {
  const MetricThread* const thread = find_metric_thread(feature.thread);
  if (thread == nullptr) return;
  const auto is_drawn = [thread](double diameter_mm) {
    return diameter_mm >= thread->minor_mm() - kTapDrillSlack_mm &&
           diameter_mm <= thread->nominal_mm + kTapDrillSlack_mm;
  };
  const bool is_somewhere =
      is_drawn(feature.diameter_mm) ||
      std::ranges::any_of(feature.segments, [&](const HoleSegment& segment) {
        return segment.type == HoleSegment::Type::Cylinder && is_drawn(segment.diameter_mm);
      });
  if (is_somewhere) return;
  add("CAT-01", "feature " + feature.name + " is to have the thread " + feature.thread +
                    ", but its diameter is " + number(feature.diameter_mm) + " mm");
}

/// ISO 286 writes the class of a hole with a capital letter, that of a shaft with a small one.
void ElementLint::check_fit(const Feature& feature) {
  if (feature.fit.empty() || feature.kind == FeatureKind::Face) return;  // a key's flanks have one
  const bool is_internal_fit = feature.fit[0] >= 'A' && feature.fit[0] <= 'Z';
  const bool is_shaft = feature.kind == FeatureKind::Shaft;
  if (is_internal_fit != is_shaft) return;
  add("CAT-01", std::string(to_string(feature.kind)) + " " + feature.name + " has the fit " +
                    feature.fit + ", which is one for " + (is_shaft ? "holes" : "shafts"));
}

void ElementLint::check_hole(const Feature& hole) {
  double reached_mm = 0.0;
  bool has_bore = hole.segments.empty();
  for (const HoleSegment& segment : hole.segments) {
    if (segment.from_mm < reached_mm - kCoincident_mm) {
      add("CAT-01",
          "hole " + hole.name + " has segments that overlap at " + number(segment.from_mm) + " mm");
    }
    reached_mm = segment.to_mm;
    has_bore = has_bore || (segment.type == HoleSegment::Type::Cylinder &&
                            std::abs(segment.diameter_mm - hole.diameter_mm) <= kCoincident_mm);
  }
  if (reached_mm > hole.depth_mm + kCoincident_mm) {
    add("CAT-01", "hole " + hole.name + " is " + number(hole.depth_mm) +
                      " mm deep, but its segments reach " + number(reached_mm) + " mm");
  }
  if (!has_bore || !(hole.diameter_mm > 0.0)) {
    add("CAT-01", "hole " + hole.name + " has no cylinder of its diameter, " +
                      number(hole.diameter_mm) + " mm");
  }
}

/// A T-slot is a throat over something wider.
void ElementLint::check_slot(const Feature& slot) {
  if (!slot.slot || slot.slot->type != SlotShape::Type::Tee) return;
  if (slot.slot->undercut_width_mm <= slot.diameter_mm) {
    add("CAT-01", "T-slot " + slot.name + " is " + number(slot.diameter_mm) +
                      " mm wide at its mouth, " + number(slot.slot->undercut_width_mm) +
                      " mm below");
  }
  const double sum_mm = slot.slot->throat_depth_mm + slot.slot->undercut_height_mm;
  if (sum_mm > slot.depth_mm + kCoincident_mm) {
    add("CAT-01", "T-slot " + slot.name + " is " + number(slot.depth_mm) +
                      " mm deep, its throat and undercut together " + number(sum_mm) + " mm");
  }
}

void ElementLint::check_box() {
  const double slack_mm = kBoxSlack_mm + kBoxSlackRatio * 2.0 * element_.obb.half_extents_mm.norm();
  double outside_mm = 0.0;
  for (const Eigen::Vector3d& vertex : solid_.vertices) {
    outside_mm = std::max(outside_mm, element_.obb.face_distance_mm(vertex));
  }
  // The exact face bulges out of its facets: try where it is farthest from them.
  for (std::uint32_t i = 0; i < solid_.triangles.size(); ++i) {
    const Face& face = solid_.faces[solid_.face_of[i]];
    if (face.facet_error_mm == 0.0 || std::holds_alternative<OtherSurface>(face.surface)) continue;
    const auto [a, b, c] = solid_.corners(i);
    const Eigen::Vector3d on_face = closest_point(face.surface, (a + b + c) / 3.0);
    outside_mm = std::max(outside_mm, element_.obb.face_distance_mm(on_face));
  }
  if (outside_mm > slack_mm) {
    add("CAT-02", "stands out of its stored box by " + number(outside_mm) + " mm");
  }
}

void ElementLint::check_volume() {
  const double facets_mm3 = mass_properties(solid_).volume_mm3;
  // Facets within e of a surface S enclose a volume within e S of the exact one.
  const double slack_mm3 =
      element_.facet_error_mm * element_.surface_mm2 + kVolumeSlackRatio * std::abs(facets_mm3);
  if (std::abs(facets_mm3 - element_.volume_mm3) > slack_mm3) {
    add("CAT-01", "says its volume is " + number(element_.volume_mm3) +
                      " mm3, its facets enclose " + number(facets_mm3) + " mm3");
  }
}

void ElementLint::check_holes() {
  const TriangleCounts counts = count_triangles(solid_, classify_faces(solid_, element_.features));
  if (counts.hole != element_.triangles.hole) {
    add("CAT-04", "has " + std::to_string(element_.triangles.hole) +
                      " triangles tagged as hole, its declared holes have " +
                      std::to_string(counts.hole));
  } else if (counts.plane != element_.triangles.plane) {
    add("CAT-04", "has " + std::to_string(element_.triangles.plane) +
                      " triangles tagged as plane, its planar faces have " +
                      std::to_string(counts.plane));
  }
  for (const Feature& feature : element_.features) {
    if (feature.kind != FeatureKind::Hole) continue;
    for (const std::uint32_t face : feature.faces) check_wall(feature, solid_.faces[face]);
  }
}

void ElementLint::check_wall(const Feature& hole, const Face& face) {
  const auto* const cylinder = std::get_if<CylinderSurface>(&face.surface);
  if (cylinder == nullptr) return;
  const Eigen::Vector3d off_axis = hole.direction.cross(cylinder->origin - hole.origin);
  const bool is_coaxial = off_axis.norm() <= kBoxSlack_mm &&
                          hole.direction.cross(cylinder->axis).norm() <= kStoredAxisSlack;
  const bool has_segment =
      std::ranges::any_of(hole.segments, [cylinder](const HoleSegment& segment) {
        return segment.type == HoleSegment::Type::Cylinder &&
               std::abs(segment.diameter_mm - 2.0 * cylinder->radius_mm) <= kBoxSlack_mm;
      });
  if (!is_coaxial || !has_segment) {
    add("CAT-04", "hole " + hole.name + " has a wall of diameter " +
                      number(2.0 * cylinder->radius_mm) + " mm that is none of its segments");
  }
  // A chord between two of n facets around misses the circle by r (1 - cos(pi / n)).
  const double allowed_mm =
      cylinder->radius_mm * (1.0 - std::cos(std::numbers::pi / kFewestFacetsAround));
  if (face.facet_error_mm > allowed_mm) {
    add("CAT-04", "hole " + hole.name + " has fewer than 8 facets around: its facets miss it by " +
                      number(face.facet_error_mm) + " mm");
  }
}

/// The box decides what is checked for collisions at all: a slack one costs time, no truth.
void ElementLint::check_box_is_tight() {
  if (solid_.vertices.empty()) return;
  const double stored_mm3 = element_.obb.volume_mm3();
  const double smallest_mm3 = enclosing_box(solid_).volume_mm3();
  if (stored_mm3 <= (1.0 + kBoxVolumeSlack) * smallest_mm3) return;
  add("CAT-09",
      "its stored box holds " + number(stored_mm3) + " mm3, one of " + number(smallest_mm3) +
          " mm3 holds it, too",
      LintFinding::Severity::Warning);
}

/// Whether an exact face lies on what the feature says it is. Free-form faces are taken as they
/// are, holes have a check of their own.
bool ElementLint::is_of(const Feature& feature, const Face& face) const {
  if (feature.kind == FeatureKind::Face) {
    const auto* const plane = std::get_if<PlaneSurface>(&face.surface);
    return plane == nullptr ||
           (feature.direction.dot(plane->normal) > 0.0 &&
            feature.direction.cross(plane->normal).norm() <= kStoredAxisSlack &&
            std::abs(signed_distance_mm(face.surface, feature.origin)) <= kBoxSlack_mm);
  }
  if (feature.kind == FeatureKind::Shaft) {
    const auto* const cylinder = std::get_if<CylinderSurface>(&face.surface);
    return cylinder == nullptr ||
           (feature.direction.cross(cylinder->origin - feature.origin).norm() <= kBoxSlack_mm &&
            feature.direction.cross(cylinder->axis).norm() <= kStoredAxisSlack &&
            std::abs(feature.diameter_mm - 2.0 * cylinder->radius_mm) <= kBoxSlack_mm);
  }
  return true;
}

void ElementLint::check_faces() {
  for (const Feature& feature : element_.features) {
    if (feature.faces.empty()) {
      add("CAT-10", std::string(to_string(feature.kind)) + " " + feature.name +
                        " has no faces: nothing tells where it is");
      continue;
    }
    if (!faces_in_range_) continue;
    const bool is_all = std::ranges::all_of(
        feature.faces, [&](std::uint32_t face) { return is_of(feature, solid_.faces[face]); });
    if (!is_all) {
      add("CAT-10", std::string(to_string(feature.kind)) + " " + feature.name +
                        " has a face that lies elsewhere");
    }
  }
}

/// In kg/m3, between magnesium foam and gold: a density in g/cm3 or in t/mm3 is none.
void ElementLint::check_density() {
  constexpr double kLeastDensity = 100.0;
  constexpr double kMostDensity = 25000.0;
  const double density = element_.density_kg_per_m3;
  if (density == 0.0 || (density >= kLeastDensity && density <= kMostDensity)) return;
  add("CAT-05",
      "its density is " + number(density) + " kg/m3, expected 100 to 25000: is the unit right?");
}

void ElementLint::check_unit() {
  if (element_.unit_in_file.empty()) add("CAT-05", "its file states no unit of length");
  const double diagonal_mm = 2.0 * element_.obb.half_extents_mm.norm();
  // Written so that NaN is a finding.
  if (!(diagonal_mm >= kSmallestDiagonal_mm && diagonal_mm <= kLargestDiagonal_mm)) {
    add("CAT-05", "measures " + number(diagonal_mm) +
                      " mm from corner to corner, expected 1 to 5000: is the unit right?");
  }
}

void ElementLint::check_origin() {
  const auto warn = [this](const char* what) {
    add("CAT-06", what, LintFinding::Severity::Warning);
  };
  if (element_.source.empty()) warn("its source is not recorded");
  if (element_.sha256.empty()) warn("its revision, the hash of its file, is not recorded");
  if (element_.licence.empty()) warn("its licence is not recorded");
}

/// The first element with facets of some size in bytes and checksum.
using FirstOf = std::map<std::pair<std::size_t, std::uint64_t>, std::string>;

void lint_stored(const Catalog& catalog, const std::string& name, FirstOf& first_of,
                 std::vector<Element>& fasteners, std::vector<LintFinding>& findings) {
  std::optional<Element> element = catalog.find(name);
  if (!element) return;  // another program has just removed it
  const auto solid = catalog.solid(name);
  catalog.brep(name);  // damage shows here
  for (LintFinding& finding : lint(*element, *solid)) findings.push_back(std::move(finding));
  const std::vector<std::byte> facets = to_blob(*solid);
  const auto [first, is_new] = first_of.try_emplace({facets.size(), checksum(facets)}, name);
  if (!is_new && to_blob(*catalog.solid(first->second)) == facets) {
    findings.push_back({"CAT-07", LintFinding::Severity::Warning, name,
                        "has the same facets as " + first->second});
  }
  if (element->role == "fastener") fasteners.push_back(std::move(*element));
}

}  // namespace

std::string_view to_string(LintFinding::Severity severity) {
  return severity == LintFinding::Severity::Warning ? "warning" : "error";
}

std::vector<LintFinding> lint(const Element& element, const FacetedSolid& solid) {
  std::vector<LintFinding> findings = ElementLint(element, solid).run();
  std::ranges::stable_sort(findings, {}, &LintFinding::rule);
  return findings;
}

std::vector<LintFinding> lint(const Catalog& catalog) {
  std::vector<LintFinding> findings;
  FirstOf first_of;
  std::vector<Element> fasteners;
  for (const std::string& name : catalog.names()) {
    try {
      lint_stored(catalog, name, first_of, fasteners, findings);
    } catch (const Error& error) {
      findings.push_back({"CAT-08", LintFinding::Severity::Error, name, error.what()});
    }
  }
  for (SizeFault& fault : size_faults(fasteners)) {
    findings.push_back({"CAT-01", LintFinding::Severity::Error, std::move(fault.element),
                        std::move(fault.message)});
  }
  std::ranges::stable_sort(findings, {}, [](const LintFinding& finding) {
    return std::tie(finding.element, finding.rule);
  });
  return findings;
}

}  // namespace dowel
