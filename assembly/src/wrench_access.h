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
#include "drive.h"

namespace dowel {

class FactSource;

/// Wrenches and cutters as cylinders, held against the parts near by. An answer is kept while the
/// fastener and all that is in its wrench's reach stay where they are.
class WrenchBench {
 public:
  /// Of all instances with a drive, by name.
  std::vector<WrenchAccess> access(FactSource& source);

  /// Names of parts, but workpieces, that are in a cylinder of `diameter_mm` upwards from the
  /// point.
  std::vector<std::string> in_way_of_cutter(FactSource& source, const CriticalPoint& point,
                                            double diameter_mm, double length_mm);

 private:
  struct Question {
    Instance fastener;
    bool before_workpiece = false;
    std::vector<Instance> near;  ///< in reach, and there when it is tightened
    /// Of these, what is put together with it in no certain order: parts of clamps.
    std::set<std::string> put_together;
    double tolerance_mm = 0.0;

    bool operator==(const Question&) const = default;
  };
  struct Known {
    Question question;
    WrenchAccess access;
  };

  WrenchAccess answer(const Question& question, const Drive& drive, FactSource& source);
  const std::shared_ptr<const CollisionElement>& cylinder(double diameter_mm, double length_mm);

  std::map<std::string, std::optional<Drive>> drives_;  ///< by element
  std::map<std::string, Known> known_;                  ///< by fastener
  std::map<std::pair<double, double>, std::shared_ptr<const CollisionElement>> cylinders_;
};

}  // namespace dowel
