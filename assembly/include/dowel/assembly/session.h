#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
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
  std::optional<Mate> made;   ///< insert, mate
  std::vector<Mate> held_by;  ///< place_at: mates that were made with it
  std::vector<Mate> dropped;  ///< mates that no longer hold
  // Of `mate`:
  std::vector<std::string> moved_along;  ///< other instances that had to move; by order of placing
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

  // What changes the project. Grounded instances do not move: Error{InvalidInput}.
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
  /// Checked where it ends. A shaft thicker than the bore is Error{InvalidInput} with the numbers.
  MoveReport insert(const InsertRequest& request, std::string_view command);
  /// Makes a mate beside those that the instance has, and keeps them. The instance moves alone
  /// where that will do; else all that hang together with it, but for grounded ones. A mate that
  /// cannot hold is refused with the reason in `conflict`; one that would interfere, as `insert`.
  MoveReport mate(const MateRequest& request, std::string_view command);
  /// Takes mates out; nothing moves. Expects: their numbers.
  void unmate(std::span<const std::uint32_t> numbers, std::string_view command);
  /// Its origin goes to `to_W` on a straight line, without turning. Checked on the way and at the
  /// end; a move out of an interference, at the end alone.
  MoveReport move(std::string_view name, const Eigen::Vector3d& to_W, std::string_view command);
  /// About the line through `point_W` along unit vector `axis_W`. |angle| <= 2 pi.
  MoveReport rotate(std::string_view name, const Eigen::Vector3d& point_W,
                    const Eigen::Vector3d& axis_W, double angle_rad, std::string_view command);
  /// The mates that went with it.
  std::vector<Mate> remove(std::string_view name, std::string_view command);
  void set_grounded(std::string_view name, bool grounded, std::string_view command);
  void set_mode(CheckMode mode, std::string_view command);
  /// Throws Error{InvalidInput} outside [kMinTolerance_mm, kMaxTolerance_mm].
  void set_tolerance(double tolerance_mm, std::string_view command);
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

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Worst verdict among `touches`; Clear where there is none.
Verdict worst(std::span<const Touch> touches);

}  // namespace dowel
