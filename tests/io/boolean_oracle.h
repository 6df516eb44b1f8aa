#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Bnd_OBB.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax3.hxx>
#include <gp_Trsf.hxx>

#include "occt.h"

/// What OpenCascade knows of two exact solids that may overlap.
namespace dowel::testing {

inline gp_Pnt to_pnt(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

inline double volume_of_mm3(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

struct Nearest {
  double distance_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

/// 0 where solids overlap; no value where OpenCascade does not know.
inline std::optional<Nearest> nearest(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  const BRepExtrema_DistShapeShape extrema(a, b);
  if (!extrema.IsDone() || extrema.NbSolution() == 0) return std::nullopt;
  return Nearest{extrema.Value(), to_eigen(extrema.PointOnShape1(1)),
                 to_eigen(extrema.PointOnShape2(1))};
}

/// Whether `point` lies in `solid` or within `slack_mm` of its boundary.
inline bool is_on_or_in(const TopoDS_Shape& solid, const Eigen::Vector3d& point, double slack_mm) {
  const BRepClass3d_SolidClassifier classifier(solid, to_pnt(point), slack_mm);
  return classifier.State() == TopAbs_IN || classifier.State() == TopAbs_ON;
}

/// Depth of points: distance from the boundary, positive inside.
class DepthOracle {
 public:
  explicit DepthOracle(const TopoDS_Shape& solid) : classifier_(solid), solid_(solid) {
    for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next()) {
      shells_.push_back(it.Current());
    }
  }

  struct Depth {
    double depth_mm = -std::numeric_limits<double>::infinity();
    Eigen::Vector3d boundary = Eigen::Vector3d::Zero();  ///< nearest place
  };
  Depth operator()(const Eigen::Vector3d& point) {
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(to_pnt(point)).Vertex();
    Depth result;
    double distance_mm = std::numeric_limits<double>::infinity();
    for (const TopoDS_Shape& shell : shells_) {
      const std::optional<Nearest> found = nearest(vertex, shell);
      if (!found || found->distance_mm >= distance_mm) continue;
      distance_mm = found->distance_mm;
      result.boundary = found->b;
    }
    result.depth_mm = contains(point) ? distance_mm : -distance_mm;
    return result;
  }

  bool contains(const Eigen::Vector3d& point) {
    classifier_.Perform(to_pnt(point), 1e-9);
    return classifier_.State() == TopAbs_IN;
  }

 private:
  BRepClass3d_SolidClassifier classifier_;
  TopoDS_Shape solid_;
  std::vector<TopoDS_Shape> shells_;
};

/// Largest extent of `shape` along `direction`; may be over the true one, never under.
inline double width_mm(const TopoDS_Shape& shape, const gp_Dir& direction) {
  gp_Trsf turn;
  turn.SetTransformation(gp_Ax3(gp_Pnt(0, 0, 0), direction));
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape.Moved(TopLoc_Location(turn)), box, Standard_False, Standard_False);
  return box.CornerMax().Z() - box.CornerMin().Z();
}

/// The overlap of two solids, in the frame that both shapes are placed in.
class Overlap {
 public:
  Overlap(const TopoDS_Shape& a, const TopoDS_Shape& b) : depth_a_(a), depth_b_(b) {
    BRepAlgoAPI_Common common(a, b);
    is_known_ = common.IsDone() && !common.HasErrors();
    if (!is_known_) return;
    for (TopExp_Explorer it(common.Shape(), TopAbs_SOLID); it.More(); it.Next()) {
      const double volume_mm3 = volume_of_mm3(it.Current());
      if (volume_mm3 > 0.0) pieces_.push_back({it.Current(), volume_mm3});
      volume_mm3_ += std::max(volume_mm3, 0.0);
    }
  }

  bool is_known() const { return is_known_; }
  double volume_mm3() const { return volume_mm3_; }

  /// Diameter of the largest ball about `point` in both solids; negative outside.
  double ball_at_mm(const Eigen::Vector3d& point) {
    return 2.0 * std::min(depth_a_(point).depth_mm, depth_b_(point).depth_mm);
  }

  /// Diameter of a ball that fits into both; looks no further once it is `enough_mm`.
  double ball_mm(double enough_mm) {
    double best_mm = 0.0;
    for (const Piece& piece : pieces_) {
      for (const Eigen::Vector3d& start : starts(piece.solid, enough_mm)) {
        const Ball ball = climbed(start, enough_mm);
        if (ball.diameter_mm > best_mm && holds(ball)) best_mm = ball.diameter_mm;
        if (best_mm >= enough_mm) return best_mm;
      }
    }
    return best_mm;
  }

  /// No ball in both is of larger diameter: one in a piece is no larger than the piece's volume
  /// allows, nor than the piece is wide in any direction.
  double ball_limit_mm() const {
    double result_mm = 0.0;
    for (const Piece& piece : pieces_) {
      double limit_mm = std::cbrt(6.0 * piece.volume_mm3 / std::numbers::pi);
      Bnd_OBB box;
      BRepBndLib::AddOBB(piece.solid, box, Standard_False, Standard_True, Standard_False);
      std::vector<gp_Dir> directions{gp_Dir(box.XDirection()), gp_Dir(box.YDirection()),
                                     gp_Dir(box.ZDirection())};
      for (TopExp_Explorer it(piece.solid, TopAbs_FACE); it.More(); it.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(it.Current()));
        if (surface.GetType() != GeomAbs_Plane) continue;
        directions.push_back(surface.Plane().Axis().Direction());
      }
      for (const gp_Dir& direction : directions) {
        limit_mm = std::min(limit_mm, width_mm(piece.solid, direction));
      }
      result_mm = std::max(result_mm, limit_mm);
    }
    return result_mm;
  }

 private:
  struct Piece {
    TopoDS_Shape solid;
    double volume_mm3 = 0.0;
  };

  /// The middle, and points under the middles of the faces.
  static std::vector<Eigen::Vector3d> starts(const TopoDS_Shape& solid, double ball_mm) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(solid, properties);
    std::vector<Eigen::Vector3d> result{to_eigen(properties.CentreOfMass())};
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
      const TopoDS_Face& face = TopoDS::Face(it.Current());
      const BRepAdaptor_Surface surface(face);
      BRepTopAdaptor_FClass2d inside(face, 1e-9);
      double low_u = 0.0, high_u = 0.0, low_v = 0.0, high_v = 0.0;
      BRepTools::UVBounds(face, low_u, high_u, low_v, high_v);
      for (const double s : {0.5, 0.2, 0.8}) {
        for (const double t : {0.5, 0.2, 0.8}) {
          const double u = low_u + s * (high_u - low_u);
          const double v = low_v + t * (high_v - low_v);
          if (inside.Perform(gp_Pnt2d(u, v)) != TopAbs_IN) continue;
          gp_Pnt point;
          gp_Vec along_u, along_v;
          surface.D1(u, v, point, along_u, along_v);
          gp_Vec normal = along_u.Crossed(along_v);
          if (normal.Magnitude() <= 0.0) continue;
          if (face.Orientation() != TopAbs_REVERSED) normal.Reverse();
          result.push_back(to_eigen(point) + 0.5 * ball_mm * to_eigen(normal.Normalized()));
          if (s == 0.5 && t == 0.5) break;
        }
      }
    }
    return result;
  }

  struct Ball {
    Eigen::Vector3d center;
    double diameter_mm = 0.0;
  };

  /// Whether places all around on the ball lie in both solids: a distance may have missed a face.
  bool holds(const Ball& ball) {
    constexpr int kPlaces = 64;
    constexpr double kGoldenAngle_rad = 2.399963229728653;
    constexpr double kAlmost = 0.98;
    for (int i = 0; i < kPlaces; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / kPlaces;
      const double across = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d direction(across * std::cos(i * kGoldenAngle_rad),
                                      across * std::sin(i * kGoldenAngle_rad), z);
      const Eigen::Vector3d place = ball.center + kAlmost * 0.5 * ball.diameter_mm * direction;
      if (!depth_a_.contains(place) || !depth_b_.contains(place)) return false;
    }
    return true;
  }

  /// Away from the nearest boundary, for as long as that makes the ball larger.
  Ball climbed(Eigen::Vector3d point, double enough_mm) {
    const auto at = [this](const Eigen::Vector3d& p) {
      const DepthOracle::Depth a = depth_a_(p);
      const DepthOracle::Depth b = depth_b_(p);
      return a.depth_mm < b.depth_mm ? a : b;
    };
    DepthOracle::Depth best = at(point);
    double step_mm = 0.5 * enough_mm;
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps && 2.0 * best.depth_mm < enough_mm; ++i) {
      Eigen::Vector3d away = point - best.boundary;
      if (best.depth_mm < 0.0) away = -away;
      if (away.norm() == 0.0) break;
      const Eigen::Vector3d next = point + step_mm * away.normalized();
      const DepthOracle::Depth there = at(next);
      if (there.depth_mm > best.depth_mm) {
        point = next;
        best = there;
      } else {
        step_mm *= 0.5;
      }
    }
    return {point, 2.0 * best.depth_mm};
  }

  DepthOracle depth_a_;
  DepthOracle depth_b_;
  bool is_known_ = false;
  std::vector<Piece> pieces_;
  double volume_mm3_ = 0.0;
};

}  // namespace dowel::testing
