#pragma once

#include <filesystem>
#include <string>

#include "dowel/assembly/session.h"

namespace dowel::tools {

/// RFC 4180: count, name, family, instances; the last separated by blanks.
std::string bom_csv(Session& session);

/// Commands of the journal that are not undone, one a line: a script that makes the project anew.
std::string journal_script(const Session& session);

/// Writes what the ending of `file` says. The file appears whole or not at all. Throws
/// Error{InvalidInput} for an unknown ending, or STEP of an element without boundary
/// representation; Error{FileUnwritable}.
void export_session(Session& session, const std::filesystem::path& file);

}  // namespace dowel::tools
