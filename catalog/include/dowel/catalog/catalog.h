#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// An element where an assembly has it.
struct SourceInstance {
  std::string name;         ///< of the component; not unique
  std::size_t element = 0;  ///< index into the source's elements
  Pose X_WI;                ///< in the frame of the assembly
};

/// What the catalogue keeps of a file that was imported, so that an unchanged one can be skipped.
struct SourceRecord {
  std::string path;      ///< as given to the build, the key
  std::string sha256;    ///< of its content
  std::string settings;  ///< what the import was told, in one line; another value means "changed"
  std::string status;    ///< "ok", "empty" or "failed"
  std::string reason;    ///< for the last two
  std::vector<std::string> elements;
  std::vector<SourceInstance> instances{};  ///< at least one of each element, where it is known
};

/// An element with its heavy parts, as an import makes it.
struct ElementRecord {
  Element element;
  FacetedSolid solid;
  std::vector<std::byte> brep;  ///< opaque here; io writes and reads it. May be empty.
};

/// Element catalogue in one SQLite file that needs nothing else. Listing reads no mesh; facets and
/// boundary representation are loaded on demand. Movable; not thread-safe: one Catalog a thread.
/// Every function throws Error{FileMalformed} where the file turns out damaged, and names it.
class Catalog {
 public:
  enum class Access { ReadOnly, ReadWrite };

  /// ReadOnly opens an existing catalogue without locks or side files. ReadWrite creates the file
  /// where it is missing. Throws Error{FileUnreadable} (missing, a folder), Error{SchemaMismatch}
  /// (not a catalogue, or of a newer version), Error{FileUnwritable}.
  Catalog(const std::filesystem::path& file, Access access);
  ~Catalog();
  Catalog(Catalog&&) noexcept;
  Catalog& operator=(Catalog&&) noexcept;

  /// All names, sorted.
  std::vector<std::string> names() const;

  /// The element called `name`; nothing where there is none.
  std::optional<Element> find(std::string_view name) const;

  /// Names that `name` may have been meant for, best first, at most `count`.
  std::vector<std::string> similar_names(std::string_view name, std::size_t count = 3) const;

  /// Facets of an element. Throws Error{NotFound}.
  std::shared_ptr<const FacetedSolid> solid(std::string_view name) const;

  /// Boundary representation of an element as `ElementRecord::brep` had it. Throws Error{NotFound}.
  std::vector<std::byte> brep(std::string_view name) const;

  std::optional<SourceRecord> source(std::string_view path) const;

  /// Records one imported file in one transaction: what it gave before is replaced. An element
  /// whose name another source already uses is renamed `NAME~2`, `NAME~3`, …; the names that were
  /// stored are returned. Throws Error{FileUnwritable} and leaves the catalogue as it was.
  std::vector<std::string> put(const SourceRecord& source, std::span<const ElementRecord> elements);

  const std::filesystem::path& file() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dowel
