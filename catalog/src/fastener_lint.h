#pragma once

#include <span>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"

/// What tables of standard parts are wrong about: misprints that a solid follows faithfully.
namespace dowel {

/// What contradicts itself in an element whose role is "fastener", one sentence each: a head that
/// is not thicker than its shank, a thread that is not the one in the name ("nut-M12"), a hole that
/// a screw of the size in the name does not pass.
std::vector<std::string> fastener_contradictions(const Element& element);

/// A fastener that is smaller somewhere than the one of the next smaller size.
struct SizeFault {
  std::string element;
  std::string message;  ///< one sentence with the numbers
};

/// Faults among `fasteners`. Sizes of one series have names that differ in one number
/// ("screw-M10x30", "screw-M12x30"; the pitch in "M12x1.5" is none); diameters of what is called
/// the same and the sides of the box must not fall as it grows.
std::vector<SizeFault> size_faults(std::span<const Element> fasteners);

}  // namespace dowel
