#pragma once

// Element records to fill catalogues with.

#include <string>
#include <vector>

#include "dowel/catalog/catalog.h"
#include "solids.h"

namespace dowel::testing {

/// A block with a pin on it in words, though its facets are just the block: every field has a value
/// of its own, so that none can be mixed up with another.
inline ElementRecord block_record(const std::string& name, double length_mm = 80.0) {
  ElementRecord record;
  record.solid = box({length_mm, 40.0, 20.0});
  record.brep = {std::byte{1}, std::byte{0}, std::byte{255}};
  Element& element = record.element;
  element.name = name;
  element.family = "H40-12";
  element.source = "blocks/block.step";
  element.sha256 = std::string(64, 'a');
  element.unit_in_file = "inch";
  element.licence = "CC0-1.0";
  element.role = "locator";
  element.description = "a block with a pin";
  element.material = "steel C45";
  element.dimensions_by = "like DIN 6321";
  element.density_kg_per_m3 = 7850.0;
  element.shape = ShapeClass::BlockCylinder;
  element.solids = 1;
  element.volume_mm3 = length_mm * 800.0;
  element.surface_mm2 = 1.0 / 3.0;
  element.center_of_mass = {0.1, -0.2, 0.3};
  element.obb.center = {1.0, 2.0, -3.0};
  element.obb.axes << 0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0;
  element.obb.half_extents_mm = {length_mm / 2.0, 20.0, 10.0};
  element.triangles = {12, 7, 3, 2};
  element.facet_error_mm = 0.015625;
  element.colour = {0.25, 0.5, 0.75};

  Feature bore;
  bore.name = "cb1";
  bore.kind = FeatureKind::Hole;
  bore.origin = {7.0, 8.0, 9.0};
  bore.direction = {0.0, 0.6, -0.8};
  bore.diameter_mm = 12.0;
  bore.depth_mm = 20.0;
  bore.blind_end = "cone";
  bore.entry = "top";
  bore.segments = {{HoleSegment::Type::Cone, 18.0, 15.0, 0.0, 1.5},
                   {HoleSegment::Type::Cylinder, 12.0, 12.0, 1.5, 20.0}};
  bore.faces = {3, 5, 4294967295U};
  Feature through = bore;
  through.name = "A1";
  through.through = true;
  through.blind_end = "";
  through.segments = {};
  through.faces = {};
  through.thread = "M12";
  through.thread_is_guess = true;
  Feature pin;
  pin.name = "pin1";
  pin.kind = FeatureKind::Shaft;
  pin.diameter_mm = 11.99;
  pin.depth_mm = 25.0;
  pin.use = "head";
  pin.fit = "g6";
  Feature top;
  top.name = "top";
  top.kind = FeatureKind::Face;
  top.area_mm2 = length_mm * 40.0;
  top.faces = {1};
  Feature slot;
  slot.name = "slot1";
  slot.kind = FeatureKind::Slot;
  slot.origin = {1.0, 2.0, 20.0};
  slot.direction = {0.0, 0.0, -1.0};
  slot.diameter_mm = 14.0;
  slot.depth_mm = 25.0;
  slot.slot = SlotShape{.type = SlotShape::Type::Tee,
                        .run = {0.6, 0.8, 0.0},
                        .length_mm = 70.0,
                        .ends = {SlotShape::End::Open, SlotShape::End::Round},
                        .throat_depth_mm = 15.0,
                        .undercut_width_mm = 24.0,
                        .undercut_height_mm = 10.0,
                        .nominal_mm = 14};
  element.features = {bore, through, pin, top, slot};
  // No such circle is found, but it is kept.
  element.bolt_circles = {{{1.0, 2.0, 3.0}, {0.0, 0.6, -0.8}, 50.0, 12.0, {"cb1", "A1", "cb1"}}};
  return record;
}

/// The source that block records come from.
inline SourceRecord block_source(const std::string& path = "blocks/block.step") {
  return {path, std::string(64, 'a'), "deflection 0", "ok", "", {}};
}

}  // namespace dowel::testing
