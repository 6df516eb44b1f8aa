#include "holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core_line.h"

namespace dowel {
namespace {

/// The void of a bore is sought this far off its axis, in radii of the narrowest one.
constexpr double kCoreOffset = 0.1;

/// A piece of a bore ends in a crossing hole where walls of other holes take up this much of its
/// rim.
constexpr double kCrossedRimShare = 0.5;

/// A boss inside a bore makes it a groove where it takes up this part of its length; not a simple
/// fraction, so that none decides by rounding.
constexpr double kHubShare = 0.55;

/// A plane is an entry where it faces the opening at less than about 84 degrees.
constexpr double kFacesOpening = 0.1;

bool contains(const std::vector<std::uint32_t>& values, std::uint32_t value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// Inner bands of one axis, and which of them open into each other.
class Bore {
 public:
  Bore(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const AxisBands& about,
       VoidFinder& voids)
      : solid_(solid), graph_(graph), axis_(about.axis) {
    double narrowest_mm = std::numeric_limits<double>::infinity();
    for (const Band& band : about.bands) {
      if (!band.is_inner || surrounds_a_hub(band, about.bands)) continue;
      bands_.push_back(&band);
      if (band.is_cylinder) narrowest_mm = std::min(narrowest_mm, band.radius_mm[0]);
    }
    if (!std::isfinite(narrowest_mm)) {
      bands_.clear();  // cones alone are no hole
      return;
    }
    void_ = voids.along(about.solid, axis_, kCoreOffset * narrowest_mm);
    for (const Band* band : bands_) stretch_.push_back(stretch_of(*band));
    link();
  }

  /// One for each chain of bands that has a cylinder and an opening.
  std::vector<HoleFinding> holes() const {
    std::vector<HoleFinding> result;
    for (std::size_t i = 0; i < bands_.size(); ++i) {
      if (below_[i] != kNone || stretch_[i] == kNone) continue;
      std::vector<std::size_t> chain;
      for (std::size_t j = i; j != kNone; j = above_[j]) chain.push_back(j);
      if (auto hole = make_hole(chain)) result.push_back(std::move(*hole));
    }
    return result;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// A groove around a boss: no shaft goes in there.
  static bool surrounds_a_hub(const Band& band, const std::vector<Band>& bands) {
    const double low = band.ends[0].rim_mm;
    const double high = band.ends[1].rim_mm;
    return std::any_of(bands.begin(), bands.end(), [&](const Band& hub) {
      const double shared = std::min(high, hub.ends[1].rim_mm) - std::max(low, hub.ends[0].rim_mm);
      return !hub.is_inner && shared > kHubShare * (high - low) &&
             std::max(hub.radius_mm[0], hub.radius_mm[1]) <
                 std::min(band.radius_mm[0], band.radius_mm[1]);
    });
  }

  /// The void stretch that the band's inside is part of: half of its length at least.
  std::size_t stretch_of(const Band& band) const {
    const double low = band.ends[0].reach_mm;
    const double high = band.ends[1].reach_mm;
    for (std::size_t s = 0; s < void_.size(); ++s) {
      const double shared = std::min(high, void_[s].high_mm) - std::max(low, void_[s].low_mm);
      // A tip's void ends before its apex: most of a short cone may be beside the line.
      if (shared >= 0.5 * (high - low) || (!band.is_cylinder && shared > 0.0)) return s;
    }
    return kNone;
  }

  void link() {
    below_.assign(bands_.size(), kNone);
    above_.assign(bands_.size(), kNone);
    for (std::size_t i = 0; i < bands_.size(); ++i) {
      for (std::size_t j = 0; j < bands_.size(); ++j) {
        if (i == j || above_[i] != kNone || below_[j] != kNone) continue;
        if (stretch_[i] == kNone || stretch_[i] != stretch_[j]) continue;
        if (open_into_each_other(*bands_[i], *bands_[j])) connect(i, j);
      }
    }
    // The next piece beyond a crossing hole; bands are sorted by height.
    for (std::size_t i = 0; i < bands_.size(); ++i) {
      for (std::size_t j = i + 1; j < bands_.size() && above_[i] == kNone; ++j) {
        if (below_[j] != kNone || stretch_[i] == kNone || stretch_[i] != stretch_[j]) continue;
        if (bands_[j]->ends[0].rim_mm <= bands_[i]->ends[1].rim_mm) continue;
        if (are_parted_by_crossing(*bands_[i], *bands_[j])) connect(i, j);
        break;
      }
    }
  }

  void connect(std::size_t low, std::size_t high) {
    above_[low] = high;
    below_[high] = low;
  }

  /// `high` begins where `low` ends: rim on rim, over a ring, or over a fillet.
  bool open_into_each_other(const Band& low, const Band& high) const {
    const BandEnd& a = low.ends[1];
    const BandEnd& b = high.ends[0];
    const auto meet = [](double p, double q) { return std::abs(p - q) <= kSameFeature_mm; };
    const auto lead_to = [](const std::vector<std::uint32_t>& faces, const Band& band) {
      return std::any_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
        return std::binary_search(band.faces.begin(), band.faces.end(), face);
      });
    };
    if (meet(a.rim_mm, b.rim_mm) && lead_to(a.across, high)) return true;
    if (meet(a.height_mm, b.rim_mm) && lead_to(a.beyond, high)) return true;
    if (!meet(a.height_mm, b.height_mm)) return false;
    return std::any_of(a.beyond.begin(), a.beyond.end(), [&](std::uint32_t face) {
      return contains(b.beyond, face) && is_ring(face, a.height_mm);
    });
  }

  static bool are_parted_by_crossing(const Band& low, const Band& high) {
    const double gap_mm = high.ends[0].rim_mm - low.ends[1].rim_mm;
    return low.is_cylinder && high.is_cylinder && low.ends[1].inner_wall_share > kCrossedRimShare &&
           high.ends[0].inner_wall_share > kCrossedRimShare &&
           gap_mm <= low.length_mm() + high.length_mm();
  }

  /// A plane square to the axis at that height.
  bool is_ring(std::uint32_t face, double height_mm) const {
    const auto* plane = std::get_if<PlaneSurface>(&graph_[face].surface);
    return plane != nullptr && axis_.is_parallel(plane->normal) &&
           std::abs(axis_.height_mm(*plane) - height_mm) <= kSameFeature_mm;
  }

  bool lies_within(std::uint32_t face, double radius_mm) const {
    const std::vector<std::uint32_t>& vertices = graph_[face].vertices;
    return std::all_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
      return axis_.distance_mm(solid_.vertices[v]) <= radius_mm + kSameFeature_mm;
    });
  }

  /// The void ends, or a floor surrounds whatever opens in its middle.
  bool is_closed(const BandEnd& end, std::size_t stretch, bool is_high) const {
    if (!end.beyond.empty() && end.lean < 0.0 && is_ring(end.beyond.front(), end.height_mm)) {
      const auto& plane = std::get<PlaneSurface>(graph_[end.beyond.front()].surface);
      if ((plane.normal.dot(axis_.direction) < 0.0) == is_high) return true;
    }
    return is_high ? void_[stretch].high_mm <= end.reach_mm + kSameFeature_mm
                   : void_[stretch].low_mm >= end.reach_mm - kSameFeature_mm;
  }

  /// A tip may pierce what lies below by less than a shaft needs; only a floor makes an end flat.
  std::string blind_end(const BandEnd& bottom, const HoleSegment& last, bool is_high) const {
    if (bottom.is_ball) return "round";
    const double sign = is_high ? -1.0 : 1.0;
    const bool has_floor =
        std::any_of(bottom.beyond.begin(), bottom.beyond.end(), [&](std::uint32_t face) {
          const auto* plane = std::get_if<PlaneSurface>(&graph_[face].surface);
          return plane != nullptr && sign * plane->normal.dot(axis_.direction) > kFacesOpening;
        });
    return last.type == HoleSegment::Type::Cone && !has_floor ? "cone" : "flat";
  }

  std::optional<std::uint32_t> entry_face(const BandEnd& end, bool is_high) const {
    const double sign = is_high ? 1.0 : -1.0;
    for (const std::uint32_t face : end.beyond) {
      const auto* plane = std::get_if<PlaneSurface>(&graph_[face].surface);
      if (plane != nullptr && sign * plane->normal.dot(axis_.direction) > kFacesOpening)
        return face;
    }
    return std::nullopt;
  }

  /// Whether a through hole opens at its high end: where it is wider, where it leaves the part
  /// rather than ends in another hole, where it faces up (+z, then +y, then +x).
  bool opens_high(const Band& lowest, const Band& highest) const {
    const double wider_mm = highest.radius_mm[1] - lowest.radius_mm[0];
    if (std::abs(wider_mm) > kSameFeature_mm) return wider_mm > 0.0;
    const bool is_low_crossing = lowest.ends[0].inner_wall_share > kCrossedRimShare;
    const bool is_high_crossing = highest.ends[1].inner_wall_share > kCrossedRimShare;
    if (is_low_crossing != is_high_crossing) return is_low_crossing;
    for (const Eigen::Index i : {2, 1, 0}) {
      if (std::abs(axis_.direction[i]) > kUnitVectorSlack) return axis_.direction[i] > 0.0;
    }
    return true;
  }

  std::optional<HoleFinding> make_hole(const std::vector<std::size_t>& chain) const {
    const Band& lowest = *bands_[chain.front()];
    const Band& highest = *bands_[chain.back()];
    const bool has_cylinder = std::any_of(chain.begin(), chain.end(),
                                          [&](std::size_t i) { return bands_[i]->is_cylinder; });
    const bool low_closed = is_closed(lowest.ends[0], stretch_[chain.front()], false);
    const bool high_closed = is_closed(highest.ends[1], stretch_[chain.back()], true);
    if (!has_cylinder || (low_closed && high_closed)) return std::nullopt;
    if (highest.ends[1].height_mm - lowest.ends[0].height_mm <= kSameFeature_mm) {
      return std::nullopt;
    }

    const bool is_through = !low_closed && !high_closed;
    const bool opens_up = is_through ? opens_high(lowest, highest) : low_closed;
    const BandEnd& mouth = opens_up ? highest.ends[1] : lowest.ends[0];
    const BandEnd& bottom = opens_up ? lowest.ends[0] : highest.ends[1];
    HoleFinding hole;
    Feature& feature = hole.feature;
    feature.kind = FeatureKind::Hole;
    feature.origin = axis_.at(mouth.height_mm);
    feature.direction = opens_up ? Eigen::Vector3d(-axis_.direction) : axis_.direction;
    feature.depth_mm = std::abs(mouth.height_mm - bottom.height_mm);
    feature.through = is_through;
    feature.segments = segments(chain, opens_up, mouth.height_mm);
    feature.diameter_mm = std::numeric_limits<double>::infinity();
    for (const HoleSegment& segment : feature.segments) {
      if (segment.type != HoleSegment::Type::Cylinder) continue;
      feature.diameter_mm = std::min(feature.diameter_mm, segment.diameter_mm);
    }
    if (!is_through) feature.blind_end = blind_end(bottom, feature.segments.back(), !opens_up);
    feature.faces = faces(chain, low_closed, high_closed);
    hole.entry_face = entry_face(mouth, opens_up);
    return hole;
  }

  /// By depth. Pieces of one cylinder that a crossing hole parts are one segment.
  std::vector<HoleSegment> segments(const std::vector<std::size_t>& chain, bool opens_up,
                                    double mouth_mm) const {
    std::vector<HoleSegment> result;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const Band& band = *bands_[opens_up ? chain[chain.size() - 1 - k] : chain[k]];
      const std::size_t near = opens_up ? 1 : 0;
      HoleSegment segment;
      segment.type = band.is_cylinder ? HoleSegment::Type::Cylinder : HoleSegment::Type::Cone;
      segment.diameter_mm = 2.0 * band.radius_mm[near];
      segment.diameter_end_mm = 2.0 * band.radius_mm[1 - near];
      segment.from_mm = std::abs(band.ends[near].rim_mm - mouth_mm);
      segment.to_mm = std::abs(band.ends[1 - near].rim_mm - mouth_mm);
      if (!result.empty() && band.is_cylinder &&
          result.back().type == HoleSegment::Type::Cylinder &&
          std::abs(result.back().diameter_mm - segment.diameter_mm) <= kSameFeature_mm) {
        result.back().to_mm = segment.to_mm;
      } else {
        result.push_back(segment);
      }
    }
    return result;
  }

  /// Walls, fillets, rings between steps and the floor.
  std::vector<std::uint32_t> faces(const std::vector<std::size_t>& chain, bool low_closed,
                                   bool high_closed) const {
    std::vector<std::uint32_t> result;
    double widest_mm = 0.0;
    for (const std::size_t i : chain) {
      widest_mm = std::max({widest_mm, bands_[i]->radius_mm[0], bands_[i]->radius_mm[1]});
    }
    const auto add_planes = [&](const BandEnd& end) {
      for (const std::uint32_t face : end.beyond) {
        if (is_ring(face, end.height_mm) && lies_within(face, widest_mm)) result.push_back(face);
      }
    };
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const Band& band = *bands_[chain[k]];
      result.insert(result.end(), band.faces.begin(), band.faces.end());
      for (const BandEnd& end : band.ends) {
        result.insert(result.end(), end.transition.begin(), end.transition.end());
      }
      if (k > 0 || low_closed) add_planes(band.ends[0]);
      if (k + 1 < chain.size() || high_closed) add_planes(band.ends[1]);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  const FacetedSolid& solid_;
  const std::vector<FaceNode>& graph_;
  const Axis& axis_;
  std::vector<const Band*> bands_;
  std::vector<VoidStretch> void_;
  std::vector<std::size_t> stretch_;  ///< of each band: index into void_
  std::vector<std::size_t> below_;    ///< of each band: the one that opens into it from below
  std::vector<std::size_t> above_;
};

}  // namespace

std::vector<HoleFinding> find_holes(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                                    const std::vector<AxisBands>& axes) {
  std::vector<HoleFinding> result;
  VoidFinder voids(solid);
  for (const AxisBands& about : axes) {
    for (HoleFinding& hole : Bore(solid, graph, about, voids).holes()) {
      result.push_back(std::move(hole));
    }
  }
  return result;
}

}  // namespace dowel
