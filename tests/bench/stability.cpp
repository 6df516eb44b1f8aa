#include "stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "dowel/kernel/mesh_defect.h"
#include "known_pair.h"
#include "locator_condition.h"
#include "mate_condition.h"
#include "methods.h"
#include "random_geometry.h"
#include "solids.h"

namespace dowel::bench {

namespace {

using testing::RandomGeometry;

/// How often a method was wrong, and how far from its threshold at most.
struct Outcome {
  std::size_t judged = 0;
  std::size_t wrong = 0;
  double off_mm = 0.0;
  std::string off_on;  ///< pair on which it was
};

std::string cell(const Outcome& outcome) {
  if (outcome.wrong == 0) return "0 of " + std::to_string(outcome.judged);
  return std::to_string(outcome.wrong) + " of " + std::to_string(outcome.judged) + ", " +
         text(outcome.off_mm) + " (" + outcome.off_on + ")";
}

/// dowel's documented band about its thresholds, a twentieth of the tolerance: as near as that no
/// method is judged.
constexpr double kBand_mm = 0.05 * kDefaultTolerance_mm;

constexpr double kFarthest_mm = 0.1;  // that is asked about, from a threshold

/// One pair in one place, ready to be asked.
class PlacedPair {
 public:
  PlacedPair(const Method& method, const KnownPair& pair, const Pose& X_WS)
      : pair_(pair), X_WS_(X_WS), checker_(method.make()) {
    checker_->add(placed(pair.still, X_WS));
    checker_->set_moving(pair.moving);
    checker_->finish();
  }

  Answer at(double gap_mm, double turn_rad) {
    return checker_->check(X_WS_ * pair_.X_SM(gap_mm, turn_rad));
  }

  /// A gap near one of the method's thresholds: dowel's are at plus and minus its tolerance, the
  /// others' is 0.
  void probe(RandomGeometry& random, bool has_verdicts, Outcome& outcome) {
    double threshold = 0.0;
    if (has_verdicts) threshold = random.coin() ? kDefaultTolerance_mm : -kDefaultTolerance_mm;
    const double beyond =
        std::pow(10.0, random.uniform(std::log10(kBand_mm), std::log10(kFarthest_mm)));
    judge(threshold + (random.coin() ? beyond : -beyond), beyond, random.uniform(-1.0, 1.0),
          outcome);
  }

  void judge(double gap_mm, double beyond_mm, double turn_rad, Outcome& outcome) {
    const Answer answer = at(gap_mm, turn_rad);
    const bool is_right =
        answer.verdict ? answer.verdict == expected(gap_mm) : answer.hit == (gap_mm < 0.0);
    ++outcome.judged;
    if (is_right) return;
    ++outcome.wrong;
    if (beyond_mm < outcome.off_mm) return;
    outcome.off_mm = beyond_mm;
    outcome.off_on = pair_.name;
  }

 private:
  static Verdict expected(double gap_mm) {
    if (gap_mm > kDefaultTolerance_mm) return Verdict::Clear;
    return gap_mm < -kDefaultTolerance_mm ? Verdict::Interference : Verdict::Contact;
  }

  const KnownPair& pair_;
  Pose X_WS_;
  std::unique_ptr<Checker> checker_;
};

std::vector<Method> methods_of_tables() {
  std::vector<Method> methods;
  for (const Method& method : all_methods()) {
    if (method.name == "dowel") methods.push_back(method);
  }
  for (const Method& method : peers()) methods.push_back(method);
  return methods;
}

bool has_verdicts(const Method& method) {
  return method.name == "dowel";
}

class Tables {
 public:
  explicit Tables(const Plan& plan)
      : methods_(methods_of_tables()),
        places_(std::max<std::size_t>(plan.poses / 100, 2)),
        plan_(plan) {}

  std::vector<Table> make() {
    return {offsets(),
            sizes(),
            exact_contact(),
            small_gaps(),
            slivers(),
            parallel_edges(),
            long_motions(),
            mate_conditions(plan_),
            locator_conditions(plan_),
            refusals()};
  }

 private:
  static constexpr std::size_t kProbes = 20;  // gaps at each place

  /// All pairs, or the flat ones, each at random poses `away_mm` from the origin.
  Outcome probe(const Method& method, std::span<const KnownPair> pairs, double away_mm,
                bool flat_only) const {
    Outcome outcome;
    RandomGeometry random(91);
    for (const KnownPair& pair : pairs) {
      if (flat_only && !pair.is_flat) continue;
      for (std::size_t i = 0; i < places_; ++i) {
        const Pose X_WS(random.rotation(), away_mm * random.direction());
        PlacedPair placed(method, pair, X_WS);
        for (std::size_t n = 0; n < kProbes; ++n) {
          placed.probe(random, has_verdicts(method), outcome);
        }
      }
    }
    return outcome;
  }

  /// "dowel, all pairs", and each method on flat ones: facets of curved faces are off anyway.
  std::vector<std::string> columns(const char* first, bool has_curved) const {
    std::vector<std::string> result{first};
    if (has_curved) result.emplace_back("dowel, all");
    for (const Method& method : methods_) result.emplace_back(method.name);
    return result;
  }

  void add_row(Table& table, std::string first, std::span<const KnownPair> pairs, double away_mm,
               bool has_curved) const {
    std::vector<std::string> row{std::move(first)};
    if (has_curved) row.push_back(cell(probe(methods_.front(), pairs, away_mm, false)));
    for (const Method& method : methods_) {
      row.push_back(cell(probe(method, pairs, away_mm, true)));
    }
    table.rows.push_back(std::move(row));
  }

  static std::string judged_how() {
    return "Verdicts at gaps and depths from 0.0005 to 0.1 mm off the method's threshold (dowel's "
           "are at plus and minus 0.01 mm, the others' is 0), at random poses: wrong of all, and "
           "how far from the threshold, in mm, a wrong one was at most, and on which pair. ";
  }

  Table offsets() const {
    Table table{"Distance from the origin",
                judged_how() +
                    "First column of figures: all known pairs, curved ones too; the others: flat "
                    "ones, where facets are exact. 100 m is the limit of what dowel accepts.",
                columns("distance, m", true),
                {}};
    const auto pairs = known_pairs({});
    for (const double away_m : {0.0, 1.0, 10.0, 99.0}) {
      add_row(table, text(away_m), pairs, 1.0e3 * away_m, true);
    }
    return table;
  }

  Table sizes() const {
    Table table{"Size of the parts",
                judged_how() + "Diameter of the pin in its hole; all other measures in proportion.",
                columns("size, mm", true),
                {}};
    for (const double scale : {0.04, 0.1, 1.0, 10.0, 100.0, 417.0}) {
      add_row(table, text(12.0 * scale), known_pairs({.scale = scale}), 1000.0, true);
    }
    return table;
  }

  Table exact_contact() const {
    Table table{"Faces in one plane",
                "Flat pairs placed with gap 0 at random poses within 10 m: the verdicts of dowel, "
                "and how often the others say that surfaces meet. Either answer of theirs can be "
                "defended; that it changes with the pose cannot.",
                {"method", "poses", "contact", "interference or \"meet\"", "clear or \"apart\""},
                {}};
    for (const Method& method : methods_) {
      std::array<std::size_t, 3> said{};
      RandomGeometry random(92);
      std::size_t poses = 0;
      for (const KnownPair& pair : known_pairs({})) {
        if (!pair.is_flat) continue;
        for (std::size_t i = 0; i < 10 * places_; ++i, ++poses) {
          PlacedPair placed(method, pair, random.pose(1.0e4));
          const Answer answer = placed.at(0.0, random.uniform(-1.0, 1.0));
          const Verdict verdict =
              answer.verdict.value_or(answer.hit ? Verdict::Interference : Verdict::Clear);
          ++said.at(static_cast<std::size_t>(verdict));
        }
      }
      table.rows.push_back({std::string(method.name), std::to_string(poses),
                            std::to_string(said[1]), std::to_string(said[2]),
                            std::to_string(said[0])});
    }
    return table;
  }

  Table small_gaps() const {
    Table table{"Gaps and depths from 1 mm down to 1e-9 mm",
                "Flat pairs at random poses within 1 m, as far apart and as deep: wrong answers of "
                "both. dowel is asked for its verdict at the default tolerance, so that gaps and "
                "depths up to it are contact.",
                columns("gap or depth, mm", false),
                {}};
    const auto pairs = known_pairs({});
    for (int exponent = 0; exponent >= -9; --exponent) {
      const double size = std::pow(10.0, exponent);
      if (size == kDefaultTolerance_mm) continue;  // the threshold itself
      std::vector<std::string> row{text(size)};
      for (const Method& method : methods_) {
        Outcome outcome;
        RandomGeometry random(93);
        for (const KnownPair& pair : pairs) {
          if (!pair.is_flat) continue;
          for (std::size_t i = 0; i < 2 * places_; ++i) {
            PlacedPair placed(method, pair, random.pose(1000.0));
            const double turn = random.uniform(-1.0, 1.0);
            placed.judge(size, size, turn, outcome);
            placed.judge(-size, size, turn, outcome);
          }
        }
        row.push_back(cell(outcome));
      }
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  Table slivers() const {
    Table table{"Slivers",
                judged_how() +
                    "A block whose faces have slivers of this width, on a plane, within "
                    "1 m.",
                columns("width, mm", false),
                {}};
    for (const double width : {1.0e-1, 1.0e-3, 1.0e-5, 1.0e-7, 1.0e-9}) {
      const std::array pair{sliver_pair(width)};
      add_row(table, text(width), pair, 1000.0, false);
    }
    return table;
  }

  Table parallel_edges() const {
    Table table{"Nearly parallel edges",
                judged_how() +
                    "Two square bars, edge over edge, crossing at this angle, within "
                    "1 m.",
                columns("angle, rad", false),
                {}};
    for (const double angle : {1.0, 1.0e-2, 1.0e-4, 1.0e-6, 1.0e-8, 1.0e-12}) {
      const std::array pair{crossed_edges(angle)};
      add_row(table, text(angle), pair, 1000.0, false);
    }
    return table;
  }

  /// Steps round a circle, back to the start.
  template <class Step>
  static double drift_mm(std::size_t steps, const Step& step) {
    const double angle = 2.0 * std::numbers::pi / static_cast<double>(steps);
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
    const Pose about = Pose::about_axis({100.0, -200.0, 50.0}, axis, angle);
    const Eigen::Vector3d lever(577.0, 577.0, 577.0);  // a point 1 m from the origin
    return (step(about, steps, lever) - lever).norm();
  }

  template <class Scalar>
  static Eigen::Vector3d by_matrices(const Pose& about, std::size_t steps,
                                     const Eigen::Vector3d& lever) {
    Eigen::Matrix<Scalar, 4, 4> step = Eigen::Matrix<Scalar, 4, 4>::Identity();
    step.template topLeftCorner<3, 3>() = about.rotation_matrix().template cast<Scalar>();
    step.template topRightCorner<3, 1>() = about.translation().template cast<Scalar>();
    Eigen::Matrix<Scalar, 4, 4> now = Eigen::Matrix<Scalar, 4, 4>::Identity();
    for (std::size_t i = 0; i < steps; ++i) now = now * step;
    const Eigen::Matrix<Scalar, 4, 1> p = now * lever.homogeneous().template cast<Scalar>();
    return p.template head<3>().template cast<double>();
  }

  Table long_motions() const {
    Table table{"Accumulated motion",
                "A full turn about an axis in space in this many steps, each multiplied to the "
                "pose: how far a point 1 m from the origin is from where it began, in mm.",
                {"steps", "dowel's pose", "matrix, double", "matrix, float"},
                {}};
    const std::size_t most = places_ < 10 ? 1'000'000 : 10'000'000;  // a quick run is short
    for (std::size_t steps = 10'000; steps <= most; steps *= 10) {
      const double pose =
          drift_mm(steps, [](const Pose& about, std::size_t count, const Eigen::Vector3d& lever) {
            Pose pose_now;
            for (std::size_t i = 0; i < count; ++i) pose_now = pose_now * about;
            return Eigen::Vector3d(pose_now * lever);
          });
      table.rows.push_back({std::to_string(steps), text(pose),
                            text(drift_mm(steps, by_matrices<double>)),
                            text(drift_mm(steps, by_matrices<float>))});
    }
    return table;
  }

  Table refusals() const {
    Table table{"Outside the working range",
                "What dowel says to solids beyond 100 m, open ones, and tolerances below 1e-6 mm.",
                {"asked", "answer"},
                {}};
    FacetedSolid far = testing::transformed(Pose::from_translation({1.0001e5, 0.0, 0.0}),
                                            testing::box({10.0, 10.0, 10.0}));
    FacetedSolid open = testing::box({10.0, 10.0, 10.0});
    open.triangles.pop_back();
    open.face_of.pop_back();
    const auto answer = [](const FacetedSolid& solid) {
      return find_defect(solid).value_or("(none)");
    };
    table.rows.push_back({"a block 100.01 m from the origin", answer(far)});
    table.rows.push_back({"a block that lacks a triangle", answer(open)});
    const auto pairs = known_pairs({});
    const KnownPair& pair = pairs.front();
    const Method tiny{"", [] { return make_dowel({.tolerance_mm = 1.0e-7}); }};
    std::string said = "(accepted)";
    try {
      (void)PlacedPair(tiny, pair, Pose()).at(0.0, 0.0);
    } catch (const std::logic_error&) {
      said = "refused: a precondition of the query";
    }
    table.rows.push_back({"a tolerance of 1e-7 mm", said});
    return table;
  }

  std::vector<Method> methods_;
  std::size_t places_;
  Plan plan_;
};

}  // namespace

std::vector<Table> run_stability(const Plan& plan) {
  return Tables(plan).make();
}

}  // namespace dowel::bench
