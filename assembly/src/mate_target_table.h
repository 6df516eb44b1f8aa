#pragma once

// The table of what a mate asks beside its features and offset. Internal to ProjectDatabase.

#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "dowel/assembly/project.h"

namespace dowel {

inline constexpr const char* kMateTargetTable = "mate_target";

/// As sqlite_schema keeps it, to the letter. One row for each Angle and each Fix.
inline constexpr const char* kMateTargetSql = R"(CREATE TABLE mate_target (
  mate INTEGER PRIMARY KEY REFERENCES mate (number) ON DELETE CASCADE,
  angle_rad REAL NOT NULL,
  qw REAL,
  qx REAL,
  qy REAL,
  qz REAL,
  x_mm REAL,
  y_mm REAL,
  z_mm REAL
) STRICT)";

/// Reads the rows, if the table is there, into the mates of `state`. Throws Error{FileMalformed}.
void read_mate_targets(SQLite::Database& database, ProjectState& state, const std::string& title);

/// Writes the row of a mate that needs one.
void write_mate_target(SQLite::Database& database, const Mate& mate);

}  // namespace dowel
