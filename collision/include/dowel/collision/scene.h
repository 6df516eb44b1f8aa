#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dowel/collision/verdict.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/id.h"
#include "dowel/kernel/pose.h"

namespace dowel {

class CollisionModel;

/// What a scene knows of an element: its box at once, its facets when a narrow phase first asks.
/// Shared by all its instances and, once loaded, by threads.
class CollisionElement {
 public:
  using Loader = std::function<std::shared_ptr<const FacetedSolid>()>;

  /// `obb`: contains the exact solid, in the element's frame; finite, with orthonormal axes. `load`
  /// is called until it once returns a solid. `hole_faces`: faces that make up the walls of holes,
  /// for HoleMode::Paper; may be empty.
  CollisionElement(const Obb& obb, Loader load, std::vector<std::uint32_t> hole_faces = {});
  ~CollisionElement();

  const Obb& obb() const noexcept { return obb_; }
  bool is_loaded() const noexcept;

  /// Builds on first use. What the loader throws passes through; a solid with a defect, or one
  /// that its box does not contain, is Error{FileMalformed}.
  const CollisionModel& model() const;

 private:
  struct State;
  Obb obb_;
  std::unique_ptr<State> state_;
};

using BodyId = Id<struct BodyTag>;

/// A stretch of a thread in which two mated bodies overlap by design: screw (nominal diameter) in
/// tapped hole (minor diameter). Points inside this cylinder are no evidence of interference.
struct ThreadRelief {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< on the axis, frame of the first body
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double length_mm = 0.0;
  double radius_mm = 0.0;  ///< nominal radius of the thread
};

struct BodyVerdict {
  BodyId moving;
  BodyId with;
  PairVerdict pair;
};

/// Counters of the paper, N_b and N_p, and of what was spared, summed over the queries of one
/// scene.
struct QueryCounters {
  std::uint64_t box_tests = 0;       ///< OBB against OBB, elements and tree nodes
  std::uint64_t triangle_tests = 0;  ///< triangle pairs that were looked at
  /// Pairs on which each skip decided, or (ShallowBoxes, KeptOff) whose search it made shorter; of
  /// Layers and Silhouettes each time that a body's candidates are found.
  std::array<std::uint64_t, kSkipCount> uses{};

  void note(Skip skip, std::uint64_t pairs = 1) { uses[static_cast<std::size_t>(skip)] += pairs; }
};

struct SweepResult {
  double time_of_impact = 1.0;       ///< in [0, 1]; 1: no interference on the way
  Pose free_pose;                    ///< last pose before it
  Verdict verdict = Verdict::Clear;  ///< worst on the way
  std::vector<BodyVerdict> pairs;    ///< at the impact, or at the end where there is none
};

/// Placed bodies and the queries on them. One scene a thread; elements may be shared between them.
/// Expects of all poses at which bodies are placed or between which they are swept: within
/// kMaxPlace_mm of the origin; of all queries: a tolerance in [kMinTolerance_mm, kMaxTolerance_mm].
class CollisionScene {
 public:
  CollisionScene();
  ~CollisionScene();
  CollisionScene(CollisionScene&&) noexcept;
  CollisionScene& operator=(CollisionScene&&) noexcept;

  BodyId add(std::shared_ptr<const CollisionElement> element, const Pose& X_WB);
  void remove(BodyId body);
  void move(BodyId body, const Pose& X_WB);
  const Pose& pose(BodyId body) const;
  std::size_t size() const;

  /// Declares threads in which `first` and `second` may overlap; replaces earlier ones of the pair.
  /// Expects: two bodies, finite lengths, unit directions.
  void set_reliefs(BodyId first, BodyId second, std::vector<ThreadRelief> reliefs);

  /// Bodies that are not clear of the moving ones, were these placed at `poses` (one for each);
  /// sorted by moving body, then by the other. Moving bodies are not checked against each other.
  /// The scene is not changed. The result is valid until the next query.
  ///
  /// Made for moves that follow each other: what the last check of a body found out (who is near,
  /// how far, which plane, facets or ball told so) is tried first, and a move that is shorter than
  /// the known gap costs no test. Allocates nothing once it has seen its largest query.
  std::span<const BodyVerdict> check(std::span<const BodyId> moving, std::span<const Pose> poses,
                                     const QueryOptions& options);

  /// The same by looking at all facets of all bodies. Reference for tests.
  std::vector<BodyVerdict> check_brute_force(std::span<const BodyId> moving,
                                             std::span<const Pose> poses,
                                             const QueryOptions& options);

  /// All pairs of the scene that are not clear, `moving < with`, sorted.
  std::vector<BodyVerdict> check_all(const QueryOptions& options);

  /// First interference of the motion in which the unit's frame goes from `from` to `to` (shortest
  /// rotation, linear translation); body i moves at `X_WU * X_UB[i]`.
  SweepResult sweep(std::span<const BodyId> moving, std::span<const Pose> X_UB, const Pose& from,
                    const Pose& to, const QueryOptions& options);

  const QueryCounters& counters() const;
  void reset_counters();

  /// Bytes of the scene's own structures and of the models built so far.
  std::size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Worst verdict in `verdicts`; Clear where there is none.
Verdict worst(std::span<const BodyVerdict> verdicts);

}  // namespace dowel
