#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "dowel/kernel/pose.h"
#include "worker.h"

namespace dowel {

/// A part of a STEP file that holds at least one solid.
struct StepPart {
  std::string name;  ///< as the file has it, cleaned: may be empty or generic
  TopoDS_Shape shape;
  std::optional<std::array<double, 3>> colour;  ///< sRGB 0..1
};

/// A part where the file places it.
struct StepInstance {
  std::string name;  ///< of the component, cleaned: may be empty or generic
  std::size_t part = 0;
  Pose X_WI;
};

struct StepContent {
  std::vector<StepPart> parts;  ///< in the order of the file
  std::vector<StepInstance> instances;
  std::string unit;  ///< "mm", "inch", ...; several are joined by "+"; empty: not stated
  /// What the file has besides or instead of solids: "4 open shells"; empty where nothing.
  std::string leftovers;
  std::vector<std::string> warnings;  ///< load and transfer checks that failed, bounded
};

/// Reads a STEP file through OpenCascade's extended data framework, in millimetres whatever the
/// file's unit and whatever was set before. `whole_file`: one part of all solids where the file
/// places them; else each distinct part once in its own frame. Closed shells without a solid become
/// solids.
/// OpenCascade crashes on damaged files and keeps global state: call it in a worker only.
/// Throws: Error{FileUnreadable}, Error{FileMalformed}; std::bad_alloc.
StepContent read_step(const std::filesystem::path& file, bool whole_file,
                      const std::function<void(WorkerStage)>& report);

}  // namespace dowel
