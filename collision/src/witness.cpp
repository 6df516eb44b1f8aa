#include "witness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "exact_face.h"

namespace dowel {
namespace {

/// A witness may miss the depth by this part of it.
constexpr double kDepthSlack = 1e-4;

/// Added to the normal matrix: two opposite planes then share the miss instead of dividing by zero.
constexpr double kRegularisation = 1e-9;

/// A witness is made deeper by these factors, again and again up to so many times each.
constexpr double kCoarseGrowth = 8.0;
constexpr double kFineGrowth = 1.05;
constexpr int kDeepenings = 8;

/// What is asked for first about a place, in wanted depths: whether the boundary is as near as
/// this.
constexpr double kUsualDepths = 2.0;

/// Rounding of a depth that was reckoned at the same place before.
constexpr double kKnownDepthSlack = 1.0e-6;

constexpr std::size_t kMaxConstraints = 4;
constexpr int kRounds = 12;
constexpr int kCoarseRounds = 1;  // of making a witness deeper for later moves: only where easy
constexpr int kNewtonSteps = 6;

/// More steps are made for as long as each leaves no more than this of what is missed: two faces
/// that touch at a point are a double root, to which Newton's steps go by halves.
constexpr double kSteadyGain = 0.5;
constexpr int kMaxNewtonSteps = 40;

enum class Side : std::uint8_t { A, B };

/// "Stay this deep behind that face", for one of the solids.
struct Constraint {
  Side side = Side::A;
  const Face* face = nullptr;  ///< an exact face; else the plane below
  Eigen::Vector3d point_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d inward_B = Eigen::Vector3d::UnitZ();
};

struct DepthAndSlope {
  double depth_mm;
  Eigen::Vector3d inward_B;
};

class Search {
 public:
  Search(const ModelPair& pair, double depth_mm)
      : pair_(pair), X_AB_(pair.X_BA.inverse()), depth_mm_(depth_mm) {}

  double enough_mm() const { return depth_mm_ - kDepthSlack * std::abs(depth_mm_); }
  bool is_for_contact() const { return depth_mm_ < 0.0; }

  /// Places that were put at the depth are hardly further from the nearest boundary.
  double usual_mm() const { return kUsualDepths * std::abs(depth_mm_); }

  void add_triangle(Side side, std::uint32_t triangle) {
    const CollisionModel& m = model(side);
    const ModelTriangle& t = m.triangles()[triangle];
    const Face& face = m.face(t.face);
    Constraint constraint{side, is_exact(face) ? &face : nullptr, t.corners[0], -t.normal};
    if (side == Side::A) {
      constraint.point_B = pair_.X_BA * constraint.point_B;
      constraint.inward_B = pair_.X_BA.rotation() * constraint.inward_B;
    }
    constraints_[count_++] = constraint;
  }

  /// Moves `p` to `depth_mm` behind all constraints, as nearly as they allow. False where they do
  /// not leave room enough.
  bool settle(Eigen::Vector3d& p) const {
    double previous = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
      std::array<Eigen::Vector3d, kMaxConstraints> slopes;
      std::array<double, kMaxConstraints> misses{};
      double worst = 0.0;
      for (std::size_t i = 0; i < count_; ++i) {
        const DepthAndSlope d = depth_behind(constraints_[i], p);
        slopes[i] = d.inward_B;
        misses[i] = depth_mm_ - d.depth_mm;
        worst = std::max(worst, misses[i]);
      }
      if (worst <= 0.1 * kDepthSlack * std::abs(depth_mm_)) break;
      if (step >= kNewtonSteps && worst > kSteadyGain * previous) break;
      previous = worst;
      p += shortest_step(slopes, misses);
      if (!p.allFinite()) return false;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      if (depth_behind(constraints_[i], p).depth_mm < enough_mm()) return false;
    }
    return true;
  }

  /// The shortest step that makes up for what is missed, to first order, and leaves no other
  /// constraint short: those that it would are met exactly, too.
  Eigen::Vector3d shortest_step(const std::array<Eigen::Vector3d, kMaxConstraints>& slopes,
                                const std::array<double, kMaxConstraints>& misses) const {
    std::array<bool, kMaxConstraints> is_met{};
    for (std::size_t i = 0; i < count_; ++i) is_met[i] = misses[i] > 0.0;
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    for (std::size_t round = 0; round < count_; ++round) {
      Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxConstraints, 3> rows(0, 3);
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxConstraints, 1> wanted(0);
      const auto active = std::count(is_met.begin(), is_met.end(), true);
      rows.resize(active, 3);
      wanted.resize(active);
      for (std::size_t i = 0, row = 0; i < count_; ++i) {
        if (!is_met[i]) continue;
        rows.row(static_cast<Eigen::Index>(row)) = slopes[i].transpose();
        wanted[static_cast<Eigen::Index>(row++)] = misses[i];
      }
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxConstraints, kMaxConstraints>
          normal = rows * rows.transpose();
      normal.diagonal().array() += kRegularisation;
      step = rows.transpose() * normal.partialPivLu().solve(wanted).eval();
      bool is_short = false;
      for (std::size_t i = 0; i < count_; ++i) {
        if (is_met[i] || slopes[i].dot(step) >= misses[i]) continue;
        is_met[i] = true;
        is_short = true;
      }
      if (!is_short) break;
    }
    return step;
  }

  struct Reading {
    double depth_mm;
    Constraint nearest;
  };
  /// Depth of `p` in one solid and the constraint that its nearest boundary stands for.
  Reading read(Side side, const Eigen::Vector3d& p) const {
    return reading(side, p, model(side).nearest(in_frame(side, p)));
  }

  /// The same where the boundary is nearer than `radius_mm`, at little cost; nothing elsewhere.
  std::optional<Reading> read_within(Side side, const Eigen::Vector3d& p, double radius_mm) const {
    const auto near = model(side).nearest_within(in_frame(side, p), radius_mm);
    if (!near) return std::nullopt;
    return reading(side, p, *near);
  }

  /// The same where the depth is known.
  Reading read_at_depth(Side side, const Eigen::Vector3d& p, double depth_mm) const {
    const auto near = read_within(side, p, depth_mm * (1.0 + kKnownDepthSlack));
    return near ? *near : read(side, p);
  }

  /// False where nothing new is learned: the face is known, or there is no room for another.
  bool add(const Constraint& constraint) {
    for (std::size_t i = 0; i < count_; ++i) {
      const bool same =
          constraint.face != nullptr
              ? constraints_[i].face == constraint.face
              : (constraints_[i].face == nullptr && constraints_[i].side == constraint.side &&
                 constraints_[i].inward_B.dot(constraint.inward_B) > 1.0 - kDepthSlack);
      if (same && constraints_[i].side == constraint.side) return false;
    }
    if (count_ < kMaxConstraints) {
      constraints_[count_++] = constraint;
      return true;
    }
    // A plane at a place of a rim stands for it only near there: the oldest one gives way.
    const auto stale = std::ranges::find_if(constraints_, [&](const Constraint& known) {
      return known.face == nullptr && known.side == constraint.side;
    });
    if (stale == constraints_.end()) return false;
    std::move(stale + 1, constraints_.end(), stale);
    constraints_.back() = constraint;
    return true;
  }

  bool in_relief(const Eigen::Vector3d& p) const {
    if (is_for_contact()) return false;
    return std::ranges::any_of(pair_.reliefs_B, [&](const ThreadRelief& relief) {
      const Eigen::Vector3d from_start = p - relief.start;
      const double along = relief.direction.dot(from_start);
      return along >= -depth_mm_ && along <= relief.length_mm + depth_mm_ &&
             (from_start - along * relief.direction).norm() <= relief.radius_mm + depth_mm_;
    });
  }

 private:
  const CollisionModel& model(Side side) const { return side == Side::A ? pair_.a : pair_.b; }

  Eigen::Vector3d in_frame(Side side, const Eigen::Vector3d& p) const {
    return side == Side::A ? X_AB_ * p : p;
  }

  Reading reading(Side side, const Eigen::Vector3d& p, const NearestPoint& near) const {
    const Face& face = model(side).face(model(side).triangles()[near.triangle].face);
    Constraint constraint{side, near.on_face && is_exact(face) ? &face : nullptr,
                          side == Side::A ? pair_.X_BA * near.point : near.point,
                          Eigen::Vector3d::UnitZ()};
    const Eigen::Vector3d inward = near.inside ? Eigen::Vector3d(p - constraint.point_B)
                                               : Eigen::Vector3d(constraint.point_B - p);
    if (inward.squaredNorm() > 0.0) constraint.inward_B = inward.normalized();
    return {near.inside ? near.distance_mm : -near.distance_mm, constraint};
  }

  DepthAndSlope depth_behind(const Constraint& constraint, const Eigen::Vector3d& p) const {
    if (constraint.face == nullptr) {
      return {constraint.inward_B.dot(p - constraint.point_B), constraint.inward_B};
    }
    if (constraint.side == Side::B) {
      return {-outward_distance_mm(*constraint.face, p), -outward_normal(*constraint.face, p)};
    }
    const Eigen::Vector3d p_A = X_AB_ * p;
    return {-outward_distance_mm(*constraint.face, p_A),
            pair_.X_BA.rotation() * -outward_normal(*constraint.face, p_A)};
  }

  const ModelPair& pair_;
  Pose X_AB_;
  double depth_mm_;
  std::array<Constraint, kMaxConstraints> constraints_;
  std::size_t count_ = 0;
};

/// Runs rounds of settling and asking from `start` on.
std::optional<Witness> run(Search& search, const Eigen::Vector3d& start, double reach_mm,
                           int rounds = kRounds) {
  constexpr std::array kSides{Side::A, Side::B};
  Eigen::Vector3d p = start;
  for (int round = 0; round < rounds; ++round) {
    if (!search.settle(p) || (p - start).norm() > reach_mm || search.in_relief(p)) {
      return std::nullopt;
    }
    // Most places are as deep as they were put or too near a boundary, which is found at little
    // cost. Only where neither is, far ones are sought.
    std::array<std::optional<Search::Reading>, 2> readings;
    bool is_short = false;
    bool learned = false;
    const auto take = [&](const Search::Reading& reading) {
      if (reading.depth_mm >= search.enough_mm()) return;
      is_short = true;
      learned = search.add(reading.nearest) || learned;
    };
    for (std::size_t i = 0; i < 2; ++i) {
      readings[i] = search.read_within(kSides[i], p, search.usual_mm());
      if (readings[i]) take(*readings[i]);
    }
    for (std::size_t i = 0; i < 2 && !is_short; ++i) {
      if (readings[i]) continue;
      readings[i] = search.read(kSides[i], p);
      take(*readings[i]);
    }
    if (!is_short) return Witness{p, readings[0]->depth_mm, readings[1]->depth_mm};
    if (!learned) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Witness> find_witness(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                    std::uint32_t triangle_a, std::uint32_t triangle_b,
                                    double depth_mm, double reach_mm) {
  Search search(pair, depth_mm);
  search.add_triangle(Side::A, triangle_a);
  search.add_triangle(Side::B, triangle_b);
  return run(search, start_B, reach_mm);
}

std::optional<Witness> find_touch(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                  std::uint32_t triangle_a, std::uint32_t triangle_b, double gap_mm,
                                  double reach_mm) {
  return find_witness(pair, start_B, triangle_a, triangle_b, -0.5 * gap_mm, reach_mm);
}

std::optional<Witness> find_witness(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                    double depth_mm, double reach_mm) {
  Search search(pair, depth_mm);
  return run(search, start_B, reach_mm);
}

std::optional<Witness> test_witness(const ModelPair& pair, const Eigen::Vector3d& point_B,
                                    double depth_mm) {
  const Search search(pair, depth_mm);
  if (search.in_relief(point_B)) return std::nullopt;
  for (const Side side : {Side::A, Side::B}) {
    if (search.read_within(side, point_B, search.enough_mm())) return std::nullopt;
  }
  const double depth_a = search.read(Side::A, point_B).depth_mm;
  if (depth_a < search.enough_mm()) return std::nullopt;
  const double depth_b = search.read(Side::B, point_B).depth_mm;
  if (depth_b < search.enough_mm()) return std::nullopt;
  return Witness{point_B, depth_a, depth_b};
}

Witness deepen(const ModelPair& pair, const Witness& witness, bool thoroughly) {
  Witness best = witness;
  const double least_growth = thoroughly ? kFineGrowth : kCoarseGrowth;
  double growth = kCoarseGrowth;
  while (growth >= least_growth) {
    for (int step = 0; step < kDeepenings; ++step) {
      const double depth_mm = std::min(best.depth_a_mm, best.depth_b_mm);
      Search search(pair, growth * depth_mm);
      search.add(search.read_at_depth(Side::A, best.point_B, best.depth_a_mm).nearest);
      search.add(search.read_at_depth(Side::B, best.point_B, best.depth_b_mm).nearest);
      const auto deeper =
          run(search, best.point_B, 8.0 * growth * depth_mm, thoroughly ? kRounds : kCoarseRounds);
      if (!deeper) break;
      best = *deeper;
    }
    growth = std::sqrt(growth);
  }
  return best;
}

}  // namespace dowel
