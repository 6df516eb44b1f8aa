#include "element_rows.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "dowel/kernel/error.h"
#include "rows.h"
#include "schema.h"

namespace dowel {
namespace {

constexpr const char* kInsertElement = R"(
  INSERT INTO element (source_id, position, name, family, unit_in_file, licence, shape, solids,
    volume_mm3, surface_mm2, center_of_mass_x, center_of_mass_y, center_of_mass_z,
    obb_center_x, obb_center_y, obb_center_z, obb_axis_1_x, obb_axis_1_y, obb_axis_1_z,
    obb_axis_2_x, obb_axis_2_y, obb_axis_2_z, obb_axis_3_x, obb_axis_3_y, obb_axis_3_z,
    obb_half_1_mm, obb_half_2_mm, obb_half_3_mm, triangles, plane_triangles, hole_triangles,
    other_triangles, facet_error_mm, red, green, blue)
  VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?))";

constexpr const char* kSelectElement = R"(
  SELECT element.id, name, family, path, sha256, unit_in_file, licence, shape, solids,
    volume_mm3, surface_mm2, center_of_mass_x, center_of_mass_y, center_of_mass_z,
    obb_center_x, obb_center_y, obb_center_z, obb_axis_1_x, obb_axis_1_y, obb_axis_1_z,
    obb_axis_2_x, obb_axis_2_y, obb_axis_2_z, obb_axis_3_x, obb_axis_3_y, obb_axis_3_z,
    obb_half_1_mm, obb_half_2_mm, obb_half_3_mm, triangles, plane_triangles, hole_triangles,
    other_triangles, facet_error_mm, red, green, blue
  FROM element JOIN source ON source.id = source_id WHERE name = ?)";

constexpr const char* kInsertFeature = R"(
  INSERT INTO feature (element_id, position, name, kind, origin_x, origin_y, origin_z,
    direction_x, direction_y, direction_z, diameter_mm, depth_mm, through, blind_end, entry,
    area_mm2, faces)
  VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?))";

constexpr const char* kSelectFeatures = R"(
  SELECT name, kind, origin_x, origin_y, origin_z, direction_x, direction_y, direction_z,
    diameter_mm, depth_mm, through, blind_end, entry, area_mm2, faces, position
  FROM feature WHERE element_id = ? ORDER BY position)";

constexpr const char* kInsertSegment = R"(
  INSERT INTO hole_segment (element_id, feature_position, position, type, diameter_mm,
    diameter_end_mm, from_mm, to_mm)
  VALUES (?,?,?,?,?,?,?,?))";

constexpr const char* kSelectSegments = R"(
  SELECT type, diameter_mm, diameter_end_mm, from_mm, to_mm, feature_position
  FROM hole_segment WHERE element_id = ? ORDER BY feature_position, position)";

constexpr const char* kInsertSlot = R"(
  INSERT INTO slot (element_id, feature_position, type, run_x, run_y, run_z, length_mm, low_end,
    high_end, throat_depth_mm, undercut_width_mm, undercut_height_mm, nominal_mm)
  VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?))";

constexpr const char* kSelectSlots = R"(
  SELECT type, run_x, run_y, run_z, length_mm, low_end, high_end, throat_depth_mm,
    undercut_width_mm, undercut_height_mm, nominal_mm, feature_position
  FROM slot WHERE element_id = ? ORDER BY feature_position)";

constexpr const char* kInsertElementDesign = R"(
  INSERT INTO element_design (element_id, role, description, material, dimensions_by,
    density_kg_per_m3)
  VALUES (?,?,?,?,?,?))";

constexpr const char* kSelectElementDesign = R"(
  SELECT role, description, material, dimensions_by, density_kg_per_m3
  FROM element_design WHERE element_id = ?)";

constexpr const char* kInsertFeatureDesign = R"(
  INSERT INTO feature_design (element_id, feature_position, use, thread, thread_is_guess, fit)
  VALUES (?,?,?,?,?,?))";

constexpr const char* kSelectFeatureDesigns = R"(
  SELECT use, thread, thread_is_guess, fit, feature_position
  FROM feature_design WHERE element_id = ? ORDER BY feature_position)";

constexpr const char* kInsertBoltCircle = R"(
  INSERT INTO bolt_circle (element_id, position, center_x, center_y, center_z, direction_x,
    direction_y, direction_z, diameter_mm, hole_diameter_mm)
  VALUES (?,?,?,?,?,?,?,?,?,?))";

constexpr const char* kInsertBoltCircleHole = R"(
  INSERT INTO bolt_circle_hole (element_id, circle_position, position, hole) VALUES (?,?,?,?))";

constexpr const char* kSelectBoltCircles = R"(
  SELECT center_x, center_y, center_z, direction_x, direction_y, direction_z, diameter_mm,
    hole_diameter_mm, position
  FROM bolt_circle WHERE element_id = ? ORDER BY position)";

constexpr const char* kSelectBoltCircleHoles = R"(
  SELECT hole FROM bolt_circle_hole WHERE element_id = ? AND circle_position = ?
  ORDER BY position)";

std::string list_of(const std::vector<std::uint32_t>& indices) {
  std::string list = "[";
  for (const std::uint32_t index : indices) {
    if (list.size() > 1) list += ',';
    list += std::to_string(index);
  }
  return list + "]";
}

void insert_segments(SQLite::Database& database, std::int64_t element_id, std::int64_t position,
                     const std::vector<HoleSegment>& segments) {
  SQLite::Statement statement(database, kInsertSegment);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const HoleSegment& segment = segments[i];
    RowWriter row(statement);
    row << element_id << position << static_cast<std::int64_t>(i) << to_string(segment.type)
        << segment.diameter_mm << segment.diameter_end_mm << segment.from_mm << segment.to_mm;
    row.execute();
  }
}

void insert_slot(SQLite::Database& database, std::int64_t element_id, std::int64_t position,
                 const SlotShape& slot) {
  SQLite::Statement statement(database, kInsertSlot);
  RowWriter row(statement);
  row << element_id << position << to_string(slot.type) << slot.run << slot.length_mm
      << to_string(slot.ends[0]) << to_string(slot.ends[1]) << slot.throat_depth_mm
      << slot.undercut_width_mm << slot.undercut_height_mm << slot.nominal_mm;
  row.execute();
}

/// What is stated about a feature; most have nothing, and no row.
void insert_design(SQLite::Database& database, std::int64_t element_id, std::int64_t position,
                   const Feature& feature) {
  if (feature.use.empty() && feature.thread.empty() && feature.fit.empty()) return;
  SQLite::Statement statement(database, kInsertFeatureDesign);
  RowWriter row(statement);
  row << element_id << position << feature.use << feature.thread
      << std::int64_t{feature.thread_is_guess ? 1 : 0} << feature.fit;
  row.execute();
}

void insert_design(SQLite::Database& database, std::int64_t element_id, const Element& element) {
  SQLite::Statement statement(database, kInsertElementDesign);
  RowWriter row(statement);
  row << element_id << element.role << element.description << element.material
      << element.dimensions_by << element.density_kg_per_m3;
  row.execute();
}

void insert_features(SQLite::Database& database, std::int64_t element_id,
                     const std::vector<Feature>& features) {
  SQLite::Statement statement(database, kInsertFeature);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Feature& feature = features[i];
    const auto position = static_cast<std::int64_t>(i);
    RowWriter row(statement);
    row << element_id << position << feature.name << to_string(feature.kind) << feature.origin
        << feature.direction << feature.diameter_mm << feature.depth_mm
        << std::int64_t{feature.through ? 1 : 0} << feature.blind_end << feature.entry
        << feature.area_mm2 << list_of(feature.faces);
    row.execute();
    insert_segments(database, element_id, position, feature.segments);
    if (feature.slot) insert_slot(database, element_id, position, *feature.slot);
    insert_design(database, element_id, position, feature);
  }
}

void insert_bolt_circles(SQLite::Database& database, std::int64_t element_id,
                         const std::vector<BoltCircle>& circles) {
  SQLite::Statement insert_circle(database, kInsertBoltCircle);
  SQLite::Statement insert_hole(database, kInsertBoltCircleHole);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    const BoltCircle& circle = circles[i];
    const auto position = static_cast<std::int64_t>(i);
    RowWriter row(insert_circle);
    row << element_id << position << circle.center << circle.direction << circle.diameter_mm
        << circle.hole_diameter_mm;
    row.execute();
    for (std::size_t j = 0; j < circle.holes.size(); ++j) {
      RowWriter hole(insert_hole);
      hole << element_id << position << static_cast<std::int64_t>(j) << circle.holes[j];
      hole.execute();
    }
  }
}

/// The features of an element, and the position of each, which segments refer to.
struct FeatureRows {
  std::vector<Feature> features;
  std::vector<std::int64_t> positions;  ///< ascending

  Feature* at(std::int64_t position) {
    const auto found = std::lower_bound(positions.begin(), positions.end(), position);
    if (found == positions.end() || *found != position) return nullptr;
    return &features[static_cast<std::size_t>(found - positions.begin())];
  }
};

FeatureRows select_features(SQLite::Statement& statement, std::int64_t element_id,
                            const std::string& place) {
  statement.reset();
  statement.bind(1, element_id);
  FeatureRows rows;
  while (statement.executeStep()) {
    RowReader row(statement, place);
    Feature feature;
    feature.name = row.text();
    feature.kind = row.one_of(
        std::array{FeatureKind::Hole, FeatureKind::Shaft, FeatureKind::Face, FeatureKind::Slot});
    feature.origin = row.vector();
    feature.direction = row.vector();
    feature.diameter_mm = row.real();
    feature.depth_mm = row.real();
    feature.through = row.integer() != 0;
    feature.blind_end = row.text();
    feature.entry = row.text();
    feature.area_mm2 = row.real();
    feature.faces = row.indices();
    rows.positions.push_back(row.integer());
    rows.features.push_back(std::move(feature));
  }
  return rows;
}

void select_segments(SQLite::Statement& statement, std::int64_t element_id, FeatureRows& rows,
                     const std::string& place) {
  statement.reset();
  statement.bind(1, element_id);
  while (statement.executeStep()) {
    RowReader row(statement, place);
    HoleSegment segment;
    segment.type = row.one_of(std::array{HoleSegment::Type::Cylinder, HoleSegment::Type::Cone});
    segment.diameter_mm = row.real();
    segment.diameter_end_mm = row.real();
    segment.from_mm = row.real();
    segment.to_mm = row.real();
    Feature* const feature = rows.at(row.integer());
    if (feature == nullptr) {
      throw Error(ErrorCode::FileMalformed, place + ": a hole segment belongs to no feature");
    }
    feature->segments.push_back(segment);
  }
}

void select_slots(SQLite::Statement& statement, std::int64_t element_id, FeatureRows& rows,
                  const std::string& place) {
  using enum SlotShape::End;
  statement.reset();
  statement.bind(1, element_id);
  while (statement.executeStep()) {
    RowReader row(statement, place);
    SlotShape slot;
    slot.type = row.one_of(
        std::array{SlotShape::Type::Plain, SlotShape::Type::Tee, SlotShape::Type::Through});
    slot.run = row.vector();
    slot.length_mm = row.real();
    for (SlotShape::End& end : slot.ends) end = row.one_of(std::array{Open, Flat, Round});
    slot.throat_depth_mm = row.real();
    slot.undercut_width_mm = row.real();
    slot.undercut_height_mm = row.real();
    slot.nominal_mm = row.count();
    Feature* const feature = rows.at(row.integer());
    if (feature == nullptr || feature->kind != FeatureKind::Slot) {
      throw Error(ErrorCode::FileMalformed, place + ": the shape of a slot belongs to no slot");
    }
    feature->slot = slot;
  }
}

void select_designs(SQLite::Statement& statement, std::int64_t element_id, FeatureRows& rows,
                    const std::string& place) {
  statement.reset();
  statement.bind(1, element_id);
  while (statement.executeStep()) {
    RowReader row(statement, place);
    std::string use = row.text();
    std::string thread = row.text();
    const bool is_guess = row.integer() != 0;
    std::string fit = row.text();
    Feature* const feature = rows.at(row.integer());
    if (feature == nullptr) {
      throw Error(ErrorCode::FileMalformed, place + ": a thread or fit belongs to no feature");
    }
    feature->use = std::move(use);
    feature->thread = std::move(thread);
    feature->thread_is_guess = is_guess;
    feature->fit = std::move(fit);
  }
}

void select_design(SQLite::Statement& statement, std::int64_t element_id, Element& element,
                   const std::string& place) {
  statement.reset();
  statement.bind(1, element_id);
  if (!statement.executeStep()) return;  // put before it was kept
  RowReader row(statement, place);
  element.role = row.text();
  element.description = row.text();
  element.material = row.text();
  element.dimensions_by = row.text();
  element.density_kg_per_m3 = row.real();
}

std::vector<BoltCircle> select_bolt_circles(SQLite::Statement& circles, SQLite::Statement& holes,
                                            std::int64_t element_id, const std::string& place) {
  circles.reset();
  circles.bind(1, element_id);
  std::vector<BoltCircle> result;
  while (circles.executeStep()) {
    RowReader row(circles, place);
    BoltCircle circle;
    circle.center = row.vector();
    circle.direction = row.vector();
    circle.diameter_mm = row.real();
    circle.hole_diameter_mm = row.real();
    holes.reset();
    holes.bind(1, element_id);
    holes.bind(2, row.integer());
    while (holes.executeStep()) circle.holes.push_back(RowReader(holes, place).text());
    result.push_back(std::move(circle));
  }
  return result;
}

}  // namespace

std::int64_t insert_element(SQLite::Database& database, std::int64_t source_id,
                            std::int64_t position, const Element& element) {
  SQLite::Statement statement(database, kInsertElement);
  RowWriter row(statement);
  row << source_id << position << element.name << element.family << element.unit_in_file
      << element.licence << to_string(element.shape) << element.solids << element.volume_mm3
      << element.surface_mm2 << element.center_of_mass << element.obb.center;
  for (int axis = 0; axis < 3; ++axis) row << Eigen::Vector3d(element.obb.axes.col(axis));
  row << element.obb.half_extents_mm << element.triangles.total << element.triangles.plane
      << element.triangles.hole << element.triangles.other << element.facet_error_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    if (element.colour) {
      row << (*element.colour)[i];
    } else {
      row.null();
    }
  }
  row.execute();
  const std::int64_t id = database.getLastInsertRowid();
  insert_features(database, id, element.features);
  insert_design(database, id, element);
  insert_bolt_circles(database, id, element.bolt_circles);
  return id;
}

ElementReader::ElementReader(SQLite::Database& database, std::string file)
    : file_(std::move(file)), version_(database, "PRAGMA user_version"), database_(database) {}

ElementReader::Statements::Statements(SQLite::Database& database, std::int64_t of_version)
    : version(of_version),
      element(database, kSelectElement),
      features(database, kSelectFeatures),
      segments(database, kSelectSegments) {
  if (version >= kSlotVersion) slots.emplace(database, kSelectSlots);
  if (version >= kDesignVersion) {
    feature_designs.emplace(database, kSelectFeatureDesigns);
    element_design.emplace(database, kSelectElementDesign);
  }
  if (version >= kBoltCircleVersion) {
    bolt_circles.emplace(database, kSelectBoltCircles);
    bolt_circle_holes.emplace(database, kSelectBoltCircleHoles);
  }
}

void ElementReader::Statements::reset() noexcept {
  for (SQLite::Statement* const statement : {&element, &features, &segments}) statement->tryReset();
  for (auto* const statement :
       {&slots, &feature_designs, &element_design, &bolt_circles, &bolt_circle_holes}) {
    if (*statement) (*statement)->tryReset();
  }
}

ElementReader::Statements& ElementReader::statements() {
  version_.executeStep();
  const std::int64_t version = version_.getColumn(0).getInt64();
  version_.reset();
  // Another program may have brought the file up to date since the last time.
  if (!statements_ || statements_->version != version) statements_.emplace(database_, version);
  return *statements_;
}

std::optional<Element> ElementReader::read(std::string_view name) {
  struct Reset {
    Statements& statements;
    ~Reset() { statements.reset(); }
  } const reset{statements()};
  return read(reset.statements, name, file_);
}

std::optional<Element> ElementReader::read(Statements& statements, std::string_view name,
                                           const std::string& file) {
  SQLite::Statement& statement = statements.element;
  statement.bind(1, std::string(name));
  if (!statement.executeStep()) return std::nullopt;

  const std::string place = file + ": is damaged: element \"" + std::string(name) + "\"";
  RowReader row(statement, place);
  const std::int64_t id = row.integer();
  Element element;
  element.name = row.text();
  if (element.name != name) throw Error(ErrorCode::FileMalformed, place + ": is indexed wrongly");
  element.family = row.text();
  element.source = row.text();
  element.sha256 = row.text();
  element.unit_in_file = row.text();
  element.licence = row.text();
  element.shape = row.one_of(std::array{ShapeClass::Block, ShapeClass::Cylinder,
                                        ShapeClass::BlockCylinder, ShapeClass::Compound});
  element.solids = row.count();
  element.volume_mm3 = row.real();
  element.surface_mm2 = row.real();
  element.center_of_mass = row.vector();
  element.obb.center = row.vector();
  for (int axis = 0; axis < 3; ++axis) element.obb.axes.col(axis) = row.vector();
  element.obb.half_extents_mm = row.vector();
  element.triangles.total = row.count();
  element.triangles.plane = row.count();
  element.triangles.hole = row.count();
  element.triangles.other = row.count();
  element.facet_error_mm = row.real();
  const std::optional<double> red = row.optional_real();
  const std::optional<double> green = row.optional_real();
  const std::optional<double> blue = row.optional_real();
  if (red && green && blue) element.colour = {*red, *green, *blue};

  FeatureRows rows = select_features(statements.features, id, place);
  select_segments(statements.segments, id, rows, place);
  if (statements.slots) select_slots(*statements.slots, id, rows, place);
  if (statements.feature_designs) select_designs(*statements.feature_designs, id, rows, place);
  if (statements.element_design) select_design(*statements.element_design, id, element, place);
  if (statements.bolt_circles) {
    element.bolt_circles =
        select_bolt_circles(*statements.bolt_circles, *statements.bolt_circle_holes, id, place);
  }
  element.features = std::move(rows.features);
  if (const auto defect = find_defect(element)) {
    throw Error(ErrorCode::FileMalformed, place + ": " + *defect);
  }
  return element;
}

}  // namespace dowel
