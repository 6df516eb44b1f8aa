#pragma once

// Whether tools reach what they work on. Internal to the rule engine.

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dowel/assembly/fixture_analysis.h"
#include "dowel/collision/scene.h"
#include "tool_room.h"

namespace dowel {

class FactSource;

/// Wrenches and cutters as cylinders, held against the parts near by, one by one. What a part is in
/// the way of is kept while it and the fastener stay where they are.
class WrenchBench {
 public:
  /// Of all instances with a drive, by name.
  std::vector<WrenchAccess> access(FactSource& source);

  const std::optional<Drive>& drive(const std::string& element, FactSource& source);

  /// Names of parts, but workpieces, that are in a cylinder of `diameter_mm` upwards from the
  /// point.
  std::vector<std::string> in_way_of_cutter(FactSource& source, const CriticalPoint& point,
                                            double diameter_mm, double length_mm);

 private:
  struct Placed {
    const Instance* instance = nullptr;
    Eigen::AlignedBox3d box_W;
    std::shared_ptr<const CollisionElement> model;
  };
  /// Of which rooms around a fastener a part is in the way.
  struct InWay {
    Instance part;
    std::vector<bool> of_head;                ///< by wrench
    std::vector<std::vector<bool>> of_lever;  ///< by wrench and angle; empty where of none
    bool of_way_in = false;
  };
  struct Known {
    Instance fastener;
    FastenerRooms rooms;
    std::map<std::string, InWay> in_way;  ///< by part
  };

  void use_tolerance(double tolerance_mm);
  /// Whether a part is in a cylinder by more than the tolerance.
  bool is_in(const ToolRoom& room, const Placed& part);
  const InWay& in_way(Known& known, const Placed& part);
  Known& known(const Instance& fastener, const Drive& drive);
  /// Parts of `put_together` do not stop a screw that comes in.
  WrenchAccess answer(Known& known, const std::vector<Placed>& near,
                      const std::set<std::string>& put_together);
  static std::vector<Placed> placed(FactSource& source);
  const std::shared_ptr<const CollisionElement>& cylinder(double diameter_mm, double length_mm);

  std::map<std::string, std::optional<Drive>> drives_;  ///< by element
  std::map<std::string, Known> known_;                  ///< by fastener
  double tolerance_mm_ = 0.0;                           ///< that these are of
  std::map<std::pair<double, double>, std::shared_ptr<const CollisionElement>> cylinders_;
};

}  // namespace dowel
