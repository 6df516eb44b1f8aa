#include "dowel/assembly/restraint.h"

#include <limits>
#include <random>

#include <Eigen/QR>
#include <catch2/catch.hpp>

namespace {

using dowel::FrictionContact;
using dowel::LocatingFrame;
using dowel::LocatingPoint;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const LocatingFrame kFrame{Vector3d(0, 0, 20), 100.0};

/// 3-2-1 of a block whose bottom is z = 0: supports, two points in front (y = -40) and one at the
/// left (x = -60), the latter at height 20.
std::vector<LocatingPoint> locators() {
  return {{"R1", {-50, -30, 0}, Vector3d::UnitZ(), 0, false},
          {"R2", {50, -30, 0}, Vector3d::UnitZ(), 0, false},
          {"R3", {0, 40, 0}, Vector3d::UnitZ(), 0, false},
          {"L1", {-40, -40, 20}, Vector3d::UnitY(), 0, false},
          {"L2", {40, -40, 20}, Vector3d::UnitY(), 0, false},
          {"L3", {-60, 0, 20}, Vector3d::UnitX(), 0, false}};
}

/// The least residual over all sets of columns whose own solution is not negative: the optimum is
/// one of them.
double best_of_all_subsets(const MatrixXd& a, const VectorXd& b) {
  double best = b.norm();
  for (unsigned set = 1; set < (1U << static_cast<unsigned>(a.cols())); ++set) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
      if (((set >> static_cast<unsigned>(i)) & 1U) != 0U) columns.push_back(i);
    }
    MatrixXd part(a.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      part.col(static_cast<Eigen::Index>(i)) = a.col(columns[i]);
    }
    const VectorXd x = part.completeOrthogonalDecomposition().solve(b);
    if (x.minCoeff() >= 0.0) best = std::min(best, (part * x - b).norm());
  }
  return best;
}

}  // namespace

TEST_CASE("non-negative least squares finds what trying all sets of columns finds", "[property]") {
  const auto seed = GENERATE(range(0U, 60U));
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Index rows = 3 + static_cast<Eigen::Index>(seed % 4);
  const Eigen::Index columns = 2 + static_cast<Eigen::Index>(seed % 8);
  MatrixXd a(rows, columns);
  VectorXd b(rows);
  for (double& value : a.reshaped()) value = normal(random);
  for (double& value : b) value = normal(random);
  const auto found = dowel::non_negative_least_squares(a, b);
  CHECK(found.has_converged);
  CHECK(found.x.minCoeff() >= 0.0);
  CHECK(found.residual == Approx(best_of_all_subsets(a, b)).margin(1e-9));
  CHECK((a * found.x - b).norm() == Approx(found.residual).margin(1e-12));
}

TEST_CASE("non-negative least squares takes equal and zero columns", "[degenerate]") {
  MatrixXd a(2, 4);
  a << 1, 1, 0, -1, 0, 0, 0, 0;
  const auto found = dowel::non_negative_least_squares(a, Eigen::Vector2d(2, 0));
  CHECK(found.residual == Approx(0.0).margin(1e-12));
  CHECK(dowel::non_negative_least_squares(a, Eigen::Vector2d(0, 1)).residual ==
        Approx(1.0).margin(1e-12));
}

TEST_CASE("a force down onto three supports goes to them by barycentric coordinates") {
  const double x = 10.0;
  const double y = 5.0;
  const double F = 1000.0;
  const auto w = dowel::wrench_of({0, 0, -F}, {x, y, 50}, kFrame);
  const auto seating = dowel::seating_forces(locators(), kFrame, w);
  const double third = (y + 30.0) / 70.0;
  const double second = 0.5 * (1.0 - third + x / 50.0);
  CHECK(seating.forces_N[0] == Approx(F * (1.0 - second - third)).margin(1e-9));
  CHECK(seating.forces_N[1] == Approx(F * second).margin(1e-9));
  CHECK(seating.forces_N[2] == Approx(F * third).margin(1e-9));
  CHECK(seating.forces_N[3] == Approx(0.0).margin(1e-9));
  CHECK(seating.residual_N == Approx(0.0).margin(1e-9));
}

TEST_CASE("a force outside of the supports lifts the workpiece off the far one") {
  // Taken about the line through R1 and R2 (y = -30), 70 from R3.
  const double F = 1000.0;
  const auto w = dowel::wrench_of({0, 0, -F}, {0, -50, 50}, kFrame);
  const auto seating = dowel::seating_forces(locators(), kFrame, w);
  CHECK(seating.forces_N[2] == Approx(-F * 20.0 / 70.0).margin(1e-9));
  CHECK(seating.least_N == Approx(-F * 20.0 / 70.0).margin(1e-9));
}

TEST_CASE("a clamp from the side above the height of its stop tilts the workpiece") {
  // The stop L3 is at height 20; the clamp presses along -x at height 20 + h. The couple
  // F h about y loads R1 and unloads R2, which are 100 apart; R3 is on their middle line.
  const double F = 1000.0;
  const double h = 25.0;
  const auto w = dowel::wrench_of({-F, 0, 0}, {60, 0, 20 + h}, kFrame);
  const auto seating = dowel::seating_forces(locators(), kFrame, w);
  CHECK(seating.forces_N[5] == Approx(F).margin(1e-9));
  CHECK(seating.forces_N[0] == Approx(F * h / 100.0).margin(1e-9));
  CHECK(seating.forces_N[1] == Approx(-F * h / 100.0).margin(1e-9));
}

TEST_CASE("two clamps of 3 kN let a workpiece slip that two of 6 kN hold") {
  // Coulomb: each clamp holds friction times force, and so does the support under it.
  const auto contacts = [](double force_N) {
    std::vector<FrictionContact> result;
    for (const double x : {-40.0, 40.0}) {
      result.push_back({{x, 0, 0}, Vector3d::UnitZ(), 0.15, std::nullopt});
      result.push_back({{x, 0, 40}, -Vector3d::UnitZ(), 0.15, force_N});
    }
    return result;
  };
  const dowel::Wrench none = dowel::Wrench::Zero();
  const double H = 1300.0;
  // In the middle between the planes of friction, so that the force alone decides.
  const auto load = dowel::wrench_of({H, 0, 0}, {0, 0, 20}, kFrame);
  CHECK_FALSE(dowel::force_closure(contacts(3000), kFrame, 2.0 * load).holds);
  CHECK(dowel::force_closure(contacts(6000), kFrame, 2.0 * load).holds);
  CHECK(dowel::load_factor(contacts(3000), kFrame, none, load) ==
        Approx(4 * 0.15 * 3000 / H).epsilon(2e-3));
  CHECK(dowel::load_factor(contacts(6000), kFrame, none, load) ==
        Approx(4 * 0.15 * 6000 / H).epsilon(2e-3));
}

TEST_CASE("forces that hold are within their cones and balance the load") {
  std::vector<FrictionContact> contacts;
  for (const auto& point : locators()) {
    contacts.push_back({point.at, point.normal, 0.2, std::nullopt});
  }
  contacts.push_back({{0, 0, 40}, -Vector3d::UnitZ(), 0.2, 5000.0});
  const auto load = dowel::wrench_of({300, 200, 0}, {20, 10, 40}, kFrame);
  const auto closure = dowel::force_closure(contacts, kFrame, load);
  REQUIRE(closure.holds);
  dowel::Wrench sum = load;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3d& force = closure.forces_N[i];
    const double along = force.dot(contacts[i].normal);
    CHECK(along >= -1e-6);
    CHECK((force - along * contacts[i].normal).norm() <= 0.2 * along + 1e-6);
    sum += dowel::wrench_of(force, contacts[i].at, kFrame);
  }
  CHECK(closure.forces_N.back().dot(contacts.back().normal) == Approx(5000.0).epsilon(1e-6));
  CHECK(sum.norm() == Approx(0.0).margin(1e-2));
}

TEST_CASE("a ladder of one wall: friction holds up to its coefficient and no further") {
  // A block pushed against a stop by a clamp opposite: nothing below. Weight W is carried where
  // 2 mu F >= W.
  const double F = 1000.0;
  const std::vector<FrictionContact> contacts{{{-50, 0, 20}, Vector3d::UnitX(), 0.2, std::nullopt},
                                              {{50, 0, 20}, -Vector3d::UnitX(), 0.2, F}};
  const auto down = [](double weight_N) {
    return dowel::wrench_of({0, 0, -weight_N}, {0, 0, 20}, kFrame);
  };
  CHECK(dowel::force_closure(contacts, kFrame, down(0.999 * 400)).holds);
  CHECK_FALSE(dowel::force_closure(contacts, kFrame, down(1.001 * 400)).holds);
}

TEST_CASE("four contacts around a rectangle close it where their turns cancel") {
  // Rows: force x, force y, torque. Contacts in the plane at p with normal n.
  const auto wrenches = [](const std::vector<std::pair<Vector2d, Vector2d>>& contacts) {
    MatrixXd W(3, static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const auto& [p, n] = contacts[i];
      W.col(static_cast<Eigen::Index>(i)) << n.x(), n.y(), p.x() * n.y() - p.y() * n.x();
    }
    return W;
  };
  const Vector2d up(0, 1);
  const Vector2d down(0, -1);
  const Vector2d left(-1, 0);
  const Vector2d right(1, 0);
  // Torques +1, +1, -1, -1: closed.
  CHECK(dowel::has_form_closure(
      wrenches({{{1, -2}, up}, {{-1, 2}, down}, {{-3, 1}, right}, {{3, -1}, left}})));
  // All four turn it the same way: it turns.
  CHECK_FALSE(dowel::has_form_closure(
      wrenches({{{1, -2}, up}, {{-1, 2}, down}, {{-3, -1}, right}, {{3, 1}, left}})));
  // Normals through one point: it turns about it.
  CHECK_FALSE(dowel::has_form_closure(
      wrenches({{{0, -2}, up}, {{0, 2}, down}, {{-3, 0}, right}, {{3, 0}, left}})));
  // Three contacts never do in a plane (Reuleaux: four are needed).
  const double s = std::sqrt(0.75);
  CHECK_FALSE(dowel::has_form_closure(
      wrenches({{{0, -1}, up}, {{s, 0.5}, {-s, -0.5}}, {{-s, 0.5}, {s, -0.5}}})));
}

TEST_CASE("3-2-1 is closed by an oblique clamp and not by one straight down") {
  const auto with = [](const Vector3d& at, const Vector3d& normal) {
    auto points = locators();
    points.push_back({"K", at, normal.normalized(), 0, false});
    return MatrixXd(dowel::locator_matrix(points, kFrame));
  };
  CHECK_FALSE(dowel::has_form_closure(with({0, 0, 40}, -Vector3d::UnitZ())));
  CHECK(dowel::has_form_closure(with({10, 0, 30}, Vector3d(-0.3, -0.3, -1))));
}

TEST_CASE("the margin of a point is its distance from the polygon's border, negative outside") {
  const std::vector<Vector2d> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 5}, {10, 5}};
  CHECK(dowel::support_margin_mm(square, {4, 5}) == Approx(4.0).margin(1e-12));
  CHECK(dowel::support_margin_mm(square, {13, 14}) == Approx(-5.0).margin(1e-12));
  CHECK(dowel::support_margin_mm(square, {12, 5}) == Approx(-2.0).margin(1e-12));
  CHECK(dowel::polygon_area_mm2(dowel::convex_polygon(square)) == Approx(100.0).margin(1e-12));
  CHECK(dowel::convex_polygon(square).size() == 4);
  const std::vector<Vector2d> line{{0, 0}, {10, 0}};
  CHECK(dowel::support_margin_mm(line, {5, 0}) <= 0.0);
  CHECK(dowel::support_margin_mm(line, {5, 3}) == Approx(-3.0).margin(1e-12));
}
