#pragma once

#include <map>
#include <utility>
#include <vector>

#include "dowel/collision/layered_projection.h"
#include "dowel/collision/scene.h"
#include "narrow_phase.h"

// What a scene is made of. Private to collision.

namespace dowel {

struct CollisionScene::Impl {
  struct Body {
    std::shared_ptr<const CollisionElement> element;  // null: a free id
    Pose X_WB;
    Obb obb_W;
    std::int8_t last_plane = -1;  // that kept the moving box off this one
    bool is_moving = false;       // during a query
  };

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

  Body& body(BodyId id);

  /// Verdict on body a placed at X_WA and body b where it stands; witness in the world.
  PairVerdict judge_bodies(BodyId a, const Pose& X_WA, BodyId b, const QueryOptions& options);

  /// Reliefs of the pair in the frame of b; valid until the next call.
  std::span<const ThreadRelief> reliefs_in(BodyId a, BodyId b, const Pose& X_BA);

  std::vector<Body> bodies;
  std::vector<BodyId> free_ids;
  LayeredProjection projection;
  std::map<std::pair<BodyId, BodyId>, std::vector<ThreadRelief>> reliefs;  // in the first's frame
  QueryCounters counters;

  std::vector<std::uint32_t> found;
  std::vector<ThreadRelief> relief_scratch;
  NarrowScratch scratch;
};

}  // namespace dowel
