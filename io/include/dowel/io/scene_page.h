#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
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

/// Binary glTF 2.0: metres, y up. Each DisplayMesh in use is written once and shared by its
/// instances (once more, on the same data, for each state it is shown in). Facets carry the normals
/// of their exact faces; edge lines are a second primitive. Nodes have the instances' names and
/// `extras` {"state": "normal" | "contact" | "colliding", "note": …}. Deterministic bytes. A mesh
/// without facets gives a node without geometry; bytes of names that are not UTF-8 become U+FFFD.
/// Expects: every instance names a mesh with a solid whose indices are in range.
/// Throws Error{InvalidInput} where the scene is beyond the 4 GiB of the format.
std::vector<std::byte> to_glb(const DisplayScene& scene);

/// Writes `to_glb`. The file appears whole or not at all. Throws Error{FileUnwritable}.
void write_glb(const std::filesystem::path& file, const DisplayScene& scene);

/// One HTML page that needs nothing else and loads nothing (no network): the scene in 3D with a
/// list of the instances, colliding ones marked. Names are shown as they are, whatever is in them.
/// Deterministic. Expects and Throws as `to_glb`.
std::string to_page(const DisplayScene& scene);

/// Writes `to_page`. The file appears whole or not at all. Throws Error{FileUnwritable}.
void write_page(const std::filesystem::path& file, const DisplayScene& scene);

}  // namespace dowel
