#pragma once

#include <string>
#include <vector>

#include "dowel/assembly/session.h"

namespace dowel {

/// One step of putting a fixture together.
struct AssemblyStep {
  /// What is brought in at once: an instance with its unit; where it can come in no other way, with
  /// all that hangs on it. The one that gives the way comes first.
  std::vector<std::string> parts;
  WayOut way;  ///< by which it would leave again; it comes in against its direction
};

/// A part that no straight way is free for.
struct BlockedPart {
  std::string part;
  std::vector<WayOut> ways;  ///< what blocks each of them
};

struct AssemblySequence {
  std::vector<std::string> base;  ///< what is there first: grounded, else the first that was placed
  std::vector<AssemblyStep> steps;  ///< in order of assembly
  /// Parts that block each other when all that `steps` has is gone; empty where it can be done.
  std::vector<BlockedPart> blocked;
  /// Interferences of blocked parts, with each other and with what is not gone, as they stand: no
  /// way is free as long as two parts are in one place.
  std::vector<Touch> entered;
};

/// An order in which each part can be brought in on a straight way past those that are there: along
/// its mates' axes and normals, or down on the base. Found by taking the fixture apart: what can be
/// taken out while much is there can be taken out when less is, so that whatever order the parts
/// are tried in, one that exists is found. Of the parts that can go, the one goes that was placed
/// last and that nothing left is mated on.
AssemblySequence plan_sequence(Session& session);

}  // namespace dowel
