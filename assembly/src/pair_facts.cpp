// Facts about pairs of parts: what touches, interferes, is near, stands in what, holds what.

#include <algorithm>
#include <cmath>

#include "dowel/assembly/fit.h"
#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/tolerance.h"
#include "fact_source.h"

namespace dowel {
namespace {

FactRows touching(FactSource& source, Verdict verdict) {
  FactRows rows;
  for (const Touch& touch : source.touches()) {
    if (touch.pair.verdict != verdict) continue;
    const Eigen::Vector3d& at = touch.pair.witness_W;
    rows.push_back({touch.instance, touch.with,
                    verdict == Verdict::Contact ? touch.pair.gap_mm : touch.pair.depth_mm, at.x(),
                    at.y(), at.z(), touch.pair.bound_mm});
  }
  return rows;
}

FactRows contacts(FactSource& source) {
  return touching(source, Verdict::Contact);
}

FactRows interferences(FactSource& source) {
  return touching(source, Verdict::Interference);
}

/// As far as any rule of the project looks.
FactRows clearances(FactSource& source) {
  const FixtureDesign& design = source.state().design;
  const double reach_mm = std::min(
      kMaxTolerance_mm, std::max(design.limit("gap_element_mm"), design.limit("gap_workpiece_mm")));
  FactRows rows;
  if (reach_mm <= source.state().tolerance_mm) return rows;
  for (const Touch& near : source.nearer_than(reach_mm)) {
    const Eigen::Vector3d& at = near.pair.witness_W;
    rows.push_back({near.instance, near.with, near.pair.gap_mm, at.x(), at.y(), at.z()});
  }
  return rows;
}

FactRows seats(FactSource& source) {
  FactRows rows;
  for (const Touch& touch : source.touches()) {
    if (touch.pair.verdict != Verdict::Contact) continue;
    for (const ContactPatch& patch : source.shared_planes(touch)) {
      rows.push_back({touch.instance, touch.with, patch.area_mm2, patch.at_W.x(), patch.at_W.y(),
                      patch.at_W.z(), patch.normal_W.x(), patch.normal_W.y(), patch.normal_W.z()});
    }
  }
  return rows;
}

/// Least and most clearance by the classes that shaft and hole are stated to have.
std::pair<FactValue, FactValue> clearance_um(const AxisPair& pair) {
  const auto hole = tolerance_class_from(pair.hole->fit);
  const auto shaft = tolerance_class_from(pair.shaft->fit);
  const double nominal_mm = std::round(pair.bore_mm);
  if (!hole || !shaft || !hole->is_hole() || shaft->is_hole() || !is_nominal_size(nominal_mm)) {
    return {FactValue(), FactValue()};
  }
  const Fit fit{nominal_mm, *hole, *shaft};
  // The sizes as drawn give the shaft's nominal size away: half a millimetre off is another one.
  constexpr double kOtherSize_mm = 0.5;
  const double apart_um = 1.0e3 * (nominal_mm - std::round(pair.shaft->diameter_mm));
  if (std::abs(pair.bore_mm - nominal_mm) > kOtherSize_mm) return {FactValue(), FactValue()};
  return {fit.least_clearance_um() + apart_um, fit.most_clearance_um() + apart_um};
}

FactRows fits(FactSource& source) {
  FactRows rows;
  for (const AxisPair& pair : source.axes()) {
    const auto [least_um, most_um] = clearance_um(pair);
    const MetricThread* thread =
        pair.is_thread ? thread_of_shaft(pair.shaft->diameter_mm) : nullptr;
    if (const MetricThread* stated = find_metric_thread(pair.shaft->thread)) thread = stated;
    rows.push_back({pair.shaft_instance,
                    pair.shaft->name,
                    pair.hole_instance,
                    pair.hole->name,
                    std::string(to_string(pair.hole->kind)),
                    pair.shaft->diameter_mm,
                    pair.bore_mm,
                    pair.overlap_mm,
                    pair.offset_mm,
                    truth(pair.is_coaxial),
                    truth(pair.is_thread),
                    pair.engagement_mm,
                    pair.past_opening_mm,
                    pair.is_thread ? FactValue(pair.tip_to_end_mm) : FactValue(),
                    truth(pair.hole->through),
                    thread != nullptr ? FactValue(thread->pitch_mm) : FactValue(),
                    text_or_null(pair.shaft->thread),
                    text_or_null(pair.hole->thread),
                    text_or_null(pair.shaft->fit),
                    text_or_null(pair.hole->fit),
                    least_um,
                    most_um});
  }
  return rows;
}

FactRows fastenings(FactSource& source) {
  FactRows rows;
  for (const Holding& holding : source.holdings()) {
    rows.push_back({holding.held, holding.by, holding.kind});
  }
  return rows;
}

/// Whether something along `axis_W` is drilled square to a plate that lies flat.
bool is_upright(const Eigen::Vector3d& axis_W) {
  return std::abs(axis_W.z()) > 1.0 - kCoaxial_rad;
}

/// A row for each upright through hole of a part, with the hole of the plate that is nearest.
void add_plate_holes(FactSource& source, const Instance& part, const Instance& plate,
                     FactRows& rows) {
  const Role role = source.role(part);
  if (role != Role::Riser && role != Role::Locator && role != Role::Support) return;
  for (const Feature& bore : source.element(part).features) {
    if (bore.kind != FeatureKind::Hole || !bore.through ||
        !is_upright(part.X_WI.rotation() * bore.direction)) {
      continue;
    }
    const Eigen::Vector3d at_W = part.X_WI * bore.origin;
    const Feature* nearest = nullptr;
    double off_mm = 0.0;
    for (const Feature& hole : source.element(plate).features) {
      if (hole.kind != FeatureKind::Hole || !is_upright(plate.X_WI.rotation() * hole.direction)) {
        continue;
      }
      const double to_hole_mm = (plate.X_WI * hole.origin - at_W).head<2>().norm();
      if (nearest != nullptr && to_hole_mm >= off_mm) continue;
      nearest = &hole;
      off_mm = to_hole_mm;
    }
    if (nearest == nullptr) continue;
    rows.push_back({part.name, bore.name, bore.diameter_mm, plate.name, nearest->name, off_mm});
  }
}

FactRows plate_holes(FactSource& source) {
  FactRows rows;
  for (const Touch& touch : source.touches()) {
    if (touch.pair.verdict != Verdict::Contact) continue;
    const Instance& a = *source.state().find(touch.instance);
    const Instance& b = *source.state().find(touch.with);
    if (source.role(a) == Role::BasePlate) add_plate_holes(source, b, a, rows);
    if (source.role(b) == Role::BasePlate) add_plate_holes(source, a, b, rows);
  }
  std::ranges::sort(rows);
  return rows;
}

}  // namespace

std::vector<FactTable> pair_facts() {
  return {
      {"clearances",
       "Pairs that do not touch and are nearer than the larger of the limits gap_element_mm and "
       "gap_workpiece_mm.",
       {{"a", "instance, first by name"},
        {"b", "instance"},
        {"gap_mm", "their least distance, to a micrometre"},
        {"x_mm", "there"},
        {"y_mm", ""},
        {"z_mm", ""}},
       FromParts | FromDesign | FromTolerance,
       clearances},
      {"contacts",
       "Pairs that touch within the project's tolerance.",
       {{"a", "instance, first by name"},
        {"b", "instance"},
        {"gap_mm", "at the point"},
        {"x_mm", "a point of contact"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"bound_mm", "how far facets may be off the exact faces; 0 where these decided"}},
       FromParts | FromTolerance,
       contacts},
      {"interferences",
       "Pairs that are in each other by more than the project's tolerance.",
       {{"a", "instance, first by name"},
        {"b", "instance"},
        {"depth_mm", "at least"},
        {"x_mm", "a point inside both"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"bound_mm", "how far facets may be off the exact faces; 0 where these decided"}},
       FromParts | FromTolerance,
       interferences},
      {"plate_holes",
       "Upright through holes of risers, locators and supports that stand on a base plate.",
       {{"instance", "part"},
        {"hole", "its feature"},
        {"diameter_mm", "of that, at its narrowest"},
        {"plate", "instance"},
        {"plate_hole", "its hole that is nearest"},
        {"off_mm", "from axis to axis, seen from above"}},
       FromParts | FromDesign | FromTolerance,
       plate_holes},
      {"seats",
       "Where touching pairs touch: a row for each plane that they share.",
       {{"a", "instance, first by name"},
        {"b", "instance"},
        {"area_mm2", "shared"},
        {"x_mm", "middle"},
        {"y_mm", ""},
        {"z_mm", ""},
        {"nx", "normal out of a, into b; unit"},
        {"ny", ""},
        {"nz", ""}},
       FromParts | FromTolerance,
       seats},
  };
}

std::vector<FactTable> axis_facts() {
  return {
      {"fastenings",
       "Joints that hold: a row for either side. Threads, screws through bores and slots, press "
       "fits, clamps on the workpiece, mates of kind fix, T-nuts and T-bolts that are pulled up in "
       "their slot. A key that is caught between two slots is held by both, and holds neither.",
       {{"instance", "what is held"},
        {"holder", "what holds it"},
        {"kind", "thread, screw, press, clamp, fix, tee or key"}},
       FromParts | FromMates | FromDesign | FromTolerance,
       fastenings},
      {"fits",
       "Shafts that stand in holes or slotted holes, by where they are.",
       {{"shaft_instance", "whose shaft"},
        {"shaft", "feature"},
        {"hole_instance", "whose hole"},
        {"hole", "feature"},
        {"hole_kind", "hole or slot"},
        {"shaft_mm", "diameter"},
        {"bore_mm", "narrowest diameter of the hole over the common length; slot: width"},
        {"overlap_mm", "common length"},
        {"offset_mm", "of the axes"},
        {"coaxial", "1: on one axis"},
        {"thread_formed", "1: the shaft is in its own core hole"},
        {"engagement_mm", "of that thread"},
        {"past_opening_mm", "by how much the shaft stands out of the hole's opening"},
        {"tip_to_end_mm", "from the screw's tip to the end of the thread; below 0: beyond it"},
        {"through", "1: the hole is open at both ends"},
        {"pitch_mm", "of the shaft's thread; NULL where it has none"},
        {"shaft_thread", "as stated; NULL where nobody does"},
        {"hole_thread", ""},
        {"shaft_fit", "ISO 286 class as stated; NULL where nobody does"},
        {"hole_fit", ""},
        {"least_clearance_um", "by the two classes; below 0: interference. NULL without classes"},
        {"most_clearance_um", ""}},
       FromParts,
       fits},
  };
}

}  // namespace dowel
