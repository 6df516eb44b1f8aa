#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/collision/verdict.h"
#include "scenario.h"

namespace dowel::bench {

/// What is known of a pose by construction, without a collision test.
struct Truth {
  /// The worst verdict over all elements at the default tolerance.
  std::optional<Verdict> verdict;
  /// Whether the surfaces of the facets have a point in common: the question that triangle
  /// libraries answer. An exact touch counts as yes.
  std::optional<bool> surfaces_meet;
};

/// Free: on the way through the fixture. Near: sliding 0.05 to 1 mm above tops. Insert: plunges and
/// drags that run into parts, slides pressed into a top. Fit: pin in hole, nut on stud. Contact:
/// sliding on tops, exactly flush and up to 1e-3 mm off. Contained: wholly inside a block. Tight:
/// as fit, but off the axis by up to more than the clearance, less than what facets are off by.
enum class MotionKind : std::uint8_t { Free, Near, Insert, Fit, Contact, Contained, Tight };

inline constexpr std::array kMotionKinds{
    MotionKind::Free,    MotionKind::Near,      MotionKind::Insert, MotionKind::Fit,
    MotionKind::Contact, MotionKind::Contained, MotionKind::Tight};

std::string_view to_string(MotionKind kind);

struct Motion {
  MotionKind kind = MotionKind::Free;
  std::vector<Pose> poses;  ///< of the moving element, in the order of a drag
  std::vector<Truth> truth;
};

/// The same on every machine. Another `variant` has other poses.
Motion motion_of(const Scenario& scenario, MotionKind kind, std::size_t count,
                 std::uint64_t variant = 0);

/// A drag over the tops of a field of elements, 0.05 to 1 mm above them, and down between them.
std::vector<Pose> field_path(const Scenario& scenario, std::size_t count);

/// Bounds by boxes and balls: the truth of a pose where they suffice. `skip`: an element that is
/// known to be clear.
Truth truth_by_bounds(const Scenario& scenario, const Pose& X_WM,
                      std::optional<std::size_t> skip = {});

}  // namespace dowel::bench
