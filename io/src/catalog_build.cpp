#include "dowel/io/catalog_build.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "assembly_project.h"
#include "dowel/catalog/catalog.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "library_manifest.h"
#include "sha256.h"

namespace dowel {
namespace {

/// Grows when the same file would give other elements than before, so that catalogues refresh.
constexpr int kPipelineVersion = 7;

/// A path of the build. `problem` tells why it leads to no file.
struct Input {
  std::filesystem::path path;
  std::string problem;
};

bool is_readable_by_dowel(const std::filesystem::path& file) {
  return is_step_file(file) || is_mesh_file(file);
}

/// All files below `folder` that dowel reads, sorted. Folders that may not be entered are left out;
/// links to folders are not followed, they may lead in circles.
std::vector<Input> files_in(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<Input> files;
  std::error_code problem;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied,
                                      problem);
  while (!problem && at != fs::recursive_directory_iterator()) {
    std::error_code ignored;
    if (is_readable_by_dowel(at->path()) && at->is_regular_file(ignored)) {
      files.push_back({at->path(), ""});
    }
    at.increment(problem);
  }
  if (problem) return {{folder, "cannot be listed: " + problem.message()}};
  if (files.empty()) return {{folder, "there is no STEP or mesh file in this folder"}};
  std::ranges::sort(files, {}, [](const Input& input) { return input.path.native(); });
  return files;
}

std::vector<Input> expand(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return files_in(path);
  std::string problem;
  if (!std::filesystem::exists(status)) {
    problem = "no such file or folder";
  } else if (!std::filesystem::is_regular_file(status)) {
    problem = "is not a regular file";
  } else if (!is_readable_by_dowel(path)) {
    problem = "its name does not end as that of a STEP or mesh file";
  }
  return {{path, problem}};
}

/// Every file once, under the first name that leads to it.
std::vector<Input> expand(std::span<const std::filesystem::path> paths) {
  std::set<std::filesystem::path> seen;
  std::vector<Input> inputs;
  for (const std::filesystem::path& path : paths) {
    for (Input& input : expand(path)) {
      // "./parts/a.step" is the same source as "parts/a.step".
      input.path = input.path.lexically_normal();
      std::error_code problem;
      std::filesystem::path key = std::filesystem::weakly_canonical(input.path, problem);
      if (problem) key = input.path;
      if (seen.insert(std::move(key)).second) inputs.push_back(std::move(input));
    }
  }
  return inputs;
}

/// All that decides what a file's content gives. Limits on time and memory are left out: they
/// decide only whether it gives anything.
std::string settings_line(const ImportOptions& options) {
  char line[160];
  std::snprintf(line, sizeof line,
                "pipeline %d, deflection %.17g mm, angle %.17g rad, %u triangles, %s",
                kPipelineVersion, options.deflection_mm, options.angular_deflection_rad,
                options.max_triangles, options.whole_file ? "whole file" : "parts");
  return line;
}

/// What a file that failed was allowed: with more of it, it may not.
std::string limits_line(const ImportOptions& options) {
  char line[80];
  std::snprintf(line, sizeof line, ", at most %.17g s, %zu MB", options.max_seconds,
                options.max_memory_mb);
  return line;
}

std::string family_of(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash);
}

/// The element that a part makes. Throws Error{FileMalformed} where
/// that is not sound.
ElementRecord make_record(ImportedPart&& part, const SourceRecord& source,
                          const std::string& licence, const ElementDesign* design) {
  ElementRecord record;
  Element& element = record.element;
  element.name = part.name.empty() ? std::filesystem::path(source.path).stem().string() : part.name;
  element.family = family_of(element.name);
  element.source = source.path;
  element.sha256 = source.sha256;
  element.unit_in_file = part.unit_in_file;
  element.licence = licence;
  element.solids = part.solid.solid_count;
  element.volume_mm3 = part.volume_mm3;
  element.surface_mm2 = part.surface_mm2;
  element.center_of_mass = part.center_of_mass;
  element.colour = part.colour;
  for (const Face& face : part.solid.faces) {
    element.facet_error_mm = std::max(element.facet_error_mm, face.facet_error_mm);
  }
  element.features = std::move(part.features);
  element.bolt_circles = std::move(part.bolt_circles);
  element.shape = part.shape;
  element.triangles = part.triangles;
  element.obb = part.obb;
  std::optional<std::string> defect;
  if (design != nullptr) defect = add_design(*design, element);
  if (!defect) defect = find_defect(element);
  if (defect) throw Error(ErrorCode::FileMalformed, "part \"" + element.name + "\": " + *defect);
  record.solid = std::move(part.solid);
  record.brep = std::move(part.brep);
  return record;
}

/// A file of the build on its way into the catalogue.
struct Job {
  Input input;
  SourceRecord source;
  std::string licence;
  const ElementDesign* design = nullptr;  ///< where a manifest beside the file has one
  bool must_read = false;
  bool has_elements = false;  ///< in the catalogue, from an earlier build
  BuiltFile built;
};

class Build {
 public:
  Build(Catalog& catalog, const BuildOptions& options, const BuildCallback& on_file,
        std::vector<Input>&& inputs)
      : catalog_(catalog), options_(options), on_file_(on_file) {
    total_ = inputs.size();
    for (Input& input : inputs) {
      if (is_stopped()) break;
      jobs_.push_back(prepare(std::move(input)));
    }
  }

  std::vector<BuiltFile> run() && {
    std::vector<std::filesystem::path> files;
    std::vector<std::size_t> job_of;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      if (!jobs_[i].must_read) continue;
      files.push_back(jobs_[i].input.path);
      job_of.push_back(i);
    }
    // What goes wrong here must not pass through the reader, which has children to look after.
    std::exception_ptr failure;
    const auto on_done = [&](std::size_t i, ImportResult&& result) {
      try {
        return report_until(job_of[i]) && store(jobs_[job_of[i]], std::move(result)) &&
               report_until(job_of[i] + 1);
      } catch (...) {
        failure = std::current_exception();
        return false;
      }
    };
    if (!is_stopped()) {
      import_files(files, options_.import, options_.jobs, on_done, [this] { return is_stopped(); });
    }
    if (failure) std::rethrow_exception(failure);
    if (!is_stopped()) report_until(jobs_.size());
    return std::move(report_);
  }

 private:
  /// By the callback, or from outside.
  bool is_stopped() {
    stopped_ = stopped_ || (options_.stop && options_.stop());
    return stopped_;
  }
  Job prepare(Input&& input);
  const LibraryManifest* manifest_of(const std::filesystem::path& file);
  bool is_unchanged(const Job& job, const SourceRecord& known) const;
  bool store(Job& job, ImportResult&& result);
  bool report_until(std::size_t end);
  void make_project(Job& job);

  Catalog& catalog_;
  const BuildOptions& options_;
  const BuildCallback& on_file_;
  std::map<std::filesystem::path, LibraryManifest> manifests_;  ///< by their files; jobs point here
  std::vector<Job> jobs_;
  std::vector<BuiltFile> report_;
  std::size_t total_ = 0;
  bool stopped_ = false;
};

/// Decides whether the file must be read. Its hash is taken before: where it changes meanwhile, the
/// next build sees another one and reads it again.
Job Build::prepare(Input&& input) {
  Job job;
  job.input = std::move(input);
  job.built.file = job.input.path.string();
  job.built.reason = job.input.problem;
  if (!job.input.problem.empty()) return job;

  job.source.path = job.built.file;
  job.source.settings = settings_line(options_.import);
  try {
    job.source.sha256 = sha256_of_file(job.input.path);
    if (const LibraryManifest* const manifest = manifest_of(job.input.path)) {
      job.design = manifest->find(job.input.path);
      if (job.design != nullptr) job.source.settings += ", manifest " + manifest->sha256();
    }
  } catch (const Error& error) {
    job.built.reason = error.what();
    return job;
  }
  const std::optional<SourceRecord> known = catalog_.source(job.source.path);
  if (known && !known->elements.empty()) {
    job.has_elements = true;
    const std::optional<Element> element = catalog_.find(known->elements.front());
    if (element) job.licence = element->licence;
  }
  job.must_read = options_.force || !known || !is_unchanged(job, *known);
  if (!job.must_read) {
    job.built.reason = known->reason;
    job.built.elements = known->elements;
    job.built.status = known->status == "ok"      ? BuildStatus::Unchanged
                       : known->status == "empty" ? BuildStatus::Empty
                                                  : BuildStatus::Failed;
  }
  if (options_.licence) job.licence = *options_.licence;
  return job;
}

/// Read once, though it describes many files.
const LibraryManifest* Build::manifest_of(const std::filesystem::path& file) {
  const std::optional<std::filesystem::path> manifest = manifest_beside(file);
  if (!manifest) return nullptr;
  const auto known = manifests_.find(*manifest);
  if (known != manifests_.end()) return &known->second;
  return &manifests_.emplace(*manifest, LibraryManifest(*manifest)).first->second;
}

bool Build::is_unchanged(const Job& job, const SourceRecord& known) const {
  const bool same_licence =
      known.elements.empty() || !options_.licence || *options_.licence == job.licence;
  std::string settings = job.source.settings;
  if (known.status == to_string(BuildStatus::Failed)) settings += limits_line(options_.import);
  return known.sha256 == job.source.sha256 && known.settings == settings && same_licence;
}

/// Puts what was read into the catalogue and completes the job's report. Always true.
bool Build::store(Job& job, ImportResult&& result) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<ElementRecord> records;
  job.built.reason = result.reason;
  job.built.warnings = std::move(result.warnings);
  switch (result.status) {
    case ImportResult::Status::Ok:
      job.built.status = BuildStatus::Ok;
      break;
    case ImportResult::Status::Empty:
      job.built.status = BuildStatus::Empty;
      break;
    case ImportResult::Status::Failed:
      job.built.status = BuildStatus::Failed;
      break;
  }
  if (job.built.status == BuildStatus::Ok) {
    if (job.design != nullptr && result.parts.size() != 1) {
      job.design = nullptr;
      job.built.warnings.push_back("library.json describes one element, but the file holds " +
                                   std::to_string(result.parts.size()) + " parts");
    }
    try {
      for (ImportedPart& part : result.parts) {
        job.built.faces += part.solid.faces.size();
        records.push_back(make_record(std::move(part), job.source, job.licence, job.design));
      }
    } catch (const std::exception& error) {
      // A part that the catalogue cannot take costs its file, not the build.
      records.clear();
      job.built.faces = 0;
      job.built.status = BuildStatus::Failed;
      job.built.reason = error.what();
    }
  }
  if (job.built.status == BuildStatus::Failed && job.has_elements) {
    // Half a copy of a file must not take away the elements of the whole one.
    job.built.reason += "; the catalogue keeps what this file gave before";
  } else {
    job.source.status = to_string(job.built.status);
    job.source.reason = job.built.reason;
    if (job.built.status == BuildStatus::Failed)
      job.source.settings += limits_line(options_.import);
    for (const ImportedInstance& instance : result.instances) {
      if (records.empty()) break;
      job.source.instances.push_back({instance.name, instance.part, instance.X_WI});
    }
    job.built.elements = catalog_.put(job.source, records);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  job.built.seconds = result.seconds + taken.count();
  return true;
}

/// Of a file that was read now or before. What goes wrong is a warning: the elements are in the
/// catalogue.
void Build::make_project(Job& job) {
  if (!options_.assemblies || job.built.elements.empty()) return;
  const std::filesystem::path file =
      *options_.assemblies / (job.input.path.stem().string() + ".dowelproj");
  try {
    const SourceRecord source = catalog_.source(job.source.path).value();
    if (source.instances.size() < 2) return;
    if (std::filesystem::exists(file)) {
      const bool is_old = job.built.status == BuildStatus::Ok;
      if (is_old) job.built.warnings.push_back(file.string() + " exists and is left as it is");
      return;
    }
    std::filesystem::create_directories(*options_.assemblies);
    write_assembly_project(file, catalog_, source);
    job.built.project = file.string();
    job.built.instances = source.instances.size();
  } catch (const std::exception& error) {
    job.built.warnings.push_back("no project: " + std::string(error.what()));
  }
}

/// Reports the files before `end` that were not reported yet. False: the caller wants no more.
bool Build::report_until(std::size_t end) {
  while (!stopped_ && report_.size() < end) {
    make_project(jobs_[report_.size()]);
    report_.push_back(std::move(jobs_[report_.size()].built));
    stopped_ = on_file_ && !on_file_(report_.back(), report_.size(), total_);
  }
  return !stopped_;
}

}  // namespace

std::string_view to_string(BuildStatus status) {
  switch (status) {
    case BuildStatus::Ok:
      return "ok";
    case BuildStatus::Unchanged:
      return "unchanged";
    case BuildStatus::Empty:
      return "empty";
    case BuildStatus::Failed:
      return "failed";
  }
  DOWEL_EXPECTS(false && "a known status");
  return {};
}

std::vector<BuiltFile> build_catalog(std::span<const std::filesystem::path> paths,
                                     const std::filesystem::path& catalog_file,
                                     const BuildOptions& options, const BuildCallback& on_file) {
  std::vector<Input> inputs = expand(paths);
  const bool has_file =
      std::ranges::any_of(inputs, [](const Input& input) { return input.problem.empty(); });
  if (!has_file) {
    std::vector<BuiltFile> report;
    for (const Input& input : inputs) {
      BuiltFile missing;
      missing.file = input.path.string();
      missing.reason = input.problem;
      report.push_back(std::move(missing));
      if (on_file && !on_file(report.back(), report.size(), inputs.size())) break;
    }
    return report;
  }
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(catalog_file, ignored);
  std::vector<BuiltFile> report;
  {
    Catalog catalog(catalog_file, Catalog::Access::ReadWrite);
    report = Build(catalog, options, on_file, std::move(inputs)).run();
  }
  if (is_new && std::ranges::all_of(report, [](const BuiltFile& file) {
        return file.status == BuildStatus::Failed;
      })) {
    std::filesystem::remove(catalog_file, ignored);
  }
  return report;
}

}  // namespace dowel
