#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// What the pictures show: shared meshes and placed instances.
struct DisplayMesh {
  std::string name;
  std::shared_ptr<const FacetedSolid> solid;
  std::array<double, 3> colour{0.7, 0.7, 0.72};  ///< sRGB 0..1
};
enum class DisplayState { Normal, Contact, Colliding };
struct DisplayInstance {
  std::string name;
  std::size_t mesh = 0;  ///< index into the meshes
  Pose X_WI;
  DisplayState state = DisplayState::Normal;
  std::string note;  ///< shown with the instance: what it collides with
};
struct DisplayScene {
  std::string title;
  std::vector<DisplayMesh> meshes;
  std::vector<DisplayInstance> instances;
};

/// Binary glTF 2.0: metres, y up, one mesh per DisplayMesh shared by its instances, normals per
/// face. Deterministic bytes.
std::vector<std::byte> to_glb(const DisplayScene& scene);

/// Writes `to_glb`. The file appears whole or not at all. Throws Error{FileUnwritable}.
void write_glb(const std::filesystem::path& file, const DisplayScene& scene);

/// Writes one HTML file that needs nothing else (no network): the scene in 3D with a list of the
/// instances, colliding ones marked. Throws Error{FileUnwritable}.
void write_page(const std::filesystem::path& file, const DisplayScene& scene);

}  // namespace dowel
