#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dowel {

enum class FeatureKind : std::uint8_t { Hole, Shaft, Face, Slot };

/// Stretch of one surface along a hole's axis; depths in mm from the opening along the direction.
struct HoleSegment {
  enum class Type : std::uint8_t { Cylinder, Cone };
  Type type = Type::Cylinder;
  double diameter_mm = 0.0;      ///< at `from_mm`
  double diameter_end_mm = 0.0;  ///< at `to_mm`; equals diameter_mm for a cylinder
  double from_mm = 0.0;
  double to_mm = 0.0;

  bool operator==(const HoleSegment&) const = default;
};

/// A named place of an element that something can be mated with. All in the element's frame, mm.
struct Feature {
  std::string name;  ///< unique in its element: "C4", "cb1", "pin1", "top"
  FeatureKind kind = FeatureKind::Hole;
  /// Hole: the centre of its opening. Shaft: the centre of its shoulder end (the end where it grows
  /// out of the part; the lower end by `direction` where both ends are free). Face: its centroid.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Hole: into the material. Shaft: from the shoulder to the free end. Face: outward normal.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double diameter_mm = 0.0;  ///< hole: narrowest cylinder of the bore that a shaft passes; shaft
  double depth_mm = 0.0;     ///< hole: opening to end; shaft: length
  bool through = false;      ///< hole: open at both ends
  std::string blind_end;     ///< blind hole: "flat", "cone" or "round"; else empty
  std::string entry;         ///< hole: name of the planar face it opens on; may be empty
  std::vector<HoleSegment> segments;  ///< hole: by depth, from the opening
  double area_mm2 = 0.0;              ///< face
  std::vector<std::uint32_t> faces;   ///< faces of the FacetedSolid that make it up, sorted
};

}  // namespace dowel
