#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/freedom.h"
#include "dowel/assembly/mate.h"
#include "dowel/assembly/mate_solver.h"
#include "dowel/assembly/pattern.h"
#include "dowel/assembly/project.h"
#include "dowel/catalog/catalog.h"
#include "dowel/collision/scene.h"

namespace dowel {

/// Two instances that are not clear of each other.
struct Touch {
  std::string instance;  ///< the one that moved; of a check of all: the one placed first
  std::string with;
  PairVerdict pair;
};

/// A mate that cannot hold beside others.
struct MateConflict {
  Mate mate;
  double off_mm = 0.0;  ///< by how much it is missed where the others hold
  double off_rad = 0.0;
  /// It could hold, but would place the part by next to nothing: two holes that are almost one.
  bool is_nearly_redundant = false;
  /// Those that it contradicts together: without any one of them it could hold beside the rest.
  std::vector<Mate> against;
};

/// What became of one placement or move. An interference is an answer, not an error.
struct MoveReport {
  std::string instance;
  bool refused = false;  ///< taken back: the instance is where it was (or was not placed at all)
  bool checked = false;  ///< false in CheckMode::Off; then the verdict means nothing
  Verdict verdict = Verdict::Clear;  ///< worst of `touches`
  std::vector<Touch> touches;        ///< by order of placing
  /// Where the instance is now; of a refused placement, where it was to be.
  Pose X_WI;
  /// Moves: how much of the way is free of interference, in [0, 1], and the last free pose.
  double free_share = 1.0;
  Pose X_WI_free;
  std::optional<Mate> made;              ///< insert, mate
  std::vector<Mate> held_by;             ///< place_at: mates that were made with it
  std::vector<Mate> dropped;             ///< mates that no longer hold
  std::vector<std::string> moved_along;  ///< other instances that moved, too; by order of placing
  std::vector<Touch> stopped_by;         ///< drag: what is in the rest of the way
  // Of `mate`:
  bool is_redundant = false;             ///< the mate takes no freedom
  std::optional<MateConflict> conflict;  ///< why it cannot be made; then it is refused
};

/// One of several instances that are placed together.
struct Placement {
  std::string element;
  std::string name;  ///< empty: chosen
  Pose X_WI;
  std::vector<Mate> mates;  ///< that hold there; numbers do not matter
};

/// A mate to make beside those that are there. All but insert keep the present place in what they
/// leave free.
struct MateRequest {
  std::optional<MateKind> kind;  ///< none: insert, by what the features are
  FeatureName moving;            ///< Fix: no feature
  FeatureName fixed;
  std::optional<std::pair<FeatureName, FeatureName>> seat;  ///< insert
  MateOptions options;     ///< insert; of a seat and a slot the offset alone
  double angle_rad = 0.0;  ///< Angle
};

/// What can still move.
struct FreedomReport {
  std::vector<Freedom> freedoms;
  /// The part that the freedoms are told against where no grounded one is in reach; else empty.
  std::string relative_to;
  struct MateShare {
    Mate mate;
    MateVerdict verdict;
  };
  std::vector<MateShare> mates;  ///< of the instance, in the order of making
};

/// What becomes of a drag that meets something: it ends there; it goes on along what it met; it is
/// done and reported; nobody looks.
enum class DragMode : std::uint8_t { Block, Slide, Warn, Off };

/// "block", "slide", "warn", "off".
std::string_view to_string(DragMode mode);

/// A motion of an instance within what its mates leave free: a slide, or a turn.
struct DragRequest {
  std::string instance;
  Eigen::Vector3d by_mm_W = Eigen::Vector3d::Zero();
  double turn_rad = 0.0;                   ///< not 0: a turn
  std::optional<Eigen::Vector3d> axis_W;   ///< of the turn, unit; none: the only one that is free
  std::optional<Eigen::Vector3d> point_W;  ///< on that axis; none: the instance's origin
  std::optional<DragMode> mode;            ///< none: by the project's
};

struct DragReport {
  MoveReport move;
  Eigen::Vector3d asked_mm_W = Eigen::Vector3d::Zero();    ///< slide, as asked
  Eigen::Vector3d allowed_mm_W = Eigen::Vector3d::Zero();  ///< what the mates leave of it
  double allowed_rad = 0.0;                                ///< turn: what the mates leave of it
  bool slid = false;                                       ///< went along what it met
  bool is_linkage = false;  ///< other parts moved on ways of their own
};

/// A straight way of a part, with what moves with it, from where it is to clear of everything.
struct WayOut {
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitZ();
  std::string along;  ///< what gives the direction: a mated feature, or the base
  double way_mm = 0.0;
  double free_mm = 0.0;           ///< of the way; all of it where nothing is met
  std::vector<Touch> blocked_by;  ///< empty: free
};

/// What counts on a way out.
struct WayQuery {
  std::set<std::string> without;   ///< instances that are as if they were not there
  bool with_sub_assembly = false;  ///< what hangs on the part goes along
  bool first_free = false;         ///< one free way is enough
  bool by_mates_alone = false;     ///< not up from the base, which is no way into a mate
};

struct InsertRequest {
  FeatureName moving;
  FeatureName fixed;
  /// Faces of the moving and of another instance that settle the place along the axis.
  std::optional<std::pair<FeatureName, FeatureName>> seat;
  MateOptions options;
};

/// Line of a bill of materials.
struct BomRow {
  std::size_t count = 0;
  std::string element;
  std::string family;
  std::vector<std::string> instances;  ///< in order of placing
};

/// Work on one project: finds elements in the project and the catalogue, places and moves
/// instances, checks every move against all others, and commits what is done. `command` is the text
/// that the journal keeps.
///
/// Functions throw Error{NotFound} for names that nothing carries (with suggestions),
/// Error{InvalidInput} for requests that make no sense, and what Project and Catalog throw; the
/// project is then as it was. One thread at a time.
class Session {
 public:
  explicit Session(Project project);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const Project& project() const;
  const ProjectState& state() const { return project().state(); }

  /// Where elements come from that the project has no copy of; may be none.
  void use_catalog(std::shared_ptr<const Catalog> catalog);
  const std::shared_ptr<const Catalog>& catalog() const;

  // What there is.
  const Instance& instance(std::string_view name) const;
  /// The project's copy, or the catalogue's entry. The reference holds until the next change.
  const Element& element(std::string_view name);
  std::shared_ptr<const FacetedSolid> solid(std::string_view element_name);
  /// Names of copies and catalogue entries, sorted.
  std::vector<std::string> element_names() const;
  PlacedFeature feature(const FeatureName& name);

  // Where a new instance of an element goes, before any turn.
  /// Origin at the opening of a hole (shoulder of a shaft, centroid of a face), z out of it.
  Pose pose_at(const FeatureName& feature_name);
  /// Standing with its bottom on a face. Throws Error{InvalidInput} where it has no planar face
  /// that looks down.
  Pose pose_on(std::string_view element_name, const FeatureName& face);
  /// All ways of standing it with its holes on holes, one on `hole`; `X_BE` against its instance.
  std::vector<PatternWay> pattern(std::string_view element_name, const FeatureName& hole);

  // What changes the project. Grounded instances do not move: Error{InvalidInput}. What is fixed
  // together (a unit: mates of kind Fix) moves as one.
  MoveReport place(std::string_view element_name, std::string_view name, const Pose& X_WI,
                   std::string_view command);
  /// The same, and mates it with the part of hole or face `at`: what of it goes there as `insert`
  /// would place it (see `matching_pairs`), by `insert` at `at` and `align` farthest from it.
  MoveReport place_at(std::string_view element_name, std::string_view name, const Pose& X_WI,
                      const FeatureName& at, std::string_view command);
  /// All of them or none: where one is refused, so are the others. Mates may name instances that
  /// come before in the list. Without a command it only tells what would come of it.
  std::vector<MoveReport> place_all(std::span<const Placement> placements,
                                    std::optional<std::string_view> command);
  /// Places all instances of another project as one: `prefix`-NAME each, fixed together, with their
  /// mates, at X_WU times their poses there. Refused as a whole. Throws Error{InvalidInput} where
  /// the project has another element of the same name.
  std::vector<MoveReport> insert_unit(const Project& unit, std::string_view prefix,
                                      const Pose& X_WU, std::string_view command);
  /// Checked where it ends. A shaft thicker than the bore is Error{InvalidInput} with the numbers.
  MoveReport insert(const InsertRequest& request, std::string_view command);
  /// Makes a mate beside those that the instance has, and keeps them. The instance moves alone
  /// where that will do; else all that hang together with it, but for grounded ones. A mate that
  /// cannot hold is refused with the reason in `conflict`; one that would interfere, as `insert`.
  MoveReport mate(const MateRequest& request, std::string_view command);
  /// Makes mates that hold as the parts stand, but for those that earlier ones, or earlier ones in
  /// the list, make redundant; nothing moves. Numbers do not matter. Returns those that were made.
  /// Throws Error{InvalidInput} where one does not hold.
  std::vector<Mate> adopt(std::span<const Mate> mates, std::string_view command);
  /// Fixes instances to the first of them as they stand, so that they move as one. Returns the
  /// mates.
  std::vector<Mate> fix(std::span<const std::string> names, std::string_view command);
  /// Puts an instance there and makes these mates of it, which hold there. Checked where it ends.
  /// Throws Error{InvalidInput} where one does not hold, or a shaft is too thick.
  MoveReport put(std::string_view name, const Pose& X_WI, std::span<const Mate> mates,
                 std::string_view command);
  /// Takes mates out; nothing moves. Expects: their numbers.
  void unmate(std::span<const std::uint32_t> numbers, std::string_view command);
  /// Its origin goes to `to_W` on a straight line, without turning. Checked on the way and at the
  /// end; a move out of an interference, at the end alone.
  MoveReport move(std::string_view name, const Eigen::Vector3d& to_W, std::string_view command);
  /// About the line through `point_W` along unit vector `axis_W`. |angle| <= 2 pi.
  MoveReport rotate(std::string_view name, const Eigen::Vector3d& point_W,
                    const Eigen::Vector3d& axis_W, double angle_rad, std::string_view command);
  /// Moves an instance along what its mates leave free, with its unit and all that hangs on the
  /// rest of the project by it alone: the allowed motion nearest to the one asked for, swept, to
  /// the first touch or as the mode says. Where its mates leave it nothing so, but all that hang
  /// together with it can follow, as in a linkage, they do, each swept on a way of its own; a turn
  /// goes as far as they let it, a slide to the place nearest to the goal on the curve. Mates that
  /// hold go on holding. Throws Error{InvalidInput} where the mates leave nothing of it.
  DragReport drag(const DragRequest& request, std::string_view command);
  /// The mates that went with it.
  std::vector<Mate> remove(std::string_view name, std::string_view command);
  void set_grounded(std::string_view name, bool grounded, std::string_view command);
  void set_mode(CheckMode mode, std::string_view command);
  /// Throws Error{InvalidInput} outside [kMinTolerance_mm, kMaxTolerance_mm].
  void set_tolerance(double tolerance_mm, std::string_view command);
  /// Roles, forces, loads, limits, overrides and waivers.
  void set_design(const FixtureDesign& design, std::string_view command);
  std::vector<std::string> undo(std::size_t count);
  std::vector<std::string> redo(std::size_t count);

  /// Writes a copy of the project; one that was in memory goes on in that file.
  void save(const std::filesystem::path& file);

  // What can be told of it.
  /// All pairs that are not clear, whatever the mode.
  std::vector<Touch> check_all();
  /// By element name.
  std::vector<BomRow> bill_of_materials();
  MateResidual residual(const Mate& mate);
  /// By the mates of all that hang together with it.
  FreedomReport freedoms(std::string_view name);
  /// The straight ways by which a part, with its unit, can leave the others, or be brought in:
  /// along its mates' axes and normals, and up from the base. Free ones first, by length; then
  /// by how far they are free.
  std::vector<WayOut> ways_out(std::string_view name, const WayQuery& query = {});
  /// What goes along where an instance is dragged, itself among it; sorted.
  std::vector<std::string> sub_assembly(std::string_view name) const;
  /// What is fixed to it, itself among it; sorted.
  std::vector<std::string> unit(std::string_view name) const;
  /// Pairs of an instance's unit with the others, were the instance there.
  std::vector<Touch> check_at(std::string_view name, const Pose& X_WI);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Worst verdict among `touches`; Clear where there is none.
Verdict worst(std::span<const Touch> touches);

}  // namespace dowel
