#pragma once

// Parts that stand in slots, whatever the mates say: T-nuts, T-bolts, keys. Internal to the rule
// engine.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dowel/assembly/project.h"
#include "instance_boxes.h"

namespace dowel {

/// A part between the walls of another one's plain slot or T-slot, by its flat sides along the
/// slot. Depths are measured from the slot's mouth.
struct SlotPair {
  std::string instance;       ///< what stands in the slot
  std::string slot_instance;  ///< whose slot
  const Feature* slot = nullptr;
  std::optional<double> width_mm;  ///< over its sides between the walls (T-slot: of the throat)
  double off_mm = 0.0;             ///< of its middle from the slot's
  std::string fit;                 ///< ISO 286 class of these sides as stated; may be empty
  std::optional<double> foot_width_mm;   ///< T-slot: over its sides in the undercut
  std::optional<double> foot_height_mm;  ///< T-slot: of these sides
  std::optional<double> shoulder_mm;     ///< T-slot: its foot is below the throat by this
  double top_mm = 0.0;                   ///< depth of its highest point; below 0: it looks out
  double floor_mm = 0.0;                 ///< from its lowest point to the slot's floor

  std::optional<double> play_mm() const {
    return width_mm ? std::optional(slot->diameter_mm - *width_mm) : std::nullopt;
  }
};

using SolidOf = std::function<std::shared_ptr<const FacetedSolid>(const std::string& element)>;

/// Sorted by instances and slots. `element_of`: an instance's element; its features are pointed to.
std::vector<SlotPair> slot_pairs(const ProjectState& state, const ElementOf& element_of,
                                 const SolidOf& solid_of);

/// Keys, each with the parts in whose slots it stands: two slots that face each other, with a play
/// of 0.1 mm at most.
std::vector<std::pair<std::string, std::string>> keyed_parts(const ProjectState& state,
                                                             const std::vector<SlotPair>& pairs);

}  // namespace dowel
