#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

namespace dowel {

/// What an instance does in the fixture.
enum class Role : std::uint8_t {
  BasePlate,
  Riser,
  Locator,            ///< settles where the workpiece is
  Support,            ///< carries the workpiece, rigid: settles its height, too
  AdjustableSupport,  ///< set against the workpiece after it is located: settles nothing
  Clamp,
  Fastener,
  Workpiece,
  Other
};

/// "base plate", "riser", "locator", "support", "adjustable support", "clamp", "fastener",
/// "workpiece", "other": the words of catalogues, too.
std::string_view to_string(Role role);
std::optional<Role> role_from(std::string_view text);

/// A force on the workpiece while it is machined. World frame, as the fixture stands.
struct Load {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_Nmm = Eigen::Vector3d::Zero();

  bool operator==(const Load&) const = default;
};

/// A point of the workpiece, in the world as it stands, that has to be where it is meant to be.
struct CriticalPoint {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double tolerance_mm = 0.0;  ///< of the feature machined there, as plus or minus

  bool operator==(const CriticalPoint&) const = default;
};

/// A quantity that rules compare with, and what it is where the project does not say.
struct Limit {
  std::string_view name;  ///< ends in its unit
  double value = 0.0;
  double least = 0.0;
  double most = 0.0;
  std::string_view meaning;
};

/// All of them, by name.
std::span<const Limit> limits();
/// Nothing where there is none of that name.
const Limit* find_limit(std::string_view name);

/// A quantity of a single part, feature, element or point that nobody can measure on its geometry.
struct StatedQuantity {
  std::string_view name;  ///< ends in its unit
  double least = 0.0;
  double most = 0.0;
  std::string_view of;  ///< what it is stated of
  std::string_view meaning;
};

/// All of them, by name.
std::span<const StatedQuantity> stated_quantities();
/// Nothing where there is none of that name.
const StatedQuantity* find_stated_quantity(std::string_view name);

/// What somebody states it to be, and by what.
struct StatedValue {
  double value = 0.0;
  std::string reason;

  bool operator==(const StatedValue&) const = default;
};

/// A rule that counts less, or more, than it is shipped to.
struct RuleOverride {
  std::string severity;  ///< "error", "warning", "info" or "off"
  std::string reason;

  bool operator==(const RuleOverride&) const = default;
};

/// A finding that somebody takes responsibility for.
struct Waiver {
  std::string reason;
  std::string by;      ///< who; may be empty
  std::string digest;  ///< of the geometry of its subjects when it was waived

  bool operator==(const Waiver&) const = default;
};

/// What the designer says of the fixture beside its geometry. A value; part of ProjectState.
struct FixtureDesign {
  std::map<std::string, Role> roles;             ///< by instance, where the catalogue's is not it
  std::map<std::string, double> clamp_forces_N;  ///< by instance
  std::map<std::string, double>
      locator_errors_mm;                        ///< by instance: plus or minus, along its normal
  std::map<std::string, Load> loads;            ///< by name
  std::map<std::string, CriticalPoint> points;  ///< by name
  std::map<std::string, double> limits;         ///< by name, where they are not the usual ones
  /// By quantity and subject: an instance, INSTANCE.FEATURE, an element or a critical point.
  std::map<std::pair<std::string, std::string>, StatedValue> stated;
  std::map<std::string, RuleOverride> overrides;                  ///< by rule
  std::map<std::pair<std::string, std::string>, Waiver> waivers;  ///< by rule and subject

  double limit(std::string_view name) const;  ///< Expects: a known name.
  /// Nothing where nobody states it.
  std::optional<double> stated_value(std::string_view quantity, const std::string& subject) const;
  /// Forgets what was said of an instance. Waivers stay: they will be told as stale.
  void forget(const std::string& instance);

  bool operator==(const FixtureDesign&) const = default;
};

}  // namespace dowel
