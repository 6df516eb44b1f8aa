#pragma once

// Shafts that stand in holes, whatever the mates say. Internal to the rule engine.

#include <string>
#include <vector>

#include "dowel/assembly/project.h"
#include "instance_boxes.h"

namespace dowel {

/// A shaft of one instance that reaches into a hole of another along the same axis, or whose axis
/// is inside of it.
struct AxisPair {
  std::string shaft_instance;
  std::string hole_instance;
  const Feature* shaft = nullptr;
  const Feature* hole = nullptr;
  double offset_mm = 0.0;      ///< of the axes, at the hole
  double overlap_mm = 0.0;     ///< length of the shaft in the hole
  double bore_mm = 0.0;        ///< narrowest cylinder of the hole over that length; slot: its width
  bool is_coaxial = false;     ///< offset within kCoaxial_mm
  bool is_thread = false;      ///< the shaft is in its own core hole
  double engagement_mm = 0.0;  ///< of that thread
  double past_opening_mm = 0.0;  ///< by how much the shaft stands out of the hole's opening
  double tip_to_end_mm = 0.0;  ///< thread: from the shaft's deeper end to the end of the core hole
};

/// Sorted by instances and features. `element_of`: an instance's element; its features are pointed
/// to.
std::vector<AxisPair> axis_pairs(const ProjectState& state, const ElementOf& element_of);

}  // namespace dowel
