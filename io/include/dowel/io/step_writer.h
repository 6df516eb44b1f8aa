#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dowel/kernel/pose.h"

namespace dowel {

/// A part for export.
struct ExportPart {
  std::string name;                             ///< product name, UTF-8
  std::vector<std::byte> brep;                  ///< ImportedPart::brep
  std::optional<std::array<double, 3>> colour;  ///< sRGB 0..1
};
struct ExportInstance {
  std::string name;      ///< name of the component, UTF-8
  std::size_t part = 0;  ///< index into the parts
  Pose X_WI;
};

/// Writes an AP214 STEP assembly in millimetres: each part once, instances as placed components
/// with names and colours. Parts without an instance are left out. Deterministic bytes: no clock,
/// no host name. The file appears whole or not at all. The work is done in a forked child, as a
/// damaged brep can crash its reader.
///
/// Expects: every instance names an existing part; no other thread of the process is running.
/// Throws: Error{InvalidInput} where there is no instance, Error{FileMalformed} where a brep is
/// damaged, Error{FileUnwritable}.
void write_step_assembly(const std::filesystem::path& file, const std::string& name,
                         const std::vector<ExportPart>& parts,
                         const std::vector<ExportInstance>& instances);

/// Writes one part in its own frame as a STEP file with a single product; else as
/// `write_step_assembly`.
void write_step_part(const std::filesystem::path& file, const ExportPart& part);

}  // namespace dowel
