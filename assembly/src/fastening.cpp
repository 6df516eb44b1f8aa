#include "dowel/assembly/fastening.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "dowel/assembly/names.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Pitches by which a screw ends before the end of its thread, and looks out of a nut at most.
constexpr double kShortOfEnd = 1.0;
constexpr double kMostBeyondNut = 6.0;

/// A washer's hole is wider than the thread by no more than this share of it (ISO 7089, 7093).
constexpr double kWasherPlay = 0.15;

std::string text(double length_mm) {
  // To a hundredth: what a reader compares with a ruler.
  std::array<char, 32> buffer{};
  const double rounded_mm = std::round(length_mm * 100.0) / 100.0;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded_mm).ptr;
  return {buffer.data(), end};
}

/// How far the part reaches along `direction` from `origin`, by its faces square to it.
double reach_mm(const Element& element, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  double most = 0.0;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.dot(direction) < 1.0 - kCoaxial_rad) {
      continue;
    }
    most = std::max(most, direction.dot(face.origin - origin));
  }
  return most;
}

/// The widest of the element across `direction`, by its box: heads are round, hexagons or more.
double width_across(const Element& element, const Eigen::Vector3d& direction) {
  double widest_mm = 0.0;
  Eigen::Index along = 0;
  (element.obb.axes.transpose() * direction).cwiseAbs().maxCoeff(&along);
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i != along) widest_mm = std::max(widest_mm, 2.0 * element.obb.half_extents_mm[i]);
  }
  return widest_mm;
}

std::optional<Fastener> screw_of(const Element& element) {
  Fastener screw;
  for (const Feature& shaft : element.features) {
    if (shaft.kind != FeatureKind::Shaft) continue;
    const MetricThread* thread = thread_of_shaft(shaft.diameter_mm);
    if (thread == nullptr || (screw.nominal_mm > 0.0 && thread->nominal_mm >= screw.nominal_mm)) {
      continue;
    }
    screw.nominal_mm = thread->nominal_mm;
    screw.feature = shaft.name;
    screw.thread_end_mm = shaft.depth_mm;
    screw.head_diameter_mm = width_across(element, shaft.direction);
    screw.length_mm = std::max(shaft.depth_mm, reach_mm(element, shaft.origin, shaft.direction));
  }
  screw.element = element.name;
  if (screw.nominal_mm == 0.0 || screw.head_diameter_mm <= screw.nominal_mm + kBoxSlack_mm)
    return std::nullopt;
  return screw;
}

std::optional<Fastener> ring_of(const Element& element, Fastener::Kind kind) {
  const Feature* hole = nullptr;
  Fastener ring;
  for (const Feature& feature : element.features) {
    if (feature.kind == FeatureKind::Shaft) {
      ring.head_diameter_mm = std::max(ring.head_diameter_mm, feature.diameter_mm);
    }
    if (feature.kind != FeatureKind::Hole) continue;
    if (hole != nullptr || !feature.through) return std::nullopt;
    hole = &feature;
  }
  if (hole == nullptr) return std::nullopt;
  ring.kind = kind;
  ring.element = element.name;
  ring.length_mm = hole->depth_mm;
  ring.feature = hole->name;
  if (kind == Fastener::Kind::Nut) {
    const MetricThread* thread = thread_of_core_hole(hole->diameter_mm);
    if (thread == nullptr) return std::nullopt;
    ring.nominal_mm = thread->nominal_mm;
    ring.core_diameter_mm = hole->diameter_mm;
    return ring;
  }
  for (const MetricThread& thread : metric_threads()) {
    const double play = hole->diameter_mm / thread.nominal_mm - 1.0;
    if (play > 0.0 && play <= kWasherPlay) ring.nominal_mm = thread.nominal_mm;
  }
  if (ring.nominal_mm == 0.0) return std::nullopt;
  return ring;
}

/// A nut with a foot under a neck. A T-bolt has no hole.
std::optional<Fastener> tee_nut_of(const Element& element) {
  auto nut = ring_of(element, Fastener::Kind::Nut);
  if (!nut) return std::nullopt;
  nut->kind = Fastener::Kind::TeeNut;
  const Feature& hole = *element.find_feature(nut->feature);
  double shoulder_mm = 0.0;  // from the top to the lowest face that looks up
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.dot(hole.direction) > kCoaxial_rad - 1.0) {
      continue;
    }
    shoulder_mm = std::max(shoulder_mm, hole.direction.dot(face.origin - hole.origin));
  }
  nut->foot_height_mm = nut->length_mm - shoulder_mm;
  nut->foot_width_mm = width_across(element, hole.direction);
  return nut;
}

/// The thread of a bore for one nominal diameter: the first core hole (`surely` one, or what could
/// be one) that everything before lets the screw reach.
struct Thread {
  bool is_reached = false;
  std::size_t hole = 0;
  double from_mm = 0.0;
  double to_mm = 0.0;
};

Thread thread_in(std::span<const BoreStretch> stretches, double nominal_mm, bool surely) {
  Thread thread;
  for (const BoreStretch& stretch : stretches) {
    if (stretch.to_mm <= kCoincident_mm) continue;
    const bool is_core = !surely || likely_thread_of_hole(stretch.diameter_mm) != nullptr;
    if (is_core && forms_thread(nominal_mm, stretch.diameter_mm)) {
      return {true, stretch.hole, stretch.from_mm, stretch.to_mm};
    }
    if (stretch.diameter_mm < nominal_mm - kShaftExcess_mm) return thread;
  }
  return thread;
}

bool passes_all(std::span<const BoreStretch> stretches, double nominal_mm) {
  return std::ranges::all_of(stretches, [=](const BoreStretch& stretch) {
    return stretch.diameter_mm >= nominal_mm - kShaftExcess_mm || stretch.to_mm <= kCoincident_mm;
  });
}

/// The lowest of a kind for a thread; nothing where there is none.
std::optional<Fastener> lowest(std::span<const Fastener> fasteners, Fastener::Kind kind,
                               double nominal_mm) {
  std::optional<Fastener> best;
  for (const Fastener& fastener : fasteners) {
    if (fastener.kind != kind || fastener.nominal_mm != nominal_mm) continue;
    if (!best || fastener.length_mm < best->length_mm) best = fastener;
  }
  return best;
}

/// Lengths of screws that do, from under the head; empty where none can.
struct Wanted {
  double least_mm = 0.0;  ///< of full threads
  double most_mm = -1.0;  ///< of the tip
  Fastening way;          ///< but for the screw
};

std::optional<Wanted> wanted_lengths(std::span<const BoreStretch> stretches,
                                     std::span<const Fastener> fasteners, const MetricThread& size,
                                     const FasteningOptions& options, bool surely) {
  Wanted wanted;
  double lift_mm = 0.0;
  if (options.needs_washer) {
    wanted.way.washer = lowest(fasteners, Fastener::Kind::Washer, size.nominal_mm);
    if (wanted.way.washer) lift_mm = wanted.way.washer->length_mm;
  }
  const Thread thread = thread_in(stretches, size.nominal_mm, surely);
  if (thread.is_reached) {
    wanted.way.thread = thread.hole;
    wanted.way.grip_mm = thread.from_mm + lift_mm;
    wanted.least_mm = wanted.way.grip_mm + options.engagement_in_diameters * size.nominal_mm;
    wanted.most_mm = thread.to_mm + lift_mm - kShortOfEnd * size.pitch_mm;
    return wanted;
  }
  if (stretches.empty() || !passes_all(stretches, size.nominal_mm)) return std::nullopt;
  wanted.way.nut = lowest(fasteners, Fastener::Kind::Nut, size.nominal_mm);
  if (!wanted.way.nut) return std::nullopt;
  wanted.way.grip_mm = stretches.back().to_mm + lift_mm;
  const double end_mm = wanted.way.grip_mm + wanted.way.nut->length_mm;
  wanted.least_mm = end_mm + kShortOfEnd * size.pitch_mm;
  wanted.most_mm = end_mm + kMostBeyondNut * size.pitch_mm;
  return wanted;
}

/// `wanted` with one of the screws.
Fastening with_screw(const Wanted& wanted, const Fastener& screw, const MetricThread& size) {
  Fastening way = wanted.way;
  way.screw = screw;
  if (way.nut) {
    way.engagement_mm = way.nut->length_mm;
    way.spare_mm = screw.length_mm - way.grip_mm - way.nut->length_mm;
  } else {
    const double end_mm = wanted.most_mm + kShortOfEnd * size.pitch_mm;
    way.engagement_mm = screw.thread_end_mm - way.grip_mm;
    way.spare_mm = end_mm - screw.length_mm;
  }
  return way;
}

}  // namespace

std::optional<Fastener> fastener_of(const Element& element) {
  const std::string role = role_of(element.name);
  if (role == "SCREW") return screw_of(element);
  if (role == "WASHER") return ring_of(element, Fastener::Kind::Washer);
  if (role == "NUT") return ring_of(element, Fastener::Kind::Nut);
  if (role == "TEE") return tee_nut_of(element);
  return std::nullopt;
}

namespace {

FasteningChoices choose(std::span<const BoreStretch> stretches, std::span<const Fastener> fasteners,
                        const FasteningOptions& options, bool surely) {
  FasteningChoices choices;
  const auto& sizes = metric_threads();
  // The thickest thread first: it is what the bore was made for.
  for (auto size = sizes.rbegin(); size != sizes.rend() && choices.ways.empty(); ++size) {
    // A screw is told by its nominal diameter; the coarse pitch keeps it further from a thread's
    // end.
    if (thread_of_shaft(size->nominal_mm) != &*size) continue;
    const auto wanted = wanted_lengths(stretches, fasteners, *size, options, surely);
    if (!wanted) continue;
    std::string there;
    for (const Fastener& screw : fasteners) {
      if (screw.kind != Fastener::Kind::Screw || screw.nominal_mm != size->nominal_mm) continue;
      there += (there.empty() ? "" : ", ") + text(screw.length_mm);
      if (screw.thread_end_mm < wanted->least_mm - kCoincident_mm ||
          screw.length_mm > wanted->most_mm + kCoincident_mm) {
        continue;
      }
      choices.ways.push_back(with_screw(*wanted, screw, *size));
    }
    choices.reason += (choices.reason.empty() ? "" : "; ") + std::string("a screw M") +
                      text(size->nominal_mm) + " has to be " + text(wanted->least_mm) +
                      " mm of thread to " + text(wanted->most_mm) + " mm long, and there are " +
                      (there.empty() ? "none" : there);
    // A core hole that is reached is the thread to use; a nut goes on any thinner screw, too.
    if (!wanted->way.nut) break;
  }
  return choices;
}

}  // namespace

FasteningChoices choose_fastening(std::span<const BoreStretch> stretches,
                                  std::span<const Fastener> fasteners,
                                  const FasteningOptions& options) {
  FasteningChoices choices = choose(stretches, fasteners, options, true);
  // Bores of whole millimetres are threads only where nothing else is.
  if (choices.ways.empty()) {
    FasteningChoices more = choose(stretches, fasteners, options, false);
    if (!more.ways.empty() || choices.reason.empty()) choices = std::move(more);
  }
  std::ranges::stable_sort(choices.ways, {},
                           [](const Fastening& way) { return way.screw.length_mm; });
  if (!choices.ways.empty()) {
    choices.reason.clear();
  } else if (choices.reason.empty()) {
    choices.reason = "no thread of the bore can be reached, and no nut goes behind it";
  }
  return choices;
}

}  // namespace dowel
