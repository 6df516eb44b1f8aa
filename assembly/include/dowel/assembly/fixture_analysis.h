#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/fixture_design.h"
#include "dowel/assembly/locating.h"
#include "dowel/assembly/restraint.h"
#include "dowel/assembly/session.h"

namespace dowel {

/// A place where something touches the workpiece. World frame.
struct WorkpieceContact {
  std::string instance;  ///< what touches it
  Role role = Role::Other;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, into the workpiece
  double area_mm2 = 0.0;                              ///< 0: along a line or at a point
  std::vector<Eigen::Vector3d> corners;               ///< of the hull of the area
};

/// A pin of a locator in a hole of the workpiece. World frame.
struct WorkpiecePin {
  std::string instance;
  std::string shaft;  ///< feature of the instance
  std::string hole;   ///< feature of the workpiece
  bool is_diamond = false;
  double hole_mm = 0.0;                             ///< diameter of the hole
  double pin_mm = 0.0;                              ///< of the pin, where it stops the hole
  double length_mm = 0.0;                           ///< of the pin
  double engagement_mm = 0.0;                       ///< of it in the hole
  Eigen::Vector3d at = Eigen::Vector3d::Zero();     ///< in the middle of that
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, into the workpiece's hole
  std::vector<Eigen::Vector3d> normals;             ///< unit: ways in which it stops the workpiece
};

/// The workpiece and all that touches it: what the analysis and the rules reckon with.
struct FixtureModel {
  std::string workpiece;
  LocatingFrame frame;
  std::optional<double> mass_kg;  ///< nothing where its density is not known
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  std::vector<WorkpieceContact> contacts;  ///< by instance
  std::vector<WorkpiecePin> pins;          ///< by instance
  /// Contacts with what is rigid and not a clamp. An area wider than half of `frame.length_mm`
  /// counts as two or three points, as far apart as it is wide.
  std::vector<LocatingPoint> locators;
};

/// What an instance is for: what the project says, else what the catalogue does.
Role fixture_role(const ProjectState& state, const Instance& instance, const Element& element);

/// True for what settles where the workpiece is when it touches it.
bool is_locating(Role role);

/// Standard gravity, which points down, against z.
inline constexpr double kGravity_m_per_s2 = 9.80665;

/// Weight of the workpiece as a wrench; zero where its mass is not known.
Wrench weight_of(const FixtureModel& model);

/// Clamp forces of the design as a wrench: each along the normals of the contacts of its clamp, in
/// equal shares.
Wrench clamping_of(const FixtureModel& model, const FixtureDesign& design);

/// All contacts with the friction of the design; clamps without a force are left out.
std::vector<FrictionContact> friction_contacts(const FixtureModel& model,
                                               const FixtureDesign& design);

/// Supports under the workpiece (their normals point up within 45 degrees), seen from above.
std::vector<Eigen::Vector2d> support_points(const FixtureModel& model);

/// Errors of the locators, and what they make of one of the design's points.
struct PointAnalysis {
  std::string name;
  CriticalPoint point;
  PositionError error;
};

struct LoadAnalysis {
  std::string name;
  Load load;
  bool holds = false;       ///< with the factor `safety`
  double residual_N = 0.0;  ///< unbalanced at that factor
  double factor = 0.0;      ///< the largest that holds, up to 100
};

/// A way in which the workpiece comes out.
struct UnloadAnalysis {
  bool is_free = false;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double lift_mm = 0.0;     ///< as far as it was tried
  std::string blocked_by;   ///< the first thing in the way along the best direction
  double free_share = 0.0;  ///< of the way along it
};

/// The workpiece put in turned, as nobody should.
struct WrongOrientation {
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< unit; through the middle of its box
  double angle_rad = 0.0;
  bool seats = false;   ///< on all locators, clear of everything
  Pose X_WI;            ///< where it ends
  std::string against;  ///< what it is in, or which locator it does not reach; empty where it seats
};

/// Quarter, third and half turns of the workpiece about the axes of its box, 23 in all: pushed
/// towards the locators, none should seat. Nothing is tried below rank 6.
struct FoolproofAnalysis {
  std::vector<WrongOrientation> wrong;
  std::size_t same = 0;  ///< orientations in which it looks as it does
  bool is_foolproof() const;
};

/// Whether a wrench reaches a screw or nut, and whether that gets to its place at all.
struct WrenchAccess {
  std::string fastener;
  std::string wrench;             ///< "hex key 10", "socket 18"
  bool before_workpiece = false;  ///< it is tightened before the workpiece and its clamps are there
  bool is_free = false;           ///< the wrench goes onto it, straight along its axis
  std::string blocked_by;         ///< the first thing in its way; empty where there is none
  double lever_mm = 0.0;
  double swing_rad = 0.0;        ///< the widest angle through which the lever turns freely
  std::optional<bool> comes_in;  ///< a screw comes to its place along its axis; nuts: not told
  std::string stopped_by;        ///< empty where it comes in
};

struct FixtureAnalysis {
  FixtureModel model;
  Locating locating;
  std::vector<PointAnalysis> points;
  std::optional<Seating> seating;  ///< nothing without clamp forces, or below rank 6
  std::vector<LoadAnalysis> loads;
  bool has_form_closure = false;
  double support_area_mm2 = 0.0;
  double support_margin_mm = 0.0;  ///< of the centre of mass; negative outside
  UnloadAnalysis unloading;
  FoolproofAnalysis foolproof;
  std::vector<WrenchAccess> wrenches;  ///< by fastener
};

/// The workpiece of the project and its contacts. Throws Error{InvalidInput} where there is not
/// exactly one workpiece.
FixtureModel fixture_model(Session& session);

/// Everything at once. Throws as fixture_model.
FixtureAnalysis analyse_fixture(Session& session);

}  // namespace dowel
