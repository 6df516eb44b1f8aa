#pragma once

// An element as rows of the catalogue's tables. Internal to the store.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>

#include "dowel/catalog/element.h"

namespace dowel {

/// Writes the element's rows, without its content. Returns the element's row id. Throws
/// SQLite::Exception.
std::int64_t insert_element(SQLite::Database& database, std::int64_t source_id,
                            std::int64_t position, const Element& element);

/// Reads elements one by one with statements that are prepared once: of many elements, preparing
/// would take most of the time. Between two reads none of them is left open, for that would lock
/// the file.
class ElementReader {
 public:
  /// `file` begins every complaint. The database must outlive the reader.
  ElementReader(SQLite::Database& database, std::string file);

  /// The element called `name`. The rows are untrusted: throws Error{FileMalformed} where they make
  /// no sound element, SQLite::Exception where they cannot be read.
  std::optional<Element> read(std::string_view name);

 private:
  /// Those of tables that the catalogue's version does not have are missing.
  struct Statements {
    Statements(SQLite::Database& database, std::int64_t of_version);
    void reset() noexcept;

    std::int64_t version;
    SQLite::Statement element;
    SQLite::Statement features;
    SQLite::Statement segments;
    std::optional<SQLite::Statement> slots;
    std::optional<SQLite::Statement> feature_designs;
    std::optional<SQLite::Statement> element_design;
    std::optional<SQLite::Statement> bolt_circles;
    std::optional<SQLite::Statement> bolt_circle_holes;
  };
  Statements& statements();
  static std::optional<Element> read(Statements& statements, std::string_view name,
                                     const std::string& file);

  std::string file_;
  SQLite::Statement version_;
  SQLite::Database& database_;
  std::optional<Statements> statements_;
};

}  // namespace dowel
