#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "dowel/collision/layered_projection.h"
#include "dowel/collision/scene.h"
#include "kept_contact.h"
#include "narrow_phase.h"

// What a scene is made of. Private to collision.

namespace dowel {

/// Expects a tolerance from kMinTolerance_mm to kMaxTolerance_mm.
void expect_valid(const QueryOptions& options);

/// Expects a body no further than kMaxPlace_mm from the origin.
void expect_valid_place(const Pose& X_WB);

struct CollisionScene::Impl {
  struct Body {
    std::shared_ptr<const CollisionElement> element;  // null: a free id
    Pose X_WB;
    bool is_moving = false;  // during a query

    Obb obb_W() const { return transformed(X_WB, element->obb()); }
  };

  /// The bodies by id: in blocks, so that it grows without room to spare.
  class Bodies {
   public:
    Body& operator[](std::size_t i) { return (*blocks_[i / kBlock])[i % kBlock]; }
    const Body& operator[](std::size_t i) const { return (*blocks_[i / kBlock])[i % kBlock]; }
    std::size_t size() const { return size_; }
    void add_one() {
      if (size_ % kBlock == 0) blocks_.push_back(std::make_unique<std::array<Body, kBlock>>());
      ++size_;
    }

   private:
    static constexpr std::size_t kBlock = 32;
    std::vector<std::unique_ptr<std::array<Body, kBlock>>> blocks_;
    std::size_t size_ = 0;
  };

  /// A placed body that a mover may meet, and what is known of the two.
  struct Candidate {
    BodyId id;
    Obb obb_W;
    Eigen::Matrix3d rotation_WB;
    std::int8_t plane = -1;    // that kept their boxes apart last
    double clear_until = 0.0;  // the two are clear while the mover's way is below this
    PairMemory memory;
  };

  /// What is remembered of a body from one check to the next. Its way is a bound of how far any
  /// point of it has moved since the candidates were found.
  struct Mover {
    BodyId id;
    bool axes_are_old = false;
    bool box_is_upright = false;  // in its element's frame, as most are
    const CollisionElement* element = nullptr;
    double radius_mm = 0.0;  // of the box's corners about its centre
    Pose X_WB;
    Obb obb_W;                    // but for the axes while `axes_are_old`
    Eigen::Matrix3d rotation_WB;  // of a body whose box is not upright, but while `axes_are_old`
    double way_mm = 0.0;
    double listed_until = -1.0;  // nothing but the candidates is met while the way is below this
    double clear_until = -1.0;   // nothing at all
    double tolerance_mm = 0.0;   // of the queries that this was found for
    HoleMode holes = HoleMode::Exact;
    SkipSet without;
    std::uint64_t last_use = 0;
    std::vector<Candidate> candidates;  // by id

    /// The box at the pose asked about. Most moves do not need its axes.
    const Obb& box_W() {
      if (axes_are_old) {
        if (box_is_upright) {
          obb_W.axes = X_WB.rotation_matrix();
        } else {
          rotation_WB = X_WB.rotation_matrix();
          obb_W.axes = rotation_WB * element->obb().axes;
        }
        axes_are_old = false;
      }
      return obb_W;
    }
    /// The body at that pose.
    PlacedModel placed() {
      const Obb& box = box_W();
      return {element->model(), box_is_upright ? box.axes : rotation_WB, X_WB.translation(), box};
    }
  };

  class PairSweep;

  /// Marks the moving bodies for the time of a query.
  class MovingMark {
   public:
    MovingMark(Impl& impl, std::span<const BodyId> moving) : impl_(impl), moving_(moving) {
      for (const BodyId id : moving_) impl_.body(id).is_moving = true;
    }
    ~MovingMark() {
      for (const BodyId id : moving_) impl_.bodies[id.value].is_moving = false;
    }
    MovingMark(const MovingMark&) = delete;
    MovingMark& operator=(const MovingMark&) = delete;

   private:
    Impl& impl_;
    std::span<const BodyId> moving_;
  };

  /// Body a, were it at X_WA, as body b sees it.
  struct PlacedPair {
    PlacedPair(Impl& impl, BodyId a, const Pose& X_WA, BodyId b)
        : PlacedPair(impl, a, b, impl.bodies[b.value].X_WB.inverse() * X_WA) {}
    ModelPair pair;

   private:
    PlacedPair(Impl& impl, BodyId a, BodyId b, const Pose& X_BA)
        : pair{impl.bodies[a.value].element->model(),
               impl.bodies[b.value].element->model(),
               impl.bodies[a.value].element->obb(),
               impl.bodies[b.value].element->obb(),
               X_BA,
               impl.reliefs_in(a, b, X_BA)} {}
  };

  Body& body(BodyId id);

  /// Verdict on body a placed at X_WA and body b where it stands; witness in the world.
  PairVerdict judge_bodies(BodyId a, const Pose& X_WA, BodyId b, const QueryOptions& options,
                           PairMemory& memory);

  /// What is remembered of the body, brought to the pose that it is asked about.
  Mover& mover_at(BodyId id, const Pose& X_WB, const QueryOptions& options);

  /// Finds the mover's candidates anew, with room for the moves to come.
  void find_candidates(Mover& mover, double step_mm);

  /// Lists the bodies whose boxes overlap `box_W` as `found`, by id.
  void find_bodies(const Aabb& box_W, SkipSet without);

  /// Whether a plane keeps the boxes apart, the one that did so last before all others; then the
  /// candidate says for how long.
  bool boxes_keep_apart(Mover& mover, Candidate& candidate, double tolerance_mm);

  /// Whether a mover and one of its candidates are in contact or worse: then the last of `verdicts`
  /// says how. Else the candidate says for how long they are clear.
  bool meet(Mover& mover, Candidate& candidate, const QueryOptions& options);

  /// The same in detail: then `verdict`, which is new, says how. `met`: they did so last time, and
  /// their boxes were not asked yet.
  bool judge_candidate(Mover& mover, Candidate& candidate, bool met, const QueryOptions& options,
                       PairVerdict& verdict);

  /// Appends the verdicts of one mover, which may move along with others, to `verdicts`; false once
  /// `first_only` ends the query.
  bool check_mover(Mover& mover, bool is_alone, const QueryOptions& options);

  /// Forgets what is remembered of all bodies but `id`, whose surroundings are as they were.
  void forget_all_but(BodyId id);

  /// Reliefs of the pair in the frame of b; valid until the next call.
  std::span<const ThreadRelief> reliefs_in(BodyId a, BodyId b, const Pose& X_BA);

  Bodies bodies;
  std::vector<BodyId> free_ids;
  LayeredProjection projection;
  std::map<std::pair<BodyId, BodyId>, std::vector<ThreadRelief>> reliefs;  // in the first's frame
  QueryCounters counters;

  std::vector<std::uint32_t> found;
  std::vector<Mover> movers;
  std::uint64_t query_count = 0;
  std::vector<BodyVerdict> verdicts;
  std::vector<Candidate> old_candidates;
  std::vector<ThreadRelief> relief_scratch;
  NarrowScratch scratch;
};

}  // namespace dowel
