#include "motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "random_geometry.h"

namespace dowel::bench {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSlack = 0.05 * kDefaultTolerance_mm;  // a truth this close to a threshold is none

Pose upright(double x, double y, double z, double yaw_rad) {
  return Pose(Eigen::Quaterniond(std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)),
              {x, y, z});
}

Aabb box_at(const Pose& X_WM, const Aabb& box) {
  return bounds(
      transformed(X_WM, Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()}));
}

double distance_mm(const Aabb& box, const Eigen::Vector3d& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

double gap_mm(const Aabb& a, const Aabb& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

/// Widest ball that fits into both boxes is no wider than this; negative: they are apart.
double overlap_mm(const Aabb& a, const Aabb& b) {
  return (a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min)).minCoeff();
}

/// True where a ball of `depth_mm` in diameter fits into `ball` and `box`.
bool share_ball(const Ball& ball, const Aabb& box, double depth_mm) {
  const double s = 0.5 * depth_mm;
  const Aabb inner{box.min.array() + s, box.max.array() - s};
  if (ball.radius_mm < s || (inner.min.array() > inner.max.array()).any()) return false;
  return distance_mm(inner, ball.center) <= ball.radius_mm - s;
}

/// Largest distance from the z axis.
double reach_mm(const Element& element) {
  double reach = 0.0;
  for (const Eigen::Vector3d& p : element.solid->vertices) {
    reach = std::max(reach, p.head<2>().norm());
  }
  return reach;
}

/// A closed curve that fills `area` (less `margin_mm` on all sides) without haste; `s` in [0, 1].
Eigen::Vector2d wander(const Aabb& area, double margin_mm, double s) {
  const Eigen::Vector2d middle = area.center().head<2>();
  const Eigen::Vector2d half = (0.5 * area.size().head<2>()).array() - margin_mm;
  return {middle.x() + half.x() * std::sin(2.0 * kPi * 3.0 * s),
          middle.y() + half.y() * std::sin(2.0 * kPi * 2.0 * s + 0.5)};
}

class MotionBuilder {
 public:
  MotionBuilder(const Scenario& scenario, MotionKind kind, std::size_t count, std::uint64_t variant)
      : scene_(scenario),
        count_(count),
        shift_(std::fmod(std::numbers::phi * static_cast<double>(variant), 1.0)),
        random_(1000 + static_cast<std::uint64_t>(kind) + 100 * variant),
        reach_mm_(reach_mm(*scenario.moving)),
        height_mm_(scenario.moving->box.max.z()) {
    motion_.kind = kind;
  }

  Motion build() {
    switch (motion_.kind) {
      case MotionKind::Free:
        add_free();
        break;
      case MotionKind::Near:
        add_near();
        break;
      case MotionKind::Insert:
        add_insert();
        break;
      case MotionKind::Fit:
        add_fit();
        break;
      case MotionKind::Contact:
        add_contact();
        break;
      case MotionKind::Contained:
        add_contained();
        break;
      case MotionKind::Tight:
        add_tight();
        break;
    }
    return std::move(motion_);
  }

 private:
  /// Between steps of the curve, other places in each variant.
  double share(std::size_t i, std::size_t count) const {
    return (static_cast<double>(i) + shift_) / static_cast<double>(count);
  }

  static constexpr double kMargin_mm = 8.0;  // to what stands beside stage and aisle

  void add(const Pose& pose) { add(pose, truth_by_bounds(scene_, pose)); }
  void add(const Pose& pose, const Truth& truth) {
    motion_.poses.push_back(pose);
    motion_.truth.push_back(truth);
  }

  bool is_free(const Pose& pose) const {
    const Aabb box = box_at(pose, scene_.moving->box).padded(1.0);
    return std::none_of(scene_.elements.begin(), scene_.elements.end(),
                        [&](const Placed& p) { return p.box_W.overlaps(box); });
  }

  Pose random_free_pose() {
    const Aabb space{{-190.0, -150.0, 1.0}, {190.0, 150.0, 170.0}};
    while (true) {
      const Eigen::Vector3d s(random_.uniform(0.0, 1.0), random_.uniform(0.0, 1.0),
                              random_.uniform(0.0, 1.0));
      Pose pose(random_.rotation(), space.min + s.cwiseProduct(space.size()));
      if (is_free(pose)) return pose;
    }
  }

  /// Straight legs between random poses, none of which comes within 1 mm of anything.
  void add_free() {
    constexpr std::size_t kLeg = 50;
    Pose from = random_free_pose();
    while (motion_.poses.size() < count_) {
      const Pose to = random_free_pose();
      std::vector<Pose> leg;
      for (std::size_t i = 0; i < kLeg; ++i) leg.push_back(interpolate(from, to, share(i, kLeg)));
      // Turns that sweep through the fixture are drawn again.
      if (!std::all_of(leg.begin(), leg.end(), [&](const Pose& p) { return is_free(p); })) continue;
      for (const Pose& pose : leg) {
        if (motion_.poses.size() < count_) add(pose);
      }
      from = to;
    }
  }

  void add_near() {
    for (std::size_t i = 0; i < count_; ++i) {
      const Aabb& ground = 2 * i < count_ ? scene_.stage : scene_.aisle;
      const double s = share(2 * i % count_, count_);
      const Eigen::Vector2d p = wander(ground, reach_mm_ + kMargin_mm, s);
      const double above = 0.05 + 0.475 * (1.0 + std::sin(2.0 * kPi * 9.0 * s));
      add(upright(p.x(), p.y(), ground.max.z() + above, 4.0 * kPi * s));
    }
  }

  void add_contact() {
    constexpr std::array kOffsets_mm{0.0,    1.0e-3, 0.0,     -1.0e-3, 0.0,
                                     1.0e-6, 0.0,    -1.0e-6, 1.0e-9,  -1.0e-9};
    constexpr std::size_t kRun = 5;
    for (std::size_t i = 0; i < count_; ++i) {
      const Aabb& ground = 2 * i < count_ ? scene_.stage : scene_.aisle;
      const double s = share(2 * i % count_, count_);
      const Eigen::Vector2d p = wander(ground, reach_mm_ + kMargin_mm, s);
      const double offset = kOffsets_mm[i / kRun % kOffsets_mm.size()];
      const Pose pose = upright(p.x(), p.y(), ground.max.z() + offset, 4.0 * kPi * s);
      Truth truth = truth_by_bounds(scene_, pose);
      // Flush faces meet; a foot that is lower by anything enters the face with its walls.
      if (truth.verdict == Verdict::Contact) truth.surfaces_meet = offset <= 0.0;
      add(pose, truth);
    }
  }

  /// A tenth of the poses each: plunges into the stage, some of them tilted, drags from the aisle
  /// into the side of the stage, and slides pressed into its top by up to half a millimetre.
  void add_insert() {
    constexpr std::size_t kParts = 10;
    const std::size_t part_count = count_ / kParts;
    const double top = scene_.stage.max.z();
    const double side = scene_.stage.min.x();
    for (std::size_t part = 0; part < kParts; ++part) {
      const double x = random_.uniform(scene_.stage.min.x() + 20.0, scene_.stage.max.x() - 20.0);
      const double y = random_.uniform(scene_.stage.min.y() + 20.0, scene_.stage.max.y() - 20.0);
      const double yaw = random_.uniform(0.0, 2.0 * kPi);
      const double tilt = part % 4 == 3 ? random_.uniform(0.03, 0.2) : 0.0;
      for (std::size_t i = 0; i < part_count; ++i) {
        const double s = share(i, part_count);
        const double pulse = std::sin(kPi * s);
        switch (part % 3) {
          case 0: {  // plunge and return, turning a little
            const double down = 4.0 - (4.0 + 0.6 * height_mm_) * pulse;
            Pose pose = upright(x, y, top + down, yaw + 0.3 * s);
            if (tilt != 0.0) {
              pose = pose * Pose::about_axis({0.0, 0.0, 0.0}, Eigen::Vector3d::UnitX(), tilt);
            }
            add_penetrating(pose);
            break;
          }
          case 1:  // drag into the side at half height and on
            add_penetrating(upright(side - reach_mm_ - 5.0 + 60.0 * s, y, top - 0.5 * height_mm_,
                                    yaw + 0.2 * s));
            break;
          default: {  // slide, pressed in
            const Eigen::Vector2d p = wander(scene_.stage, reach_mm_ + kMargin_mm, 0.3 * s);
            add_penetrating(upright(p.x(), p.y(), top - 0.5 * pulse, yaw));
            break;
          }
        }
      }
    }
    while (motion_.poses.size() < count_) {
      add(motion_.poses.back(), motion_.truth.back());
    }
  }

  /// For poses that leave a part of the moving element outside.
  void add_penetrating(const Pose& pose) {
    Truth truth = truth_by_bounds(scene_, pose);
    if (truth.verdict == Verdict::Interference) truth.surfaces_meet = true;
    add(pose, truth);
  }

  /// In and out, up to a third of the clearance off the axis, turning.
  void add_fit() {
    for (std::size_t i = 0; i < count_; ++i) {
      const double s = share(i, count_);
      const double in = 0.5 * (1.0 - std::cos(2.0 * kPi * 5.0 * s));
      const double off = kFitClearance_mm / 3.0 * std::sin(2.0 * kPi * 7.0 * s);
      const double direction = 2.0 * kPi * 3.0 * s;
      const double above = 1.0;  // to start with
      const Pose pose =
          upright(scene_.fit.top.x() + off * std::cos(direction),
                  scene_.fit.top.y() + off * std::sin(direction),
                  scene_.fit.top.z() + above - (scene_.fit.travel_mm - 2.0) * in, 2.0 * kPi * s);
      add(pose, truth_by_bounds(scene_, pose, scene_.fit.partner));
    }
  }

  void add_contained() {
    const Aabb& moving = scene_.moving->box;
    const double margin = reach_mm_ + 5.0;
    const double low = scene_.solid_W.min.z() + 5.0;
    const double room = scene_.solid_W.size().z() - 10.0 - moving.size().z();
    for (std::size_t i = 0; i < count_; ++i) {
      const double s = share(i, count_);
      const Eigen::Vector2d p = wander(scene_.solid_W, margin, s);
      add(upright(p.x(), p.y(), low + room * 0.5 * (1.0 + std::sin(2.0 * kPi * s)), 4.0 * kPi * s),
          {Verdict::Interference, false});
    }
  }

  /// Off the axis by 0.08 to 0.22 mm, a land of the pin ahead.
  void add_tight() {
    for (std::size_t i = 0; i < count_; ++i) {
      const double s = share(i, count_);
      const double in = 0.8 - 0.2 * std::cos(2.0 * kPi * 5.0 * s);
      const double off = 0.15 + 0.07 * std::sin(2.0 * kPi * 7.0 * s);
      const double direction = 2.0 * kPi * 3.0 * s;
      const Pose pose =
          upright(scene_.fit.top.x() + off * std::cos(direction),
                  scene_.fit.top.y() + off * std::sin(direction),
                  scene_.fit.top.z() + 1.0 - (scene_.fit.travel_mm - 2.0) * in, direction);
      Truth truth;
      // Pin and wall are cylinders: the gap, or the ball that fits into both, lies on the line of
      // their axes. That nothing else is near follows from boxes.
      if (truth_by_bounds(scene_, pose, scene_.fit.partner).verdict == Verdict::Clear) {
        truth.verdict = verdict_of_gap(kFitClearance_mm - off);
      }
      add(pose, truth);
    }
  }

  static std::optional<Verdict> verdict_of_gap(double gap) {
    constexpr double kTolerance = kDefaultTolerance_mm;
    if (std::abs(std::abs(gap) - kTolerance) < kSlack) return {};
    if (gap > kTolerance) return Verdict::Clear;
    return gap > -kTolerance ? Verdict::Contact : Verdict::Interference;
  }

  const Scenario& scene_;
  std::size_t count_;
  double shift_;
  testing::RandomGeometry random_;
  double reach_mm_;
  double height_mm_;
  Motion motion_;
};

}  // namespace

std::string_view to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::Free:
      return "free";
    case MotionKind::Near:
      return "near";
    case MotionKind::Insert:
      return "insert";
    case MotionKind::Fit:
      return "fit";
    case MotionKind::Contact:
      return "contact";
    case MotionKind::Contained:
      return "contained";
    case MotionKind::Tight:
      return "tight";
  }
  throw std::logic_error("unknown motion");
}

Truth truth_by_bounds(const Scenario& scenario, const Pose& X_WM, std::optional<std::size_t> skip) {
  constexpr double kTolerance = kDefaultTolerance_mm;
  std::vector<Aabb> hull;
  for (const Aabb& part : scenario.moving->hull) hull.push_back(box_at(X_WM, part));
  const Aabb box = box_at(X_WM, scenario.moving->box);
  std::vector<Ball> balls = scenario.moving->core_balls;
  for (Ball& ball : balls) ball.center = X_WM * ball.center;

  double gap_at_least = std::numeric_limits<double>::infinity();
  double gap_at_most = gap_at_least;
  double depth_at_most = -gap_at_least;
  for (std::size_t i = 0; i < scenario.elements.size(); ++i) {
    const Placed& other = scenario.elements[i];
    if (i == skip || gap_mm(box, other.box_W) > 10.0 * kTolerance) continue;
    for (const Aabb& part : other.element->hull) {
      const Aabb part_W = box_at(other.X_WE, part);
      for (const Aabb& piece : hull) {
        gap_at_least = std::min(gap_at_least, gap_mm(piece, part_W));
        depth_at_most = std::max(depth_at_most, overlap_mm(piece, part_W));
      }
    }
    for (const Aabb& core : other.core_W) {
      for (const Ball& ball : balls) {
        if (share_ball(ball, core, kTolerance + kSlack)) return {Verdict::Interference, {}};
        gap_at_most = std::min(gap_at_most, distance_mm(core, ball.center) - ball.radius_mm);
      }
    }
  }
  if (gap_at_least > kTolerance + kSlack) return {Verdict::Clear, false};
  if (depth_at_most < kTolerance - kSlack && gap_at_most < kTolerance - kSlack) {
    return {Verdict::Contact, {}};
  }
  return {};
}

Motion motion_of(const Scenario& scenario, MotionKind kind, std::size_t count,
                 std::uint64_t variant) {
  return MotionBuilder(scenario, kind, count, variant).build();
}

std::vector<Pose> field_path(const Scenario& scenario, std::size_t count) {
  std::vector<Pose> poses;
  const double reach = reach_mm(*scenario.moving);
  const Aabb& stage = scenario.stage;
  // Around the riser in the middle, the same way whatever the number of elements.
  const Eigen::Vector2d center = stage.center().head<2>();
  Eigen::Vector2d middle = scenario.elements.front().X_WE.translation().head<2>();
  for (const Placed& p : scenario.elements) {
    const Eigen::Vector2d at = p.X_WE.translation().head<2>();
    if ((at - center).norm() < (middle - center).norm() - kSlack) middle = at;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(count);
    const double above = 0.05 + 0.475 * (1.0 + std::sin(2.0 * kPi * 9.0 * s));
    const double sink = i % 100 < 50 ? 0.0 : 0.3;
    poses.push_back(upright(middle.x() + 60.0 * std::sin(2.0 * kPi * 3.0 * s),
                            middle.y() + 60.0 * std::sin(2.0 * kPi * 2.0 * s + 0.5),
                            stage.max.z() + above - sink * reach, 4.0 * kPi * s));
  }
  return poses;
}

}  // namespace dowel::bench
