#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace dowel::tools {

/// Keys keep the order in which they were set: what the program prints is read by people, too.
using Json = nlohmann::ordered_json;

/// [x, y, z]
Json to_json(const Eigen::Vector3d& vector);

/// On one line. Numbers read back as the same double; bytes that are no UTF-8 are replaced.
std::string to_line(const Json& json);

/// Writes `text` and a line end to standard output. Throws Error{FileUnwritable} where that fails,
/// as on a full disk: a cut result must not look like a whole one.
void print_line(std::string_view text);

}  // namespace dowel::tools
