#include "dowel/io/import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>
#include <variant>

#include <BRepGProp.hxx>
#include <BinTools.hxx>
#include <GProp_GProps.hxx>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/tolerance.h"
#include "exact_reach.h"
#include "facet.h"
#include "mesh_reader.h"
#include "occt.h"
#include "part_names.h"
#include "result_codec.h"
#include "step_reader.h"
#include "worker.h"

namespace dowel {
namespace {

using StageReport = std::function<void(WorkerStage)>;

bool has_ending(const std::filesystem::path& file, std::initializer_list<const char*> endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

ImportResult failed(const std::string& reason) {
  ImportResult result;
  result.reason = reason;
  return result;
}

std::vector<std::byte> brep_bytes(const TopoDS_Shape& shape) {
  std::ostringstream stream(std::ios::out | std::ios::binary);
  BinTools::Write(shape, stream, false, false, BinTools_FormatVersion_CURRENT);
  const std::string bytes = std::move(stream).str();
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  return {first, first + bytes.size()};
}

/// Volume and centre of mass by integration over the exact faces; the facets' where that goes
/// astray, as it does on faces with a broken parameter range.
void set_mass(const TopoDS_Shape& shape, ImportedPart& part) {
  const MassProperties facets = mass_properties(part.solid);
  part.surface_mm2 = 0.0;
  double slack_mm3 = 0.0;
  for (const Face& face : part.solid.faces) {
    part.surface_mm2 += face.area_mm2;
    slack_mm3 += face.area_mm2 * face.facet_error_mm;
  }
  GProp_GProps properties;
  // Adaptive integration only where it matters: the plain one is exact on analytic faces, but may
  // miss a promille on rational splines.
  const bool has_splines = std::any_of(
      part.solid.faces.begin(), part.solid.faces.end(),
      [](const Face& face) { return std::holds_alternative<OtherSurface>(face.surface); });
  if (has_splines) {
    BRepGProp::VolumeProperties(shape, properties, kIntegrationRatio);
  } else {
    BRepGProp::VolumeProperties(shape, properties);
  }
  const double volume_mm3 = properties.Mass();
  constexpr double kPlausible = 0.01;
  const double largest_error_mm3 = 2.0 * slack_mm3 + kPlausible * facets.volume_mm3;
  const bool is_plausible = std::abs(volume_mm3 - facets.volume_mm3) <= largest_error_mm3;
  part.volume_mm3 = is_plausible ? volume_mm3 : facets.volume_mm3;
  part.center_of_mass = is_plausible ? to_eigen(properties.CentreOfMass()) : facets.center_of_mass;
}

/// What a part warns of: each face that is not where it should be says that the file is damaged.
std::vector<std::string> part_warnings(const FacetedShape& facets, const std::string& name) {
  if (facets.misplaced_faces == 0) return {};
  return {"part " + name + ": " + std::to_string(facets.misplaced_faces) +
          (facets.misplaced_faces == 1 ? " face has its" : " faces have their") +
          " boundary off the surface that the file gives"};
}

void recognise(ImportedPart& part) {
  part.features = recognise_features(part.solid);
  part.bolt_circles = find_bolt_circles(part.features);
  part.shape = classify_shape(part.solid, part.features);
  part.triangles = count_triangles(part.solid, classify_faces(part.solid, part.features));
}

ImportedPart import_part(const StepPart& from, const std::string& name,
                         const ImportOptions& options, const StageReport& report,
                         std::vector<std::string>& warnings) {
  report(WorkerStage::Mesh);
  const FacetedShape facets = facet(
      from.shape, {options.deflection_mm, options.angular_deflection_rad, options.max_triangles});
  report(WorkerStage::Volume);
  ImportedPart part;
  part.solid = facets.solid;
  part.name = name;
  for (std::string& warning : part_warnings(facets, name)) warnings.push_back(std::move(warning));
  part.colour = from.colour;
  guarded("the integration of its volume failed", [&] {
    set_mass(facets.shape, part);
    part.brep = brep_bytes(facets.shape);
  });
  report(WorkerStage::Features);
  recognise(part);
  report(WorkerStage::Box);
  part.obb = guarded("the search for its smallest box failed", [&] { return exact_box(facets); });
  return part;
}

ImportResult import_step(const std::filesystem::path& file, const ImportOptions& options,
                         const StageReport& report) {
  StepContent content = read_step(file, options.whole_file, report);
  ImportResult result;
  result.warnings = std::move(content.warnings);
  if (content.parts.empty()) {
    result.status = ImportResult::Status::Empty;
    result.reason = content.leftovers.empty() ? "no shape" : content.leftovers + ", no solid";
    return result;
  }
  std::vector<std::string> found;
  for (const StepPart& part : content.parts) found.push_back(part.name);
  const std::vector<std::string> names = part_names(found, clean_text(file.stem().string()));
  for (std::size_t i = 0; i < content.parts.size(); ++i) {
    try {
      result.parts.push_back(
          import_part(content.parts[i], names[i], options, report, result.warnings));
    } catch (const Error& error) {
      ImportResult failure = failed(
          content.parts.size() == 1 ? error.what() : "part " + names[i] + ": " + error.what());
      failure.warnings = std::move(result.warnings);
      return failure;
    }
    result.parts.back().unit_in_file = content.unit;
  }
  for (const StepInstance& instance : content.instances) {
    result.instances.push_back(
        {is_usable_name(instance.name) ? instance.name : names[instance.part], instance.part,
         instance.X_WI});
  }
  result.status = ImportResult::Status::Ok;
  return result;
}

ImportResult import_mesh(const std::filesystem::path& file, const StageReport& report) {
  ImportedPart part;
  part.solid = read_mesh(file, report);
  part.name = clean_text(file.stem().string());
  part.unit_in_file = has_ending(file, {".glb"}) ? "m" : "mm";
  const MassProperties mass = mass_properties(part.solid);
  part.volume_mm3 = mass.volume_mm3;
  part.surface_mm2 = mass.surface_mm2;
  part.center_of_mass = mass.center_of_mass;
  report(WorkerStage::Features);
  recognise(part);
  report(WorkerStage::Box);
  part.obb = enclosing_box(part.solid);
  ImportResult result;
  result.status = ImportResult::Status::Ok;
  result.instances.push_back({part.name, 0, Pose()});
  result.parts.push_back(std::move(part));
  return result;
}

/// Runs in the worker.
ImportResult import_here(const std::filesystem::path& file, const ImportOptions& options,
                         const StageReport& report) {
  try {
    if (is_step_file(file)) return import_step(file, options, report);
    if (is_mesh_file(file)) return import_mesh(file, report);
    return failed("its ending is not one of .step .stp .obj .off .stl .ply .glb");
  } catch (const Error& error) {
    return failed(error.what());
  }
}

ImportResult from_outcome(WorkerOutcome&& outcome) {
  ImportResult result;
  if (outcome.failure.empty()) {
    try {
      result = decode_result(outcome.output);
    } catch (const Error& error) {
      result = failed(error.what());
    }
  } else {
    result = failed(outcome.failure);
  }
  result.seconds = outcome.seconds;
  return result;
}

}  // namespace

bool is_step_file(const std::filesystem::path& file) {
  return has_ending(file, {".step", ".stp"});
}

bool is_mesh_file(const std::filesystem::path& file) {
  return has_ending(file, {".obj", ".off", ".stl", ".ply", ".glb"});
}

ImportResult import_file(const std::filesystem::path& file, const ImportOptions& options) {
  ImportResult only;
  import_files({file}, options, 1, [&](std::size_t, ImportResult&& result) {
    only = std::move(result);
    return true;
  });
  return only;
}

void import_files(const std::vector<std::filesystem::path>& files, const ImportOptions& options,
                  unsigned jobs, const std::function<bool(std::size_t, ImportResult&&)>& on_done,
                  const std::function<bool()>& stop) {
  DOWEL_EXPECTS(options.deflection_mm >= 0.0 && options.angular_deflection_rad > 0.0);
  DOWEL_EXPECTS(options.max_triangles > 0);
  run_workers(
      files.size(), jobs, {options.max_seconds, options.max_memory_mb},
      [&](std::size_t i, const StageReport& report) {
        return encode(import_here(files[i], options, report));
      },
      [&](std::size_t i, WorkerOutcome&& outcome) {
        return on_done(i, from_outcome(std::move(outcome)));
      },
      stop);
}

}  // namespace dowel
