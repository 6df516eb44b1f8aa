#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/catalog/feature.h"
#include "dowel/kernel/box.h"

namespace dowel {

/// The paper's classes of element shapes, by what its outer faces are.
enum class ShapeClass : std::uint8_t { Block, Cylinder, BlockCylinder, Compound };

/// What a facet belongs to (the paper's Table 1): a planar face, the curved wall of a hole, or
/// anything else.
enum class FacetClass : std::uint8_t { Plane, Hole, Other };

struct TriangleCounts {
  std::uint32_t total = 0;
  std::uint32_t plane = 0;
  std::uint32_t hole = 0;
  std::uint32_t other = 0;
};

/// Three or more equal holes evenly spaced on a circle of their common opening plane.
struct BoltCircle {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();      ///< in the opening plane
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of the holes, into the material
  double diameter_mm = 0.0;                              ///< of the pitch circle
  double hole_diameter_mm = 0.0;
  std::vector<std::string> holes;  ///< names of the holes, around the circle
};

/// One catalogue entry without its heavy parts (facets, boundary representation), which the
/// catalogue loads on demand. Lengths in mm, all in the element's frame.
struct Element {
  std::string name;          ///< unique in the catalogue: "H40-12/riser-80x80x40"
  std::string family;        ///< what stands before the last '/' of the name; may be empty
  std::string source;        ///< file that it was read from, as given to the build
  std::string sha256;        ///< of that file, lower-case hex
  std::string unit_in_file;  ///< "mm", "inch", "m", …
  std::string licence;
  std::string role;           ///< as stated by its maker: "base plate", "fastener"; may be empty
  std::string description;    ///< one line by its maker; may be empty
  std::string material;       ///< "steel C45"; may be empty
  std::string dimensions_by;  ///< where its dimensions come from: "like ISO 4762"; may be empty
  double density_kg_per_m3 = 0.0;  ///< of its material; 0: not known
  ShapeClass shape = ShapeClass::Compound;
  std::uint32_t solids = 0;
  double volume_mm3 = 0.0;   ///< of the exact solid
  double surface_mm2 = 0.0;  ///< of the exact solid
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  Obb obb;  ///< smallest box found; contains the exact solid, not just its facets
  TriangleCounts triangles;
  double facet_error_mm = 0.0;                  ///< largest over the faces
  std::optional<std::array<double, 3>> colour;  ///< sRGB 0..1
  std::vector<Feature> features;
  std::vector<BoltCircle> bolt_circles;

  /// Mass by volume and density; nothing where the density is not known.
  std::optional<double> mass_kg() const;

  /// The feature called `name`; nothing where there is none.
  const Feature* find_feature(std::string_view feature_name) const;
};

/// "block", "cylinder", "block-cylinder" or "compound".
std::string_view to_string(ShapeClass shape);

/// "hole", "shaft", "face" or "slot".
std::string_view to_string(FeatureKind kind);

/// "cylinder" or "cone".
std::string_view to_string(HoleSegment::Type type);

/// "plain", "tee" or "through".
std::string_view to_string(SlotShape::Type type);

/// "open", "flat" or "round".
std::string_view to_string(SlotShape::End end);

/// First reason why `element` cannot be used as it stands, as one sentence that names the field or
/// feature: a number that is not finite, a negative size, a box whose axes are not orthonormal, a
/// direction that is not of unit length, two features of one name. Nothing where it is sound.
/// Whether its numbers agree with its mesh is another question (see lint.h).
std::optional<std::string> find_defect(const Element& element);

}  // namespace dowel
