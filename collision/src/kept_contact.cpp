#include "kept_contact.h"

#include <algorithm>

#include "dowel/collision/box_separation.h"
#include "exact_face.h"

namespace dowel {

void note_method(const CollisionModel& a, std::uint32_t i, const CollisionModel& b, std::uint32_t j,
                 PairVerdict& verdict) {
  const ModelTriangle& of_a = a.triangles()[i];
  const ModelTriangle& of_b = b.triangles()[j];
  if (verdict.method == Method::Boxes) verdict.method = Method::Facets;
  if (of_a.slack_mm + of_b.slack_mm > 0.0) verdict.method = Method::Exact;
  const Face& face_a = a.face(of_a.face);
  const Face& face_b = b.face(of_b.face);
  const double unknown = (is_exact(face_a) ? 0.0 : face_a.facet_error_mm) +
                         (is_exact(face_b) ? 0.0 : face_b.facet_error_mm);
  verdict.bound_mm = std::max(verdict.bound_mm, unknown);
}

bool KeptContact::touches_at(std::uint32_t i, const Eigen::Vector3d& on_a_A,
                             const Eigen::Vector3d& on_a_B, const Footing& on_b) const {
  const auto on_b_B = place_near(b_, on_b, on_a_B);
  if (on_b_B) touch(i, on_a_A, on_a_B, on_b.triangle, *on_b_B);
  return on_b_B.has_value();
}

void KeptContact::touch(std::uint32_t i, const Eigen::Vector3d& on_a_A,
                        const Eigen::Vector3d& on_a_B, std::uint32_t j,
                        const Eigen::Vector3d& on_b_B) const {
  note_method(a_, i, b_, j, verdict_);
  verdict_.verdict = Verdict::Contact;
  verdict_.gap_mm = (on_a_B - on_b_B).norm();
  verdict_.witness_W = 0.5 * (on_a_B + on_b_B);
  memory_.contact_a = i;
  memory_.contact_b = j;
  memory_.has_contact_place = true;
  memory_.contact_A = on_a_A;
  memory_.contact_B = on_b_B;
}

std::optional<Eigen::Vector3d> KeptContact::place_near(const CollisionModel& model,
                                                       const Footing& footing,
                                                       const Eigen::Vector3d& p) const {
  ++counters_.triangle_tests;
  const double reach_squared = options_.tolerance_mm * options_.tolerance_mm;
  const FacePoint near =
      nearest_on_patch(model, footing.triangle, p, reach_squared, footing.is_over);
  if (near.distance_squared_mm2 > reach_squared) return {};
  return near.point;
}

bool still_rests(const PlacedModel& a, const PlacedModel& b, const QueryOptions& options,
                 PairMemory& memory, QueryCounters& counters, PairVerdict& verdict) {
  const double least_gap = -options.tolerance_mm * (1.0 - kSafety);
  if (gap_along(a.obb_W, b.obb_W, memory.shallow_plane) <= least_gap) {
    memory.shallow_plane = -1;
    return false;
  }
  const auto in_B = [&](const Eigen::Vector3d& p_A) { return b.seen_from(a.in_world(p_A)); };
  const auto in_A = [&](const Eigen::Vector3d& p_B) { return a.seen_from(b.in_world(p_B)); };
  if (!KeptContact(a.model, b.model, options, memory, counters, verdict).holds(in_B, in_A)) {
    return false;
  }
  verdict.witness_W = b.in_world(verdict.witness_W);
  return true;
}

}  // namespace dowel
