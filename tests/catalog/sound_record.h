#pragma once

// Element records that lint finds nothing wrong with.

#include <algorithm>
#include <string>
#include <utility>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/recognition.h"
#include "dowel/kernel/mass_properties.h"

namespace dowel::testing {

/// A record whose numbers agree with its solid.
inline ElementRecord sound_record(const std::string& name, FacetedSolid solid) {
  ElementRecord record;
  Element& element = record.element;
  const MassProperties mass = mass_properties(solid);
  element.name = name;
  element.source = name + ".step";
  element.unit_in_file = "mm";
  element.licence = "CC0-1.0";
  element.sha256 = std::string(64, 'a');
  element.solids = solid.solid_count;
  element.volume_mm3 = mass.volume_mm3;
  element.surface_mm2 = mass.surface_mm2;
  element.center_of_mass = mass.center_of_mass;
  element.features = recognise_features(solid);
  element.shape = classify_shape(solid, element.features);
  element.triangles = count_triangles(solid, classify_faces(solid, element.features));
  element.obb = enclosing_box(solid);
  for (const Face& face : solid.faces) {
    element.facet_error_mm = std::max(element.facet_error_mm, face.facet_error_mm);
  }
  record.solid = std::move(solid);
  return record;
}

}  // namespace dowel::testing
