#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dowel/catalog/feature.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// A stretch of the rim of a planar face.
struct OutlineEdge {
  enum class Type : std::uint8_t {
    Line,
    Arc,   ///< of a circle; a full one where its turn is
    Chord  ///< of a curve that is neither, as long as the facets have it
  };
  Type type = Type::Line;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of an arc
  double radius_mm = 0.0;                            ///< of an arc
  double turn_rad = 0.0;  ///< of an arc, seen from outside: > 0 counter-clockwise, 2 pi: all around
};

/// A closed rim; seen from outside the face is on its left.
using OutlineLoop = std::vector<OutlineEdge>;

/// What bounds a planar face: by lines and circles where the faces around it are exact.
struct FaceOutline {
  OutlineLoop outer;
  std::vector<OutlineLoop> inner;  ///< around what is cut out of it, by position
  /// The whole element is behind its plane: the face lies on the element's convex hull, so that
  /// something flat can be put against it.
  bool on_hull = false;

  /// Of what is between the loops.
  double area_mm2(const Eigen::Vector3d& normal) const;
};

/// Outlines of those of `features` that are planar faces, in their order; an empty one for a face
/// that `solid` does not have or around which its facets do not close. From the facets, which know
/// their exact faces: wanted for one element at a time, and so not kept in the catalogue.
std::vector<FaceOutline> face_outlines(const FacetedSolid& solid,
                                       const std::vector<Feature>& features);

}  // namespace dowel
