#include "dowel/assembly/thread.h"

#include <algorithm>
#include <cmath>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// True where `segment` is a core hole for a thread of the shaft's diameter.
bool is_core_hole(double shaft_diameter_mm, const HoleSegment& segment) {
  return segment.type == HoleSegment::Type::Cylinder &&
         forms_thread(shaft_diameter_mm, segment.diameter_mm);
}

/// The core hole `segments[i]` with the chamfers beside it that narrow towards it.
DepthRange with_chamfers(const std::vector<HoleSegment>& segments, std::size_t i) {
  DepthRange stretch{segments[i].from_mm, segments[i].to_mm};
  if (i > 0 && segments[i - 1].type == HoleSegment::Type::Cone &&
      segments[i - 1].diameter_mm > segments[i - 1].diameter_end_mm) {
    stretch.from_mm = segments[i - 1].from_mm;
  }
  if (i + 1 < segments.size() && segments[i + 1].type == HoleSegment::Type::Cone &&
      segments[i + 1].diameter_mm < segments[i + 1].diameter_end_mm) {
    stretch.to_mm = segments[i + 1].to_mm;
  }
  return stretch;
}

/// A shaft's axis, seen from the part with the hole.
struct ShaftAxis {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;

  double distance_mm(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d offset = point - origin;
    return (offset - offset.dot(direction) * direction).norm();
  }
};

bool is_coaxial(const ShaftAxis& shaft, const Feature& hole, double depth_mm) {
  return hole.direction.cross(shaft.direction).norm() <= kCoaxial_rad &&
         shaft.distance_mm(hole.origin + depth_mm * hole.direction) <= kCoaxial_mm;
}

}  // namespace

AxisFit fit_on_axis(const Feature& shaft, const Pose& X_WS, const Feature& hole, const Pose& X_WH) {
  DOWEL_EXPECTS(shaft.kind == FeatureKind::Shaft && hole.kind == FeatureKind::Hole);
  const Pose X_HS = X_WH.inverse() * X_WS;
  const auto depth_of = [&](double along_shaft_mm) {
    const Eigen::Vector3d point = X_HS * (shaft.origin + along_shaft_mm * shaft.direction);
    return hole.direction.dot(point - hole.origin);
  };
  const auto [low_mm, high_mm] = std::minmax({depth_of(0.0), depth_of(shaft.depth_mm)});

  AxisFit fit;
  const HoleSegment* opening = nullptr;
  bool inside = false;
  for (const HoleSegment& segment : hole.segments) {
    if (segment.type != HoleSegment::Type::Cylinder) continue;
    if (opening == nullptr) opening = &segment;
    // A shaft that ends on a step, give or take rounding, is not in what lies beyond.
    if (std::min(high_mm, segment.to_mm) - std::max(low_mm, segment.from_mm) <= kCoincident_mm) {
      continue;
    }
    inside = true;
    if (shaft.diameter_mm <= segment.diameter_mm + kShaftExcess_mm) continue;
    if (forms_thread(shaft.diameter_mm, segment.diameter_mm)) {
      fit.thread = true;
    } else if (fit.obstacle == nullptr) {
      fit.obstacle = &segment;
    }
  }
  if (!inside && opening != nullptr && shaft.diameter_mm > opening->diameter_mm + kShaftExcess_mm &&
      !forms_thread(shaft.diameter_mm, opening->diameter_mm)) {
    fit.obstacle = opening;
  }
  return fit;
}

std::optional<DepthRange> core_hole(const Feature& hole, double nominal_mm) {
  for (const HoleSegment& segment : hole.segments) {
    if (is_core_hole(nominal_mm, segment)) return DepthRange{segment.from_mm, segment.to_mm};
  }
  return std::nullopt;
}

double engagement_mm(const Feature& shaft, const Pose& X_WS, const Feature& hole,
                     const Pose& X_WH) {
  DOWEL_EXPECTS(shaft.kind == FeatureKind::Shaft && hole.kind == FeatureKind::Hole);
  const auto core = core_hole(hole, shaft.diameter_mm);
  if (!core) return 0.0;
  const Pose X_HS = X_WH.inverse() * X_WS;
  const auto depth_of = [&](double along_shaft_mm) {
    const Eigen::Vector3d point = X_HS * (shaft.origin + along_shaft_mm * shaft.direction);
    return hole.direction.dot(point - hole.origin);
  };
  const auto [low_mm, high_mm] = std::minmax({depth_of(0.0), depth_of(shaft.depth_mm)});
  return DepthRange{std::max(low_mm, core->from_mm), std::min(high_mm, core->to_mm)}.length_mm();
}

std::vector<ThreadRelief> thread_reliefs(const Element& tapped, const Pose& X_WT,
                                         const Element& screw, const Pose& X_WS) {
  std::vector<ThreadRelief> reliefs;
  const Pose X_TS = X_WT.inverse() * X_WS;
  for (const Feature& shaft : screw.features) {
    if (shaft.kind != FeatureKind::Shaft) continue;
    const ShaftAxis axis{X_TS * shaft.origin, X_TS.rotation() * shaft.direction};
    for (const Feature& hole : tapped.features) {
      // Most holes of a plate are out of the question by their opening.
      if (hole.kind != FeatureKind::Hole ||
          axis.distance_mm(hole.origin) > kCoaxial_mm + kCoaxial_rad * hole.depth_mm) {
        continue;
      }
      for (std::size_t i = 0; i < hole.segments.size(); ++i) {
        const HoleSegment& segment = hole.segments[i];
        if (!is_core_hole(shaft.diameter_mm, segment)) continue;
        if (!is_coaxial(axis, hole, 0.5 * (segment.from_mm + segment.to_mm))) continue;
        const DepthRange stretch = with_chamfers(hole.segments, i);
        reliefs.push_back({.start = hole.origin + stretch.from_mm * hole.direction,
                           .direction = hole.direction,
                           .length_mm = stretch.to_mm - stretch.from_mm,
                           .radius_mm = 0.5 * shaft.diameter_mm});
      }
    }
  }
  return reliefs;
}

bool may_form_thread(const Element& tapped, const Element& screw) {
  return std::ranges::any_of(screw.features, [&](const Feature& shaft) {
    if (shaft.kind != FeatureKind::Shaft) return false;
    return std::ranges::any_of(tapped.features, [&](const Feature& hole) {
      return hole.kind == FeatureKind::Hole &&
             std::ranges::any_of(hole.segments, [&](const HoleSegment& segment) {
               return is_core_hole(shaft.diameter_mm, segment);
             });
    });
  });
}

}  // namespace dowel
