#pragma once

#include <array>
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

/// What a slot has beside the fields of every feature.
struct SlotShape {
  enum class Type : std::uint8_t {
    Plain,   ///< groove or pocket with a floor and two walls
    Tee,     ///< T-slot: a throat over a wider undercut
    Through  ///< slotted hole: no floor, both ends round
  };
  /// How it ends along its run.
  enum class End : std::uint8_t {
    Open,  ///< leaves the part, or opens into something wider
    Flat,  ///< a wall across
    Round  ///< a half cylinder as wide as the slot
  };
  Type type = Type::Plain;
  /// Unit vector along the slot, across its direction; of the two towards +x, else +y, else +z.
  Eigen::Vector3d run = Eigen::Vector3d::UnitX();
  double length_mm = 0.0;        ///< along the run as far as both walls reach, round ends included
  std::array<End, 2> ends{};     ///< against the run, along it
  double throat_depth_mm = 0.0;  ///< T-slot: mouth to undercut; else 0
  double undercut_width_mm = 0.0;   ///< T-slot; else 0
  double undercut_height_mm = 0.0;  ///< T-slot: floor to throat; else 0
  std::uint32_t nominal_mm = 0;     ///< T-slot: size by ISO 299 of its throat; 0: none

  bool operator==(const SlotShape&) const = default;
};

/// A named place of an element that something can be mated with. All in the element's frame, mm.
struct Feature {
  std::string name;  ///< unique in its element: "C4", "cb1", "pin1", "top"
  FeatureKind kind = FeatureKind::Hole;
  /// Hole: the centre of its opening. Shaft: the centre of its shoulder end (the end where it grows
  /// out of the part; the lower end by `direction` where both ends are free). Face: its centroid.
  /// Slot: the middle of its mouth, which is as high as the lower of its walls.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Hole, slot: into the material. Shaft: from the shoulder to the free end. Face: outward normal.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double diameter_mm = 0.0;  ///< hole: narrowest cylinder of the bore that a shaft passes; shaft;
                             ///< slot: width of its mouth, the thickest shaft that goes in
  double depth_mm = 0.0;     ///< hole, slot: opening to end; shaft: length
  bool through = false;      ///< hole, slotted hole: open at both ends
  std::string blind_end;     ///< blind hole: "flat", "cone" or "round"; else empty
  std::string entry;         ///< hole, slot: name of the planar face it opens on; may be empty
  std::vector<HoleSegment> segments;  ///< hole: by depth, from the opening
  std::optional<SlotShape> slot;      ///< slot, where it is known
  double area_mm2 = 0.0;              ///< face
  std::string use;  ///< what its maker calls it: "shank", "rest"; empty where nobody says
  std::string
      thread;  ///< hole, shaft: ISO metric thread in or on it: "M12", "M12x1.5"; may be empty
  bool thread_is_guess = false;  ///< nobody states the thread; size and shape make it likely
  std::string fit;  ///< ISO 286 class of its diameter or width as stated: "H7", "g6"; may be empty
  std::vector<std::uint32_t> faces;  ///< faces of the FacetedSolid that make it up, sorted
};

}  // namespace dowel
