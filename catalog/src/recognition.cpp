#include "dowel/catalog/recognition.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "face_graph.h"
#include "feature_names.h"
#include "holes.h"
#include "planar_faces.h"
#include "revolved_bands.h"
#include "shafts.h"
#include "slots.h"
#include "surface_fit.h"

namespace dowel {
namespace {

/// To the grid of features. Adding zero turns -0 into 0.
double rounded(double length_mm) {
  return std::round(length_mm * kFeatureSteps_per_mm) / kFeatureSteps_per_mm + 0.0;
}

void round(Eigen::Vector3d& direction) {
  for (double& component : direction) {
    if (std::abs(component) < kRounding) component = 0.0;
  }
  direction.normalize();
}

void round(SlotShape& slot) {
  round(slot.run);
  slot.length_mm = rounded(slot.length_mm);
  slot.throat_depth_mm = rounded(slot.throat_depth_mm);
  slot.undercut_width_mm = rounded(slot.undercut_width_mm);
  slot.undercut_height_mm = rounded(slot.undercut_height_mm);
}

void round(Feature& feature) {
  feature.origin = feature.origin.unaryExpr(&rounded);
  round(feature.direction);
  feature.diameter_mm = rounded(feature.diameter_mm);
  feature.depth_mm = rounded(feature.depth_mm);
  feature.area_mm2 = rounded(feature.area_mm2);
  for (HoleSegment& segment : feature.segments) {
    segment.diameter_mm = rounded(segment.diameter_mm);
    segment.diameter_end_mm = rounded(segment.diameter_end_mm);
    segment.from_mm = rounded(segment.from_mm);
    segment.to_mm = rounded(segment.to_mm);
  }
  if (feature.slot) round(*feature.slot);
}

void append(std::vector<Feature>& all, std::vector<Feature> more) {
  for (Feature& feature : more) {
    round(feature);
    all.push_back(std::move(feature));
  }
}

/// Slots that open on one planar face get its name as their entry.
std::vector<Feature> slots_with_entries(const std::vector<SlotFinding>& findings,
                                        const std::map<std::uint32_t, std::string>& name_of_face) {
  std::vector<Feature> slots;
  for (const SlotFinding& finding : findings) {
    std::set<std::string> entries;
    for (const std::uint32_t face : finding.mouth_faces) {
      const auto name = name_of_face.find(face);
      if (name != name_of_face.end()) entries.insert(name->second);
    }
    slots.push_back(finding.feature);
    if (entries.size() == 1) slots.back().entry = *entries.begin();
  }
  return slots;
}

}  // namespace

std::vector<Feature> recognise_features(const FacetedSolid& solid) {
  const std::vector<FaceNode> graph = face_graph(solid);
  const std::vector<AxisBands> axes = revolved_bands(solid, graph);
  const std::vector<HoleFinding> findings = find_holes(solid, graph, axes);

  std::vector<bool> is_taken(graph.size(), false);
  for (const HoleFinding& finding : findings) {
    for (const std::uint32_t face : finding.feature.faces) is_taken[face] = true;
  }
  const std::vector<Feature> faces = named_faces(find_planar_faces(solid, graph, is_taken));
  std::map<std::uint32_t, std::string> name_of_face;
  for (const Feature& face : faces) {
    for (const std::uint32_t index : face.faces) name_of_face[index] = face.name;
  }
  std::vector<Feature> holes;
  for (const HoleFinding& finding : findings) {
    holes.push_back(finding.feature);
    if (const auto* const thread = likely_thread_of_hole(finding.feature.diameter_mm)) {
      holes.back().thread = thread->name;
      holes.back().thread_is_guess = true;
    }
    if (!finding.entry_face) continue;
    const auto name = name_of_face.find(*finding.entry_face);
    if (name != name_of_face.end()) holes.back().entry = name->second;
  }

  std::vector<Feature> features;
  append(features, named_holes(holes));
  append(features, named_shafts(find_shafts(axes)));
  append(features, faces);
  append(features, named_slots(slots_with_entries(find_slots(solid, graph), name_of_face)));
  return features;
}

std::vector<FacetClass> classify_faces(const FacetedSolid& solid,
                                       const std::vector<Feature>& features) {
  std::vector<FacetClass> classes(solid.faces.size(), FacetClass::Other);
  for (const Feature& feature : features) {
    if (feature.kind != FeatureKind::Hole && feature.kind != FeatureKind::Face) continue;
    const FacetClass kind =
        feature.kind == FeatureKind::Hole ? FacetClass::Hole : FacetClass::Plane;
    for (const std::uint32_t face : feature.faces) {
      DOWEL_EXPECTS(face < classes.size());
      classes[face] = kind;
    }
  }
  // Rings and floors are planar faces that a hole has.
  std::vector<std::vector<std::uint32_t>> triangles(classes.size());
  for (std::uint32_t t = 0; t < solid.face_of.size(); ++t) {
    const std::uint32_t face = solid.face_of[t];
    DOWEL_EXPECTS(face < classes.size());
    if (classes[face] == FacetClass::Hole) triangles[face].push_back(t);
  }
  for (std::size_t f = 0; f < classes.size(); ++f) {
    const Face& face = solid.faces[f];
    if (is_plane(face.surface)) {
      classes[f] = FacetClass::Plane;
    } else if (classes[f] == FacetClass::Hole &&
               std::holds_alternative<OtherSurface>(face.surface)) {
      const auto fit = fit_surface(solid, face, triangles[f]);
      if (fit && is_plane(fit->surface)) classes[f] = FacetClass::Plane;
    }
  }
  return classes;
}

TriangleCounts count_triangles(const FacetedSolid& solid, const std::vector<FacetClass>& classes) {
  DOWEL_EXPECTS(classes.size() == solid.faces.size());
  TriangleCounts counts;
  for (const std::uint32_t face : solid.face_of) {
    DOWEL_EXPECTS(face < classes.size());
    ++counts.total;
    switch (classes[face]) {
      case FacetClass::Plane:
        ++counts.plane;
        break;
      case FacetClass::Hole:
        ++counts.hole;
        break;
      case FacetClass::Other:
        ++counts.other;
        break;
    }
  }
  return counts;
}

}  // namespace dowel
