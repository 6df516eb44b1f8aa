#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dowel/collision/axis_profile.h"
#include "dowel/collision/core.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Node of the tree over an element's triangles. Its box contains the exact faces of its triangles,
/// not just the facets. Children of an inner node are adjacent.
struct BvhNode {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
  std::uint32_t first = 0;  ///< leaf: first triangle; inner node: left child, the right one is next
  std::uint32_t count = 0;  ///< triangles of a leaf; 0: inner node
  /// A cone that holds the normals of all its facets: its axis, and cosine and sine of the angle
  /// that they spread about it; cosine 0: any.
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float cosine = 0.0F;
  float sine = 1.0F;

  bool is_leaf() const noexcept { return count != 0; }
};

/// The box of a node once more for walks of tree against tree, in lanes of one register: single
/// precision, rounded outwards, about the centre of the root's box.
struct NodeBox {
  static constexpr float kNever = 1e30F;  ///< keeps the last lane out of every maximum of gaps

  alignas(16) std::array<float, 4> center{};
  alignas(16) std::array<float, 4> half{0.0F, 0.0F, 0.0F, kNever};
};

/// How the two triangles at an edge meet. Blend: smoothly, a plane and a face of revolution, along
/// a circle, as at a fillet.
enum class EdgeShape : std::uint8_t { Inner, Convex, Concave, Smooth, Blend };

/// A facet and what is needed to correct it to the exact faces.
struct ModelTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;  ///< unit, outward, of the facet
  std::uint32_t face = 0;
  std::array<std::uint32_t, 3> neighbours{};  ///< face beyond edge i (corner i to i + 1)
  std::array<std::uint32_t, 3> beyond{};      ///< triangle beyond edge i
  std::array<EdgeShape, 3> edges{};           ///< Inner: the same face goes on beyond it
  bool is_hole = false;                       ///< belongs to the wall of a hole
  /// How far the exact boundary can stand off this facet: 0 for a plane that ends in straight
  /// edges, and for a face that is known by its facets alone.
  double slack_mm = 0.0;
  /// The same along the normal alone: 0 for every plane, whose rims are curved in the plane.
  double normal_slack_mm = 0.0;
};

/// A straight edge of a facet that stands for a curved rim.
struct Chord {
  std::uint32_t triangle = 0;
  std::uint32_t edge = 0;
};

/// Where a walk over a face ends, and whether the point walked to is over that facet or its edges.
struct Footing {
  std::uint32_t triangle = 0;
  bool is_over = false;
};

/// A place inside a planar face, and a facet that it is on: where it is in contact is asked first.
struct Seat {
  Eigen::Vector3d point;
  std::uint32_t triangle = 0;
};

/// A plane of the largest planar faces, and its seats: spread over all faces in it.
struct SeatPlane {
  PlaneSurface plane;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Place on the exact boundary that is nearest to some point.
struct NearestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance_mm = 0.0;
  bool inside = false;  ///< the asked point lies in the material
  std::uint32_t triangle = 0;
  bool on_face = false;  ///< in the inside of a face, not on its rim
};

/// An element ready for collision queries: immutable, shared by its instances and by threads. All
/// in the element's frame.
///
/// Point queries answer for the exact faces where these are planes, cylinders, cones, spheres or
/// tori, and for the facets elsewhere. A facet is corrected in two ways: a point of its inside is
/// lifted to the exact surface, and its straight edges are replaced by the curve in which the two
/// exact surfaces meet.
class CollisionModel {
 public:
  static constexpr std::uint32_t kTrianglesPerLeaf = 4;  ///< at most

  /// `hole_faces`: faces that are walls of holes. Throws Error{FileMalformed} where the solid has a
  /// defect (kernel/mesh_defect.h).
  CollisionModel(std::shared_ptr<const FacetedSolid> solid,
                 std::span<const std::uint32_t> hole_faces);

  std::span<const BvhNode> nodes() const noexcept { return nodes_; }
  std::span<const NodeBox> node_boxes() const noexcept { return node_boxes_; }  ///< by node
  std::span<const ModelTriangle> triangles() const noexcept { return triangles_; }
  const Face& face(std::uint32_t index) const { return solid_->faces[index]; }
  std::uint32_t solid_count() const noexcept { return solid_->solid_count; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(solid_->faces.size()); }

  /// Chords of the same face between which and their arcs a part of triangle `index` may lie: there
  /// it overhangs the exact face. Among them can be chords of other triangles.
  std::span<const Chord> overhangs(std::uint32_t index) const noexcept {
    return std::span(overhangs_)
        .subspan(overhang_begin_[index], overhang_begin_[index + 1] - overhang_begin_[index]);
  }

  /// Nearest place of the boundary. Inside or outside follows from the side of the nearest face, or
  /// from the edge's shape; at a corner from what a ray leaves and enters.
  NearestPoint nearest(const Eigen::Vector3d& point) const;

  /// The same where it is nearer than `radius_mm`; nothing elsewhere. Cheap for small radii.
  std::optional<NearestPoint> nearest_within(const Eigen::Vector3d& point, double radius_mm) const;

  /// The triangle that a walk from triangle `start` over inner edges towards `point` leads to: on a
  /// convex face the one that the point is over, if it is no dozen triangles away; `start` where
  /// that is it, or where a rim is in between. For points that slide over a face.
  Footing walk_towards(std::uint32_t start, const Eigen::Vector3d& point) const;

  /// The same by looking at every triangle. Reference for tests.
  NearestPoint nearest_brute_force(const Eigen::Vector3d& point) const;

  /// True where `point` lies inside the facets: a ray in general position leaves the material more
  /// often than it enters it; where eight rays graze an edge the winding number decides.
  bool facets_contain(const Eigen::Vector3d& point) const;

  /// Winding number of the facets about `point`, 1 inside, 0 outside; O(n).
  /// Source: Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983.
  double winding_number(const Eigen::Vector3d& point) const;

  /// A point deep inside each closed component (not of cavities), with its depth.
  struct InnerPoint {
    Eigen::Vector3d point;
    double depth_mm;
  };
  std::span<const InnerPoint> inner_points() const noexcept { return inner_points_; }

  /// Convex pieces of the material.
  const Cores& cores() const noexcept { return cores_; }

  /// Profiles about the axes of the cylinders.
  const AxisProfiles& profiles() const noexcept { return profiles_; }

  /// The planes of the largest planar faces, each once, the largest first.
  std::span<const SeatPlane> seat_planes() const noexcept { return seat_planes_; }
  std::span<const Seat> seats(const SeatPlane& plane) const noexcept {
    return std::span(seats_).subspan(plane.first, plane.count);
  }

  /// Largest slack of the triangles, and largest error of faces known by their facets alone.
  double max_slack_mm() const noexcept { return max_slack_mm_; }
  double max_unknown_mm() const noexcept { return max_unknown_mm_; }

  std::size_t memory_bytes() const;

 private:
  /// Returns how far the exact boundary can stand off each facet along x, y and z.
  std::vector<Eigen::Vector3d> build_triangles(std::span<const std::uint32_t> hole_faces);
  void build_tree(const std::vector<Eigen::Vector3d>& reaches);
  void set_node_boxes();
  void set_cone(BvhNode& node, std::span<const std::uint32_t> triangles) const;
  void find_overhangs();
  void find_inner_points();
  /// Away from the nearest place of the boundary, for as long as that makes it deeper.
  InnerPoint pushed_inwards(InnerPoint from, Eigen::Vector3d boundary, double step_mm) const;
  void find_seat_planes();
  void find_seats(SeatPlane& plane);

  std::shared_ptr<const FacetedSolid> solid_;
  std::vector<BvhNode> nodes_;
  std::vector<NodeBox> node_boxes_;
  std::vector<ModelTriangle> triangles_;
  std::vector<std::uint32_t> component_of_;  // by triangle
  std::vector<Chord> overhangs_;             // by triangle, from overhang_begin_ on
  std::vector<std::uint32_t> overhang_begin_;
  std::vector<InnerPoint> inner_points_;
  std::vector<SeatPlane> seat_planes_;
  std::vector<Seat> seats_;
  AxisProfiles profiles_;
  Cores cores_;
  double max_slack_mm_ = 0.0;
  double max_unknown_mm_ = 0.0;
};

}  // namespace dowel
