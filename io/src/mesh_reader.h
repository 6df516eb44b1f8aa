#pragma once

#include <filesystem>
#include <functional>

#include "dowel/kernel/faceted_solid.h"
#include "worker.h"

namespace dowel {

/// Reads .obj, .off, .stl, .ply or .glb as one sound solid with planar faces. Numbers are
/// millimetres; glTF has metres and y up by its standard and is brought to millimetres and z up.
/// Vertices with equal coordinates are one; a shell that is inside out as a whole is turned.
/// assimp, which reads glTF, is not made for damaged files: call it in a worker only.
/// Throws Error{FileUnreadable}, Error{FileMalformed}: damaged, empty, open, or inconsistent.
FacetedSolid read_mesh(const std::filesystem::path& file,
                       const std::function<void(WorkerStage)>& report);

}  // namespace dowel
