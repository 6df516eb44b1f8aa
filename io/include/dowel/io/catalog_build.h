#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/io/import.h"

namespace dowel {

struct BuildOptions {
  ImportOptions import;
  unsigned jobs = 1;   ///< files read at a time
  bool force = false;  ///< reads unchanged files, too
  /// Recorded with the elements of all files of this build. Without it, elements keep the licence
  /// that the catalogue has for their file.
  std::optional<std::string> licence;
  /// Folder, made where it is missing, for a project of each file that places more than one part:
  /// "as1.stp" becomes "as1.dowelproj". A project that is there already is left as it is.
  std::optional<std::filesystem::path> assemblies;
  /// Asked several times a second; true ends the build. What was put stays, files that were being
  /// read are left for the next build, and the report ends before them.
  std::function<bool()> stop;
};

enum class BuildStatus {
  Ok,
  Unchanged,  ///< same content and settings as in the catalogue: not read again
  Empty,      ///< holds no solid
  Failed
};

/// "ok", "unchanged", "empty" or "failed".
std::string_view to_string(BuildStatus status);

/// What became of one file.
struct BuiltFile {
  /// As given, or folder as given + path in it; without detours such as "./" or "x/../". The
  /// catalogue knows the file by it.
  std::string file;
  BuildStatus status = BuildStatus::Failed;
  std::string reason;  ///< why Empty or Failed
  /// What the reader found wrong and went on past; an Unchanged file is not read and has none.
  std::vector<std::string> warnings;
  std::vector<std::string> elements;  ///< their names in the catalogue
  std::size_t faces = 0;              ///< of those elements, where the file was read now
  std::string project;                ///< that was made of its assembly; may be empty
  std::size_t instances = 0;          ///< in that project
  double seconds = 0.0;               ///< to read it and to recognise its features
};

/// Called in the calling thread for each file, in the order of the report; false stops the build.
using BuildCallback =
    std::function<bool(const BuiltFile& file, std::size_t done, std::size_t total)>;

/// Reads the elements of `paths` (files, and folders with all in them that dowel reads) into the
/// catalogue at `catalog_file`, which is made where it is missing. One transaction a file: what a
/// file gave before is replaced, but kept where the file fails now. A file that fails is an answer,
/// as is a path that is missing; both are in the report, and the rest is read. Files that were
/// Empty or Failed before are not tried again until they change, unless forced; Failed ones also
/// where the limits on time or memory are others. Where all that is
/// read fails, no catalogue is made.
///
/// The report is sorted within a folder and otherwise in the order of `paths`; a file that several
/// paths lead to is read once. The same files give the same catalogue for any number of jobs.
///
/// Expects: no other thread of the process is running (see import_file).
/// Throws Error where the catalogue cannot be opened or written; what was put before then, stays.
std::vector<BuiltFile> build_catalog(std::span<const std::filesystem::path> paths,
                                     const std::filesystem::path& catalog_file,
                                     const BuildOptions& options,
                                     const BuildCallback& on_file = nullptr);

}  // namespace dowel
