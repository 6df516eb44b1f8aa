#include "project_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "design_rows.h"
#include "dowel/assembly/names.h"
#include "dowel/kernel/error.h"

namespace dowel {
namespace {

constexpr const char* kModeSetting = "mode";
constexpr const char* kToleranceSetting = "tolerance_mm";

/// Adds what is only in `from`, or differs, to `before`, and likewise `to` to `after`. Side by
/// side, for both are sorted and mostly the same.
template <class Map, class Row>
void add_difference(const Map& from, const Map& to, std::vector<Row>& before,
                    std::vector<Row>& after) {
  auto a = from.begin();
  auto b = to.begin();
  while (a != from.end() || b != to.end()) {
    if (b == to.end() || (a != from.end() && a->first < b->first)) {
      before.push_back((a++)->second);
    } else if (a == from.end() || b->first < a->first) {
      after.push_back((b++)->second);
    } else {
      if (!(a->second == b->second)) {
        before.push_back(a->second);
        after.push_back(b->second);
      }
      ++a;
      ++b;
    }
  }
}

std::map<std::string, SettingRow> by_name(std::vector<SettingRow> rows) {
  std::map<std::string, SettingRow> result;
  for (SettingRow& row : rows) {
    std::string name = row.name;
    result.emplace(std::move(name), std::move(row));
  }
  return result;
}

[[noreturn]] void fail_to_fit(const std::string& row) {
  throw Error(ErrorCode::FileMalformed, "the journal does not fit the project: " + row);
}

template <class Map, class Key, class Row>
void take(Map& map, const Key& key, const Row& row, const std::string& what) {
  const auto found = map.find(key);
  if (found == map.end() || !(found->second == row)) {
    fail_to_fit(what + " is not as the journal left it");
  }
  map.erase(found);
}

template <class Map, class Key, class Row>
void put(Map& map, const Key& key, const Row& row, const std::string& what) {
  if (!map.emplace(key, row).second) fail_to_fit(what + " is there already");
}

bool is_known(const ProjectState& state, const FeatureName& name) {
  return state.instances.contains(name.instance);
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::vector<SettingRow> settings_of(const ProjectState& state) {
  std::vector<SettingRow> rows{{kModeSetting, std::string(to_string(state.mode))},
                               {kToleranceSetting, number_text(state.tolerance_mm)}};
  for (SettingRow& row : rows_of(state.design)) rows.push_back(std::move(row));
  return rows;
}

void apply_setting(ProjectState& state, const SettingRow& row) {
  if (row.name == kModeSetting) {
    if (const auto mode = check_mode_from(row.value)) {
      state.mode = *mode;
      return;
    }
  } else if (row.name == kToleranceSetting) {
    double value = 0.0;
    const char* const end = row.value.data() + row.value.size();
    const auto [stop, error] = std::from_chars(row.value.data(), end, value);
    if (error == std::errc{} && stop == end && is_tolerance(value)) {
      state.tolerance_mm = value;
      return;
    }
  } else if (put_row(state.design, row)) {
    return;
  }
  throw Error(ErrorCode::FileMalformed,
              "setting \"" + row.name + "\" has the unknown value \"" + row.value + "\"");
}

ProjectChange difference(const ProjectState& from, const ProjectState& to) {
  ProjectChange change;
  add_difference(by_name(settings_of(from)), by_name(settings_of(to)), change.before.settings,
                 change.after.settings);
  add_difference(from.instances, to.instances, change.before.instances, change.after.instances);
  add_difference(from.mates, to.mates, change.before.mates, change.after.mates);
  return change;
}

ProjectState changed(const ProjectState& state, const ProjectChange& change) {
  ProjectState next = state;
  const std::vector<SettingRow> present = settings_of(state);
  for (const SettingRow& row : change.before.settings) {
    if (std::ranges::find(present, row) == present.end()) {
      fail_to_fit("setting \"" + row.name + "\" is not as the journal left it");
    }
    take_row(next.design, row);
  }
  for (const Mate& mate : change.before.mates) {
    take(next.mates, mate.number, mate, "mate " + std::to_string(mate.number));
  }
  for (const Instance& instance : change.before.instances) {
    take(next.instances, instance.name, instance, "instance \"" + instance.name + "\"");
  }
  for (const SettingRow& row : change.after.settings) apply_setting(next, row);
  for (const Instance& instance : change.after.instances) {
    put(next.instances, instance.name, instance, "instance \"" + instance.name + "\"");
  }
  for (const Mate& mate : change.after.mates) {
    put(next.mates, mate.number, mate, "mate " + std::to_string(mate.number));
  }
  return next;
}

std::optional<std::string> find_defect(const ProjectState& state,
                                       const std::vector<std::string>& elements) {
  std::vector<std::uint32_t> numbers;
  for (const auto& [name, instance] : state.instances) {
    if (const auto defect = instance_name_defect(name)) {
      return "instance name \"" + name + "\" " + *defect;
    }
    numbers.push_back(instance.number);
    if (!std::ranges::binary_search(elements, instance.element)) {
      return "instance \"" + name + "\" is of element \"" + instance.element +
             "\", of which there is no copy";
    }
  }
  std::ranges::sort(numbers);
  const auto twice = std::ranges::adjacent_find(numbers);
  if (twice != numbers.end()) {
    return "two instances have the number " + std::to_string(*twice);
  }
  for (const auto& [number, mate] : state.mates) {
    const bool sound = is_known(state, mate.moving) && is_known(state, mate.fixed) &&
                       (!mate.has_seat() ||
                        (is_known(state, mate.moving_face) && is_known(state, mate.fixed_face))) &&
                       std::isfinite(mate.offset_mm) && std::isfinite(mate.angle_rad);
    if ((mate.kind == MateKind::Fix) != mate.X_FM.has_value()) {
      return "mate " + std::to_string(number) + " has a held pose, or none, against its kind";
    }
    if (!sound) return "mate " + std::to_string(number) + " is between unknown instances";
  }
  return std::nullopt;
}

std::optional<MateKind> mate_kind_from(std::string_view text) {
  using enum MateKind;
  for (const MateKind kind : {ShaftInHole, HoleOnHole, BlindHoleOnHole, HoleOverShaft, FaceOnFace,
                              Align, KeyInSlot, Angle, Fix}) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

std::optional<CheckMode> check_mode_from(std::string_view text) {
  for (const CheckMode mode : {CheckMode::Block, CheckMode::Warn, CheckMode::Off}) {
    if (to_string(mode) == text) return mode;
  }
  return std::nullopt;
}

}  // namespace dowel
