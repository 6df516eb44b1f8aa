#pragma once

#include <filesystem>

#include "dowel/catalog/catalog.h"

namespace dowel {

/// Makes `file` a project in which the elements of `catalog` stand as the assembly `source` has
/// them. Names of instances are those of the assembly, with "_" for what an instance's name may not
/// hold, and "-2", "-3", ... where one is taken. Throws Error{FileUnwritable} where the file exists
/// or cannot be written, Error{InvalidInput} where an instance stands farther out than a project
/// may hold, Error{FileMalformed} where the catalogue is damaged; then there is no file.
void write_assembly_project(const std::filesystem::path& file, const Catalog& catalog,
                            const SourceRecord& source);

}  // namespace dowel
