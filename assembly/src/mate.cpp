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

/// A half turn about the axis of `X_WA`'s frame that is most nearly square to unit vector `v_W`
/// (made square): of all half turns that reverse `v_W`, one that a person would pick.
Eigen::Quaterniond half_turn(const Eigen::Vector3d& v_W, const Pose& X_WA) {
  const Eigen::Matrix3d axes_W = X_WA.rotation_matrix();
  Eigen::Index squarest = 0;
  (axes_W.transpose() * v_W).cwiseAbs().minCoeff(&squarest);
  Eigen::Vector3d axis = axes_W.col(squarest);
  axis = (axis - axis.dot(v_W) * v_W).normalized();
  return {0.0, axis.x(), axis.y(), axis.z()};
}

/// Shortest rotation that takes unit vector `from` to unit vector `to`, which are not opposite.
Eigen::Quaterniond shortest_arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Quaterniond arc;
  arc.w() = 1.0 + from.dot(to);
  arc.vec() = from.cross(to);
  return arc.normalized();
}

/// The rotation nearest to A's present one that gives direction `d_A` of A the direction `d_W`.
Eigen::Quaterniond nearest_rotation(const Pose& X_WA, const Eigen::Vector3d& d_A,
                                    const Eigen::Vector3d& d_W) {
  Eigen::Quaterniond rotation = X_WA.rotation();
  const Eigen::Vector3d present = (rotation * d_A).normalized();
  const bool opposite = present.dot(d_W) < 0.0 && present.cross(d_W).norm() < kParallel_rad;
  if (opposite) rotation = half_turn(present, X_WA) * rotation;
  // Twice: what the first leaves near the opposite direction, the second takes away.
  for (int pass = 0; pass < 2; ++pass) {
    rotation = (shortest_arc((rotation * d_A).normalized(), d_W) * rotation).normalized();
  }
  return rotation;
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
    case MateKind::FaceOnFace: {
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

void check_seat(const Seat& seat, MateKind kind) {
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
                            const std::optional<Seat>& seat, const MateOptions& options) {
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
      (turn * nearest_rotation(moving.X_WI, to.direction_A, to.direction_W)).normalized();
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
  return {nearest_rotation(X_WR, Eigen::Vector3d::UnitZ(), up_W), origin_W};
}

Pose standing_pose(const Feature& bottom, const PlacedFeature& face) {
  const Pose X_WE = upright_pose(face.origin_W(), face.direction_W(), face.X_WI);
  return X_WE * Pose::from_translation(-bottom.origin);
}

MateResidual mate_residual(const PlacedFeature& moving, const PlacedFeature& fixed,
                           const std::optional<Seat>& seat, const MateOptions& options) {
  const MateKind kind = mate_kind(*moving.feature, *fixed.feature);
  // Over a shaft the sense is read off the present pose, in which a flip has already been made.
  const bool flip = options.flip && kind != MateKind::HoleOverShaft;
  const Alignment to = align(kind, moving, fixed, flip);
  const Eigen::Vector3d axis_W = fixed.direction_W();
  const Eigen::Vector3d direction_W = moving.X_WI.rotation() * to.direction_A;
  const Eigen::Vector3d off_W = moving.X_WI * to.point_A - to.target_W;

  MateResidual residual;
  residual.along_mm = off_W.dot(to.away_W) - options.offset_mm;
  // A seat settles the sense itself; without one, the sense is the mate's.
  const double cosine = seat ? std::abs(direction_W.dot(axis_W)) : direction_W.dot(to.direction_W);
  residual.angle_rad = std::atan2(direction_W.cross(axis_W).norm(), cosine);
  if (kind != MateKind::FaceOnFace) {
    residual.axis_mm = (off_W - off_W.dot(axis_W) * axis_W).norm();
  }
  if (seat) {
    const Eigen::Vector3d normal_W = seat->fixed_face.direction_W();
    const Eigen::Vector3d face_W = moving.X_WI * seat->moving_face->origin;
    residual.along_mm = normal_W.dot(face_W - seat->fixed_face.origin_W()) - options.offset_mm;
    const Eigen::Vector3d moving_normal_W = moving.X_WI.rotation() * seat->moving_face->direction;
    residual.angle_rad = std::max(
        residual.angle_rad,
        std::atan2(moving_normal_W.cross(normal_W).norm(), -moving_normal_W.dot(normal_W)));
  }
  return residual;
}

}  // namespace dowel
