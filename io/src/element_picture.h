#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Two opposite corners, from which all six sides can be seen, and the plan.
enum class SeenFrom : std::uint8_t {
  FrontRightTop,   ///< shows front, right and top
  BackLeftBottom,  ///< shows back, left and bottom
  Top              ///< against z, y up: shows many holes without crowding
};

/// Where a feature shows in a picture. In pixels, y down.
struct FeatureMark {
  std::size_t feature = 0;  ///< index into the element's features
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius_px = 0.0;  ///< of the hole's mouth or the shaft's end; 0 for faces and slots
};

/// Shaded picture of an element with the walls of its features coloured by kind.
struct ElementPicture {
  std::vector<std::byte> png;
  std::vector<FeatureMark> marks;  ///< of the features that can be seen, in the element's order
};

/// Whether the feature turns towards a viewer who stands there. It may be hidden all the same.
bool faces_viewer(const Feature& feature, SeenFrom from);

/// What a feature is drawn and listed in: "#rrggbb". Threads, stated or likely, have a colour of
/// their own, whatever they are cut in.
std::string feature_colour(const Feature& feature);

/// Parallel projection that fills the picture. Same input, same bytes.
/// Expects: `solid` is the element's, with indices in range; neither side of the picture 0.
ElementPicture draw_element(const Element& element, const FacetedSolid& solid, SeenFrom from,
                            std::uint32_t width_px, std::uint32_t height_px);

}  // namespace dowel
