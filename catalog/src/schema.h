#pragma once

// The catalogue file's tables. Internal to the store.

#include <array>
#include <cstdint>

namespace dowel {

/// "DWLC" in the database header: tells a catalogue from any other SQLite file.
inline constexpr std::int32_t kCatalogApplicationId = 0x44574C43;

/// Grows with every change of the tables below. Older ones are read as they are, and brought up to
/// this one when they are opened for writing.
///  1: the first
///  2: `slot`
///  3: `element_design`, `feature_design`
///  4: `bolt_circle`, `bolt_circle_hole`
///  5: `instance`
///  6: `blob`, `element_blob`
inline constexpr std::int32_t kCatalogVersion = 6;

/// The first version that keeps the shape of slots.
inline constexpr std::int32_t kSlotVersion = 2;

/// The first version that keeps what the maker of an element states about it.
inline constexpr std::int32_t kDesignVersion = 3;

/// The first version that keeps bolt circles.
inline constexpr std::int32_t kBoltCircleVersion = 4;

/// The first version that keeps where assemblies have their elements.
inline constexpr std::int32_t kInstanceVersion = 5;

/// The first version that keeps equal content once.
inline constexpr std::int32_t kSharedContentVersion = 6;

struct SchemaTable {
  const char* name = nullptr;
  const char* sql = nullptr;  ///< as sqlite_schema keeps it, to the letter
  std::int32_t since = 1;     ///< version that brought it
};

/// Every table that a catalogue of this version has. They are columns rather than documents so that
/// rules can be written over them in SQL.
inline constexpr std::array<SchemaTable, 13> kCatalogTables{{
    {"source", R"(CREATE TABLE source (
  id INTEGER PRIMARY KEY,
  path TEXT NOT NULL UNIQUE,
  sha256 TEXT NOT NULL,
  settings TEXT NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('ok', 'empty', 'failed')),
  reason TEXT NOT NULL
) STRICT)"},
    {"element", R"(CREATE TABLE element (
  id INTEGER PRIMARY KEY,
  source_id INTEGER NOT NULL REFERENCES source (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  name TEXT NOT NULL UNIQUE,
  family TEXT NOT NULL,
  unit_in_file TEXT NOT NULL,
  licence TEXT NOT NULL,
  shape TEXT NOT NULL CHECK (shape IN ('block', 'cylinder', 'block-cylinder', 'compound')),
  solids INTEGER NOT NULL,
  volume_mm3 REAL NOT NULL,
  surface_mm2 REAL NOT NULL,
  center_of_mass_x REAL NOT NULL,
  center_of_mass_y REAL NOT NULL,
  center_of_mass_z REAL NOT NULL,
  obb_center_x REAL NOT NULL,
  obb_center_y REAL NOT NULL,
  obb_center_z REAL NOT NULL,
  obb_axis_1_x REAL NOT NULL,
  obb_axis_1_y REAL NOT NULL,
  obb_axis_1_z REAL NOT NULL,
  obb_axis_2_x REAL NOT NULL,
  obb_axis_2_y REAL NOT NULL,
  obb_axis_2_z REAL NOT NULL,
  obb_axis_3_x REAL NOT NULL,
  obb_axis_3_y REAL NOT NULL,
  obb_axis_3_z REAL NOT NULL,
  obb_half_1_mm REAL NOT NULL,
  obb_half_2_mm REAL NOT NULL,
  obb_half_3_mm REAL NOT NULL,
  triangles INTEGER NOT NULL,
  plane_triangles INTEGER NOT NULL,
  hole_triangles INTEGER NOT NULL,
  other_triangles INTEGER NOT NULL,
  facet_error_mm REAL NOT NULL,
  red REAL,
  green REAL,
  blue REAL,
  UNIQUE (source_id, position)
) STRICT)"},
    {"feature", R"(CREATE TABLE feature (
  element_id INTEGER NOT NULL REFERENCES element (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('hole', 'shaft', 'face', 'slot')),
  origin_x REAL NOT NULL,
  origin_y REAL NOT NULL,
  origin_z REAL NOT NULL,
  direction_x REAL NOT NULL,
  direction_y REAL NOT NULL,
  direction_z REAL NOT NULL,
  diameter_mm REAL NOT NULL,
  depth_mm REAL NOT NULL,
  through INTEGER NOT NULL CHECK (through IN (0, 1)),
  blind_end TEXT NOT NULL,
  entry TEXT NOT NULL,
  area_mm2 REAL NOT NULL,
  faces TEXT NOT NULL,
  PRIMARY KEY (element_id, position),
  UNIQUE (element_id, name)
) STRICT, WITHOUT ROWID)"},
    {"hole_segment", R"(CREATE TABLE hole_segment (
  element_id INTEGER NOT NULL,
  feature_position INTEGER NOT NULL,
  position INTEGER NOT NULL,
  type TEXT NOT NULL CHECK (type IN ('cylinder', 'cone')),
  diameter_mm REAL NOT NULL,
  diameter_end_mm REAL NOT NULL,
  from_mm REAL NOT NULL,
  to_mm REAL NOT NULL,
  PRIMARY KEY (element_id, feature_position, position),
  FOREIGN KEY (element_id, feature_position) REFERENCES feature (element_id, position)
    ON DELETE CASCADE
) STRICT, WITHOUT ROWID)"},
    {"slot",
     R"(CREATE TABLE slot (
  element_id INTEGER NOT NULL,
  feature_position INTEGER NOT NULL,
  type TEXT NOT NULL CHECK (type IN ('plain', 'tee', 'through')),
  run_x REAL NOT NULL,
  run_y REAL NOT NULL,
  run_z REAL NOT NULL,
  length_mm REAL NOT NULL,
  low_end TEXT NOT NULL CHECK (low_end IN ('open', 'flat', 'round')),
  high_end TEXT NOT NULL CHECK (high_end IN ('open', 'flat', 'round')),
  throat_depth_mm REAL NOT NULL,
  undercut_width_mm REAL NOT NULL,
  undercut_height_mm REAL NOT NULL,
  nominal_mm INTEGER NOT NULL,
  PRIMARY KEY (element_id, feature_position),
  FOREIGN KEY (element_id, feature_position) REFERENCES feature (element_id, position)
    ON DELETE CASCADE
) STRICT, WITHOUT ROWID)",
     kSlotVersion},
    {"element_design",
     R"(CREATE TABLE element_design (
  element_id INTEGER PRIMARY KEY REFERENCES element (id) ON DELETE CASCADE,
  role TEXT NOT NULL,
  description TEXT NOT NULL,
  material TEXT NOT NULL,
  dimensions_by TEXT NOT NULL,
  density_kg_per_m3 REAL NOT NULL
) STRICT)",
     kDesignVersion},
    {"feature_design",
     R"(CREATE TABLE feature_design (
  element_id INTEGER NOT NULL,
  feature_position INTEGER NOT NULL,
  use TEXT NOT NULL,
  thread TEXT NOT NULL,
  thread_is_guess INTEGER NOT NULL CHECK (thread_is_guess IN (0, 1)),
  fit TEXT NOT NULL,
  PRIMARY KEY (element_id, feature_position),
  FOREIGN KEY (element_id, feature_position) REFERENCES feature (element_id, position)
    ON DELETE CASCADE
) STRICT, WITHOUT ROWID)",
     kDesignVersion},
    {"bolt_circle",
     R"(CREATE TABLE bolt_circle (
  element_id INTEGER NOT NULL REFERENCES element (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  center_x REAL NOT NULL,
  center_y REAL NOT NULL,
  center_z REAL NOT NULL,
  direction_x REAL NOT NULL,
  direction_y REAL NOT NULL,
  direction_z REAL NOT NULL,
  diameter_mm REAL NOT NULL,
  hole_diameter_mm REAL NOT NULL,
  PRIMARY KEY (element_id, position)
) STRICT, WITHOUT ROWID)",
     kBoltCircleVersion},
    {"bolt_circle_hole",
     R"(CREATE TABLE bolt_circle_hole (
  element_id INTEGER NOT NULL,
  circle_position INTEGER NOT NULL,
  position INTEGER NOT NULL,
  hole TEXT NOT NULL,
  PRIMARY KEY (element_id, circle_position, position),
  FOREIGN KEY (element_id, circle_position) REFERENCES bolt_circle (element_id, position)
    ON DELETE CASCADE
) STRICT, WITHOUT ROWID)",
     kBoltCircleVersion},
    {"instance",
     R"(CREATE TABLE instance (
  source_id INTEGER NOT NULL REFERENCES source (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  element_position INTEGER NOT NULL,
  name TEXT NOT NULL,
  qw REAL NOT NULL,
  qx REAL NOT NULL,
  qy REAL NOT NULL,
  qz REAL NOT NULL,
  x_mm REAL NOT NULL,
  y_mm REAL NOT NULL,
  z_mm REAL NOT NULL,
  PRIMARY KEY (source_id, position)
) STRICT, WITHOUT ROWID)",
     kInstanceVersion},
    {"content", R"(CREATE TABLE content (
  element_id INTEGER NOT NULL REFERENCES element (id) ON DELETE CASCADE,
  kind TEXT NOT NULL CHECK (kind IN ('facets', 'brep')),
  checksum INTEGER NOT NULL,
  bytes BLOB NOT NULL,
  UNIQUE (element_id, kind)
) STRICT)"},
    {"blob",
     R"(CREATE TABLE blob (
  id INTEGER PRIMARY KEY,
  checksum INTEGER NOT NULL,
  repeat INTEGER NOT NULL,
  bytes BLOB NOT NULL,
  UNIQUE (checksum, repeat)
) STRICT)",
     kSharedContentVersion},
    {"element_blob",
     R"(CREATE TABLE element_blob (
  element_id INTEGER NOT NULL REFERENCES element (id) ON DELETE CASCADE,
  kind TEXT NOT NULL CHECK (kind IN ('facets', 'brep')),
  blob_id INTEGER NOT NULL REFERENCES blob (id),
  PRIMARY KEY (element_id, kind),
  UNIQUE (blob_id, element_id, kind)
) STRICT, WITHOUT ROWID)",
     kSharedContentVersion},
}};

}  // namespace dowel
