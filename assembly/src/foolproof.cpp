#include "foolproof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fact_source.h"
#include "fixture_result.h"
#include "instance_boxes.h"
#include "solid_symmetry.h"

namespace dowel {
namespace {

/// The workpiece is put in from this far above the first locators, and beside the others.
constexpr double kAbove_mm = 5.0;
constexpr double kBeside_mm = 1.0;

/// Two orientations that differ by less look the same to whoever puts the workpiece in.
constexpr double kLooksSame_mm = 0.05;

/// Shares of the tolerance that the pushes may use up one after the other, so that a later one
/// starts clear of what the earlier ones ended at.
constexpr std::array<double, 3> kPushShares{0.25, 0.5, 0.75};

/// Normals of locators closer than this are one direction.
constexpr double kOneDirection = 0.99;

/// Towards locators: a direction out of them, and how far the workpiece's box reaches past them.
struct Push {
  Eigen::Vector3d normal_W;  ///< into the workpiece
  int points = 0;
  double recess_mm = 0.0;
};

/// Proper rotations that take the axes of a box to each other; the identity is not among them.
std::vector<Eigen::Matrix3d> box_turns() {
  std::vector<Eigen::Matrix3d> turns;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        turn(order[static_cast<std::size_t>(axis)], axis) =
            (signs >> static_cast<unsigned>(axis) & 1U) != 0 ? -1.0 : 1.0;
      }
      if (turn.determinant() > 0.0 && !turn.isIdentity()) turns.push_back(turn);
    }
  } while (std::ranges::next_permutation(order).found);
  return turns;
}

class Foolproofing {
 public:
  Foolproofing(const FoolproofQuestion& question, const Element& workpiece, PlacedBodies& models)
      : question_(question),
        workpiece_(workpiece),
        X_WI_(question.opened.find(question.workpiece)->X_WI),
        models_(models),
        bodies_(models.empty_copy()) {
    bodies_.follow(question.opened);
    find_pushes();
    find_pin();
  }

  /// The workpiece turned about the middle of its box.
  OrientationTry try_turn(const Eigen::Matrix3d& turn) {
    OrientationTry result;
    const Eigen::Matrix3d axes_W = X_WI_.rotation() * workpiece_.obb.axes;
    const Eigen::Matrix3d turn_W = axes_W * turn * axes_W.transpose();
    const Eigen::Vector3d middle_W = question_.frame.reference;
    const Pose X_WW = Pose::from_matrix(turn_W, middle_W - turn_W * middle_W);
    result.looks_same =
        covers_itself(*models_.shape(workpiece_.name), X_WI_.inverse() * X_WW * X_WI_,
                      kLooksSame_mm + workpiece_.facet_error_mm);
    if (result.looks_same) return result;
    room_W_.setEmpty();
    result.result = tried(X_WW * X_WI_);
    result.room_W = room_W_;
    const Eigen::AngleAxisd about(turn_W);
    result.result.axis_W = about.axis();
    result.result.angle_rad = about.angle();
    return result;
  }

 private:
  double extent_mm(const Pose& X_WI, const Eigen::Vector3d& normal_W) const {
    const Eigen::Matrix3d axes_W = X_WI.rotation() * workpiece_.obb.axes;
    return (axes_W.transpose() * normal_W).cwiseAbs().dot(workpiece_.obb.half_extents_mm);
  }

  void find_pushes() {
    for (const LocatingPoint& point : question_.locators) {
      if (point.two_sided) continue;
      auto push = std::ranges::find_if(pushes_, [&](const Push& known) {
        return known.normal_W.dot(point.normal) > kOneDirection;
      });
      if (push == pushes_.end()) push = pushes_.insert(pushes_.end(), {point.normal, 0, 0.0});
      ++push->points;
      const double in_box_mm = push->normal_W.dot(point.at - question_.frame.reference) +
                               extent_mm(X_WI_, push->normal_W);
      push->recess_mm = std::max(push->recess_mm, in_box_mm);
    }
    std::ranges::stable_sort(pushes_, std::ranges::greater{}, &Push::points);
    if (pushes_.size() > kPushShares.size()) pushes_.resize(kPushShares.size());
  }

  /// The first pin in a hole, and the hole.
  void find_pin() {
    for (const LocatingPoint& point : question_.locators) {
      if (!point.two_sided || hole_ != nullptr) continue;
      const Eigen::Vector3d at = X_WI_.inverse() * point.at;
      for (const Feature& feature : workpiece_.features) {
        if (feature.kind != FeatureKind::Hole) continue;
        const Eigen::Vector3d off = (at - feature.origin).cross(feature.direction);
        if (off.norm() > kCoaxial_mm) continue;
        hole_ = &feature;
        pin_W_ = point.at;
        return;
      }
    }
  }

  /// Places from which a turned workpiece may be pushed home: beside the locators, or with one of
  /// its holes over the first pin.
  std::vector<Pose> starts(const Pose& X_WI) const {
    Eigen::Vector3d by_W = Eigen::Vector3d::Zero();
    for (const Push& push : pushes_) {
      const double clear_mm = &push == &pushes_.front() ? kAbove_mm : kBeside_mm;
      by_W += (extent_mm(X_WI, push.normal_W) - extent_mm(X_WI_, push.normal_W) + push.recess_mm +
               clear_mm) *
              push.normal_W;
    }
    if (hole_ == nullptr) return {Pose(X_WI.rotation(), X_WI.translation() + by_W)};
    const Eigen::Vector3d axis_W = X_WI_.rotation() * hole_->direction;
    by_W = by_W.dot(axis_W) * axis_W;
    std::vector<Pose> poses;
    for (const Feature& feature : workpiece_.features) {
      if (feature.kind != FeatureKind::Hole ||
          std::abs(feature.diameter_mm - hole_->diameter_mm) > kLooksSame_mm) {
        continue;
      }
      const Eigen::Vector3d direction_W = X_WI.rotation() * feature.direction;
      if (direction_W.cross(axis_W).norm() > kCoaxial_rad) continue;
      const Eigen::Vector3d to_pin_W = pin_W_ - X_WI * feature.origin;
      poses.emplace_back(X_WI.rotation(),
                         X_WI.translation() + by_W + to_pin_W - to_pin_W.dot(axis_W) * axis_W);
    }
    return poses;
  }

  /// Where it seats, if it does; else what the last try was against.
  WrongOrientation tried(const Pose& X_WI) {
    WrongOrientation result;
    result.X_WI = X_WI;
    result.against = question_.locators.front().name;
    for (const Pose& start : starts(X_WI)) {
      result = pushed_home(start);
      if (result.seats) break;
    }
    return result;
  }

  /// Notes that the answer hangs on what is there.
  void look_at(const Pose& X_WI) {
    const Eigen::Vector3d middle_W = X_WI * workpiece_.obb.center;
    const Eigen::Vector3d half_mm =
        (X_WI.rotation() * workpiece_.obb.axes).cwiseAbs() * workpiece_.obb.half_extents_mm +
        Eigen::Vector3d::Constant(kBeside_mm);
    room_W_.extend(Eigen::AlignedBox3d(middle_W - half_mm, middle_W + half_mm));
  }

  /// The first part that it would be in at a pose; empty where there is none.
  std::string in_the_way(const Pose& X_WI, double tolerance_mm) {
    look_at(X_WI);
    for (const Touch& touch : bodies_.check(question_.workpiece, X_WI, tolerance_mm)) {
      if (touch.pair.verdict == Verdict::Interference) return touch.with;
    }
    return {};
  }

  WrongOrientation pushed_home(Pose X_WI) {
    WrongOrientation result;
    result.X_WI = X_WI;
    result.against = in_the_way(X_WI, question_.tolerance_mm);
    if (!result.against.empty()) return result;
    for (std::size_t i = 0; i < pushes_.size(); ++i) {
      const Push& push = pushes_[i];
      if (hole_ != nullptr && i > 0) break;  // the pin holds it
      const double way_mm = kAbove_mm + push.recess_mm + extent_mm(X_WI, push.normal_W);
      const Pose X_WI_end(X_WI.rotation(), X_WI.translation() - way_mm * push.normal_W);
      const double tolerance_mm =
          std::max(kMinTolerance_mm, kPushShares[i] * question_.tolerance_mm);
      const auto path =
          bodies_.sweep({{question_.workpiece, Pose()}}, {X_WI, X_WI_end}, tolerance_mm);
      look_at(path.X_WU_free);
      if (path.touches.empty()) {
        result.against = missed({});
        return result;  // it goes past
      }
      X_WI = path.X_WU_free;
    }
    result.X_WI = X_WI;
    const auto touches = bodies_.check(question_.workpiece, X_WI, question_.tolerance_mm);
    for (const Touch& touch : touches) {
      if (touch.pair.verdict == Verdict::Interference) result.against = touch.with;
    }
    if (result.against.empty()) result.against = missed(touches);
    result.seats = result.against.empty();
    return result;
  }

  /// The first locator that is not among `touches`.
  std::string missed(const std::vector<Touch>& touches) const {
    for (const LocatingPoint& point : question_.locators) {
      // A pin that is in a hole need not touch its wall; one beside it was in the way.
      if (point.two_sided) continue;
      if (std::ranges::find(touches, point.name, &Touch::with) == touches.end()) return point.name;
    }
    return {};
  }

  const FoolproofQuestion& question_;
  const Element& workpiece_;
  Pose X_WI_;
  PlacedBodies& models_;
  PlacedBodies bodies_;
  std::vector<Push> pushes_;
  const Feature* hole_ = nullptr;
  Eigen::Vector3d pin_W_ = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d room_W_;  ///< of the try at hand
};

/// Boxes of the parts in which two questions differ, as they were and as they are.
std::vector<Eigen::AlignedBox3d> changed_boxes(const FoolproofQuestion& before,
                                               const FoolproofQuestion& now) {
  std::vector<Eigen::AlignedBox3d> boxes;
  const auto add_changed = [&](const FoolproofQuestion& from, const FoolproofQuestion& in) {
    for (const auto& [name, instance] : from.opened.instances) {
      const Instance* other = in.opened.find(name);
      if (other == nullptr || !(*other == instance)) boxes.push_back(from.boxes_W.at(name));
    }
  };
  add_changed(before, now);
  add_changed(now, before);
  return boxes;
}

}  // namespace

bool FoolproofAnalysis::is_foolproof() const {
  return std::ranges::none_of(wrong, &WrongOrientation::seats);
}

FoolproofQuestion foolproof_question(const FixtureModel& model, FactSource& source) {
  FoolproofQuestion question{
      model.workpiece, model.frame, model.locators, {}, {}, source.state().tolerance_mm};
  double recess_mm = 0.0;
  for (const LocatingPoint& point : model.locators) {
    recess_mm = std::max(recess_mm, (point.at - model.frame.reference).norm());
  }
  const double reach_mm = 2.0 * model.frame.length_mm + recess_mm + kAbove_mm + kBeside_mm;
  question.opened = opened_around(model, source, reach_mm);
  for (const auto& [name, instance] : question.opened.instances) {
    question.boxes_W.emplace(name, box_around(instance, source.element(instance)));
  }
  return question;
}

FoolproofAnalysis FoolproofAnswer::analysis() const {
  FoolproofAnalysis result;
  for (const OrientationTry& one : tries) {
    if (one.looks_same) {
      ++result.same;
    } else {
      result.wrong.push_back(one.result);
    }
  }
  return result;
}

FoolproofAnswer analyse_foolproof(FoolproofQuestion question, const FoolproofAnswer& known,
                                  const Element& workpiece, PlacedBodies& models) {
  const FoolproofQuestion& before = known.question;
  const bool may_know =
      before.workpiece == question.workpiece && before.frame == question.frame &&
      before.locators == question.locators && before.tolerance_mm == question.tolerance_mm &&
      *before.opened.find(question.workpiece) == *question.opened.find(question.workpiece);
  std::vector<Eigen::AlignedBox3d> changed;
  if (may_know) changed = changed_boxes(before, question);
  FoolproofAnswer answer{std::move(question), {}};
  // What is not settled seats turned a little, too.
  if (!analyse_locating(answer.question.locators, answer.question.frame).is_deterministic()) {
    return answer;
  }
  std::optional<Foolproofing> foolproofing;
  const std::vector<Eigen::Matrix3d> turns = box_turns();
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const bool is_known =
        may_know && (known.tries[i].looks_same ||
                     std::ranges::none_of(changed, [&](const Eigen::AlignedBox3d& box) {
                       return box.intersects(known.tries[i].room_W);
                     }));
    if (is_known) {
      answer.tries.push_back(known.tries[i]);
      continue;
    }
    if (!foolproofing) foolproofing.emplace(answer.question, workpiece, models);
    answer.tries.push_back(foolproofing->try_turn(turns[i]));
  }
  return answer;
}

}  // namespace dowel
