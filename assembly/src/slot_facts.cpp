// Facts about what stands in slots.

#include <algorithm>
#include <cmath>

#include "dowel/kernel/tolerance.h"
#include "fact_source.h"

namespace dowel {
namespace {

FactValue number_or_null(const std::optional<double>& value) {
  return value ? FactValue(*value) : FactValue();
}

FactRows slot_fits(FactSource& source) {
  FactRows rows;
  for (const SlotPair& pair : source.slots()) {
    const Feature& slot = *pair.slot;
    const bool is_tee = slot.slot->type == SlotShape::Type::Tee;
    const Eigen::Vector3d into_W =
        source.state().find(pair.slot_instance)->X_WI.rotation() * slot.direction;
    const auto of_tee = [&](double value) { return is_tee ? FactValue(value) : FactValue(); };
    rows.push_back({pair.instance,
                    pair.slot_instance,
                    slot.name,
                    truth(is_tee),
                    slot.diameter_mm,
                    number_or_null(pair.width_mm),
                    number_or_null(pair.play_mm()),
                    pair.off_mm,
                    text_or_null(pair.fit),
                    text_or_null(slot.fit),
                    number_or_null(pair.foot_width_mm),
                    number_or_null(pair.foot_height_mm),
                    of_tee(slot.slot->undercut_width_mm),
                    of_tee(slot.slot->undercut_height_mm),
                    number_or_null(pair.shoulder_mm),
                    -pair.top_mm,
                    pair.floor_mm,
                    into_W.x(),
                    into_W.y(),
                    into_W.z()});
  }
  return rows;
}

bool is_upright(const Eigen::Vector3d& axis_W) {
  return std::abs(axis_W.z()) > 1.0 - kCoaxial_rad;
}

/// A row for each upright through hole of a part, with the upright slot of the plate whose middle
/// is nearest.
void add_plate_slots(FactSource& source, const Instance& part, const Instance& plate,
                     FactRows& rows) {
  const Role role = source.role(part);
  if (role != Role::Riser && role != Role::Locator && role != Role::Support) return;
  for (const Feature& bore : source.element(part).features) {
    if (bore.kind != FeatureKind::Hole || !bore.through ||
        !is_upright(part.X_WI.rotation() * bore.direction)) {
      continue;
    }
    const Eigen::Vector3d at = plate.X_WI.inverse() * (part.X_WI * bore.origin);
    const Feature* nearest = nullptr;
    double off_mm = 0.0;
    for (const Feature& slot : source.element(plate).features) {
      if (slot.kind != FeatureKind::Slot || !slot.slot ||
          !is_upright(plate.X_WI.rotation() * slot.direction)) {
        continue;
      }
      const Eigen::Vector3d across = slot.direction.cross(slot.slot->run);
      const double to_slot_mm = std::abs(across.dot(at - slot.origin));
      if (nearest != nullptr && to_slot_mm >= off_mm) continue;
      nearest = &slot;
      off_mm = to_slot_mm;
    }
    if (nearest == nullptr) continue;
    rows.push_back({part.name, bore.name, plate.name, nearest->name, off_mm});
  }
}

FactRows plate_slots(FactSource& source) {
  FactRows rows;
  for (const Touch& touch : source.touches()) {
    if (touch.pair.verdict != Verdict::Contact) continue;
    const Instance& a = *source.state().find(touch.instance);
    const Instance& b = *source.state().find(touch.with);
    if (source.role(a) == Role::BasePlate) add_plate_slots(source, b, a, rows);
    if (source.role(b) == Role::BasePlate) add_plate_slots(source, a, b, rows);
  }
  std::ranges::sort(rows);
  return rows;
}

}  // namespace

std::vector<FactTable> slot_facts() {
  return {{"plate_slots",
           "Upright through holes of risers, locators and supports that stand on a base plate with "
           "slots.",
           {{"instance", "part"},
            {"hole", "its feature"},
            {"plate", "instance"},
            {"slot", "its slot whose middle is nearest"},
            {"off_mm", "from the hole's axis to that, seen from above"}},
           FromParts | FromDesign | FromTolerance,
           plate_slots},
          {"slot_fits",
           "Parts with flat sides that stand in plain slots or T-slots: T-nuts, T-bolts, keys.",
           {{"instance", "what stands in the slot"},
            {"slot_instance", "whose slot"},
            {"slot", "feature"},
            {"tee", "1: a T-slot"},
            {"slot_mm", "width between the walls; T-slot: of its throat"},
            {"width_mm", "of the part there; NULL where it is in the undercut alone"},
            {"play_mm", "slot less part, as drawn; NULL as before"},
            {"off_mm", "of its middle from the slot's"},
            {"fit", "ISO 286 class of the part's sides; NULL where nobody says"},
            {"slot_fit", ""},
            {"foot_width_mm", "of the part in the undercut; NULL where it has no foot there"},
            {"foot_height_mm", ""},
            {"undercut_width_mm", "of the T-slot; NULL of others"},
            {"undercut_height_mm", ""},
            {"shoulder_mm", "by how much the foot is below the throat; NULL where there is none"},
            {"out_mm", "by how much the part looks out of the slot; below 0: not at all"},
            {"floor_mm", "from its lowest point to the slot's floor"},
            {"dx", "into the slot; unit"},
            {"dy", ""},
            {"dz", ""}},
           FromParts,
           slot_fits}};
}

}  // namespace dowel
