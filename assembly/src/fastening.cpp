#include "dowel/assembly/fastening.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>

#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Pitches by which a screw ends before the end of its thread, and looks out of a nut at most.
constexpr double kShortOfEnd = 1.0;
constexpr double kMostBeyondNut = 6.0;

std::string text(double length_mm) {
  // To a hundredth: what a reader compares with a ruler.
  std::array<char, 32> buffer{};
  const double rounded_mm = std::round(length_mm * 100.0) / 100.0;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded_mm).ptr;
  return {buffer.data(), end};
}

/// Whether a fastener has threads of this size.
bool has_thread(const Fastener& fastener, const MetricThread& size) {
  if (fastener.nominal_mm != size.nominal_mm) return false;
  if (fastener.pitch_mm == 0.0) return thread_of_shaft(size.nominal_mm) == &size;
  return fastener.pitch_mm == size.pitch_mm;
}

/// The thread of a bore for one nominal diameter: the first core hole (`surely` one, or what could
/// be one) that everything before lets the screw reach.
struct Thread {
  bool is_reached = false;
  std::size_t hole = 0;
  double from_mm = 0.0;
  double to_mm = 0.0;
};

Thread thread_in(std::span<const BoreStretch> stretches, const MetricThread& size, bool surely) {
  Thread thread;
  for (const BoreStretch& stretch : stretches) {
    if (stretch.to_mm <= kCoincident_mm) continue;
    const bool is_core = !surely || likely_thread_of_hole(stretch.diameter_mm) != nullptr;
    if (is_core && thread_of_core_hole(stretch.diameter_mm) == &size) {
      return {true, stretch.hole, stretch.from_mm, stretch.to_mm};
    }
    if (stretch.diameter_mm < size.nominal_mm - kShaftExcess_mm) return thread;
  }
  return thread;
}

bool passes_all(std::span<const BoreStretch> stretches, double nominal_mm) {
  return std::ranges::all_of(stretches, [=](const BoreStretch& stretch) {
    return stretch.diameter_mm >= nominal_mm - kShaftExcess_mm || stretch.to_mm <= kCoincident_mm;
  });
}

/// The lowest of those for which `is_wanted` holds; nothing where there is none.
template <class Wanted>
std::optional<Fastener> lowest(std::span<const Fastener> fasteners, const Wanted& is_wanted) {
  std::optional<Fastener> best;
  for (const Fastener& fastener : fasteners) {
    if (!is_wanted(fastener)) continue;
    if (!best || fastener.length_mm < best->length_mm) best = fastener;
  }
  return best;
}

std::optional<Fastener> lowest_washer(std::span<const Fastener> fasteners,
                                      const MetricThread& size) {
  return lowest(fasteners, [&](const Fastener& fastener) {
    return fastener.kind == Fastener::Kind::Washer && fastener.nominal_mm == size.nominal_mm;
  });
}

std::optional<Fastener> lowest_nut(std::span<const Fastener> fasteners, const MetricThread& size,
                                   bool with_collar) {
  return lowest(fasteners, [&](const Fastener& fastener) {
    return fastener.kind == Fastener::Kind::Nut && has_thread(fastener, size) &&
           fastener.has_collar == with_collar;
  });
}

/// Lengths of screws that do, from under the head.
struct Wanted {
  double least_mm = 0.0;  ///< of full threads
  double most_mm = -1.0;  ///< of the tip
  Fastening way;          ///< but for the screw
};

/// For a thread in the bore, else for each nut that goes behind it; none where there is neither.
std::vector<Wanted> wanted_lengths(std::span<const BoreStretch> stretches,
                                   std::span<const Fastener> fasteners, const MetricThread& size,
                                   const FasteningOptions& options, bool surely) {
  Wanted wanted;
  if (options.needs_washer) wanted.way.washer = lowest_washer(fasteners, size);
  const double lift_mm = wanted.way.lift_mm();
  const Thread thread = thread_in(stretches, size, surely);
  if (thread.is_reached) {
    wanted.way.thread = thread.hole;
    wanted.way.grip_mm = thread.from_mm + lift_mm;
    wanted.least_mm = wanted.way.grip_mm + options.engagement_in_diameters * size.nominal_mm;
    wanted.most_mm = thread.to_mm + lift_mm - kShortOfEnd * size.pitch_mm;
    return {wanted};
  }
  if (stretches.empty() || !passes_all(stretches, size.nominal_mm)) return {};
  std::vector<Wanted> with_nut;
  for (const bool with_collar : {false, true}) {
    wanted.way.nut = lowest_nut(fasteners, size, with_collar);
    if (!wanted.way.nut) continue;
    wanted.way.grip_mm = stretches.back().to_mm + lift_mm;
    const double end_mm = wanted.way.grip_mm + wanted.way.nut->length_mm;
    wanted.least_mm = end_mm + kShortOfEnd * size.pitch_mm;
    wanted.most_mm = end_mm + kMostBeyondNut * size.pitch_mm;
    with_nut.push_back(wanted);
  }
  return with_nut;
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

/// "a screw M12 has to be 42 mm of thread to 38 mm long, and there are 30, 40".
std::string none_fits(const Wanted& wanted, const MetricThread& size, const std::string& there) {
  return "a screw " + std::string(size.name) + " has to be " + text(wanted.least_mm) +
         " mm of thread to " + text(wanted.most_mm) + " mm long, and there are " +
         (there.empty() ? "none" : there);
}

/// The thickest first, of one diameter the coarse one.
std::vector<const MetricThread*> sizes_to_try() {
  std::vector<const MetricThread*> sizes;
  for (const MetricThread& size : metric_threads()) sizes.push_back(&size);
  std::ranges::stable_sort(sizes, std::greater<>(), &MetricThread::nominal_mm);
  return sizes;
}

FasteningChoices choose(std::span<const BoreStretch> stretches, std::span<const Fastener> fasteners,
                        const FasteningOptions& options, bool surely) {
  FasteningChoices choices;
  // The thickest thread first: it is what the bore was made for.
  for (const MetricThread* size : sizes_to_try()) {
    const auto ways = wanted_lengths(stretches, fasteners, *size, options, surely);
    for (const Wanted& wanted : ways) {
      std::string there;
      for (const Fastener& screw : fasteners) {
        if (screw.kind != Fastener::Kind::Screw || !has_thread(screw, *size)) continue;
        there += (there.empty() ? "" : ", ") + text(screw.length_mm);
        if (screw.thread_end_mm < wanted.least_mm - kCoincident_mm ||
            screw.length_mm > wanted.most_mm + kCoincident_mm) {
          continue;
        }
        choices.ways.push_back(with_screw(wanted, screw, *size));
      }
      if (wanted.way.nut && wanted.way.nut->has_collar && ways.size() > 1) continue;
      choices.reason += (choices.reason.empty() ? "" : "; ") + none_fits(wanted, *size, there);
    }
    // A core hole that is reached is the thread to use; a nut goes on any thinner screw, too.
    if (!choices.ways.empty() || (!ways.empty() && !ways.front().way.nut)) break;
  }
  return choices;
}

/// What stands on the face on a T-bolt, without the bolt.
std::vector<Fastening> stands_on_face(std::span<const Fastener> fasteners, const MetricThread& size,
                                      double mouth_mm) {
  std::vector<Fastening> stands;
  const auto bears = [&](const Fastener& fastener) {
    return fastener.head_diameter_mm > mouth_mm + kShaftExcess_mm;
  };
  Fastening way;
  if (const auto nut = lowest_nut(fasteners, size, false)) {
    way.nut = nut;
    way.washer = lowest_washer(fasteners, size);
    if (bears(way.washer ? *way.washer : *nut)) stands.push_back(way);
  }
  const std::optional<Fastener> plain_nut = way.nut;
  way = {};
  way.nut = lowest_nut(fasteners, size, true);
  if (way.nut && bears(*way.nut)) stands.push_back(way);
  if (!plain_nut) return stands;
  way = {};
  way.nut = plain_nut;
  for (const Fastener& washer : fasteners) {
    if (washer.kind != Fastener::Kind::SphericalWasher || washer.nominal_mm != size.nominal_mm ||
        way.washer) {
      continue;
    }
    // The narrowest seat that bears: the wide ones are for slotted holes.
    for (const Fastener& seat : fasteners) {
      if (seat.kind != Fastener::Kind::ConicalSeat || !bears(seat) ||
          !pair_height_mm(washer, seat)) {
        continue;
      }
      if (way.conical_seat && way.conical_seat->head_diameter_mm <= seat.head_diameter_mm) continue;
      way.washer = washer;
      way.conical_seat = seat;
    }
  }
  if (way.washer) stands.push_back(way);
  return stands;
}

}  // namespace

double Fastening::lift_mm() const {
  if (!washer) return 0.0;
  return conical_seat ? pair_height_mm(*washer, *conical_seat).value() : washer->length_mm;
}

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

FasteningChoices choose_tee_bolt(std::span<const BoreStretch> stretches,
                                 std::span<const Fastener> fasteners, double shoulder_mm,
                                 double mouth_mm) {
  FasteningChoices choices;
  for (const MetricThread* size : sizes_to_try()) {
    std::string there;
    std::vector<Fastener> bolts;
    for (const Fastener& bolt : fasteners) {
      if (bolt.kind != Fastener::Kind::TeeBolt || !has_thread(bolt, *size)) continue;
      there += (there.empty() ? "" : ", ") + text(bolt.length_mm);
      bolts.push_back(bolt);
    }
    if (bolts.empty() || !passes_all(stretches, size->nominal_mm)) continue;
    std::ranges::stable_sort(bolts, {}, &Fastener::length_mm);
    const std::vector<Fastening> stands = stands_on_face(fasteners, *size, mouth_mm);
    for (Fastening way : stands) {
      way.grip_mm = shoulder_mm + way.lift_mm();
      way.engagement_mm = way.nut->length_mm;
      const double least_mm =
          way.grip_mm + way.nut->length_mm + kShortOfEnd * size->pitch_mm - kCoincident_mm;
      const auto bolt = std::ranges::find_if(bolts, [&](const Fastener& candidate) {
        return candidate.thread_end_mm >= least_mm && candidate.neck_height_mm <= way.grip_mm;
      });
      if (bolt == bolts.end()) {
        choices.reason += (choices.reason.empty() ? "" : "; ") + std::string("a T-bolt ") +
                          std::string(size->name) + " has to have " + text(least_mm) +
                          " mm to the end of its thread, and there are " + there + " long";
        continue;
      }
      way.screw = *bolt;
      way.spare_mm = bolt->length_mm - way.grip_mm - way.nut->length_mm;
      choices.ways.push_back(std::move(way));
    }
    if (stands.empty()) {
      choices.reason += (choices.reason.empty() ? "" : "; ") + std::string("no nut ") +
                        std::string(size->name) + " stands on the face beside a bore of " +
                        text(mouth_mm) + " mm";
    }
  }
  if (choices.ways.empty() && choices.reason.empty()) {
    choices.reason = "no T-bolt goes through the bore";
  }
  if (!choices.ways.empty()) choices.reason.clear();
  return choices;
}

}  // namespace dowel
