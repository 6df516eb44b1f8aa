#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dowel/kernel/pose.h"

namespace dowel {

/// An assembly for export: shared parts and where they are placed.
struct ExportPart {
  std::string name;
  std::vector<std::byte> brep;  ///< ImportedPart::brep
  std::optional<std::array<double, 3>> colour;
};
struct ExportInstance {
  std::string name;
  std::size_t part = 0;  ///< index into the parts
  Pose X_WI;
};

/// Writes an AP214 STEP assembly in millimetres: each part once, instances as placed components
/// with names and colours. Deterministic bytes: no clock, no host name. The file appears whole or
/// not at all. Throws Error{FileUnwritable}, or Error{FileMalformed} where a brep is damaged.
void write_step_assembly(const std::filesystem::path& file, const std::string& name,
                         const std::vector<ExportPart>& parts,
                         const std::vector<ExportInstance>& instances);

}  // namespace dowel
