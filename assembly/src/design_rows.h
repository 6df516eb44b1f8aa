#pragma once

// A fixture's design as rows of the table "setting". Internal to Project.

#include <vector>

#include "project_rows.h"

namespace dowel {

/// One row for each entry, named "role REST1", "limit friction"; values are JSON.
std::vector<SettingRow> rows_of(const FixtureDesign& design);

/// Puts the entry of a row into the design, or takes it out (then the value does not matter). False
/// where the name is none of a design's. Throws Error{FileMalformed} for a value that makes no
/// sense.
bool put_row(FixtureDesign& design, const SettingRow& row);
bool take_row(FixtureDesign& design, const SettingRow& row);

}  // namespace dowel
