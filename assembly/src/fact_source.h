#pragma once

// What facts are computed from: a session's state and what has been found out about it. Internal to
// the rule engine.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "axis_pair.h"
#include "contact_patch.h"
#include "dowel/assembly/fixture_analysis.h"
#include "dowel/assembly/session.h"
#include "dowel/catalog/lint.h"
#include "fact_table.h"
#include "fixture_contacts.h"
#include "fixture_result.h"
#include "foolproof.h"
#include "placed_bodies.h"
#include "slot_pair.h"
#include "wrench_access.h"

namespace dowel {

/// A joint by which one part holds another.
struct Holding {
  std::string held;
  std::string by;
  std::string kind;  ///< "thread", "screw", "press", "clamp", "fix", "tee", "key"
};

class FactSource {
 public:
  explicit FactSource(Session& session);

  /// Takes over the session's state. The inputs that changed since the last call.
  unsigned update();

  Session& session() { return session_; }
  const ProjectState& state() const { return state_; }
  const Element& element(const Instance& instance) { return session_.element(instance.element); }
  std::shared_ptr<const FacetedSolid> solid(const std::string& element);
  std::shared_ptr<const CollisionElement> shape(const std::string& element) {
    return bodies_.shape(element);
  }
  Role role(const Instance& instance) { return fixture_role(state_, instance, element(instance)); }

  /// Pairs that are not clear at the project's tolerance, by name.
  const std::vector<Touch>& touches();
  /// Pairs that do not touch and are nearer than `gap_mm`, by name.
  const std::vector<Touch>& nearer_than(double gap_mm);
  const std::vector<AxisPair>& axes();
  const std::vector<SlotPair>& slots();
  const std::vector<Holding>& holdings();
  /// One for each workpiece.
  const std::vector<FixtureModel>& fixtures();

  /// What is wrong with the data of an element, found once: copies in a project never change.
  const std::vector<LintFinding>& data_faults(const std::string& element);
  /// Planes that the two of a contact share.
  const std::vector<ContactPatch>& shared_planes(const Touch& touch);
  /// Whether the workpiece comes out.
  const UnloadAnalysis& unloading(const FixtureModel& model);
  /// Whether the workpiece seats in a wrong orientation.
  const FoolproofAnalysis& foolproof(const FixtureModel& model);
  /// Of all screws and nuts that have a hexagon, by name.
  const std::vector<WrenchAccess>& wrenches();
  /// What a wrench gets hold of.
  const std::optional<Drive>& drive(const std::string& element) {
    return wrench_bench_.drive(element, *this);
  }
  /// Parts but the workpiece that a cutter is in, which comes down to a critical point.
  std::vector<std::string> in_way_of_cutter(const CriticalPoint& point, double diameter_mm,
                                            double length_mm);
  /// The verdict of two placed parts at a tolerance, whose gap is the least to a micrometre.
  PairVerdict pair(const std::string& a, const std::string& b, double tolerance_mm);

 private:
  /// Pairs that are no farther apart than a gap, and the state that they are of.
  struct Pairs {
    ProjectState of;
    double gap_mm = 0.0;
    std::optional<std::vector<Touch>> touches;
  };
  /// Asks anew about the parts that changed alone; `but` are left out.
  void update_pairs(Pairs& pairs, double gap_mm, const std::vector<Touch>* but);
  PairVerdict nearest(const std::string& a, const std::string& b, PairVerdict pair);

  Session& session_;
  ProjectState state_;
  bool has_state_ = false;
  PlacedBodies bodies_;
  std::map<std::string, std::shared_ptr<const FacetedSolid>> solids_;
  /// Kept while the two stay where they are.
  struct SharedPlanes {
    Instance a;
    Instance b;
    double tolerance_mm = 0.0;
    std::vector<ContactPatch> patches;
  };
  std::map<std::pair<std::string, std::string>, SharedPlanes> shared_planes_;
  struct KnownUnloading {
    Unloading of;
    UnloadAnalysis analysis;
  };
  std::map<std::string, KnownUnloading> unloadings_;  ///< by workpiece
  struct KnownFoolproof {
    FoolproofAnswer answer;
    FoolproofAnalysis analysis;
  };
  std::map<std::string, KnownFoolproof> foolproofs_;  ///< by workpiece
  std::map<std::string, std::vector<LintFinding>> data_faults_;
  Pairs touching_;
  Pairs near_;
  WrenchBench wrench_bench_;
  std::optional<std::vector<WrenchAccess>> wrenches_;
  std::optional<std::vector<AxisPair>> axes_;
  std::optional<std::vector<SlotPair>> slots_;
  std::optional<std::vector<Holding>> holdings_;
  std::optional<std::vector<FixtureModel>> fixtures_;
};

}  // namespace dowel
