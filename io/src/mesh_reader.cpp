#include "mesh_reader.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "dowel/io/file.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "mesh_faces.h"
#include "part_names.h"
#include "ply.h"
#include "text_mesh.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

void append_mesh(const aiMesh& from, FacetedSolid& mesh) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned v = 0; v < from.mNumVertices; ++v) {
    const aiVector3D& p = from.mVertices[v];
    mesh.vertices.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y),
                               static_cast<double>(p.z));
  }
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines bound nothing
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= from.mNumVertices) {
        throw Error(ErrorCode::FileMalformed, "vertex index " + std::to_string(face.mIndices[k]) +
                                                  " is out of range, the mesh has " +
                                                  std::to_string(from.mNumVertices) + " vertices");
      }
      triangle[k] = offset + face.mIndices[k];
    }
    mesh.triangles.push_back(triangle);
  }
}

/// The meshes of a binary glTF placed as it places them, brought from metres to millimetres and
/// from y up to z up. From memory: a model may not open other files.
FacetedSolid parse_glb(const std::string& content) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFileFromMemory(content.data(), content.size(),
                                  aiProcess_Triangulate | aiProcess_PreTransformVertices, "glb");
  if (scene == nullptr) {
    throw Error(ErrorCode::FileMalformed,
                "cannot be read as binary glTF: " + clean_text(importer.GetErrorString()));
  }
  FacetedSolid mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) append_mesh(*scene->mMeshes[m], mesh);
  constexpr double kMillimetresPerMetre = 1000.0;
  for (Vector3d& v : mesh.vertices) v = kMillimetresPerMetre * Vector3d(v.x(), -v.z(), v.y());
  return mesh;
}

FacetedSolid parse(const std::filesystem::path& file, const std::string& content) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".obj") return parse_obj(content);
  if (ending == ".off") return parse_off(content);
  if (ending == ".ply") return parse_ply(content);
  if (ending == ".stl") {
    return is_binary_stl(content) ? parse_binary_stl(content) : parse_ascii_stl(content);
  }
  return parse_glb(content);
}

void expect_coordinates_in_range(const FacetedSolid& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].cwiseAbs().maxCoeff() <= kMaxCoordinate_mm &&
        mesh.vertices[v].allFinite()) {
      continue;
    }
    throw Error(ErrorCode::FileMalformed, "vertex " + std::to_string(v) +
                                              " is not finite or beyond " +
                                              std::to_string(kMaxCoordinate_mm) + " mm");
  }
}

void expect_closed(const FacetedSolid& mesh) {
  const MeshEdgeCounts edges = count_edges(mesh);
  const auto of_all = " of its " + std::to_string(edges.all) + " edges belong to ";
  if (edges.open > 0) {
    throw Error(ErrorCode::FileMalformed,
                "mesh is not closed: " + std::to_string(edges.open) + of_all + "one triangle");
  }
  if (edges.crowded > 0) {
    throw Error(ErrorCode::FileMalformed, "mesh touches itself: " + std::to_string(edges.crowded) +
                                              of_all + "three triangles or more");
  }
}

}  // namespace

FacetedSolid read_mesh(const std::filesystem::path& file,
                       const std::function<void(WorkerStage)>& report) {
  report(WorkerStage::Read);
  FacetedSolid mesh = parse(file, read_file(file));
  report(WorkerStage::Mesh);
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::FileMalformed, "it has no triangles, expected a closed mesh");
  }
  expect_coordinates_in_range(mesh);
  mesh.faces.resize(1);
  mesh.face_of.assign(mesh.triangles.size(), 0);
  mesh.solid_count = 1;
  weld(mesh);
  expect_closed(mesh);
  orient_outward(mesh);
  if (!(mass_properties(mesh).volume_mm3 > 0.0)) {
    throw Error(ErrorCode::FileMalformed, "it encloses no volume, expected a solid");
  }
  report(WorkerStage::Features);
  set_planar_faces(mesh);
  if (const auto defect = find_defect(mesh)) {
    throw Error(ErrorCode::FileMalformed, "mesh is not sound: " + *defect);
  }
  return mesh;
}

}  // namespace dowel
