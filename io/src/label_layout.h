#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dowel {

/// A name that wants to stand at a point of a picture. In pixels, y down.
struct Label {
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius_px = 0.0;  ///< of what it names: the name stands in it or beside it
  bool must_show = true;   ///< else it is left out where there is no room
};

struct PlacedLabel {
  std::size_t label = 0;  ///< index of the label
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double font_px = 0.0;
  bool has_leader = false;  ///< so far from its point that a line must tell where it belongs
};

/// Finds places for names, the first first, so that they cover each other and what others name as
/// little as can be. Crowded pictures get smaller letters. Those that must show are all placed.
std::vector<PlacedLabel> place_labels(std::span<const Label> labels, double width_px,
                                      double height_px);

}  // namespace dowel
