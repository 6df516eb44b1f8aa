#include "instance_rows.h"

#include <cmath>
#include <utility>

#include "dowel/kernel/tolerance.h"
#include "rows.h"
#include "schema.h"

namespace dowel {

void insert_instances(SQLite::Database& database, std::int64_t source_id,
                      const std::vector<SourceInstance>& instances) {
  SQLite::Statement statement(database, R"(
    INSERT INTO instance (source_id, position, element_position, name, qw, qx, qy, qz, x_mm, y_mm,
      z_mm)
    VALUES (?,?,?,?,?,?,?,?,?,?,?))");
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const SourceInstance& instance = instances[i];
    const Eigen::Quaterniond& q = instance.X_WI.rotation();
    RowWriter row(statement);
    row << source_id << static_cast<std::int64_t>(i) << static_cast<std::int64_t>(instance.element)
        << instance.name << q.w() << q.x() << q.y() << q.z() << instance.X_WI.translation();
    row.execute();
  }
}

std::vector<SourceInstance> select_instances(SQLite::Database& database, std::int64_t source_id,
                                             std::size_t element_count, const std::string& place) {
  if (database.execAndGet("PRAGMA user_version").getInt64() < kInstanceVersion) return {};
  SQLite::Statement statement(database, R"(
    SELECT element_position, name, qw, qx, qy, qz, x_mm, y_mm, z_mm
    FROM instance WHERE source_id = ? ORDER BY position)");
  statement.bind(1, source_id);
  std::vector<SourceInstance> result;
  while (statement.executeStep()) {
    RowReader row(statement, place);
    SourceInstance instance;
    instance.element = row.count();
    instance.name = row.text();
    const double w = row.real();
    const Eigen::Vector3d v = row.vector();
    const Eigen::Vector3d translation = row.vector();
    const Eigen::Quaterniond rotation(w, v.x(), v.y(), v.z());
    // Written so that NaN is refused.
    if (instance.element >= element_count || !translation.allFinite() ||
        !(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack)) {
      throw Error(ErrorCode::FileMalformed,
                  place + ": instance \"" + instance.name + "\" has no element or no rigid pose");
    }
    instance.X_WI = Pose(rotation, translation);
    result.push_back(std::move(instance));
  }
  return result;
}

}  // namespace dowel
