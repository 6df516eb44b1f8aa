#include "dowel/assembly/mate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "dowel/catalog/element.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

[[noreturn]] void refuse_mate(const std::string& message) {
  throw Error(ErrorCode::InvalidInput, message);
}

std::string quoted(const Feature& feature) {
  return "\"" + feature.name + "\"";
}

Eigen::Vector3d far_end(const Feature& feature) {
  return feature.origin + feature.depth_mm * feature.direction;
}

/// Where the moving feature goes: `point_A` onto `target_W`, `direction_A` along `direction_W`.
struct Alignment {
  Eigen::Vector3d point_A;
  Eigen::Vector3d direction_A;
  Eigen::Vector3d target_W;
  Eigen::Vector3d direction_W;
  Eigen::Vector3d away_W;  ///< the way the moving part leaves
};

/// Sense of the axis where a through hole slides over a shaft: +1 with it, -1 against it.
double sliding_sense(const PlacedFeature& hole, const PlacedFeature& shaft, bool flip) {
  if (!hole.feature->through) return 1.0;
  const double sense = hole.direction_W().dot(shaft.direction_W()) >= 0.0 ? 1.0 : -1.0;
  return flip ? -sense : sense;
}

Alignment align(MateKind kind, const PlacedFeature& moving, const PlacedFeature& fixed, bool flip) {
  const Feature& f = *moving.feature;
  const Eigen::Vector3d g_W = fixed.direction_W();
  Alignment result{f.origin, f.direction, fixed.origin_W(), g_W, -g_W};
  switch (kind) {
    case MateKind::ShaftInHole:
      if (flip) {
        result.point_A = far_end(f);
        result.direction_A = -f.direction;
      }
      break;
    case MateKind::HoleOnHole:
      result.point_A = flip ? f.origin : far_end(f);
      if (flip) result.direction_A = -f.direction;
      break;
    case MateKind::BlindHoleOnHole:
      result.direction_W = -g_W;
      break;
    case MateKind::HoleOverShaft: {
      const double sense = sliding_sense(moving, fixed, flip);
      result.point_A = sense > 0.0 ? f.origin : far_end(f);
      result.direction_W = sense * g_W;
      result.away_W = g_W;
      break;
    }
    default: {
      DOWEL_EXPECTS(kind == MateKind::FaceOnFace);
      const Eigen::Vector3d centroid_W = moving.origin_W();
      result.target_W = centroid_W - g_W.dot(centroid_W - fixed.origin_W()) * g_W;
      result.direction_W = -g_W;
      result.away_W = g_W;
      break;
    }
  }
  return result;
}

/// Sense, +1 or -1, of `normal` along `axis`. Throws where the two are not parallel.
double sense_along(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis, const Feature& face,
                   const char* whose) {
  const double off_rad = std::atan2(normal.cross(axis).norm(), std::abs(normal.dot(axis)));
  if (off_rad > kCoaxial_rad) {
    refuse_mate("face " + quoted(face) + " of the " + whose +
                " part is not square to the axis: it is " +
                std::to_string(off_rad * kDegrees_per_rad) + " degrees off");
  }
  return normal.dot(axis) > 0.0 ? 1.0 : -1.0;
}

void check_seat(const SeatFaces& seat, MateKind kind) {
  if (kind == MateKind::FaceOnFace)
    refuse_mate("two faces are a seat of their own: leave out `seat`");
  for (const Feature* face : {seat.moving_face, seat.fixed_face.feature}) {
    if (face->kind != FeatureKind::Face) {
      refuse_mate("a seat needs two faces, but " + quoted(*face) + " is a " +
                  std::string(to_string(face->kind)));
    }
  }
}

void check_flip(MateKind kind, const Feature& moving, bool has_seat) {
  if (has_seat) refuse_mate("the faces of the seat settle the sense: leave out `flip`");
  if (kind == MateKind::FaceOnFace)
    refuse_mate("two faces meet in one sense only: leave out `flip`");
  if (moving.kind == FeatureKind::Hole && !moving.through) {
    refuse_mate("hole " + quoted(moving) + " is blind and has one opening: leave out `flip`");
  }
}

/// A frame on a feature's axis; about the axis it may stand anyhow.
Pose axis_frame(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return frame_on_axis(origin, direction.normalized(), direction.unitOrthogonal());
}

/// Of the moving part and `fixed_body`; holds nothing yet.
Joint free_joint(std::size_t fixed_body) {
  Joint joint;
  joint.b = fixed_body;
  return joint;
}

bool has_axis(const Feature& feature) {
  return feature.kind == FeatureKind::Hole || feature.kind == FeatureKind::Shaft;
}

/// The joints of an `insert` or a seat.
std::vector<Joint> insert_joints(const MateFeatures& mate, const Pose& X_BA) {
  if (mate_kind(*mate.moving, *mate.fixed) != mate.kind) {
    refuse_mate(quoted(*mate.moving) + " and " + quoted(*mate.fixed) + " are not " +
                std::string(to_string(mate.kind)));
  }
  // Over a shaft the sense is read off the present pose, in which a flip has already been made.
  const bool flip = mate.flip && mate.kind != MateKind::HoleOverShaft;
  const Alignment to = align(mate.kind, {mate.moving, X_BA}, {mate.fixed, Pose()}, flip);
  Joint joint = free_joint(1);
  joint.holds_tilt = true;
  joint.X_AF = axis_frame(to.point_A, to.direction_A);
  const bool on_face = mate.kind == MateKind::FaceOnFace;
  const bool has_seat = mate.fixed_face != nullptr;
  joint.holds_slide = {!on_face, !on_face, !has_seat};
  // A face's frame looks out of it, so that what it is off is the gap.
  const Eigen::Vector3d sense = on_face ? Eigen::Vector3d(-to.direction_W) : to.direction_W;
  if (on_face) joint.X_AF = axis_frame(to.point_A, -to.direction_A);
  joint.X_BG = axis_frame(has_seat ? to.target_W : to.target_W + mate.offset_mm * to.away_W, sense);
  if (!has_seat) return {joint};

  Joint seat = free_joint(2);
  seat.X_AF = axis_frame(mate.moving_face->origin, -mate.moving_face->direction);
  seat.X_BG = axis_frame(mate.fixed_face->origin + mate.offset_mm * mate.fixed_face->direction,
                         mate.fixed_face->direction);
  seat.holds_tilt = true;
  seat.holds_slide[2] = true;
  // The face settles the sense of the axis, and C may be a third part: it is read off the present
  // pose, in which the seat has been made. The seat's own tilt tells where that is wrong.
  const Eigen::Vector3d axis_B = X_BA.rotation() * to.direction_A;
  if (axis_B.dot(sense) < 0.0) joint.X_BG = axis_frame(to.target_W, -sense);
  return {joint, seat};
}

Joint align_joint(const MateFeatures& mate) {
  if (!has_axis(*mate.moving) || !has_axis(*mate.fixed)) {
    refuse_mate("align needs two holes or shafts, but " +
                quoted(has_axis(*mate.moving) ? *mate.fixed : *mate.moving) + " is a " +
                std::string(to_string((has_axis(*mate.moving) ? mate.fixed : mate.moving)->kind)));
  }
  Joint joint = free_joint(1);
  joint.X_AF = axis_frame(mate.moving->origin, mate.moving->direction);
  joint.X_BG = axis_frame(mate.fixed->origin, (mate.flip ? -1.0 : 1.0) * mate.fixed->direction);
  joint.holds_tilt = true;
  joint.holds_slide = {true, true, false};
  return joint;
}

Joint angle_joint(const MateFeatures& mate) {
  // Written so that NaN is refused.
  if (!(mate.angle_rad >= 0.0 && mate.angle_rad <= std::numbers::pi)) {
    refuse_mate("an angle between two directions is 0 to 180 degrees");
  }
  Joint joint = free_joint(1);
  joint.X_AF = axis_frame(mate.moving->origin, mate.moving->direction);
  joint.X_BG = axis_frame(mate.fixed->origin, mate.fixed->direction);
  if (std::sin(mate.angle_rad) > kParallel_rad) {
    joint.angle_rad = mate.angle_rad;
    return joint;
  }
  // Parallel is two equations: an angle that cannot be opened has no derivative.
  joint.holds_tilt = true;
  if (mate.angle_rad > 1.0) joint.X_BG = axis_frame(mate.fixed->origin, -mate.fixed->direction);
  return joint;
}

Joint fix_joint(const MateFeatures& mate) {
  Joint joint = free_joint(1);
  joint.X_BG = mate.X_BA_held;
  joint.holds_tilt = true;
  joint.holds_spin = true;
  joint.holds_slide = {true, true, true};
  return joint;
}

/// Two opposite flat sides of a part and the solid between them.
struct Key {
  Eigen::Vector3d across = Eigen::Vector3d::Zero();  ///< unit, from one side to the other
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double width_mm = 0.0;
};

/// The widest key of `element` that stands along unit vector `into` and goes into a slot of
/// `most_mm`; where there is none, the narrowest that does not.
Key find_key(const Element& element, const Eigen::Vector3d& into, double most_mm) {
  Key best;
  const auto is_better = [&](double width_mm) {
    const bool fits = width_mm <= most_mm + kShaftExcess_mm;
    const bool best_fits = best.width_mm <= most_mm + kShaftExcess_mm;
    if (best.width_mm == 0.0) return true;
    if (fits != best_fits) return fits;
    return fits ? width_mm > best.width_mm : width_mm < best.width_mm;
  };
  for (const Feature& side : element.features) {
    if (side.kind != FeatureKind::Face || std::abs(side.direction.dot(into)) > kCoaxial_rad)
      continue;
    for (const Feature& other : element.features) {
      if (other.kind != FeatureKind::Face ||
          (side.direction + other.direction).norm() > kCoaxial_rad) {
        continue;
      }
      const double width_mm = side.direction.dot(side.origin - other.origin);
      if (width_mm <= kCoincident_mm || !is_better(width_mm)) continue;
      best = {side.direction, 0.5 * (side.origin + other.origin), width_mm};
    }
  }
  return best;
}

Joint slot_joint(const MateFeatures& mate) {
  const Feature& key_feature = *mate.moving;
  const Feature& slot = *mate.fixed;
  if (slot.kind != FeatureKind::Slot || !slot.slot || key_feature.kind == FeatureKind::Slot) {
    refuse_mate("expected a face, hole or shaft of the key and a slot, got " +
                std::string(to_string(key_feature.kind)) + " " + quoted(key_feature) + " and " +
                std::string(to_string(slot.kind)) + " " + quoted(slot));
  }
  const Eigen::Vector3d into = key_feature.direction.normalized();
  const Key key = find_key(*mate.moving_element, into, slot.diameter_mm);
  if (key.width_mm == 0.0) {
    refuse_mate("no two opposite flat sides along " + quoted(key_feature) +
                " make a key for slot " + quoted(slot));
  }
  // What has no neck stands in the undercut.
  const bool has_undercut = slot.slot->type == SlotShape::Type::Tee;
  const double most_mm = has_undercut ? slot.slot->undercut_width_mm : slot.diameter_mm;
  if (key.width_mm > most_mm + kShaftExcess_mm) {
    refuse_mate("the key along " + quoted(key_feature) + " is " + std::to_string(key.width_mm) +
                " mm wide and does not go into slot " + quoted(slot) + ", which is " +
                std::to_string(slot.diameter_mm) + " mm wide" +
                (has_undercut ? ", and " + std::to_string(most_mm) + " below its throat" : ""));
  }
  const bool on_floor = key_feature.kind == FeatureKind::Face && !slot.through;
  Joint joint = free_joint(1);
  const Eigen::Vector3d middle =
      key_feature.origin + key.across.dot(key.middle - key_feature.origin) * key.across;
  const Eigen::Vector3d run = (mate.flip ? -1.0 : 1.0) * slot.slot->run;
  joint.X_AF = frame_on_axis(middle, into, key.across.cross(into));
  joint.X_BG = frame_on_axis(
      slot.origin + (on_floor ? slot.depth_mm - mate.offset_mm : 0.0) * slot.direction,
      slot.direction.normalized(), run);
  joint.holds_tilt = true;
  joint.holds_spin = true;
  joint.holds_slide = {false, true, on_floor};
  return joint;
}

}  // namespace

std::string_view to_string(MateKind kind) {
  switch (kind) {
    case MateKind::ShaftInHole:
      return "shaft in hole";
    case MateKind::HoleOnHole:
      return "hole on hole";
    case MateKind::BlindHoleOnHole:
      return "blind hole on hole";
    case MateKind::HoleOverShaft:
      return "hole over shaft";
    case MateKind::FaceOnFace:
      return "face on face";
    case MateKind::Align:
      return "align";
    case MateKind::KeyInSlot:
      return "key in slot";
    case MateKind::Angle:
      return "angle";
    case MateKind::Fix:
      return "fix";
  }
  DOWEL_EXPECTS(false && "a known kind of mate");
  return {};
}

MateKind mate_kind(const Feature& moving, const Feature& fixed) {
  using enum FeatureKind;
  if (moving.kind == Shaft && fixed.kind == Hole) return MateKind::ShaftInHole;
  if (moving.kind == Hole && fixed.kind == Shaft) return MateKind::HoleOverShaft;
  if (moving.kind == Face && fixed.kind == Face) return MateKind::FaceOnFace;
  if (moving.kind == Hole && fixed.kind == Hole) {
    return moving.through ? MateKind::HoleOnHole : MateKind::BlindHoleOnHole;
  }
  refuse_mate(std::string(to_string(moving.kind)) + " " + quoted(moving) + " cannot go into " +
              std::string(to_string(fixed.kind)) + " " + quoted(fixed) +
              ": expected a shaft and a hole, two holes or two faces");
}

MatePlacement place_by_mate(const PlacedFeature& moving, const PlacedFeature& fixed,
                            const std::optional<SeatFaces>& seat, const MateOptions& options) {
  DOWEL_EXPECTS(std::isfinite(options.offset_mm) && std::isfinite(options.rotation_rad));
  const MateKind kind = mate_kind(*moving.feature, *fixed.feature);
  if (options.flip) check_flip(kind, *moving.feature, seat.has_value());

  Alignment to = align(kind, moving, fixed, options.flip);
  Eigen::Vector3d seat_normal_W = Eigen::Vector3d::Zero();
  if (seat) {
    check_seat(*seat, kind);
    seat_normal_W = seat->fixed_face.direction_W();
    const double moving_sense =
        sense_along(seat->moving_face->direction, to.direction_A, *seat->moving_face, "moving");
    const double fixed_sense =
        sense_along(seat_normal_W, fixed.direction_W(), *seat->fixed_face.feature, "fixed");
    to.direction_W = -moving_sense * fixed_sense * fixed.direction_W();
  }

  const Eigen::Quaterniond turn(Eigen::AngleAxisd(options.rotation_rad, to.away_W));
  const Eigen::Quaterniond rotation =
      (turn * nearest_rotation(moving.X_WI.rotation(), to.direction_A, to.direction_W))
          .normalized();
  Eigen::Vector3d translation = to.target_W - rotation * to.point_A;
  if (seat) {
    const Eigen::Vector3d axis_W = fixed.direction_W();
    const Eigen::Vector3d face_W = rotation * seat->moving_face->origin + translation;
    const double gap = seat_normal_W.dot(face_W - seat->fixed_face.origin_W());
    translation += (options.offset_mm - gap) / seat_normal_W.dot(axis_W) * axis_W;
  } else {
    translation += options.offset_mm * to.away_W;
  }
  return {kind, Pose(rotation, translation)};
}

Pose upright_pose(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& up_W, const Pose& X_WR) {
  return {nearest_rotation(X_WR.rotation(), Eigen::Vector3d::UnitZ(), up_W), origin_W};
}

Pose standing_pose(const Feature& bottom, const PlacedFeature& face) {
  const Pose X_WE = upright_pose(face.origin_W(), face.direction_W(), face.X_WI);
  return X_WE * Pose::from_translation(-bottom.origin);
}

std::vector<Joint> mate_joints(const MateFeatures& mate, const Pose& X_BA) {
  DOWEL_EXPECTS(std::isfinite(mate.offset_mm) && std::isfinite(mate.angle_rad));
  switch (mate.kind) {
    case MateKind::Align:
      return {align_joint(mate)};
    case MateKind::KeyInSlot:
      return {slot_joint(mate)};
    case MateKind::Angle:
      return {angle_joint(mate)};
    case MateKind::Fix:
      return {fix_joint(mate)};
    default:
      return insert_joints(mate, X_BA);
  }
}

bool nearest_flip(MateFeatures mate, const Pose& X_BA) {
  DOWEL_EXPECTS(mate.kind == MateKind::Align || mate.kind == MateKind::KeyInSlot);
  mate.flip = false;
  const Joint joint = mate_joints(mate, X_BA).front();
  const Eigen::Quaterniond R_BF = X_BA.rotation() * joint.X_AF.rotation();
  const Eigen::Vector3d axis =
      mate.kind == MateKind::Align ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  return (R_BF * axis).dot(joint.X_BG.rotation() * axis) < 0.0;
}

MateResidual mate_residual(const std::vector<Joint>& joints, const Pose& X_WA, const Pose& X_WB,
                           const Pose& X_WC) {
  MateResidual residual;
  for (const Joint& joint : joints) {
    const JointOff off = joint_off(joint, X_WA, joint.b == 2 ? X_WC : X_WB);
    residual.angle_rad = std::max(residual.angle_rad, off.turn_rad.norm());
    residual.axis_mm = std::max(residual.axis_mm, off.slide_mm.head<2>().norm());
    if (joint.holds_slide[2]) residual.along_mm = off.slide_mm.z();
  }
  return residual;
}

MateResidual mate_residual(const PlacedFeature& moving, const PlacedFeature& fixed,
                           const std::optional<SeatFaces>& seat, const MateOptions& options) {
  MateFeatures mate;
  mate.kind = mate_kind(*moving.feature, *fixed.feature);
  mate.moving = moving.feature;
  mate.fixed = fixed.feature;
  mate.offset_mm = options.offset_mm;
  mate.flip = options.flip;
  if (seat) {
    mate.moving_face = seat->moving_face;
    mate.fixed_face = seat->fixed_face.feature;
  }
  const std::vector<Joint> joints = mate_joints(mate, fixed.X_WI.inverse() * moving.X_WI);
  return mate_residual(joints, moving.X_WI, fixed.X_WI, seat ? seat->fixed_face.X_WI : fixed.X_WI);
}

}  // namespace dowel
