#include "dowel/assembly/mate_solver.h"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/assembly/freedom.h"
#include "random_geometry.h"

using dowel::Freedom;
using dowel::Joint;
using dowel::MateProblem;
using dowel::MateSolution;
using dowel::MateStatus;
using dowel::Pose;
using dowel::solve_mates;
namespace testing = dowel::testing;

namespace {

using Vector = Eigen::Vector3d;

/// A frame at `origin` whose z axis is `z`.
Pose frame(const Vector& origin, const Vector& z) {
  return dowel::frame_on_axis(origin, z.normalized(), Vector::UnitX());
}

Joint insert_joint(std::size_t a, std::size_t b, const Pose& X_AF, const Pose& X_BG) {
  return {.a = a,
          .b = b,
          .X_AF = X_AF,
          .X_BG = X_BG,
          .holds_tilt = true,
          .holds_slide = {true, true, true}};
}

Joint align_joint(std::size_t a, std::size_t b, const Pose& X_AF, const Pose& X_BG) {
  return {.a = a,
          .b = b,
          .X_AF = X_AF,
          .X_BG = X_BG,
          .holds_tilt = true,
          .holds_slide = {true, true, false}};
}

Joint seat_joint(std::size_t a, std::size_t b, const Pose& X_AF, const Pose& X_BG) {
  return {.a = a,
          .b = b,
          .X_AF = X_AF,
          .X_BG = X_BG,
          .holds_tilt = true,
          .holds_slide = {false, false, true}};
}

/// How far the joint is off, in extended precision and by another way than the library's: z axes
/// by their cross product, x axes by theirs, slides by dot products in the world.
double truly_off_mm(const Joint& joint, const Pose& X_WA, const Pose& X_WB) {
  using Real = long double;
  using Vec = Eigen::Matrix<Real, 3, 1>;
  const auto turned = [](const Pose& pose, const Vec& v) {
    return Vec(pose.rotation().cast<Real>().normalized() * v);
  };
  const auto moved = [&](const Pose& pose, const Vec& p) {
    return Vec(turned(pose, p) + pose.translation().cast<Real>());
  };
  const auto axis_F = [&](int i) { return turned(X_WA, turned(joint.X_AF, Vec::Unit(i))); };
  const auto axis_G = [&](int i) { return turned(X_WB, turned(joint.X_BG, Vec::Unit(i))); };
  const Vec off = moved(X_WA, joint.X_AF.translation().cast<Real>()) -
                  moved(X_WB, joint.X_BG.translation().cast<Real>());
  Real worst = 0;
  const auto along = [&](int i) { worst = std::max(worst, 100 * (axis_F(i) - axis_G(i)).norm()); };
  if (joint.holds_tilt) along(2);
  if (joint.holds_spin) along(0);
  if (joint.angle_rad) {
    const Real angle = std::atan2(axis_F(2).cross(axis_G(2)).norm(), axis_F(2).dot(axis_G(2)));
    worst = std::max(worst, 100 * std::abs(angle - static_cast<Real>(*joint.angle_rad)));
  }
  for (int i = 0; i < 3; ++i) {
    if (joint.holds_slide[static_cast<std::size_t>(i)]) {
      worst = std::max(worst, std::abs(off.dot(axis_G(i))));
    }
  }
  return static_cast<double>(worst);
}

Joint random_mate(testing::RandomGeometry& random, std::size_t a, std::size_t b) {
  Joint joint{.a = a, .b = b, .X_AF = random.pose(400), .X_BG = random.pose(400)};
  switch (random.index(6)) {
    case 0:
      return insert_joint(a, b, joint.X_AF, joint.X_BG);
    case 1:
      return align_joint(a, b, joint.X_AF, joint.X_BG);
    case 2:
      return seat_joint(a, b, joint.X_AF, joint.X_BG);
    case 3:
      joint.holds_tilt = joint.holds_spin = true;
      joint.holds_slide = {false, true, true};
      return joint;
    case 4:
      joint.angle_rad = random.uniform(0.01, 3.13);
      return joint;
    default:
      joint.holds_tilt = joint.holds_spin = true;
      joint.holds_slide = {true, true, true};
      return joint;
  }
}

std::string status_text(const MateSolution& solution) {
  std::string text;
  for (const auto& mate : solution.mates) {
    text += "status " + std::to_string(static_cast<int>(mate.status)) + " takes " +
            std::to_string(mate.freedoms_taken) + " off " + std::to_string(mate.off_mm) + "; ";
  }
  return text;
}

}  // namespace

TEST_CASE("100,000 random mate trees are placed within 1e-9 mm", "[property]") {
  testing::RandomGeometry random(7);
  double worst_mm = 0.0;
  std::size_t bodies = 0;
  std::size_t not_sound = 0;
  for (int tree = 0; tree < 100000; ++tree) {
    MateProblem problem;
    problem.bodies.push_back({random.pose(1000), true});
    const std::size_t count = 1 + random.index(4);
    for (std::size_t body = 1; body <= count; ++body) {
      problem.bodies.push_back({random.pose(1000), false});
      const std::size_t parent = random.index(static_cast<std::uint32_t>(body));
      problem.mates.push_back(
          {random.coin() ? random_mate(random, body, parent) : random_mate(random, parent, body)});
    }
    bodies += count;
    const MateSolution solution = solve_mates(problem);
    if (!solution.is_sound()) ++not_sound;
    for (const auto& mate : problem.mates) {
      worst_mm = std::max(
          worst_mm, truly_off_mm(mate[0], solution.X_WB[mate[0].a], solution.X_WB[mate[0].b]));
    }
    if (!(solution.X_WB[0] == problem.bodies[0].X_WB)) ++not_sound;
  }
  CHECK(bodies > 200000);
  CHECK(not_sound == 0);
  CHECK(worst_mm < 1e-9);
}

TEST_CASE("a body on two pins and a face stands where they say", "[property]") {
  const unsigned seed = GENERATE(range(0U, 200U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  // Two parallel holes and the face beneath them, at any place of both parts.
  const Pose X_AM = random.pose(200);
  const Pose X_BN = random.pose(200);
  const double apart_mm = random.uniform(5, 300);
  const auto at = [](const Pose& base, double x) {
    return base * Pose::from_translation({x, 0, 0});
  };
  MateProblem problem;
  problem.bodies = {{random.pose(500), true}, {random.pose(500), false}};
  problem.mates = {{insert_joint(1, 0, at(X_AM, 0), at(X_BN, 0))},
                   {align_joint(1, 0, at(X_AM, apart_mm), at(X_BN, apart_mm))},
                   {seat_joint(1, 0, at(X_AM, 17), at(X_BN, 3))}};
  const MateSolution solution = solve_mates(problem);
  INFO(status_text(solution));
  // The pose by hand: M of A is N of B.
  const Pose expected = problem.bodies[0].X_WB * X_BN * X_AM.inverse();
  CHECK((solution.X_WB[1].translation() - expected.translation()).norm() < 1e-9);
  CHECK(solution.X_WB[1].rotation().angularDistance(expected.rotation()) < 1e-7);
  CHECK(solution.mates[0].freedoms_taken == 5);
  CHECK(solution.mates[1].freedoms_taken == 1);
  CHECK(solution.mates[2].status == MateStatus::Redundant);
  CHECK(solution.freedoms.cols() == 0);
}

TEST_CASE("a closed loop of four bars finds the angle of the law of cosines", "[property]") {
  const unsigned seed = GENERATE(range(300U, 400U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  // Ground, two bars of lengths r and s from its pins at 0 and d; they meet in a joint.
  const double d = random.uniform(100, 300);
  const double r = random.uniform(0.6, 0.9) * d;
  const double s = random.uniform(0.6, 0.9) * d;
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  // Present poses near the solution above the base line, the first bar off by up to 20 degrees.
  const double alpha = std::acos((d * d + r * r - s * s) / (2 * d * r));
  const double beta = std::acos((d * d + s * s - r * r) / (2 * d * s));
  problem.bodies = {
      {Pose(), true},
      {Pose::about_axis({0, 0, 0}, z, alpha + random.uniform(-0.3, 0.3)), false},
      {Pose::about_axis({d, 0, 0}, z, std::numbers::pi - beta) * Pose::from_translation({d, 0, 0}),
       false}};
  problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                   {insert_joint(2, 0, frame({0, 0, 0}, z), frame({d, 0, 0}, z))},
                   {align_joint(1, 2, frame({r, 0, 0}, z), frame({s, 0, 0}, z))}};
  const MateSolution solution = solve_mates(problem);
  INFO(status_text(solution));
  const Vector tip = solution.X_WB[1] * Vector(r, 0, 0);
  CHECK((tip - Vector(r * std::cos(alpha), r * std::sin(alpha), 0)).norm() < 1e-9);
  CHECK((tip - solution.X_WB[2] * Vector(s, 0, 0)).norm() < 1e-9);
  CHECK(solution.freedoms.cols() == 0);
  CHECK(solution.is_sound());
}

TEST_CASE("what a mate leaves free is named by its axes") {
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  problem.bodies = {{Pose(), true}, {Pose::from_translation({0, 0, 90}), false}};
  const auto left_by = [&](const Joint& joint) {
    problem.mates = {{joint}};
    return freedoms_of(solve_mates(problem), 1);
  };
  SECTION("no mate: everything") {
    const MateSolution free = solve_mates(problem);
    CHECK(freedoms_of(free, 1).size() == 6);
    CHECK(freedoms_of(free, 0).empty());
  }
  SECTION("insert: turns about its axis") {
    const auto left = left_by(insert_joint(1, 0, frame({5, 0, 0}, z), frame({20, 30, 40}, z)));
    REQUIRE(left.size() == 1);
    CHECK(left[0].kind == Freedom::Kind::Turn);
    CHECK((left[0].axis_W - z).norm() < 1e-12);
    CHECK((left[0].point_W - Vector(20, 30, 40)).head<2>().norm() < 1e-9);
    CHECK(std::abs(left[0].slide_mm_per_rad) < 1e-9);
  }
  SECTION("align: turns about it and slides along it") {
    const auto left = left_by(align_joint(1, 0, frame({5, 0, 0}, z), frame({20, 30, 40}, z)));
    REQUIRE(left.size() == 2);
    CHECK(left[0].kind == Freedom::Kind::Slide);
    CHECK((left[0].axis_W - z).norm() < 1e-12);
    CHECK(left[1].kind == Freedom::Kind::Turn);
    CHECK(std::abs(left[1].slide_mm_per_rad) < 1e-9);
  }
  SECTION("seat on an upright face: slides in it, turns about its normal") {
    const auto left = left_by(seat_joint(1, 0, frame({0, 0, 0}, z), frame({7, 0, 0}, {0, 1, 0})));
    REQUIRE(left.size() == 3);
    CHECK((left[0].axis_W - Vector::UnitX()).norm() < 1e-12);
    CHECK((left[1].axis_W - Vector::UnitZ()).norm() < 1e-12);
    CHECK(left[2].kind == Freedom::Kind::Turn);
    CHECK((left[2].axis_W - Vector::UnitY()).norm() < 1e-12);
  }
  SECTION("a chain of two hinges: turns, and slides across as the first one turns") {
    problem.bodies.push_back({Pose::from_translation({50, 0, 0}), false});
    problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                     {insert_joint(2, 1, frame({0, 0, 0}, z), frame({50, 0, 0}, z))}};
    const auto left = freedoms_of(solve_mates(problem), 2);
    REQUIRE(left.size() == 2);
    CHECK(left[0].kind == Freedom::Kind::Slide);
    CHECK((left[0].axis_W - Vector::UnitY()).norm() < 1e-9);
    CHECK(left[1].kind == Freedom::Kind::Turn);
    CHECK((left[1].axis_W - z).norm() < 1e-9);
  }
}

TEST_CASE("mates that contradict each other: the later one is named with what it misses") {
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  problem.bodies = {{Pose(), true}, {Pose::from_translation({3, 4, 5}), false}};
  problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                   {align_joint(1, 0, frame({40, 0, 0}, z), frame({42.5, 0, 0}, z))},
                   {seat_joint(1, 0, frame({10, 0, 7}, z), frame({0, 0, 7}, z))}};
  const MateSolution solution = solve_mates(problem);
  CHECK(solution.mates[0].status == MateStatus::Holds);
  CHECK(solution.mates[1].status == MateStatus::Conflicting);
  CHECK(solution.mates[1].off_mm >= 2.5 - 1e-9);
  CHECK(solution.mates[2].status == MateStatus::Redundant);
  CHECK_FALSE(solution.is_sound());
  CHECK(solution.X_WB[1].translation().norm() < 1e-9);
  CHECK(solution.freedoms.cols() == 1);
}

TEST_CASE("near-singular mates get a right answer or a name, never a jump", "[degenerate]") {
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  const Pose start = Pose::from_translation({0.3, -0.2, 0.4});
  problem.bodies = {{Pose(), true}, {start, false}};
  const auto check_calm = [&](const MateSolution& solution) {
    INFO(status_text(solution));
    CHECK(solution.X_WB[1].rotation().coeffs().allFinite());
    CHECK((solution.X_WB[1].translation() - start.translation()).norm() < 2.0);
    CHECK(solution.X_WB[1].rotation().angularDistance(start.rotation()) < 0.1);
  };
  SECTION("axes 1e-9 rad from parallel are parallel") {
    const Vector tilted = Vector(1e-9, 0, 1).normalized();
    problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                     {align_joint(1, 0, frame({40, 0, 0}, z), frame({40, 0, 0}, tilted))}};
    const MateSolution solution = solve_mates(problem);
    check_calm(solution);
    CHECK(solution.is_sound());
    CHECK(solution.mates[1].freedoms_taken == 1);
    CHECK(solution.freedoms.cols() == 0);
  }
  SECTION("two faces 1e-9 rad from parallel do not hold the slide between them") {
    const Vector tilted = Vector(1e-9, 0, 1).normalized();
    problem.mates = {{seat_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                     {seat_joint(1, 0, frame({60, 0, 0}, tilted), frame({60, 0, 0}, tilted))}};
    const MateSolution solution = solve_mates(problem);
    check_calm(solution);
    CHECK(solution.mates[1].status != MateStatus::Holds);
  }
  SECTION("holes 1e-6 mm apart are no hold against turning") {
    const double apart_mm = GENERATE(1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 0.0);
    CAPTURE(apart_mm);
    problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                     {align_joint(1, 0, frame({apart_mm, 0, 0}, z), frame({apart_mm, 0, 0}, z))}};
    const MateSolution solution = solve_mates(problem);
    check_calm(solution);
    const MateStatus second = solution.mates[1].status;
    if (apart_mm > 2e-4) CHECK(second == MateStatus::Holds);
    if (apart_mm < 9e-5 && apart_mm > 2e-8) CHECK(second == MateStatus::NearlyRedundant);
    if (apart_mm < 5e-9) CHECK(second == MateStatus::Redundant);
  }
  SECTION("three holes in a row: the third is redundant, or conflicts by its pitch") {
    const double error_mm = GENERATE(0.0, 1e-9, 0.005, 0.3);
    CAPTURE(error_mm);
    problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                     {align_joint(1, 0, frame({40, 0, 0}, z), frame({40, 0, 0}, z))},
                     {align_joint(1, 0, frame({80, 0, 0}, z), frame({80 + error_mm, 0, 0}, z))}};
    const MateSolution solution = solve_mates(problem);
    check_calm(solution);
    CHECK(solution.mates[1].freedoms_taken == 1);
    CHECK(solution.mates[2].status ==
          (error_mm < 0.1 ? MateStatus::Redundant : MateStatus::Conflicting));
    if (error_mm > 0.1) CHECK(solution.mates[2].off_mm == Approx(error_mm).margin(1e-9));
  }
  SECTION("the same mate a hundred times is one mate") {
    problem.mates.assign(100, {insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))});
    const MateSolution solution = solve_mates(problem);
    check_calm(solution);
    for (std::size_t i = 1; i < 100; ++i) CHECK(solution.mates[i].status == MateStatus::Redundant);
  }
}

TEST_CASE("mates between held bodies hold or conflict, and move nothing", "[degenerate]") {
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  problem.bodies = {{Pose(), true}, {Pose::from_translation({0, 0, 3}), true}};
  problem.mates = {{seat_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 3}, z))},
                   {seat_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))}};
  const MateSolution solution = solve_mates(problem);
  CHECK(solution.mates[0].status == MateStatus::Redundant);
  CHECK(solution.mates[1].status == MateStatus::Conflicting);
  CHECK(solution.mates[1].off_mm == Approx(3.0));
  CHECK(solution.X_WB[1] == problem.bodies[1].X_WB);
  CHECK(solution.freedoms.cols() == 0);
  CHECK(solve_mates({}).X_WB.empty());
}

TEST_CASE("a body that must turn far for its second hole turns, and comes out right",
          "[property]") {
  const int degrees = GENERATE(0, 45, 90, 135, 179, 180, 181, 270);
  CAPTURE(degrees);
  const Vector z = Vector::UnitZ();
  MateProblem problem;
  problem.bodies = {{Pose(), true},
                    {Pose::about_axis({0, 0, 0}, z, degrees * std::numbers::pi / 180), false}};
  problem.mates = {{insert_joint(1, 0, frame({0, 0, 0}, z), frame({0, 0, 0}, z))},
                   {align_joint(1, 0, frame({40, 0, 0}, z), frame({40, 0, 0}, z))}};
  const MateSolution solution = solve_mates(problem);
  CHECK(solution.is_sound());
  CHECK((solution.X_WB[1] * Vector(40, 0, 0) - Vector(40, 0, 0)).norm() < 1e-9);
}
