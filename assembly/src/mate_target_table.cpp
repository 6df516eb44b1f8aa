#include "mate_target_table.h"

#include <array>
#include <cmath>

#include "dowel/kernel/error.h"

namespace dowel {
namespace {

std::optional<Pose> pose_in(SQLite::Statement& row, int first_column) {
  std::array<double, 7> values{};
  for (int i = 0; i < 7; ++i) {
    if (row.getColumn(first_column + i).isNull()) return std::nullopt;
    values[static_cast<std::size_t>(i)] = row.getColumn(first_column + i).getDouble();
  }
  const Eigen::Quaterniond rotation(values[0], values[1], values[2], values[3]);
  const Eigen::Vector3d translation(values[4], values[5], values[6]);
  // Written so that NaN is refused.
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack) ||
      !(translation.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    throw Error(ErrorCode::FileMalformed, "is not rigid or too far away");
  }
  return Pose(rotation, translation);
}

}  // namespace

void read_mate_targets(SQLite::Database& database, ProjectState& state, const std::string& title) {
  if (!database.tableExists(kMateTargetTable)) return;
  SQLite::Statement rows(database,
                         "SELECT mate, angle_rad, qw, qx, qy, qz, x_mm, y_mm, z_mm FROM "
                         "mate_target ORDER BY mate");
  while (rows.executeStep()) {
    const std::int64_t number = rows.getColumn(0).getInt64();
    const auto found = number < 0 || number > UINT32_MAX
                           ? state.mates.end()
                           : state.mates.find(static_cast<std::uint32_t>(number));
    if (found == state.mates.end()) {
      throw Error(ErrorCode::FileMalformed, title + ": is damaged: there is no mate " +
                                                std::to_string(number) + " to have a target");
    }
    found->second.angle_rad = rows.getColumn(1).getDouble();
    try {
      found->second.X_FM = pose_in(rows, 2);
    } catch (const Error& error) {
      throw Error(error.code(), title + ": is damaged: the held pose of mate " +
                                    std::to_string(number) + " " + error.what());
    }
  }
}

void write_mate_target(SQLite::Database& database, const Mate& mate) {
  if (mate.kind != MateKind::Angle && mate.kind != MateKind::Fix) return;
  SQLite::Statement insert(database, "INSERT INTO mate_target VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, mate.number);
  insert.bind(2, mate.angle_rad);
  if (mate.X_FM) {
    const Eigen::Quaterniond& q = mate.X_FM->rotation();
    const Eigen::Vector3d& t = mate.X_FM->translation();
    int column = 3;
    for (const double value : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) {
      insert.bind(column++, value);
    }
  }
  insert.exec();
}

}  // namespace dowel
