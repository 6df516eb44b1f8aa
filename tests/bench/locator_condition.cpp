#include "locator_condition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "dowel/assembly/locating.h"
#include "random_geometry.h"

namespace {

/// A hundred digits: the condition's square, 1e26 at most here, leaves more than 70 of them.
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                           boost::multiprecision::et_off>;

}  // namespace

/// Boost's own lacks what Eigen 3.4 asks for.
template <>
struct Eigen::NumTraits<Real> : Eigen::GenericNumTraits<Real> {};

namespace dowel::bench {

namespace {

using testing::RandomGeometry;
using Points = std::vector<LocatingPoint>;

using Matrix6 = Eigen::Matrix<Real, 6, 6>;
using Vector3 = Eigen::Matrix<Real, 3, 1>;

constexpr double kLength_mm = 80.0;

/// The six locators, the same numbers as dowel has, without rounding from there on.
struct ExactLocators {
  Matrix6 matrix;
  std::array<Real, 6> singular_values;  ///< ascending

  ExactLocators(const Points& points, const LocatingFrame& frame) {
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3 normal = points[i].normal.cast<Real>();
      const Vector3 arm = points[i].at.cast<Real>() - frame.reference.cast<Real>();
      matrix.col(static_cast<Eigen::Index>(i)) << normal, arm.cross(normal) / Real(frame.length_mm);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix * matrix.transpose(),
                                                        Eigen::EigenvaluesOnly);
    for (std::size_t i = 0; i < 6; ++i) {
      const Real square = solver.eigenvalues()[static_cast<Eigen::Index>(i)];
      singular_values[i] = square > 0 ? Real(sqrt(square)) : Real(0);
    }
  }

  Real condition() const { return singular_values.back() / singular_values.front(); }

  int rank() const {
    const Real zero = Real(kLocatingRank) * singular_values.back();
    return static_cast<int>(
        std::ranges::count_if(singular_values, [&](const Real& value) { return value > zero; }));
  }

  /// Largest displacement of `at`, over all signs of the errors.
  Real worst_mm(const Points& points, const LocatingFrame& frame, const Eigen::Vector3d& at) const {
    const Matrix6 motion_by_error = Matrix6(matrix.transpose()).fullPivLu().inverse();
    const Vector3 arm = (at.cast<Real>() - frame.reference.cast<Real>()) / Real(frame.length_mm);
    Real worst = 0;
    for (unsigned signs = 0; signs < 32; ++signs) {
      Eigen::Matrix<Real, 6, 1> errors;
      for (unsigned i = 0; i < 6; ++i) {
        const Real error = points[i].error_mm;
        errors[i] = ((signs >> i) & 1U) != 0U ? error : Real(-error);
      }
      const Eigen::Matrix<Real, 6, 1> motion = motion_by_error * errors;
      const Vector3 slide = motion.head<3>();
      const Vector3 turn = motion.tail<3>();
      const Vector3 way = slide + turn.cross(arm);
      worst = std::max(worst, Real(sqrt(way.dot(way))));
    }
    return worst;
  }
};

LocatingPoint point(const Eigen::Vector3d& at, const Eigen::Vector3d& normal) {
  return {"P", at, normal, 0.0, false};
}

/// Three supports, two side locators and a stop, each set at its usual place.
Points three_two_one() {
  return {point({-50, -30, 0}, Eigen::Vector3d::UnitZ()),
          point({50, -30, 0}, Eigen::Vector3d::UnitZ()),
          point({0, 40, 0}, Eigen::Vector3d::UnitZ()),
          point({-40, -40, 20}, Eigen::Vector3d::UnitY()),
          point({40, -40, 20}, Eigen::Vector3d::UnitY()),
          point({-60, 0, 20}, Eigen::Vector3d::UnitX())};
}

/// The third support stands `off_mm` off the line of the others.
Points supports_in_line(double off_mm) {
  Points points = three_two_one();
  points[2].at = {10.0, -30.0 + off_mm, 0.0};
  return points;
}

/// The two side locators stand `off_mm` apart.
Points side_locators_together(double off_mm) {
  Points points = three_two_one();
  points[4].at.x() = points[3].at.x() + off_mm;
  return points;
}

/// The lines of the side locators and of the stop miss one point by `off_mm`: about it the part can
/// almost turn.
Points lines_through_a_point(double off_mm) {
  Points points = three_two_one();
  const Eigen::Vector3d center(0.0, 0.0, 20.0);
  constexpr std::array kAngles_rad{0.5, 2.0, 4.0};
  for (std::size_t i = 0; i < kAngles_rad.size(); ++i) {
    const Eigen::Vector3d out(std::cos(kAngles_rad[i]), std::sin(kAngles_rad[i]), 0.0);
    points[3 + i] = point(center + 55.0 * out, -out);
  }
  points[5].at += off_mm * Eigen::Vector3d::UnitZ().cross(points[5].normal);
  return points;
}

/// What dowel said of one arrangement in many places.
struct Outcome {
  double condition = 0.0;  ///< smallest and largest are alike but for rounding: the first one's
  std::set<int> ranks;
  std::size_t wrong_ranks = 0;
  double condition_off = 0.0;  ///< largest, of the true one
  double worst_mm = 0.0;
  double worst_off_mm = 0.0;
};

/// Where the truth is this near to where dowel draws the line, either rank can be told.
constexpr double kRankBand = 0.1;

void judge(Points points, RandomGeometry& random, Outcome& outcome) {
  constexpr double kReach_mm = 1000.0;
  const Pose X_WF = random.pose(kReach_mm);
  for (LocatingPoint& p : points) {
    p.at = X_WF * p.at;
    p.normal = X_WF.rotation_matrix() * p.normal;
    p.error_mm = random.uniform(0.005, 0.05);
  }
  const LocatingFrame frame{X_WF * Eigen::Vector3d(3.0, -2.0, 15.0), kLength_mm};
  const ExactLocators exact(points, frame);
  const Locating found = analyse_locating(points, frame);
  const auto condition = static_cast<double>(exact.condition());
  outcome.condition = condition;
  outcome.ranks.insert(found.rank);
  const bool is_told = std::abs(std::log(condition * kLocatingRank)) > kRankBand;
  if (is_told && found.rank != exact.rank()) ++outcome.wrong_ranks;
  if (found.rank != 6) return;
  outcome.condition_off =
      std::max(outcome.condition_off, std::abs(found.condition - condition) / condition);
  const Eigen::Vector3d at = X_WF * Eigen::Vector3d(70.0, 55.0, 40.0);
  const Real truth_mm = exact.worst_mm(points, frame, at);
  const double told_mm = position_error(points, frame, at, {.samples = 0}).worst_mm;
  outcome.worst_mm = std::max(outcome.worst_mm, static_cast<double>(truth_mm));
  outcome.worst_off_mm =
      std::max(outcome.worst_off_mm, std::abs(static_cast<double>(Real(told_mm) - truth_mm)));
}

std::vector<std::string> row(const char* what, Points (*locators)(double), double off_mm,
                             std::size_t count) {
  RandomGeometry random(95);
  Outcome outcome;
  for (std::size_t i = 0; i < count; ++i) judge(locators(off_mm), random, outcome);
  std::string ranks;
  for (const int rank : outcome.ranks) ranks += (ranks.empty() ? "" : ", ") + std::to_string(rank);
  const bool is_settled = outcome.worst_mm > 0.0;
  return {what,
          text(off_mm),
          text(outcome.condition),
          ranks,
          std::to_string(outcome.wrong_ranks) + " of " + std::to_string(count),
          is_settled ? text(outcome.condition_off) : "–",
          is_settled ? text(outcome.worst_mm) : "–",
          is_settled ? text(outcome.worst_off_mm) : "–"};
}

}  // namespace

Table locator_conditions(const Plan& plan) {
  Table table{
      "Nearly singular locators",
      "Three supports, two side locators and a stop, one of them moved until the workpiece is held "
      "by next to nothing; in random places within 1 m, each locator with an error of 0.005 to "
      "0.05 mm. Condition of the locator matrix, by arithmetic of 100 digits on the same numbers; "
      "the rank that dowel tells, and how often it is not that of the true singular values (zero: "
      "below 1e-9 of the largest); by how much of itself the condition is off; the largest "
      "displacement of a point of the workpiece that the errors allow, and by how much dowel's is "
      "off, in mm.",
      {"locators", "off, mm", "condition", "rank", "wrong ranks", "condition off by",
       "displacement, mm", "off by, mm"},
      {}};
  const std::size_t count = std::max<std::size_t>(plan.poses / 50, 4);
  struct Kind {
    const char* name;
    Points (*locators)(double off_mm);
  };
  constexpr std::array<Kind, 3> kKinds{{{"supports almost in line", supports_in_line},
                                        {"side locators together", side_locators_together},
                                        {"lines through one point", lines_through_a_point}}};
  for (const Kind& kind : kKinds) {
    for (const double off_mm : {70.0, 1.0, 1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10}) {
      table.rows.push_back(row(kind.name, kind.locators, off_mm, count));
    }
  }
  return table;
}

}  // namespace dowel::bench
