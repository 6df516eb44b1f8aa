#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "part.h"

namespace dowel::library {

/// File of a part below the library's folder: "H40-12/riser-80x80x40.step".
std::string file_name(const Part& part);

/// The part in OpenCascade's binary format, without facets.
std::vector<std::byte> to_brep(const TopoDS_Shape& shape);

/// Writes one STEP file for each part below `folder`, then the manifest library.json. Makes the
/// folders that are missing; files of other names stay. The same parts give the same bytes.
/// Throws: Error{FileUnwritable}.
void write_library(const std::filesystem::path& folder, const std::vector<Part>& parts);

}  // namespace dowel::library
