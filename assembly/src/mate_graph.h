#pragma once

// Which parts hang together, by the mates of a state. Internal to Session.

#include <set>
#include <string>

#include "dowel/assembly/project.h"

namespace dowel {

using PartNames = std::set<std::string>;

/// Instances that a mate is on.
PartNames parts_of(const Mate& mate);

/// The instances that hang together with `name`, itself among them: over mates, and up to what is
/// grounded.
PartNames hanging_together(const ProjectState& state, const std::string& name);

/// The unit of `name`: what is fixed to it by mates of kind Fix, itself among them.
PartNames unit_of(const ProjectState& state, const std::string& name);

/// The sub-assembly that goes along where `name` is dragged: its unit, and what hangs on the rest
/// of the project by these alone. The rest is what is grounded; where nothing in reach is, what
/// `name` was mated to rather than what was mated to it.
PartNames sub_assembly_of(const ProjectState& state, const std::string& name);

/// Whether `group`, a sub-assembly, is in a loop of mates: it is mated with two others at least,
/// where all that is grounded counts as one.
bool is_in_loop(const ProjectState& state, const PartNames& group);

/// Those of `group` that may move. Where none is grounded, `held` stays.
PartNames free_parts(const ProjectState& state, PartNames group, const std::string& held);

}  // namespace dowel
