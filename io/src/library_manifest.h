#pragma once

// library.json: what the maker of a library of elements states about them beside their solids.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"

namespace dowel {

/// What is stated about one element. Of its features, place, size and what a solid cannot tell.
struct ElementDesign {
  std::string family;
  std::string licence;
  std::string role;
  std::string description;
  std::string material;
  std::string dimensions_by;
  double density_kg_per_m3 = 0.0;
  std::vector<Feature> features;
};

class LibraryManifest {
 public:
  /// Reads `file` in the format "dowel-library/1" (io/README.md); a file of another program states
  /// nothing. Throws Error{FileUnreadable},
  /// Error{FileMalformed} naming the place and what was expected there.
  explicit LibraryManifest(const std::filesystem::path& file);

  /// SHA-256 of the manifest.
  const std::string& sha256() const { return sha256_; }

  /// What it states about the element of `element_file`; nothing where it does not list it.
  const ElementDesign* find(const std::filesystem::path& element_file) const;

 private:
  std::filesystem::path folder_;
  std::string sha256_;
  std::map<std::string, ElementDesign> designs_;  ///< by the file's path in the folder
};

/// The manifest that can describe `element_file`: library.json in its folder, else in the one
/// above.
std::optional<std::filesystem::path> manifest_beside(const std::filesystem::path& element_file);

/// Adds to `element` what is stated about it. Stated features are matched by where and how large
/// they are. Returns one sentence about the first that the solid does not have; nothing where it
/// has all.
std::optional<std::string> add_design(const ElementDesign& design, Element& element);

}  // namespace dowel
