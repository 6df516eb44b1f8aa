#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dowel/assembly/session.h"

namespace dowel {

/// Writes some instances of a project, with the mates among them, as a project of its own, which
/// `Session::insert_unit` places as one. The first of them becomes its origin. The file needs
/// nothing else. Throws Error{FileUnwritable} where it exists or cannot be written; nothing is
/// left of it then.
void save_unit(Session& session, const std::vector<std::string>& names,
               const std::filesystem::path& file);

}  // namespace dowel
