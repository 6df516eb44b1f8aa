#include "design_rows.h"

#include <array>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kRole = "role ";
constexpr std::string_view kClampForce = "clamp-force ";
constexpr std::string_view kLocatorError = "locator-error ";
constexpr std::string_view kLoad = "load ";
constexpr std::string_view kPoint = "point ";
constexpr std::string_view kLimit = "limit ";
constexpr std::string_view kStated = "stated ";
constexpr std::string_view kOverride = "override ";
constexpr std::string_view kWaiver = "waiver ";

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

SettingRow row(std::string_view kind, const std::string& name, const Json& value) {
  return {std::string(kind) + name, dump(value)};
}

Json to_json(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

double number_from(const Json& json) {
  const double value = json.get<double>();
  if (!std::isfinite(value)) throw Error(ErrorCode::FileMalformed, "a number is not finite");
  return value;
}

Eigen::Vector3d vector_from(const Json& json) {
  const auto values = json.get<std::array<double, 3>>();
  Eigen::Vector3d vector(values[0], values[1], values[2]);
  if (!vector.allFinite()) throw Error(ErrorCode::FileMalformed, "a vector is not finite");
  return vector;
}

/// The name behind `kind` where the row is of that kind.
std::optional<std::string> name_in(const SettingRow& row, std::string_view kind) {
  if (!row.name.starts_with(kind)) return std::nullopt;
  return row.name.substr(kind.size());
}

/// Rule or quantity, and subject: neither a rule's id nor a quantity's name has a blank.
std::pair<std::string, std::string> key_with_subject(const std::string& name) {
  const std::size_t blank = name.find(' ');
  if (blank == std::string::npos) throw Error(ErrorCode::FileMalformed, "there is no subject");
  return {name.substr(0, blank), name.substr(blank + 1)};
}

bool put(FixtureDesign& design, const SettingRow& row, const Json& value) {
  if (const auto name = name_in(row, kRole)) {
    const auto role = role_from(value.get<std::string>());
    if (!role) throw Error(ErrorCode::FileMalformed, "an unknown role");
    design.roles[*name] = *role;
  } else if (const auto clamp = name_in(row, kClampForce)) {
    design.clamp_forces_N[*clamp] = number_from(value);
  } else if (const auto locator = name_in(row, kLocatorError)) {
    design.locator_errors_mm[*locator] = number_from(value);
  } else if (const auto load = name_in(row, kLoad)) {
    design.loads[*load] = {vector_from(value.at("force_N")), vector_from(value.at("at")),
                           vector_from(value.at("torque_Nmm"))};
  } else if (const auto point = name_in(row, kPoint)) {
    design.points[*point] = {vector_from(value.at("at")), number_from(value.at("tolerance_mm"))};
  } else if (const auto limit = name_in(row, kLimit)) {
    if (find_limit(*limit) == nullptr) throw Error(ErrorCode::FileMalformed, "an unknown limit");
    design.limits[*limit] = number_from(value);
  } else if (const auto stated = name_in(row, kStated)) {
    const auto key = key_with_subject(*stated);
    if (find_stated_quantity(key.first) == nullptr) {
      throw Error(ErrorCode::FileMalformed, "an unknown quantity");
    }
    design.stated[key] = {number_from(value.at("value")), value.at("reason").get<std::string>()};
  } else if (const auto rule = name_in(row, kOverride)) {
    design.overrides[*rule] = {value.at("severity").get<std::string>(),
                               value.at("reason").get<std::string>()};
  } else if (const auto waived = name_in(row, kWaiver)) {
    design.waivers[key_with_subject(*waived)] = {value.at("reason").get<std::string>(),
                                                 value.at("by").get<std::string>(),
                                                 value.at("digest").get<std::string>()};
  } else {
    return false;
  }
  return true;
}

}  // namespace

std::vector<SettingRow> rows_of(const FixtureDesign& design) {
  std::vector<SettingRow> rows;
  for (const auto& [name, role] : design.roles) rows.push_back(row(kRole, name, to_string(role)));
  for (const auto& [name, force_N] : design.clamp_forces_N) {
    rows.push_back(row(kClampForce, name, force_N));
  }
  for (const auto& [name, error_mm] : design.locator_errors_mm) {
    rows.push_back(row(kLocatorError, name, error_mm));
  }
  for (const auto& [name, load] : design.loads) {
    rows.push_back(row(kLoad, name,
                       {{"force_N", to_json(load.force_N)},
                        {"at", to_json(load.at)},
                        {"torque_Nmm", to_json(load.torque_Nmm)}}));
  }
  for (const auto& [name, point] : design.points) {
    rows.push_back(
        row(kPoint, name, {{"at", to_json(point.at)}, {"tolerance_mm", point.tolerance_mm}}));
  }
  for (const auto& [name, value] : design.limits) rows.push_back(row(kLimit, name, value));
  for (const auto& [key, stated] : design.stated) {
    rows.push_back(row(kStated, key.first + " " + key.second,
                       {{"value", stated.value}, {"reason", stated.reason}}));
  }
  for (const auto& [rule, change] : design.overrides) {
    rows.push_back(
        row(kOverride, rule, {{"severity", change.severity}, {"reason", change.reason}}));
  }
  for (const auto& [key, waiver] : design.waivers) {
    rows.push_back(row(kWaiver, key.first + " " + key.second,
                       {{"reason", waiver.reason}, {"by", waiver.by}, {"digest", waiver.digest}}));
  }
  return rows;
}

bool put_row(FixtureDesign& design, const SettingRow& row) {
  try {
    // A row of another kind need not be JSON.
    const Json value = Json::parse(row.value, nullptr, false);
    return put(design, row, value);
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::FileMalformed, "setting \"" + row.name + "\": " + error.what());
  } catch (const Error& error) {
    throw Error(error.code(), "setting \"" + row.name + "\": " + error.what());
  }
}

bool take_row(FixtureDesign& design, const SettingRow& row) {
  const auto take = [&](auto& map, std::string_view kind) {
    const auto name = name_in(row, kind);
    return name && map.erase(*name) > 0;
  };
  if (const auto waived = name_in(row, kWaiver))
    return design.waivers.erase(key_with_subject(*waived)) > 0;
  if (const auto stated = name_in(row, kStated))
    return design.stated.erase(key_with_subject(*stated)) > 0;
  return take(design.roles, kRole) || take(design.clamp_forces_N, kClampForce) ||
         take(design.locator_errors_mm, kLocatorError) || take(design.loads, kLoad) ||
         take(design.points, kPoint) || take(design.limits, kLimit) ||
         take(design.overrides, kOverride);
}

}  // namespace dowel
