#include "query_files.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "collision_element.h"
#include "dowel/collision/scene.h"
#include "dowel/kernel/convex_hull.h"

namespace dowel::bench {

namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Two sets of points, each with its convex hull, before and after. Truth: whether they meet.
struct Query {
  Points a;
  Points b;
  Points a_after;
  Points b_after;
  bool truth = false;
};

constexpr double kSize_mm = 100.0;  ///< that each query is scaled to
constexpr double kHalf_mm = 0.05;   ///< half the edge of a cube; five times the tolerance
/// Of vertices that should move alike, of the query's size: data have it from rounding.
constexpr double kAlike = 1.0e-9;

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t line, const char* expected) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": expected " + expected);
}

/// The double nearest to numerator / denominator: exact where the data were doubles.
double ratio(const std::string& numerator, const std::string& denominator) {
  using Real = boost::multiprecision::cpp_bin_float_100;
  const Real value = Real(numerator) / Real(denominator);
  return value.convert_to<double>();
}

/// "n,d,n,d,n,d,truth".
Eigen::Vector3d read_vertex(const std::filesystem::path& file, std::size_t number,
                            const std::string& line, bool& truth) {
  constexpr const char* kExpected = "numerator,denominator of x, y and z, and 0 or 1";
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    std::erase_if(cell, [](char c) { return c == ' ' || c == '\r'; });
    cells.push_back(cell);
  }
  const auto is_empty = [](const std::string& cell) { return cell.empty(); };
  if (cells.size() != 7 || std::ranges::any_of(cells, is_empty) ||
      (cells[6] != "0" && cells[6] != "1")) {
    fail(file, number, kExpected);
  }
  truth = cells[6] == "1";
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  try {
    for (std::size_t k = 0; k < 3; ++k) {
      p[static_cast<Eigen::Index>(k)] = ratio(cells[2 * k], cells[2 * k + 1]);
    }
  } catch (const std::exception&) {  // no number, or 0 below the line
    fail(file, number, kExpected);
  }
  if (!p.allFinite()) fail(file, number, kExpected);
  return p;
}

std::vector<Query> read_sweeps(const std::filesystem::path& file, std::size_t vertices_of_a) {
  std::vector<Query> queries;
  std::ifstream stream(file);
  std::string line;
  std::size_t number = 0;
  Points points;
  while (std::getline(stream, line)) {
    ++number;
    if (line.empty() || line == "\r") continue;
    bool truth = false;
    points.push_back(read_vertex(file, number, line, truth));
    if (points.size() < 8) continue;
    const auto from = [&](std::size_t begin, std::size_t end) {
      return Points(points.begin() + static_cast<std::ptrdiff_t>(begin),
                    points.begin() + static_cast<std::ptrdiff_t>(end));
    };
    queries.push_back({from(0, vertices_of_a), from(vertices_of_a, 4), from(4, 4 + vertices_of_a),
                       from(4 + vertices_of_a, 8), truth});
    points.clear();
  }
  if (!points.empty()) fail(file, number, "eight lines a query");
  return queries;
}

std::vector<Query> read_triangles(const std::filesystem::path& file) {
  constexpr const char* kExpected = "18 numbers and 0 or 1";
  std::vector<Query> queries;
  std::ifstream stream(file);
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> values;
    for (double value = 0.0; words >> value;) values.push_back(value);
    if (values.empty() && words.eof()) continue;
    if (!words.eof() || values.size() != 19 || (values[18] != 0.0 && values[18] != 1.0)) {
      fail(file, number, kExpected);
    }
    Points points;
    for (std::size_t i = 0; i < 18; i += 3) {
      points.emplace_back(values[i], values[i + 1], values[i + 2]);
    }
    const Points a(points.begin(), points.begin() + 3);
    const Points b(points.begin() + 3, points.end());
    queries.push_back({a, b, a, b, values[18] == 1.0});
  }
  return queries;
}

/// Moved to the origin and scaled to `kSize_mm`; false where all is one point.
bool normalise(Query& query) {
  Points all = query.a;
  for (const Points* more : {&query.b, &query.a_after, &query.b_after}) {
    all.insert(all.end(), more->begin(), more->end());
  }
  const Aabb box = bounds(all);
  const double size = box.size().maxCoeff();
  if (!(size > 0.0)) return false;
  for (Points* points : {&query.a, &query.b, &query.a_after, &query.b_after}) {
    for (Eigen::Vector3d& p : *points) p = (p - box.center()) * (kSize_mm / size);
  }
  return true;
}

/// How all vertices move; nothing where they do not move alike.
std::optional<Eigen::Vector3d> common_way(const Points& before, const Points& after) {
  const Eigen::Vector3d way = after.front() - before.front();
  for (std::size_t i = 1; i < before.size(); ++i) {
    if ((after[i] - before[i] - way).norm() > kAlike * kSize_mm) return std::nullopt;
  }
  return way;
}

const Eigen::Vector3d& farthest(const Points& points, const Eigen::Vector3d& direction) {
  return *std::ranges::max_element(points, {},
                                   [&](const Eigen::Vector3d& p) { return p.dot(direction); });
}

/// Whether a direction is found along which the hulls are more than `margin_mm` apart.
/// Source: Gilbert, "An Iterative Procedure for Computing the Minimum of a Quadratic Form on a
/// Convex Set", 1966.
bool are_apart(const Points& a, const Points& b, double margin_mm) {
  constexpr int kSteps = 500;
  Eigen::Vector3d way = a.front() - b.front();
  for (int i = 0; i < kSteps; ++i) {
    const double length = way.norm();
    if (length <= margin_mm) return false;
    const Eigen::Vector3d nearest = farthest(a, -way) - farthest(b, way);
    if (nearest.dot(way) / length > margin_mm) return true;
    const Eigen::Vector3d step = nearest - way;
    const double square = step.squaredNorm();
    if (square == 0.0) return false;
    way += std::clamp(-way.dot(step) / square, 0.0, 1.0) * step;
  }
  return false;
}

/// Hull of cubes about the points: their own hull and a little more.
std::shared_ptr<const CollisionElement> thickened(const Points& points) {
  Points corners;
  for (const Eigen::Vector3d& p : points) {
    for (unsigned i = 0; i < 8; ++i) {
      corners.push_back(p + kHalf_mm * Eigen::Vector3d((i & 1U) != 0U ? 1.0 : -1.0,
                                                       (i & 2U) != 0U ? 1.0 : -1.0,
                                                       (i & 4U) != 0U ? 1.0 : -1.0));
    }
  }
  const ConvexHull hull = convex_hull(corners);
  std::map<std::uint32_t, std::uint32_t> index;
  FacetedSolid solid;
  solid.solid_count = 1;
  solid.faces.push_back({OtherSurface{}, false, 0.0, 0.0, 0});
  for (const Triangle& triangle : hull.triangles) {
    Triangle own{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [entry, is_new] =
          index.try_emplace(triangle[i], static_cast<std::uint32_t>(solid.vertices.size()));
      if (is_new) solid.vertices.push_back(corners[triangle[i]]);
      own[i] = entry->second;
    }
    solid.triangles.push_back(own);
    solid.face_of.push_back(0);
  }
  return testing::collision_element(std::move(solid));
}

/// The queries of one file or folder.
struct Tally {
  std::size_t queries = 0;
  std::size_t not_rigid = 0;
  std::size_t too_near = 0;
  std::size_t judged_yes = 0;
  std::size_t judged_no = 0;
  std::size_t false_yes = 0;
  std::size_t false_no = 0;
  double taken_us = 0.0;

  Tally& operator+=(const Tally& more) {
    queries += more.queries;
    not_rigid += more.not_rigid;
    too_near += more.too_near;
    judged_yes += more.judged_yes;
    judged_no += more.judged_no;
    false_yes += more.false_yes;
    false_no += more.false_no;
    taken_us += more.taken_us;
    return *this;
  }
};

bool meet(const Query& query, const Eigen::Vector3d& way, double& taken_us) {
  CollisionScene scene;
  const BodyId a = scene.add(thickened(query.a), Pose());
  scene.add(thickened(query.b), Pose());
  const Pose still;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const SweepResult found =
      scene.sweep({&a, 1}, {&still, 1}, still, Pose::from_translation(way), QueryOptions{});
  taken_us += std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  return found.verdict == Verdict::Interference;
}

void judge(Query query, Tally& tally) {
  ++tally.queries;
  if (!normalise(query)) {
    ++tally.too_near;
    return;
  }
  const auto way_a = common_way(query.a, query.a_after);
  const auto way_b = common_way(query.b, query.b_after);
  if (!way_a || !way_b) {
    ++tally.not_rigid;
    return;
  }
  const Eigen::Vector3d way = *way_a - *way_b;  // of A, seen from B
  if (!query.truth) {
    Points swept = query.a;
    for (const Eigen::Vector3d& p : query.a) swept.emplace_back(p + way);
    // Two cubes reach this far towards each other.
    const double reach_mm = 2.0 * std::sqrt(3.0) * kHalf_mm + 2.0 * kDefaultTolerance_mm;
    if (!are_apart(swept, query.b, reach_mm)) {
      ++tally.too_near;
      return;
    }
  }
  const bool answer = meet(query, way, tally.taken_us);
  ++(query.truth ? tally.judged_yes : tally.judged_no);
  if (answer && !query.truth) ++tally.false_yes;
  if (!answer && query.truth) ++tally.false_no;
}

std::vector<std::string> row(const std::string& name, const Tally& tally) {
  const std::size_t judged = tally.judged_yes + tally.judged_no;
  return {name,
          std::to_string(tally.queries),
          std::to_string(tally.not_rigid),
          std::to_string(tally.too_near),
          std::to_string(tally.judged_yes),
          std::to_string(tally.judged_no),
          std::to_string(tally.false_yes) + " / " + std::to_string(tally.false_no),
          judged == 0 ? "–" : text(tally.taken_us / static_cast<double>(judged))};
}

/// The queries of a file; nothing where it is no file of queries.
std::vector<Query> read(const std::filesystem::path& file) {
  const std::string folder = file.parent_path().filename().string();
  if (file.extension() == ".tri") return read_triangles(file);
  if (file.extension() != ".csv") return {};
  if (folder == "edge-edge") return read_sweeps(file, 2);
  if (folder == "vertex-face") return read_sweeps(file, 1);
  return {};
}

}  // namespace

QueryStudy run_query_files(const std::filesystem::path& folder) {
  std::map<std::string, Tally> tallies;  // by folder, sorted
  try {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      const std::vector<Query> queries = read(entry.path());
      if (queries.empty()) continue;
      const std::filesystem::path group =
          std::filesystem::relative(entry.path().parent_path(), folder);
      Tally& tally = tallies[group == "." ? "triangles" : group.string()];
      for (const Query& query : queries) judge(query, tally);
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw std::runtime_error(folder.string() + ": cannot be read: " + error.code().message());
  }
  if (tallies.empty()) {
    throw std::runtime_error(
        folder.string() +
        ": expected queries in edge-edge/*.csv, vertex-face/*.csv or *.tri somewhere below");
  }
  QueryStudy study;
  study.table = {
      "Public queries",
      "dowel's sweep on queries of two vertices, edges or triangles, each made a thin solid, in a "
      "scene 100 mm wide. Left out: queries in which the vertices of one move differently, which "
      "no rigid motion does, and those whose truth is no while the two come nearer than the solids "
      "are thick. Wrong answers: false yes / false no; mean microseconds of a sweep.",
      {"queries", "all", "not rigid", "too near", "judged: meet", "judged: do not", "wrong",
       "time"},
      {}};
  Tally all;
  for (const auto& [name, tally] : tallies) {
    study.table.rows.push_back(row(name, tally));
    all += tally;
  }
  study.table.rows.push_back(row("all", all));
  study.wrong = all.false_yes + all.false_no;
  return study;
}

}  // namespace dowel::bench
