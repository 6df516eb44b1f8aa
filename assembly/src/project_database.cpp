#include "project_database.h"

#include <array>
#include <cmath>
#include <limits>

#include "dowel/kernel/blob.h"
#include "dowel/kernel/error.h"
#include "mate_target_table.h"

namespace dowel {
namespace {

std::uint32_t number_in(const SQLite::Column& column, const std::string& title) {
  const std::int64_t value = column.getInt64();
  if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::FileMalformed,
                title + ": is damaged: number " + std::to_string(value) + " is out of range");
  }
  return static_cast<std::uint32_t>(value);
}

Instance read_instance(SQLite::Statement& row, const std::string& title) {
  Instance instance;
  instance.number = number_in(row.getColumn(0), title);
  instance.name = row.getColumn(1).getString();
  instance.element = row.getColumn(2).getString();
  std::array<double, 7> values{};
  for (int i = 0; i < 7; ++i) {
    values[static_cast<std::size_t>(i)] = row.getColumn(3 + i).getDouble();
  }
  const Eigen::Quaterniond rotation(values[0], values[1], values[2], values[3]);
  const Eigen::Vector3d translation(values[4], values[5], values[6]);
  // Written so that NaN is refused.
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack) ||
      !(translation.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    throw Error(ErrorCode::FileMalformed, title + ": is damaged: the pose of instance \"" +
                                              instance.name + "\" is not rigid or too far away");
  }
  instance.X_WI = Pose(rotation, translation);
  instance.grounded = row.getColumn(10).getInt() != 0;
  return instance;
}

Mate read_mate(SQLite::Statement& row, const std::string& title) {
  Mate mate;
  mate.number = number_in(row.getColumn(0), title);
  const auto kind = mate_kind_from(row.getColumn(1).getString());
  if (!kind) {
    throw Error(
        ErrorCode::FileMalformed,
        title + ": is damaged: mate " + std::to_string(mate.number) + " is of an unknown kind");
  }
  mate.kind = *kind;
  mate.moving = {row.getColumn(2).getString(), row.getColumn(3).getString()};
  mate.fixed = {row.getColumn(4).getString(), row.getColumn(5).getString()};
  if (!row.getColumn(6).isNull()) {
    mate.moving_face = {mate.moving.instance, row.getColumn(7).getString()};
    mate.fixed_face = {row.getColumn(6).getString(), row.getColumn(8).getString()};
  }
  mate.offset_mm = row.getColumn(9).getDouble();
  mate.flip = row.getColumn(10).getInt() != 0;
  mate.thread = row.getColumn(11).getInt() != 0;
  return mate;
}

/// `bytes` outlives the statement's next step. An empty blob is bound as one, not as NULL.
void bind_blob(SQLite::Statement& statement, int index, std::span<const std::byte> bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::FileUnwritable, "an element is larger than 1 GB");
  }
  statement.bindNoCopy(index, bytes.empty() ? static_cast<const void*>("") : bytes.data(),
                       static_cast<int>(bytes.size()));
}

}  // namespace

ProjectDatabase::ProjectDatabase(const std::filesystem::path& file, ProjectAccess access)
    : file_(file, access) {}

ProjectState ProjectDatabase::read_state() const {
  return guarded(title(), [&] {
    ProjectState state;
    SQLite::Statement settings(database(), "SELECT name, value FROM setting ORDER BY name");
    while (settings.executeStep()) {
      const SettingRow row{settings.getColumn(0).getString(), settings.getColumn(1).getString()};
      try {
        apply_setting(state, row);
      } catch (const Error& error) {
        throw Error(error.code(), title() + ": is damaged: " + error.what());
      }
    }
    SQLite::Statement instances(database(),
                                "SELECT number, name, element, qw, qx, qy, qz, x_mm, y_mm, z_mm, "
                                "grounded FROM instance ORDER BY number");
    while (instances.executeStep()) {
      Instance instance = read_instance(instances, title());
      state.instances.emplace(instance.name, instance);
    }
    SQLite::Statement mates(database(),
                            "SELECT number, kind, moving, moving_feature, fixed, fixed_feature, "
                            "seat, moving_face, fixed_face, offset_mm, flip, thread FROM mate "
                            "ORDER BY number");
    while (mates.executeStep()) {
      Mate mate = read_mate(mates, title());
      state.mates.emplace(mate.number, mate);
    }
    read_mate_targets(database(), state, title());
    if (const auto defect = find_defect(state, element_names())) {
      throw Error(ErrorCode::FileMalformed, title() + ": is damaged: " + *defect);
    }
    return state;
  });
}

std::vector<std::string> ProjectDatabase::element_names() const {
  return guarded(title(), [&] {
    std::vector<std::string> names;
    SQLite::Statement rows(database(), "SELECT name FROM element ORDER BY name");
    while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
    return names;
  });
}

std::string ProjectDatabase::element_text(std::string_view name) const {
  return guarded(title(), [&] {
    SQLite::Statement row(database(), "SELECT description FROM element WHERE name = ?");
    row.bind(1, std::string(name));
    if (!row.executeStep()) {
      throw Error(ErrorCode::NotFound,
                  title() + ": has no copy of element \"" + std::string(name) + "\"");
    }
    return row.getColumn(0).getString();
  });
}

std::vector<std::byte> ProjectDatabase::element_content(std::string_view name,
                                                        const char* column) const {
  return guarded(title(), [&] {
    SQLite::Statement row(database(),
                          std::string("SELECT ") + column + " FROM element WHERE name = ?");
    row.bind(1, std::string(name));
    if (!row.executeStep()) {
      throw Error(ErrorCode::NotFound,
                  title() + ": has no copy of element \"" + std::string(name) + "\"");
    }
    const SQLite::Column blob = row.getColumn(0);
    const auto* const bytes = static_cast<const std::byte*>(blob.getBlob());
    return std::vector<std::byte>(bytes, bytes + blob.getBytes());
  });
}

std::vector<JournalEntry> ProjectDatabase::journal() const {
  return guarded(title(), [&] {
    std::vector<JournalEntry> entries;
    SQLite::Statement rows(database(),
                           "SELECT number, command, undone FROM journal ORDER BY number");
    while (rows.executeStep()) {
      entries.push_back({number_in(rows.getColumn(0), title()), rows.getColumn(1).getString(),
                         rows.getColumn(2).getInt() != 0});
    }
    return entries;
  });
}

namespace {

JournalRecord read_record(SQLite::Statement& row, const std::string& title) {
  JournalRecord record;
  record.number = number_in(row.getColumn(0), title);
  record.command = row.getColumn(1).getString();
  const std::string what = title + ": journal entry " + std::to_string(record.number);
  record.change.before = rows_from_text(row.getColumn(2).getString(), what);
  record.change.after = rows_from_text(row.getColumn(3).getString(), what);
  return record;
}

}  // namespace

std::optional<JournalRecord> ProjectDatabase::record(JournalEnd end, std::size_t skip) const {
  return guarded(title(), [&]() -> std::optional<JournalRecord> {
    SQLite::Statement row(
        database(), end == JournalEnd::LastDone
                        ? "SELECT number, command, before, after FROM journal WHERE undone = 0 "
                          "ORDER BY number DESC LIMIT 1 OFFSET ?"
                        : "SELECT number, command, before, after FROM journal WHERE undone = 1 "
                          "ORDER BY number LIMIT 1 OFFSET ?");
    row.bind(1, static_cast<std::int64_t>(skip));
    if (!row.executeStep()) return std::nullopt;
    return read_record(row, title());
  });
}

void ProjectDatabase::for_each_done(const std::function<void(const JournalRecord&)>& visit) const {
  guarded(title(), [&] {
    SQLite::Statement rows(database(),
                           "SELECT number, command, before, after FROM journal WHERE undone = 0 "
                           "ORDER BY number");
    while (rows.executeStep()) visit(read_record(rows, title()));
  });
}

void ProjectDatabase::write_elements(std::span<const ProjectElement> elements) {
  SQLite::Statement insert(database(), "INSERT INTO element VALUES (?, ?, ?, ?)");
  for (const ProjectElement& element : elements) {
    const std::vector<std::byte> facets = to_blob(*element.solid);
    insert.bind(1, element.element.name);
    insert.bind(2, to_text(element.element));
    bind_blob(insert, 3, facets);
    bind_blob(insert, 4, element.brep);
    insert.exec();
    insert.reset();
  }
}

void ProjectDatabase::write_rows(const ProjectRows& before, const ProjectRows& after) {
  const auto erase = [&](const char* sql, std::uint32_t number) {
    SQLite::Statement statement(database(), sql);
    statement.bind(1, number);
    statement.exec();
  };
  for (const Mate& mate : before.mates) erase("DELETE FROM mate WHERE number = ?", mate.number);
  // A renumbered name would meet UNIQUE: all go before any comes. Mates may point to a row that
  // comes back at the end of the transaction.
  for (const Instance& instance : before.instances) {
    erase("DELETE FROM instance WHERE number = ?", instance.number);
  }
  for (const SettingRow& row : before.settings) {
    SQLite::Statement erase_setting(database(), "DELETE FROM setting WHERE name = ?");
    erase_setting.bind(1, row.name);
    erase_setting.exec();
  }
  for (const SettingRow& row : after.settings) {
    SQLite::Statement insert(database(), "INSERT INTO setting VALUES (?, ?)");
    insert.bind(1, row.name);
    insert.bind(2, row.value);
    insert.exec();
  }
  for (const Instance& instance : after.instances) {
    SQLite::Statement insert(database(),
                             "INSERT INTO instance VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    const Eigen::Quaterniond& q = instance.X_WI.rotation();
    const Eigen::Vector3d& t = instance.X_WI.translation();
    insert.bind(1, instance.number);
    insert.bind(2, instance.name);
    insert.bind(3, instance.element);
    int column = 4;
    for (const double value : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) {
      insert.bind(column++, value);
    }
    insert.bind(column, instance.grounded ? 1 : 0);
    insert.exec();
  }
  for (const Mate& mate : after.mates) {
    SQLite::Statement insert(database(),
                             "INSERT INTO mate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, mate.number);
    insert.bind(2, std::string(to_string(mate.kind)));
    insert.bind(3, mate.moving.instance);
    insert.bind(4, mate.moving.feature);
    insert.bind(5, mate.fixed.instance);
    insert.bind(6, mate.fixed.feature);
    if (mate.has_seat()) {
      insert.bind(7, mate.fixed_face.instance);
      insert.bind(8, mate.moving_face.feature);
      insert.bind(9, mate.fixed_face.feature);
    }
    insert.bind(10, mate.offset_mm);
    insert.bind(11, mate.flip ? 1 : 0);
    insert.bind(12, mate.thread ? 1 : 0);
    insert.exec();
    write_mate_target(database(), mate);
  }
}

void ProjectDatabase::commit(std::string_view command, const ProjectChange& change,
                             std::span<const ProjectElement> elements) {
  guarded(title(), [&] {
    file_.prepare_to_write();
    SQLite::Transaction transaction(database());
    database().exec("DELETE FROM journal WHERE undone = 1");
    write_elements(elements);
    write_rows(change.before, change.after);
    SQLite::Statement insert(
        database(),
        "INSERT INTO journal VALUES ((SELECT coalesce(max(number), 0) + 1 FROM "
        "journal), ?, ?, ?, 0)");
    insert.bind(1, std::string(command));
    insert.bind(2, to_text(change.before));
    insert.bind(3, to_text(change.after));
    insert.exec();
    transaction.commit();
  });
}

void ProjectDatabase::step(const std::vector<JournalRecord>& records, bool undo) {
  guarded(title(), [&] {
    file_.prepare_to_write();
    SQLite::Transaction transaction(database());
    for (const JournalRecord& record : records) {
      const ProjectChange& change = record.change;
      write_rows(undo ? change.after : change.before, undo ? change.before : change.after);
      SQLite::Statement mark(database(), "UPDATE journal SET undone = ? WHERE number = ?");
      mark.bind(1, undo ? 1 : 0);
      mark.bind(2, record.number);
      mark.exec();
    }
    transaction.commit();
  });
}

void ProjectDatabase::copy_into(const std::filesystem::path& file, const std::string& title) const {
  guarded(title, [&] {
    SQLite::Statement vacuum(database(), "VACUUM INTO ?");
    vacuum.bind(1, std::filesystem::absolute(file).string());
    vacuum.exec();
  });
}

}  // namespace dowel
