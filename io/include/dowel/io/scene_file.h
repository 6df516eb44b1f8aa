#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dowel/kernel/pose.h"

namespace dowel {

/// One body of a scene file: what it is and where it stands.
struct SceneBody {
  std::string id;
  std::filesystem::path
      source;           ///< file to read, relative paths resolved; empty: `element` is used
  std::string element;  ///< name in a catalogue; empty: `source` is used
  Pose X_WB;
};

/// A scene in the format "dowel-scene/1".
struct SceneFile {
  std::vector<SceneBody> bodies;
  std::vector<std::size_t> moving;  ///< indices into `bodies`
  /// True where "moving" is a list: poses then place the unit's frame, and body i stands at
  /// `X_WU * bodies[i].X_WB`. False: poses place the moving body itself.
  bool moves_as_unit = false;
};

/// Reads and checks a scene. Throws Error{FileUnreadable} or Error{FileMalformed} naming the file
/// and the place (line and column, or key) and what was expected there.
SceneFile read_scene(const std::filesystem::path& file);

/// Reads poses from CSV with header `qw,qx,qy,qz,tx,ty,tz`, one a line. Throws as `read_scene`
/// does, naming the line.
std::vector<Pose> read_poses(const std::filesystem::path& file);

}  // namespace dowel
