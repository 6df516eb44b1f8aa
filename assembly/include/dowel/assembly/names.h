#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace dowel {

/// Why `name` cannot name an instance ("has a dot at 3: ..."), or nothing where it can. Names are
/// UTF-8 of at most 64 bytes without white space, control characters, dots and quotes, and do not
/// start with '#': so that INSTANCE.FEATURE can be read, and written without quotes.
std::optional<std::string> instance_name_defect(std::string_view name);

/// Role of an element as its name tells it, in upper case: "PLATE" for "H40-12/plate-10x8", the
/// first word without digits behind the last '/'; "PART" where there is none.
std::string role_of(std::string_view element_name);

/// First of ROLE1, ROLE2, ... that `is_taken` does not know.
std::string free_name(std::string_view element_name,
                      const std::function<bool(const std::string&)>& is_taken);

/// True for a tolerance between contact and interference that can be asked for, in mm.
bool is_tolerance(double tolerance_mm);

}  // namespace dowel
