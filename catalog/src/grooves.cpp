#include "grooves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axis.h"
#include "disjoint_sets.h"
#include "dowel/kernel/tolerance.h"
#include "groove_walls.h"

namespace dowel {
namespace {

using End = SlotShape::End;

/// Lines that probe the void run this far off the middle, in widths of the slot.
constexpr double kProbeOffset = 0.05;

/// A pocket with four straight walls is a slot where it is this much longer than wide; not a
/// fraction that anybody draws.
constexpr double kPocketRatio = 1.95;

/// Pieces of one groove, and the axes to measure it by.
class Groove {
 public:
  Groove(const SolidView& view, const GrooveFloor& floor, std::vector<GroovePiece> pieces)
      : view_(view), floor_(floor), up_(floor.up), pieces_(std::move(pieces)) {
    std::vector<std::size_t> walls;
    for (const GroovePiece& piece : pieces_) {
      for (const GrooveSide& side : piece.sides) walls.push_back(side.wall);
    }
    run_ = run_of(up_, patch(largest_patch(view_, walls)).plane.normal);
    across_ = up_.cross(run_);
    for (GroovePiece& piece : pieces_) {
      if (patch(piece.sides[0].wall).plane.normal.dot(across_) < 0.0) {
        std::swap(piece.sides[0], piece.sides[1]);
      }
    }
    std::sort(pieces_.begin(), pieces_.end(), [](const GroovePiece& a, const GroovePiece& b) {
      return a.run.low_mm < b.run.low_mm;
    });
    for (const std::size_t side : {0U, 1U}) {
      wall_mm_[side] = place_of(side, false);
      mouth_at_mm_[side] = is_tee() ? place_of(side, true) : wall_mm_[side];
    }
    measure_mouth();
  }

  /// The groove as one slot for each stretch of it that nothing closes.
  std::vector<SlotFinding> slots() const {
    std::vector<SlotFinding> result;
    std::size_t first = 0;
    double built_mm = pieces_[0].run.length_mm();
    double reached_mm = pieces_[0].run.high_mm;
    for (std::size_t next = 1; next <= pieces_.size(); ++next) {
      if (next < pieces_.size() && runs_on(reached_mm, built_mm, pieces_[next].run)) {
        built_mm += pieces_[next].run.length_mm();
        reached_mm = std::max(reached_mm, pieces_[next].run.high_mm);
        continue;
      }
      if (auto slot = make_slot(first, next)) result.push_back(std::move(*slot));
      if (next == pieces_.size()) break;
      first = next;
      built_mm = pieces_[next].run.length_mm();
      reached_mm = pieces_[next].run.high_mm;
    }
    return result;
  }

 private:
  struct Ending {
    End end = End::Open;
    double at_mm = 0.0;  ///< along the run
  };

  const PlanePatch& patch(std::size_t index) const { return view_.patches.patches[index]; }
  bool is_tee() const { return pieces_[0].is_tee(); }
  double width_mm() const { return mouth_at_mm_[1] - mouth_at_mm_[0]; }
  double undercut_mm() const { return wall_mm_[1] - wall_mm_[0]; }

  std::vector<std::size_t> walls(std::size_t side, bool throats) const {
    std::vector<std::size_t> result;
    for (const GroovePiece& piece : pieces_) {
      const GrooveSide& of = piece.sides[side];
      if (throats) {
        result.insert(result.end(), of.throats.begin(), of.throats.end());
      } else {
        result.push_back(of.wall);
      }
    }
    return result;
  }

  double place_of(std::size_t side, bool throats) const {
    return across_.dot(patch(largest_patch(view_, walls(side, throats))).plane.origin);
  }

  /// Of all pieces the highest, of the two sides of one the lower.
  void measure_mouth() {
    mouth_mm_ = -std::numeric_limits<double>::infinity();
    for (const GroovePiece& piece : pieces_) {
      double lower_mm = std::numeric_limits<double>::infinity();
      for (const GrooveSide& side : piece.sides) {
        double top_mm = -std::numeric_limits<double>::infinity();
        const auto look = [&](std::size_t wall) {
          const WallTop top = top_of_wall(view_, patch(wall), up_, 0.5 * width_mm());
          top_mm = std::max(top_mm, top.height_mm);
        };
        if (is_tee()) {
          std::ranges::for_each(side.throats, look);
        } else {
          look(side.wall);
        }
        lower_mm = std::min(lower_mm, top_mm);
      }
      mouth_mm_ = std::max(mouth_mm_, lower_mm);
    }
  }

  Eigen::Vector3d at(double run_mm, double across_mm, double up_mm) const {
    return run_mm * run_ + across_mm * across_ + up_mm * up_;
  }

  Eigen::Vector3d middle(double run_mm) const {
    const double low_mm = floor_.height_mm;
    const double high_mm = is_tee() ? ledge_mm() : mouth_mm_;
    return at(run_mm, 0.5 * (wall_mm_[0] + wall_mm_[1]), 0.5 * (low_mm + high_mm));
  }

  double offset_mm() const {
    return kProbeOffset * std::min(undercut_mm(), mouth_mm_ - floor_.height_mm);
  }

  double ledge_mm() const {
    std::vector<std::size_t> ledges;
    for (const GroovePiece& piece : pieces_) {
      for (const GrooveSide& side : piece.sides) {
        ledges.insert(ledges.end(), side.ledges.begin(), side.ledges.end());
      }
    }
    return up_.dot(patch(largest_patch(view_, ledges)).plane.origin);
  }

  /// Nothing but void between what was reached and the next piece, and less of it than of walls.
  bool runs_on(double reached_mm, double built_mm, const Extent& next) const {
    const double gap_mm = next.low_mm - reached_mm;
    if (gap_mm <= kSameFeature_mm) return true;
    if (gap_mm > built_mm + next.length_mm()) return false;
    return is_void_between(view_.solid, lump(), middle(reached_mm), middle(next.low_mm),
                           offset_mm());
  }

  std::uint32_t lump() const { return patch(pieces_[0].sides[0].wall).solid; }

  /// What closes the groove where a wall ends, seen along `outward`.
  Ending ending_at(const PlanePatch& wall, const RimEdge& edge, const Eigen::Vector3d& outward,
                   double at_mm) const {
    const FaceNode& across = view_.graph[edge.face_across];
    const auto* cylinder = std::get_if<CylinderSurface>(&across.surface);
    const double rise = rise_across(view_.solid, view_.graph, wall, edge);
    if (cylinder != nullptr && across.reversed && std::abs(rise) <= kTangent_rad &&
        cylinder->axis.cross(up_).norm() <= kCoaxial_rad) {
      const bool is_round =
          std::abs(2.0 * cylinder->radius_mm - undercut_mm()) <= kSameFeature_mm &&
          std::abs(across_.dot(cylinder->origin) - 0.5 * (wall_mm_[0] + wall_mm_[1])) <=
              kSameFeature_mm;
      const double reach_mm = is_round ? 0.5 * width_mm() : cylinder->radius_mm;
      return {is_round ? End::Round : End::Flat, outward.dot(cylinder->origin) + reach_mm};
    }
    return {rise > kTangent_rad ? End::Flat : End::Open, at_mm};
  }

  /// The end along `outward`, which is the run or against it.
  Ending ending(std::size_t first, std::size_t last, const Eigen::Vector3d& outward,
                double at_mm) const {
    Ending result{End::Open, at_mm};
    bool has_edge = false;
    const auto is_there = [&](std::uint32_t v) {
      return std::abs(outward.dot(view_.solid.vertices[v]) - at_mm) <= kSameFeature_mm;
    };
    for (std::size_t i = first; i < last; ++i) {
      for (const GrooveSide& side : pieces_[i].sides) {
        const PlanePatch& wall = patch(side.wall);
        for (const std::uint32_t face : wall.faces) {
          for (const RimEdge& edge : view_.graph[face].rim) {
            if (!is_there(edge.from) || !is_there(edge.to)) continue;
            has_edge = true;
            const Ending here = ending_at(wall, edge, outward, at_mm);
            if (here.end > result.end) result = here;
          }
        }
      }
    }
    if (has_edge) return result;
    // A slanted end: closed where something stands in the way.
    const double sense = outward.dot(run_);
    const double inner_mm = sense * at_mm;
    const double outer_mm = sense * (at_mm + 0.5 * undercut_mm());
    if (!is_void_between(view_.solid, lump(), middle(inner_mm), middle(outer_mm), offset_mm())) {
      result.end = End::Flat;
    }
    return result;
  }

  /// Longer than wide, or at least a gap that is deeper than wide.
  static bool is_slot(const SlotShape& shape, double width_mm, double depth_mm) {
    const auto count = [&shape](End end) { return std::ranges::count(shape.ends, end); };
    const double least_mm = width_mm - kSameFeature_mm;
    if (count(End::Flat) == 2) return shape.length_mm >= kPocketRatio * width_mm;
    if (count(End::Open) == 2 && depth_mm >= least_mm) return true;
    return shape.length_mm >= least_mm;
  }

  void add_parts(std::size_t first, std::size_t last, SlotFinding& slot) const {
    std::vector<std::uint32_t>& faces = slot.feature.faces;
    const auto add = [&](const std::vector<std::size_t>& patches) {
      for (const std::size_t p : patches) {
        faces.insert(faces.end(), patch(p).faces.begin(), patch(p).faces.end());
      }
    };
    for (std::size_t i = first; i < last; ++i) {
      for (const std::size_t s : {0U, 1U}) {
        const GrooveSide& side = pieces_[i].sides[s];
        slot.walls[s].push_back(side.wall);
        slot.walls[s].insert(slot.walls[s].end(), side.throats.begin(), side.throats.end());
        add(side.floors);
        add(side.ledges);
        faces.insert(faces.end(), side.fillets.begin(), side.fillets.end());
        for (const std::size_t wall :
             side.throats.empty() ? std::vector{side.wall} : side.throats) {
          const WallTop top = top_of_wall(view_, patch(wall), up_, 0.5 * width_mm());
          slot.mouth_faces.insert(slot.mouth_faces.end(), top.beyond.begin(), top.beyond.end());
        }
      }
    }
    for (std::vector<std::size_t>& side : slot.walls) {
      sort_unique(side);
      add(side);
    }
    sort_unique(faces);
  }

  std::optional<SlotFinding> make_slot(std::size_t first, std::size_t last) const {
    double low_mm = std::numeric_limits<double>::infinity();
    double high_mm = -low_mm;
    for (std::size_t i = first; i < last; ++i) {
      low_mm = std::min(low_mm, pieces_[i].run.low_mm);
      high_mm = std::max(high_mm, pieces_[i].run.high_mm);
    }
    const Ending low = ending(first, last, -run_, -low_mm);
    const Ending high = ending(first, last, run_, high_mm);
    SlotShape shape;
    shape.type = is_tee() ? SlotShape::Type::Tee : SlotShape::Type::Plain;
    shape.run = run_;
    shape.length_mm = low.at_mm + high.at_mm;
    shape.ends = {low.end, high.end};
    if (is_tee()) {
      shape.throat_depth_mm = mouth_mm_ - ledge_mm();
      shape.undercut_width_mm = undercut_mm();
      shape.undercut_height_mm = ledge_mm() - floor_.height_mm;
    }
    const double depth_mm = mouth_mm_ - floor_.height_mm;
    if (depth_mm <= kSameFeature_mm || width_mm() <= kSameFeature_mm ||
        !is_slot(shape, width_mm(), depth_mm)) {
      return std::nullopt;
    }
    SlotFinding slot;
    Feature& feature = slot.feature;
    feature.kind = FeatureKind::Slot;
    feature.origin =
        at(0.5 * (high.at_mm - low.at_mm), 0.5 * (mouth_at_mm_[0] + mouth_at_mm_[1]), mouth_mm_);
    feature.direction = -up_;
    feature.diameter_mm = width_mm();
    feature.depth_mm = depth_mm;
    feature.slot = shape;
    add_parts(first, last, slot);
    return slot;
  }

  const SolidView& view_;
  const GrooveFloor& floor_;
  Eigen::Vector3d up_;
  Eigen::Vector3d run_;
  Eigen::Vector3d across_;
  std::vector<GroovePiece> pieces_;      ///< side 0 faces `across_`; by where they begin
  std::array<double, 2> wall_mm_{};      ///< along `across_`: where each side's walls stand
  std::array<double, 2> mouth_at_mm_{};  ///< the same for those at the mouth
  double mouth_mm_ = 0.0;                ///< along `up_`
};

/// Whether both walls of one piece go on in those of the other.
bool are_in_line(const SolidView& view, const GroovePiece& a, const GroovePiece& b) {
  if (a.is_tee() != b.is_tee()) return false;
  const auto goes_on = [&](const GrooveSide& from, const GrooveSide& to) {
    const auto& patches = view.patches.patches;
    return are_coplanar(view.solid, patches[from.wall], patches[to.wall]) &&
           (!a.is_tee() ||
            are_coplanar(view.solid, patches[from.throats.front()], patches[to.throats.front()]));
  };
  return (goes_on(a.sides[0], b.sides[0]) && goes_on(a.sides[1], b.sides[1])) ||
         (goes_on(a.sides[0], b.sides[1]) && goes_on(a.sides[1], b.sides[0]));
}

}  // namespace

std::vector<SlotFinding> find_grooves(const SolidView& view) {
  std::vector<SlotFinding> result;
  for (const GrooveFloor& floor : groove_floors(view)) {
    DisjointSets lines(floor.pieces.size());
    for (std::size_t i = 0; i < floor.pieces.size(); ++i) {
      for (std::size_t j = i + 1; j < floor.pieces.size(); ++j) {
        if (lines.are_joined(i, j) || !are_in_line(view, floor.pieces[i], floor.pieces[j]))
          continue;
        lines.join(i, j);
      }
    }
    for (const std::vector<std::size_t>& members : lines.sets()) {
      std::vector<GroovePiece> pieces;
      for (const std::size_t i : members) pieces.push_back(floor.pieces[i]);
      for (SlotFinding& slot : Groove(view, floor, std::move(pieces)).slots()) {
        result.push_back(std::move(slot));
      }
    }
  }
  return result;
}

}  // namespace dowel
