// Verdicts against OpenCascade's Booleans and distances, which share no code with ours.

#include "boolean_oracle.h"

#include <array>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "dowel/collision/scene.h"
#include "facet.h"
#include "library/builders.h"
#include "oracle_shapes.h"
#include "random_geometry.h"
#include "real_shapes.h"

namespace dowel::testing {
namespace {

using Eigen::Vector3d;

#ifdef DOWEL_SANITIZED
constexpr int kPairs = 25;
#else
constexpr int kPairs = 150;
#endif
constexpr int kSlowPairs = 2'200;  // of which OpenCascade leaves one in twenty open

/// OpenCascade works with 1e-7 mm, and its distances were found off by 4e-5 mm at times.
constexpr double kOracleSlack_mm = 1.0e-4;

struct Solid {
  NamedShape source;
  std::vector<std::pair<double, std::shared_ptr<const CollisionElement>>> elements;  ///< by finesse

  Solid(NamedShape shape, std::initializer_list<double> deflections_mm) : source(std::move(shape)) {
    for (const double deflection_mm : deflections_mm) {
      const FacetOptions options{.deflection_mm = deflection_mm,
                                 .angular_deflection_rad = deflection_mm > 0.1 ? 1.0 : 0.3};
      elements.emplace_back(deflection_mm, collision_element(facet(source.shape, options).solid));
    }
  }
  const Obb& obb() const { return elements.front().second->obb(); }
  double radius_mm() const { return obb().half_extents_mm.norm(); }
};

struct Pair {
  std::string made;  ///< how
  std::shared_ptr<const Solid> a;
  std::shared_ptr<const Solid> b;
  Pose X_AB;
};

constexpr double kCoarse_mm = 0.5;
constexpr double kFine_mm = 0.02;

/// 0, or of either sign between a tenth of the tolerance and half a millimetre, all orders alike.
double offset_mm(RandomGeometry& random, double tolerance_mm) {
  const double size = std::pow(10.0, random.uniform(std::log10(0.1 * tolerance_mm), -0.3));
  if (random.index(8) == 0) return 0.0;
  return random.coin() ? size : -size;
}

Pair overlapping(RandomGeometry& random, Pair pair) {
  const double reach_mm = pair.a->radius_mm() + pair.b->radius_mm();
  const Eigen::Quaterniond turn = random.rotation();
  const Vector3d away = random.uniform(0.1, 1.0) * reach_mm * random.direction();
  pair.X_AB = Pose(turn, pair.a->obb().center + away - turn * pair.b->obb().center);
  pair.made = "anywhere";
  return pair;
}

/// B is moved along the shortest way to A, which leaves `gap_mm`.
Pair touching(RandomGeometry& random, Pair pair, double gap_mm) {
  pair = overlapping(random, pair);
  const Vector3d away = (pair.X_AB * pair.b->obb().center - pair.a->obb().center).normalized();
  std::optional<Nearest> way;
  for (int i = 0; i < 40; ++i) {
    way = nearest(pair.a->source.shape, placed(pair.b->source.shape, pair.X_AB));
    if (way && way->distance_mm > 1.0) break;
    const double step_mm = 0.1 * (pair.a->radius_mm() + pair.b->radius_mm());
    pair.X_AB = Pose(pair.X_AB.rotation(), pair.X_AB.translation() + step_mm * away);
  }
  if (way && way->distance_mm > 0.0) {
    const Vector3d shift = (1.0 - gap_mm / way->distance_mm) * (way->a - way->b);
    pair.X_AB = Pose(pair.X_AB.rotation(), pair.X_AB.translation() + shift);
  }
  pair.made = "touching + " + named("", {gap_mm});
  return pair;
}

struct Seat {
  Vector3d center;
  Vector3d normal;
  double size_mm = 0.0;
};

std::vector<Seat> planar_faces(const TopoDS_Shape& shape) {
  std::vector<Seat> result;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(it.Current()));
    if (surface.GetType() != GeomAbs_Plane) continue;
    const gp_Ax3 frame = surface.Plane().Position();
    Vector3d normal = to_eigen(frame.Direction());
    if (!frame.Direct()) normal = -normal;
    if (it.Current().Orientation() == TopAbs_REVERSED) normal = -normal;
    GProp_GProps area;
    BRepGProp::SurfaceProperties(it.Current(), area);
    result.push_back({to_eigen(area.CentreOfMass()), normal, std::sqrt(area.Mass())});
  }
  return result;
}

/// A face of B before a face of A, `gap_mm` off.
Pair mated(RandomGeometry& random, Pair pair, double gap_mm) {
  const std::vector<Seat> on_a = planar_faces(pair.a->source.shape);
  const std::vector<Seat> on_b = planar_faces(pair.b->source.shape);
  if (on_a.empty() || on_b.empty()) return touching(random, pair, gap_mm);
  const Seat& a = on_a[random.index(static_cast<std::uint32_t>(on_a.size()))];
  const Seat& b = on_b[random.index(static_cast<std::uint32_t>(on_b.size()))];
  const double spin_rad =
      random.coin() ? 0.5 * std::numbers::pi * random.index(4) : random.uniform(0.0, 6.0);
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(spin_rad, a.normal) *
                                  Eigen::Quaterniond::FromTwoVectors(b.normal, -a.normal);
  Vector3d shift = random.point(0.5 * std::max(a.size_mm, b.size_mm));
  shift -= shift.dot(a.normal) * a.normal;
  pair.X_AB = Pose(turn, a.center + shift + gap_mm * a.normal - turn * b.center);
  pair.made = "face to face + " + named("", {gap_mm});
  return pair;
}

/// A pin in a hole of `host` with play, off its middle, tilted within it, at any depth or seated.
Pair pin_in_hole(RandomGeometry& random, std::shared_ptr<const Solid> host, double tolerance_mm) {
  const std::vector<UprightHole>& holes = host->source.holes;
  const UprightHole& hole = holes[random.index(static_cast<std::uint32_t>(holes.size()))];
  const double play_mm = offset_mm(random, tolerance_mm);
  const double radius_mm = hole.radius_mm - play_mm;
  const double length_mm = std::round(random.uniform(3.0, 25.0));
  Pair pair;
  pair.made = "pin in hole, play " + named("", {play_mm});
  pair.a = std::move(host);
  pair.b = std::make_shared<const Solid>(
      stepped_pin(radius_mm, length_mm, radius_mm + random.uniform(1.0, 5.0)),
      std::initializer_list<double>{random.coin() ? kCoarse_mm : kFine_mm});
  const double off_mm = random.coin() ? 0.0 : play_mm + offset_mm(random, tolerance_mm);
  const double direction_rad = random.uniform(0.0, 6.28);
  const double lift_mm =
      random.coin() ? offset_mm(random, tolerance_mm) : random.uniform(0.0, 0.8 * length_mm);
  const double tilt_rad = random.coin() ? 0.0 : offset_mm(random, tolerance_mm) / length_mm;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(tilt_rad, Vector3d::UnitX()) *
                                Eigen::AngleAxisd(random.uniform(0.0, 6.28), Vector3d::UnitZ()));
  pair.X_AB = Pose(turn, {hole.x_mm + off_mm * std::cos(direction_rad),
                          off_mm * std::sin(direction_rad), hole.top_z_mm + lift_mm});
  return pair;
}

struct Ruling {
  std::optional<Verdict> truth;  ///< none: not judged
  std::string figures;           ///< what OpenCascade measured
  std::string fault;             ///< of dowel; empty: none
};

/// Holds `said` against OpenCascade, in the frame of A.
Ruling judge(const Pair& pair, const PairVerdict& said, const Vector3d& witness_A, double t) {
  const TopoDS_Shape& a = pair.a->source.shape;
  const TopoDS_Shape b = placed(pair.b->source.shape, pair.X_AB);
  Ruling result;
  std::ostringstream figures;
  figures.precision(17);
  const std::optional<Nearest> gap = nearest(a, b);
  if (!gap) return result;
  figures << "distance " << gap->distance_mm << " at " << gap->a.transpose();
  const double slack_mm = kOracleSlack_mm + said.bound_mm;
  if (said.verdict == Verdict::Clear && gap->distance_mm > t) {
    result.truth = Verdict::Clear;
    if (said.gap_mm > gap->distance_mm + slack_mm) result.fault = "the gap is smaller than said";
    result.figures = figures.str();
    return result;
  }
  Overlap overlap(a, b);
  if (!overlap.is_known()) return result;
  figures << ", common volume " << overlap.volume_mm3();
  double ball_mm = 0.0;
  if (said.verdict == Verdict::Interference) {
    ball_mm = overlap.ball_at_mm(witness_A);
    figures << ", ball at the witness (" << witness_A.transpose() << ") " << ball_mm;
    if (ball_mm < std::min(0.9 * t, said.depth_mm - slack_mm) - 2.0 * said.bound_mm) {
      result.fault = "the witness is less deep than said";
    }
  }
  if (said.verdict == Verdict::Contact) {
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(to_pnt(witness_A)).Vertex();
    for (const TopoDS_Shape& shape : {a, b}) {
      const std::optional<Nearest> to_witness = nearest(vertex, shape);
      const double limit_mm = said.gap_mm + slack_mm;
      // At times only the edges of a face are found near a point that lies on it.
      if (to_witness && to_witness->distance_mm > limit_mm &&
          !is_on_or_in(shape, witness_A, limit_mm)) {
        figures << ", witness off by " << to_witness->distance_mm;
        result.fault = "the witness is further off than said";
      }
    }
  }
  if (ball_mm >= 1.1 * t) {
    result.truth = Verdict::Interference;
  } else if (overlap.volume_mm3() == 0.0) {
    // A ball that is there has a volume, whatever the Boolean found: slivers escape it.
    if (ball_mm >= 0.9 * t) return result;
    if (gap->distance_mm <= 0.9 * t - said.bound_mm) result.truth = Verdict::Contact;
    if (gap->distance_mm > t + slack_mm) result.truth = Verdict::Clear;
  } else {
    const double limit_mm = overlap.ball_limit_mm();
    figures << ", ball at most " << limit_mm;
    if (limit_mm < 0.9 * t - 2.0 * said.bound_mm) {
      result.truth = Verdict::Contact;
    } else {
      const double enough_mm = 1.1 * t + 2.0 * said.bound_mm;
      ball_mm = std::max(ball_mm, overlap.ball_mm(enough_mm));
      figures << ", ball found " << ball_mm;
      if (ball_mm >= enough_mm) result.truth = Verdict::Interference;
    }
    if (said.verdict == Verdict::Clear) result.fault = "clear, but they have a volume in common";
  }
  if (result.truth && *result.truth != said.verdict) {
    result.fault = "should be " + std::string(to_string(*result.truth));
  }
  result.figures = figures.str();
  return result;
}

std::string text_of(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  const Vector3d& p = pose.translation();
  return named("q(w,x,y,z)", {q.w(), q.x(), q.y(), q.z()}) + named(" p", {p.x(), p.y(), p.z()});
}

PairVerdict verdict_of(CollisionScene& scene, BodyId moving, const QueryOptions& options) {
  const std::array<BodyId, 1> bodies{moving};
  const std::array<Pose, 1> poses{scene.pose(moving)};
  const auto found = scene.check(bodies, poses, options);
  return found.empty() ? PairVerdict{} : found.front().pair;
}

/// Wrong verdicts as text, and how many pairs were judged to be what.
struct Tally {
  std::map<Verdict, int> judged;
  int open = 0;
  std::vector<std::string> wrong;
};

void check_pair(const Pair& pair, const Pose& X_WA, const QueryOptions& options, Tally& tally) {
  for (const auto& [fine_a_mm, element_a] : pair.a->elements) {
    for (const auto& [fine_b_mm, element_b] : pair.b->elements) {
      CollisionScene scene;
      const BodyId a = scene.add(element_a, X_WA);
      const BodyId b = scene.add(element_b, X_WA * pair.X_AB);
      const PairVerdict said = verdict_of(scene, a, options);
      const PairVerdict swapped = verdict_of(scene, b, options);
      Ruling ruling = judge(pair, said, X_WA.inverse() * said.witness_W, options.tolerance_mm);
      if (ruling.truth) {
        ++tally.judged[*ruling.truth];
      } else {
        ++tally.open;
      }
      if (said.verdict != swapped.verdict) ruling.fault += " B against A differs";
      if (ruling.fault.empty()) continue;
      tally.wrong.push_back(
          ruling.fault + "\n  " + pair.made + "\n  A: " + pair.a->source.name +
          named(", deflection", {fine_a_mm}) + "\n  B: " + pair.b->source.name +
          named(", deflection", {fine_b_mm}) + "\n  X_WA " + text_of(X_WA) + "\n  X_AB " +
          text_of(pair.X_AB) + named("\n  tolerance", {options.tolerance_mm}) + "\n  dowel: A, B " +
          std::string(to_string(said.verdict)) +
          named(" depth, gap, bound", {said.depth_mm, said.gap_mm, said.bound_mm}) + ", B, A " +
          std::string(to_string(swapped.verdict)) + "\n  OpenCascade: " + ruling.figures);
    }
  }
}

using Pool = std::vector<std::shared_ptr<const Solid>>;

Pair random_pair(RandomGeometry& random, const Pool& pool, double tolerance_mm) {
  const auto any = [&] { return pool[random.index(static_cast<std::uint32_t>(pool.size()))]; };
  const Pair pair{"", any(), any(), Pose()};
  switch (random.index(5)) {
    case 0:
      return overlapping(random, pair);
    case 1:
      return touching(random, pair, offset_mm(random, tolerance_mm));
    case 2:
    case 3:
      return mated(random, pair, offset_mm(random, tolerance_mm));
    default: {
      std::shared_ptr<const Solid> host = pair.a;
      while (host->source.holes.empty()) host = any();
      return pin_in_hole(random, host, tolerance_mm);
    }
  }
}

Pool made_pool(RandomGeometry& random) {
  Pool pool;
  for (const double deflection_mm : {kCoarse_mm, kFine_mm}) {
    for (NamedShape& shape : random_shapes(random)) {
      pool.push_back(std::make_shared<const Solid>(std::move(shape),
                                                   std::initializer_list<double>{deflection_mm}));
    }
  }
  return pool;
}

/// Those with no more faces than `max_faces`; pins go into the made plate.
Pool pool_of(std::vector<NamedShape> shapes, int max_faces, double deflection_mm) {
  Pool pool;
  for (NamedShape& shape : shapes) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape.shape, TopAbs_FACE, faces);
    if (faces.Extent() > max_faces) continue;
    pool.push_back(std::make_shared<const Solid>(std::move(shape),
                                                 std::initializer_list<double>{deflection_mm}));
  }
  pool.push_back(std::make_shared<const Solid>(holed_plate(20.0, 6.0),
                                               std::initializer_list<double>{kCoarse_mm}));
  return pool;
}

void check_pairs(RandomGeometry& random, const Pool& pool, int pairs, Tally& tally) {
  for (int i = 0; i < pairs; ++i) {
    constexpr std::array<double, 5> kTolerances_mm{0.01, 0.01, 0.01, 0.1, 0.001};
    const double tolerance_mm = kTolerances_mm[random.index(kTolerances_mm.size())];
    const Pair pair = random_pair(random, pool, tolerance_mm);
    const Pose X_WA = random.pose(std::pow(10.0, random.uniform(0.0, 4.0)));
    check_pair(pair, X_WA, {.tolerance_mm = tolerance_mm}, tally);
  }
}

void report(Tally& tally) {
  const int sum = tally.judged[Verdict::Clear] + tally.judged[Verdict::Contact] +
                  tally.judged[Verdict::Interference];
  CAPTURE(sum, tally.open, tally.judged[Verdict::Clear], tally.judged[Verdict::Contact],
          tally.judged[Verdict::Interference]);
  for (const std::string& text : tally.wrong) UNSCOPED_INFO(text);
  CHECK(tally.wrong.empty());
  CHECK(10 * tally.open < 3 * (sum + tally.open));
  for (const auto& [verdict, count] : tally.judged) {
    CAPTURE(to_string(verdict));
    CHECK(10 * count >= sum);
  }
}

TEST_CASE("verdicts are those of OpenCascade's Booleans", "[property]") {
  RandomGeometry random(1);
  Tally tally;
  check_pairs(random, made_pool(random), kPairs * 3 / 4, tally);
  const library::System& h40 = library::system_called("H40-12");
  std::vector<library::Part> parts = library::rest_buttons(h40);
  for (const auto& make : {library::vee_blocks, library::straps, library::fit_screws, library::nuts,
                           library::rest_pads, library::spacers}) {
    for (library::Part& part : make(h40)) parts.push_back(std::move(part));
  }
  check_pairs(random, pool_of(library_shapes(parts), 40, 0.0), kPairs / 5, tally);
  check_pairs(random, pool_of(real_shapes(DOWEL_SHARED_STEP), 60, kFine_mm), kPairs / 10, tally);
  report(tally);
}

TEST_CASE("two thousand verdicts are those of OpenCascade's Booleans", "[.slow]") {
  RandomGeometry random(2);
  Tally tally;
  for (int i = 0; i < 10; ++i) {
    check_pairs(random, made_pool(random), kSlowPairs * 7 / 100, tally);
  }
  check_pairs(random, pool_of(library_shapes(library::all_parts()), 60, 0.0), kSlowPairs / 5,
              tally);
  check_pairs(random, pool_of(real_shapes(DOWEL_SHARED_STEP), 90, kFine_mm), kSlowPairs / 10,
              tally);
  report(tally);
  CHECK(tally.judged[Verdict::Clear] + tally.judged[Verdict::Contact] +
            tally.judged[Verdict::Interference] >=
        2'000);
}

/// Faults found by the tests above, at the tolerance and with the facets that show them.
void check_regression(NamedShape a, double fine_a_mm, NamedShape b, double fine_b_mm,
                      const Pose& X_WA, const Pose& X_AB, double tolerance_mm) {
  const Pair pair{
      "regression", std::make_shared<const Solid>(std::move(a), std::initializer_list{fine_a_mm}),
      std::make_shared<const Solid>(std::move(b), std::initializer_list{fine_b_mm}), X_AB};
  Tally tally;
  check_pair(pair, X_WA, {.tolerance_mm = tolerance_mm}, tally);
  for (const std::string& text : tally.wrong) UNSCOPED_INFO(text);
  CHECK(tally.wrong.empty());
}

// The lowest place of the cylinder's rounding (torus 9.984, 2.496) is in the plane of the nut's top
// face within 1e-14 mm, 10.78 mm from the axis, well inside that face. Clear was said, with gap 0.
TEST_CASE("a rounded cylinder that leans on a nut is in contact", "[regression]") {
  const NamedShape cylinder{
      "rounded cylinder 12.48 21.95", rounded(round_bar(12.48, 0.0, 21.95), 0.2 * 12.48), {}};
  const Pose X_AB(Eigen::Quaterniond(0.61471722496836234, -0.57640980170584288, 0.289744510378033,
                                     -0.45378694618776844),
                  {-1.9282419183233261, 8.7646828250860587, 21.960448705803159});
  check_regression(hex_nut(26.06, 10.04, 5.25), kCoarse_mm, cylinder, kCoarse_mm, Pose(), X_AB,
                   0.001);
}

// The gap is 0.79 of the tolerance. Clear was said, with gap 0.
TEST_CASE("a sphere that touches the rounded edge of a block is in contact", "[regression]") {
  const NamedShape block{
      "rounded block 44.35 39.5 16.36 3.53", rounded(library::block(44.35, 39.5, 16.36), 3.53), {}};
  const NamedShape ball{"sphere 15.41", BRepPrimAPI_MakeSphere(15.41).Solid(), {}};
  const Pose X_WA(Eigen::Quaterniond(0.69266692984528899, -0.04203968547590934, 0.65967546880658257,
                                     0.28857142096646343),
                  {9.3971666941580558, 3.1340611450946732, 6.612285696045376});
  const Pose X_AB(Eigen::Quaterniond(0.13694754873113388, 0.12139008288576532, -0.88342178452387188,
                                     0.43136500472590322),
                  {28.845977850208232, -32.179122074764024, 4.0169425386663953});
  check_regression(block, kCoarse_mm, ball, kFine_mm, X_WA, X_AB, 0.001);
}

// Interference is right, but the witness was 0.00354 mm deep where 0.005 was said.
TEST_CASE("the witness in a pin's chamfer is as deep as said", "[regression]") {
  const Pose X_WA(Eigen::Quaterniond(-0.46868909615976817, 0.86239920560695604,
                                     -0.046914375495619123, -0.18546477477215684),
                  {-12.465738901427834, 48.388480826207569, -45.144202778865207});
  const Pose X_AB(Eigen::Quaterniond(-0.15113170527702591, 0, 0, 0.98851363554584226),
                  {-9.9944999999999986, 0, 17.383805639741873});
  check_regression(clamp_strap(66.63, 39.78, 17.4), kFine_mm,
                   stepped_pin(7.9260415341163073, 4, 10.969992020147018), kCoarse_mm, X_WA, X_AB,
                   0.01);
}

NamedShape pointed_cone(double radius_mm, double height_mm) {
  return {named("cone", {radius_mm, 0.0, height_mm}),
          library::turned({{0.0, 0.0}, {radius_mm, 0.0}, {0.0, height_mm}}),
          {}};
}

// The rim of the cone's base reaches 0.001685 mm below the top of the plate, a sixth of the
// tolerance. Interference was said, with a witness 0.14 mm outside one of the two.
TEST_CASE("a pointed cone that stands on its rim is in contact", "[regression]") {
  const Pose X_WA(Eigen::Quaterniond(-0.34272653492718202, 0.058839260961595523,
                                     0.42589549898346013, 0.83527808996281583),
                  {13.306212850878637, -10.325602474118131, -7.6341612252412645});
  const Pose X_AB(Eigen::Quaterniond(-0.28494796539577416, -0.31674845919208611,
                                     0.87149017669112783, 0.24285786490685241),
                  {19.471070806809401, -7.341598360352112, 27.69117983582607});
  check_regression(holed_plate(13.82, 2.47), kCoarse_mm, pointed_cone(19.98, 8.1), kCoarse_mm, X_WA,
                   X_AB, 0.01);
}

TEST_CASE("a pointed cone is in contact with a wedge that its rim touches", "[regression]") {
  const double half_mm = 31.15 * std::tan(0.5 * 10.2 * std::numbers::pi / 180.0);
  const NamedShape wedge{"wedge 10.2 31.15",
                         library::prism_y({{-half_mm, 0.0}, {0.0, 31.15}, {half_mm, 0.0}}, 30.0),
                         {}};
  const Pose X_WA(Eigen::Quaterniond(0.45280121991431971, 0.32391881325571015, -0.74257078193018589,
                                     0.37233894704517362),
                  {2.4735531166553066, -19.933109306794982, -14.744232214978943});
  const Pose X_AB(Eigen::Quaterniond(0.81249841549571911, 0.37472158459205679, 0.21316272165576683,
                                     -0.39241777859071275),
                  {-17.107868825467708, 29.044306229047265, -19.107496180652966});
  check_regression(pointed_cone(15.08, 17.76), kCoarse_mm, wedge, kFine_mm, X_WA, X_AB, 0.001);
}

// The plate's lower edge at x = 40 is 0.002239 mm deep in the torus, and a ball of 0.0019 mm fits
// into both: 1.9 times the tolerance. Contact was said.
TEST_CASE("a torus that an edge cuts interferes", "[regression]") {
  const NamedShape torus{"torus 29.53 2.93", BRepPrimAPI_MakeTorus(29.53, 2.93).Solid(), {}};
  const Pose X_WA(Eigen::Quaterniond(0.64274881662853678, 0.60797805002584149,
                                     -0.060997039063694587, 0.46207792701540434),
                  {308.24537808704565, 322.19952845372757, -425.9167388914758});
  const Pose X_AB(Eigen::Quaterniond(0.23251601302011699, 0.61370543927799714, -0.75380891317075382,
                                     -0.032772853311183396),
                  {67.232305408170134, 29.405897204215538, -15.533653045002673});
  check_regression(tee_slot_plate(15.21, 33.36), kCoarse_mm, torus, kFine_mm, X_WA, X_AB, 0.001);
}

// The witness is on a flank of B, 0.009 mm from its edge: OpenCascade's distance is that from the
// edge.
TEST_CASE("the witness of two nuts in contact is on both", "[regression]") {
  const Pose X_WA(Eigen::Quaterniond(-0.70760764210181848, 0.084050277924733352,
                                     -0.58171802402286676, 0.39221310042732027),
                  {-3.3839197303723925, -13.576229878981787, 3.372163357675138});
  const Pose X_AB(Eigen::Quaterniond(0.097021673802954719, 0.26566126103081933,
                                     -0.22614689017576364, 0.93213114595738034),
                  {1.7331379767119939, -7.6431769806595877, -16.889698131414487});
  check_regression(hex_nut(13.99, 11.57, 8.69), kCoarse_mm, hex_nut(24.72, 11.92, 6.69), kFine_mm,
                   X_WA, X_AB, 0.01);
}

}  // namespace
}  // namespace dowel::testing
