#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "dowel/assembly/joint.h"
#include "dowel/catalog/element.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// What goes with what. The first named moves, the second stays.
///
/// | kind            | axes            | along the axis                                     |
/// |-----------------|-----------------|----------------------------------------------------|
/// | ShaftInHole     | same sense      | shoulder at the opening                            |
/// | HoleOnHole      | same sense      | far end of the through hole at the other's opening |
/// | BlindHoleOnHole | opposite sense  | opening on opening                                 |
/// | HoleOverShaft   | see below       | the hole's end next to the shoulder stands on it   |
/// | FaceOnFace      | opposite sense  | planes coincide; nothing moves in the plane        |
/// | Align           | either sense    | free                                               |
/// | KeyInSlot       | into the slot   | a face: on the floor; a hole or shaft: free         |
/// | Angle           | at an angle     | free                                               |
/// | Fix             | all of A is held as it stands to B                                    ||
///
/// The first four are what `insert` makes of two features, FaceOnFace is a seat. Align is for the
/// second hole of a pattern. A key is the part of A between two opposite flat faces, the widest
/// that go in between the walls of the slot, or else of a T-slot's undercut; it stands in its
/// middle, along its run.
///
/// A through hole slides over a shaft in the sense that turns the part least; a blind one with its
/// opening first.
enum class MateKind {
  ShaftInHole,
  HoleOnHole,
  BlindHoleOnHole,
  HoleOverShaft,
  FaceOnFace,
  Align,
  KeyInSlot,
  Angle,
  Fix
};

/// "shaft in hole", "hole on hole", "blind hole on hole", "hole over shaft", "face on face",
/// "align", "key in slot", "angle", "fix".
std::string_view to_string(MateKind kind);

/// A feature and the pose of the instance that it belongs to.
struct PlacedFeature {
  const Feature* feature = nullptr;  ///< in the instance's frame
  Pose X_WI;

  Eigen::Vector3d origin_W() const { return X_WI * feature->origin; }
  Eigen::Vector3d direction_W() const { return X_WI.rotation() * feature->direction; }
};

/// Two planar faces, of the moving part and of any other, that take over the place along the axis:
/// their planes coincide and their normals are opposite, which also settles the sense of the axis.
struct SeatFaces {
  const Feature* moving_face = nullptr;  ///< in the moving instance's frame
  PlacedFeature fixed_face;
};

struct MateOptions {
  /// Lifts the moving part off again by this much, against the way it came in (with a seat: along
  /// the fixed face's normal).
  double offset_mm = 0.0;
  /// Turns it further, counter-clockwise for one who looks at the fixed part from where the moving
  /// one came.
  double rotation_rad = 0.0;
  /// Takes the moving feature from its other end. Not with a seat, blind holes or faces.
  bool flip = false;
};

/// Where the moving instance ends up.
struct MatePlacement {
  MateKind kind = MateKind::ShaftInHole;
  Pose X_WA;
};

/// The kind of mate of a moving and a fixed feature. Throws Error{InvalidInput} where there is none
/// (a shaft in a shaft, a face in a hole).
MateKind mate_kind(const Feature& moving, const Feature& fixed);

/// Places instance A by closed form so that its feature `moving` mates with `fixed`. Of all turns
/// about the axis it takes the one nearest to A's present orientation, then adds
/// `options.rotation_rad`. Construction: rounded, within a few ulp of the coordinates.
/// Throws Error{InvalidInput}: no such mate, a seat whose faces are not square to the axis, a seat
/// or flip that does not apply. Diameters are not looked at; see `fit_on_axis`.
MatePlacement place_by_mate(const PlacedFeature& moving, const PlacedFeature& fixed,
                            const std::optional<SeatFaces>& seat, const MateOptions& options);

/// The pose at `origin_W` whose z axis is unit vector `up_W`, turned about it so that it is as near
/// as can be to the orientation of `X_WR`.
Pose upright_pose(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& up_W, const Pose& X_WR);

/// Where an element stands with its face `bottom` (in its own frame, looking down: against z) on
/// the placed face: the planes coincide, normals are opposite, centroid is on centroid, and it is
/// turned as little as can be against the part it stands on.
Pose standing_pose(const Feature& bottom, const PlacedFeature& face);

/// A mate with the features that it names, in the frames of the parts A (that moves) and B.
struct MateFeatures {
  MateKind kind = MateKind::ShaftInHole;
  const Element* moving_element = nullptr;  ///< KeyInSlot: has the key
  const Feature* moving = nullptr;          ///< none: Fix
  const Feature* fixed = nullptr;
  const Feature* moving_face = nullptr;  ///< of a seat beside an axis; else none
  const Feature* fixed_face = nullptr;   ///< of B or of a third part C
  double offset_mm = 0.0;
  double angle_rad = 0.0;  ///< Angle: between the directions, 0 to pi
  /// From its other end; Align, KeyInSlot: axes, or runs, of opposite sense.
  bool flip = false;
  Pose X_BA_held;  ///< Fix
};

/// What the mate asks, as joints of A (body 0) with B (body 1) and, of a seat beside an axis, with
/// C (body 2). `X_BA`: where A stands now; it settles the sense of a through hole over a shaft.
/// Throws Error{InvalidInput}: features that the kind does not go with, no key that fits the slot.
std::vector<Joint> mate_joints(const MateFeatures& mate, const Pose& X_BA);

/// `flip` of an Align or KeyInSlot such that A turns least. Throws as `mate_joints` does.
bool nearest_flip(MateFeatures mate, const Pose& X_BA);

/// How far two mated features are off each other now.
struct MateResidual {
  double axis_mm = 0.0;    ///< between the axes, at the moving feature; 0 for faces
  double angle_rad = 0.0;  ///< by which directions are off, sense included
  double along_mm = 0.0;   ///< gap along the axis or normal less the offset that was asked for
};

/// By the joints of a mate, at the poses of A, B and C (that of B where there is no C).
MateResidual mate_residual(const std::vector<Joint>& joints, const Pose& X_WA, const Pose& X_WB,
                           const Pose& X_WC);

/// `offset_mm` and `flip` as the mate was made with.
MateResidual mate_residual(const PlacedFeature& moving, const PlacedFeature& fixed,
                           const std::optional<SeatFaces>& seat, const MateOptions& options);

}  // namespace dowel
