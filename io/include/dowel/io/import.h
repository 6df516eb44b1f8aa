#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

namespace dowel {

struct ImportOptions {
  /// Linear deflection of the facets; 0: relative to the part's size (see io/README.md).
  double deflection_mm = 0.0;
  double angular_deflection_rad = 0.5;
  /// Facets of one part are coarsened until they are fewer than this.
  std::uint32_t max_triangles = 400'000;
  /// True: all solids of the file become one part, placed as the file places them. False: each
  /// distinct part of an assembly becomes a part of its own.
  bool whole_file = false;
  double max_seconds = 120.0;        ///< processor time of the worker; four times that by the clock
  std::size_t max_memory_mb = 4096;  ///< address space of the worker
};

inline constexpr std::size_t kMaxInstances = 100'000;

/// One distinct part of a file, in its own frame, with what is recognised on it
/// (catalog/recognition.h).
struct ImportedPart {
  std::string name;  ///< product name as UTF-8, or the file's stem where it has no usable one
  std::string unit_in_file;
  FacetedSolid solid;
  double volume_mm3 = 0.0;   ///< of the exact solid
  double surface_mm2 = 0.0;  ///< of the exact solid
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  std::optional<std::array<double, 3>> colour;  ///< sRGB 0..1
  Obb obb;                                      ///< smallest box found around the exact solid
  std::vector<Feature> features;
  std::vector<BoltCircle> bolt_circles;
  ShapeClass shape = ShapeClass::Compound;
  TriangleCounts triangles;
  std::vector<std::byte> brep;  ///< OpenCascade's binary format; empty for mesh files
};

/// A part where the file places it.
struct ImportedInstance {
  std::string name;      ///< of the component as UTF-8, or the part's where it has no usable one
  std::size_t part = 0;  ///< index into the parts
  Pose X_WI;             ///< in the frame of the file
};

struct ImportResult {
  enum class Status { Ok, Empty, Failed };
  Status status = Status::Failed;
  std::string reason;  ///< empty where Ok
  /// What the reader found wrong and went on past: the geometry may differ from what was meant.
  std::vector<std::string> warnings;
  std::vector<ImportedPart> parts;
  /// In the order of the file, sub-assemblies resolved. A part of a file without an assembly is
  /// there once. Of more than `kMaxInstances` the first; mirrored and scaled ones are left out; a
  /// warning tells both.
  std::vector<ImportedInstance> instances;
  double seconds = 0.0;
};

/// True for the file endings that `import_file` reads as STEP, as a mesh.
bool is_step_file(const std::filesystem::path& file);
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a STEP or mesh file and recognises features, in a child process with limits on time and
/// memory: the STEP reader crashes on damaged files and keeps global state. Never throws for a bad
/// file: that is a Failed result. The child is forked: expects that no other thread of the process
/// is running.
ImportResult import_file(const std::filesystem::path& file, const ImportOptions& options);

/// The same for many files, `jobs` children at a time. `on_done(i, result)` is called in the
/// calling thread as each finishes, in the order of `files`; where it returns false no more are
/// started. `stop` is asked several times a second; once it says true, no more are reported and
/// those being read are dropped.
void import_files(const std::vector<std::filesystem::path>& files, const ImportOptions& options,
                  unsigned jobs, const std::function<bool(std::size_t, ImportResult&&)>& on_done,
                  const std::function<bool()>& stop = nullptr);

}  // namespace dowel
