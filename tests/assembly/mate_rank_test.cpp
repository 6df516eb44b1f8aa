// What the solver says of mates, held against ranks over the integers.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include "dowel/assembly/freedom.h"
#include "dowel/assembly/mate_solver.h"
#include "random_geometry.h"

using dowel::Joint;
using dowel::MateProblem;
using dowel::MateStatus;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                              boost::multiprecision::et_off>;
using Row = std::vector<Integer>;
using IntVector = Eigen::Matrix<long long, 3, 1>;
using IntMatrix = Eigen::Matrix<long long, 3, 3>;

/// Rows in echelon form, without a fraction and without rounding.
class ExactRows {
 public:
  std::size_t rank() const { return rows_.size(); }

  /// True where the row is not a sum of multiples of those before; it is then one of them.
  /// `columns` tells how many count: a right-hand side behind them is carried along.
  bool add(Row row, std::size_t columns) {
    reduce(row);
    for (std::size_t i = 0; i < columns; ++i) {
      if (row[i] == 0) continue;
      pivots_.push_back(i);
      rows_.push_back(std::move(row));
      return true;
    }
    return false;
  }

  void reduce(Row& row) const {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Integer factor = row[pivots_[i]];
      if (factor == 0) continue;
      const Integer pivot = rows_[i][pivots_[i]];
      Integer common = 0;
      for (std::size_t j = 0; j < row.size(); ++j) {
        row[j] = row[j] * pivot - factor * rows_[i][j];
        common = gcd(common, row[j]);
      }
      if (common > 1) {
        for (Integer& entry : row) entry /= common;
      }
    }
  }

 private:
  std::vector<Row> rows_;
  std::vector<std::size_t> pivots_;
};

/// A frame in the world: columns of `axes` are its axes, `scale` times too long.
struct ExactFrame {
  IntMatrix axes;
  long long scale = 1;
  IntVector origin;

  Pose pose() const {
    const Eigen::Matrix3d rotation = axes.cast<double>() / static_cast<double>(scale);
    return Pose::from_matrix(rotation, origin.cast<double>());
  }
};

/// Axes of the world in any order, sometimes of a turn by a rational quaternion instead; the origin
/// on a grid, so that axes and planes often fall together.
ExactFrame random_frame(testing::RandomGeometry& random) {
  ExactFrame frame;
  const auto small = [&](std::uint32_t most) {
    return static_cast<long long>(random.index(2 * most + 1)) - static_cast<long long>(most);
  };
  long long w = 0;
  long long x = 0;
  long long y = 0;
  long long z = 0;
  const std::uint32_t most = random.index(4) == 0 ? 2 : 1;
  while (w * w + x * x + y * y + z * z == 0) {
    w = small(most);
    x = most == 1 && random.coin() ? 0 : small(most);
    y = most == 1 && random.coin() ? 0 : small(most);
    z = small(most);
  }
  frame.scale = w * w + x * x + y * y + z * z;
  frame.axes << w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y),
      2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x), 2 * (x * z - w * y),
      2 * (y * z + w * x), w * w - x * x - y * y + z * z;
  frame.origin = IntVector(40 * small(2), 40 * small(2), 40 * small(1));
  return frame;
}

/// One scalar equation: what turns and slides of A against B make of it.
struct Equation {
  IntVector turn;
  IntVector slide;
};

struct ExactMate {
  std::size_t a = 0;
  std::size_t b = 0;
  ExactFrame frame;  ///< G
  IntVector p_F;
  IntVector z_F;  ///< for angles
  bool tilt = false;
  bool spin = false;
  std::array<bool, 3> slide{};
  bool angle = false;

  std::vector<Equation> equations() const {
    std::vector<Equation> all;
    const IntVector zero = IntVector::Zero();
    if (tilt) all.push_back({frame.axes.col(0), zero});
    if (tilt) all.push_back({frame.axes.col(1), zero});
    if (spin) all.push_back({frame.axes.col(2), zero});
    if (angle) all.push_back({z_F.cross(frame.axes.col(2)), zero});
    for (int i = 0; i < 3; ++i) {
      if (slide[static_cast<std::size_t>(i)]) {
        all.push_back({p_F.cross(IntVector(frame.axes.col(i))), frame.axes.col(i)});
      }
    }
    return all;
  }
};

ExactMate random_mate(testing::RandomGeometry& random, std::size_t bodies) {
  ExactMate mate;
  mate.a = 1 + random.index(static_cast<std::uint32_t>(bodies - 1));
  do {
    mate.b = random.index(static_cast<std::uint32_t>(bodies));
  } while (mate.b == mate.a);
  mate.frame = random_frame(random);
  switch (random.index(7)) {
    case 0:  // insert
      mate.tilt = true;
      mate.slide = {true, true, true};
      break;
    case 1:  // align
      mate.tilt = true;
      mate.slide = {true, true, false};
      break;
    case 2:
    case 3:  // seat
      mate.tilt = true;
      mate.slide = {false, false, true};
      break;
    case 4:  // key in slot
      mate.tilt = mate.spin = true;
      mate.slide = {false, true, random.coin()};
      break;
    case 5:
      mate.angle = true;
      break;
    default:  // fix, seldom: it leaves little to look at
      mate.tilt = mate.spin = true;
      mate.slide = {true, true, random.coin()};
  }
  mate.p_F = mate.frame.origin;
  for (int i = 0; i < 3; ++i) {
    if (!mate.slide[static_cast<std::size_t>(i)]) {
      mate.p_F += static_cast<long long>(random.index(9)) * mate.frame.axes.col(i);
    }
  }
  do {
    mate.z_F = random_frame(random).axes.col(2);
  } while (mate.angle && mate.z_F.cross(IntVector(mate.frame.axes.col(2))).isZero());
  return mate;
}

/// The equations of a mate as rows over all bodies but the first, which is held.
std::vector<Row> rows_of(const ExactMate& mate, std::size_t bodies) {
  std::vector<Row> rows;
  for (const Equation& equation : mate.equations()) {
    Row row(6 * (bodies - 1) + 1, 0);
    const auto put = [&](std::size_t body, long long sign) {
      if (body == 0) return;
      for (int i = 0; i < 3; ++i) {
        row[6 * (body - 1) + static_cast<std::size_t>(i)] = sign * equation.turn[i];
        row[6 * (body - 1) + 3 + static_cast<std::size_t>(i)] = sign * equation.slide[i];
      }
    };
    put(mate.a, 1);
    put(mate.b, -1);
    rows.push_back(std::move(row));
  }
  return rows;
}

Row unit_row(std::size_t columns, std::size_t at) {
  Row row(columns + 1, 0);
  row[at] = 1;
  return row;
}

/// True where no body can turn any more.
bool holds_all_turns(const ExactRows& rows, std::size_t bodies) {
  const std::size_t columns = 6 * (bodies - 1);
  for (std::size_t body = 0; body + 1 < bodies; ++body) {
    for (std::size_t i = 0; i < 3; ++i) {
      ExactRows more = rows;
      if (more.add(unit_row(columns, 6 * body + i), columns)) return false;
    }
  }
  return true;
}

/// True where slide `axis` of the mate depends on the rows: then a shift along it contradicts them.
bool is_settled(const ExactMate& mate, int axis, const ExactRows& rows, std::size_t bodies) {
  ExactMate one = mate;
  one.tilt = one.spin = one.angle = false;
  one.slide = {axis == 0, axis == 1, axis == 2};
  ExactRows more = rows;
  return !more.add(rows_of(one, bodies).front(), 6 * (bodies - 1));
}

Joint joint_of(const ExactMate& mate, const std::vector<Pose>& X_WB) {
  const Pose X_WG = mate.frame.pose();
  const Eigen::Vector3d origin = mate.p_F.cast<double>();
  Joint joint;
  joint.a = mate.a;
  joint.b = mate.b;
  joint.holds_tilt = mate.tilt;
  joint.holds_spin = mate.spin;
  joint.holds_slide = mate.slide;
  Pose X_WF(X_WG.rotation(), origin);
  if (mate.angle) {
    const Eigen::Vector3d z_F = mate.z_F.cast<double>().normalized();
    const Eigen::Vector3d z_G = mate.frame.axes.col(2).cast<double>().normalized();
    joint.angle_rad = std::atan2(z_F.cross(z_G).norm(), z_F.dot(z_G));
    X_WF = dowel::frame_on_axis(origin, z_F, Eigen::Vector3d::UnitX());
  }
  joint.X_AF = X_WB[mate.a].inverse() * X_WF;
  joint.X_BG = X_WB[mate.b].inverse() * X_WG;
  return joint;
}

struct Tally {
  int redundant = 0;
  int conflicting = 0;
  int rigid = 0;
  int loops = 0;
};

void check_graph(unsigned seed, Tally& tally) {
  testing::RandomGeometry random(seed);
  const std::size_t bodies = 2 + random.index(4);
  const std::size_t columns = 6 * (bodies - 1);
  const std::size_t mates = bodies - 1 + random.index(6);
  MateProblem problem;
  std::vector<Pose> X_WB;
  for (std::size_t body = 0; body < bodies; ++body) {
    X_WB.push_back(random.pose(300));
    problem.bodies.push_back({X_WB.back(), body == 0});
  }
  ExactRows rows;
  std::vector<MateStatus> expected;
  std::vector<int> taken;
  bool has_conflict = false;
  for (std::size_t number = 0; number < mates; ++number) {
    const ExactMate mate = random_mate(random, bodies);
    Joint joint = joint_of(mate, X_WB);
    // Where nothing turns any more, linear is exact, and a shift against what is settled conflicts.
    int shifted = -1;
    if (!has_conflict && holds_all_turns(rows, bodies)) {
      for (int i = 0; i < 3; ++i) {
        if (mate.slide[static_cast<std::size_t>(i)] && is_settled(mate, i, rows, bodies))
          shifted = i;
      }
    }
    if (shifted >= 0 && random.coin()) {
      const double shift_mm = 1.0 + random.index(30);
      joint.X_BG = joint.X_BG * Pose::from_translation(shift_mm * Eigen::Vector3d::Unit(shifted));
      expected.push_back(MateStatus::Conflicting);
      taken.push_back(0);
      has_conflict = true;
      ++tally.conflicting;
    } else {
      const std::size_t before = rows.rank();
      for (Row& row : rows_of(mate, bodies)) rows.add(std::move(row), columns);
      taken.push_back(static_cast<int>(rows.rank() - before));
      expected.push_back(taken.back() == 0 ? MateStatus::Redundant : MateStatus::Holds);
      if (taken.back() == 0) ++tally.redundant;
    }
    problem.mates.push_back({joint});
  }
  if (rows.rank() == columns) ++tally.rigid;
  if (mates >= bodies) ++tally.loops;

  const dowel::MateSolution solution = solve_mates(problem);
  for (std::size_t number = 0; number < mates; ++number) {
    CAPTURE(seed, number, solution.mates[number].off_mm, solution.mates[number].off_rad);
    CHECK(solution.mates[number].status == expected[number]);
    CHECK(solution.mates[number].freedoms_taken == taken[number]);
  }
  CAPTURE(seed);
  CHECK(static_cast<std::size_t>(solution.freedoms.cols()) == columns - rows.rank());
  for (std::size_t body = 1; body < bodies; ++body) {
    ExactRows more = rows;
    for (std::size_t i = 0; i < 6; ++i) more.add(unit_row(columns, 6 * (body - 1) + i), columns);
    CHECK(freedoms_of(solution, body).size() == more.rank() - rows.rank());
    CHECK((solution.X_WB[body].translation() - X_WB[body].translation()).norm() < 1e-9);
  }
}

}  // namespace

TEST_CASE("verdicts on 1,000 mate graphs are those of ranks over the integers", "[property]") {
  Tally tally;
  for (unsigned seed = 0; seed < 1000; ++seed) check_graph(seed, tally);
  CAPTURE(tally.redundant, tally.conflicting, tally.rigid, tally.loops);
  CHECK(tally.redundant > 200);
  CHECK(tally.conflicting > 50);
  CHECK(tally.rigid > 100);
  CHECK(tally.rigid < 900);
  CHECK(tally.loops > 500);
}
