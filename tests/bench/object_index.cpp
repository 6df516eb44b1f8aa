#include "object_index.h"

#include <algorithm>
#include <array>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include "dowel/collision/layered_projection.h"
#include "motion.h"
#include "scenario.h"

namespace dowel::bench {

namespace {

class LayeredIndex : public ObjectIndex {
 public:
  void insert(const Aabb& box) override { model_.insert(count_++, box); }
  void remove_last() override { model_.remove(--count_); }
  std::size_t count_overlaps(const Aabb& box) override {
    model_.query(box, found_);
    return found_.size();
  }

 private:
  LayeredProjection model_;
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> found_;
};

class EveryBox : public ObjectIndex {
 public:
  void insert(const Aabb& box) override { boxes_.push_back(box); }
  void remove_last() override { boxes_.pop_back(); }
  std::size_t count_overlaps(const Aabb& box) override {
    return static_cast<std::size_t>(
        std::ranges::count_if(boxes_, [&](const Aabb& other) { return other.overlaps(box); }));
  }

 private:
  std::vector<Aabb> boxes_;
};

class RTree : public ObjectIndex {
  using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Box = boost::geometry::model::box<Point>;
  using Entry = std::pair<Box, std::uint32_t>;

 public:
  void insert(const Aabb& box) override {
    entries_.emplace_back(as_box(box), static_cast<std::uint32_t>(entries_.size()));
    tree_.insert(entries_.back());
  }
  void remove_last() override {
    tree_.remove(entries_.back());
    entries_.pop_back();
  }
  std::size_t count_overlaps(const Aabb& box) override {
    std::size_t count = 0;
    const Box wanted = as_box(box);
    const auto end = tree_.qend();
    for (auto it = tree_.qbegin(boost::geometry::index::intersects(wanted)); it != end; ++it) {
      ++count;
    }
    return count;
  }

 private:
  static Box as_box(const Aabb& box) {
    return {Point(box.min.x(), box.min.y(), box.min.z()),
            Point(box.max.x(), box.max.y(), box.max.z())};
  }

  boost::geometry::index::rtree<Entry, boost::geometry::index::rstar<16>> tree_;
  std::vector<Entry> entries_;
};

struct IndexCost {
  double insert_us = 0.0;  ///< mean of the last tenth of the elements, one by one
  double remove_us = 0.0;  ///< mean of as many
  double query_us = 0.0;   ///< mean
  double candidates = 0.0;
};

Aabb box_at(const Pose& X_WM, const Aabb& box) {
  return bounds(
      transformed(X_WM, Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()}));
}

/// Processor time of `work`, the fastest of `rounds`.
template <class Work>
double fastest_us(std::size_t rounds, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t round = 0; round < rounds; ++round) {
    const double start_us = processor_us();
    work();
    best = std::min(best, processor_us() - start_us);
  }
  return best;
}

IndexCost measure(const IndexKind& kind, const Scenario& scene, const std::vector<Pose>& poses,
                  std::size_t rounds) {
  std::vector<Aabb> asked;
  asked.reserve(poses.size());
  for (const Pose& pose : poses) asked.push_back(box_at(pose, scene.moving->box));
  const std::unique_ptr<ObjectIndex> index = kind.make();
  const std::size_t count = scene.elements.size();
  const std::size_t last = std::max<std::size_t>(std::min<std::size_t>(count / 10, 1000), 1);
  for (std::size_t i = 0; i + last < count; ++i) index->insert(scene.elements[i].box_W);
  (void)index->count_overlaps(asked.front());
  IndexCost cost;
  const auto per = [](double us, std::size_t n) { return us / static_cast<double>(n); };
  const auto add_last = [&] {
    for (std::size_t i = count - last; i < count; ++i) index->insert(scene.elements[i].box_W);
    (void)index->count_overlaps(asked.front());  // what is put off until then counts
  };
  cost.insert_us = per(fastest_us(1, add_last), last);
  cost.remove_us = per(fastest_us(1,
                                  [&] {
                                    for (std::size_t i = 0; i < last; ++i) index->remove_last();
                                    (void)index->count_overlaps(asked.front());
                                  }),
                       last);
  add_last();
  std::size_t found = 0;
  cost.query_us = per(fastest_us(rounds,
                                 [&] {
                                   found = 0;
                                   for (const Aabb& box : asked) {
                                     found += index->count_overlaps(box);
                                   }
                                 }),
                      asked.size());
  cost.candidates = static_cast<double>(found) / static_cast<double>(asked.size());
  return cost;
}

}  // namespace

std::vector<IndexKind> index_kinds() {
  std::vector<IndexKind> kinds{
      {"layered projection", [] { return std::make_unique<LayeredIndex>(); }},
      {"every box", [] { return std::make_unique<EveryBox>(); }, true},
      {"R-tree", [] { return std::make_unique<RTree>(); }}};
#ifdef DOWEL_BENCH_FCL
  kinds.push_back({"dynamic AABB tree", make_fcl_tree});
  kinds.push_back({"sweep and prune", make_fcl_sweep_and_prune, true});
#endif
  return kinds;
}

std::vector<Table> run_object_study(const Plan& plan) {
  Table queries{"Broad phase over objects: queries",
                "Boxes of placed elements that the moving element's box overlaps: microseconds of "
                "a query / candidates found, means. Scenes: the free, near and insert motions; "
                "fields: the path of the growth test. What takes time in proportion to all "
                "elements is left out of the largest field. FCL's two make a shape for each "
                "query.",
                {"index"},
                {}};
  Table changes{"Broad phase over objects: changes",
                "Microseconds to add / to remove an element, with what the next query has to make "
                "up for, mean of the last tenth (1,000 at most) of the elements.",
                {"index"},
                {}};
  std::vector<Scenario> scenes = paper_scenarios();
  std::vector<std::vector<Pose>> paths;
  for (const Scenario& scene : scenes) {
    paths.emplace_back();
    for (const MotionKind kind : {MotionKind::Free, MotionKind::Near, MotionKind::Insert}) {
      const Motion motion = motion_of(scene, kind, plan.poses);
      paths.back().insert(paths.back().end(), motion.poses.begin(), motion.poses.end());
    }
  }
  for (std::size_t count = 100; count <= (plan.poses < 500 ? 1'000U : 100'000U); count *= 10) {
    scenes.push_back(field_of_elements(count));
    paths.push_back(field_path(scenes.back(), plan.poses));
  }
  for (const Scenario& scene : scenes) {
    const std::string name = scene.name == "field" ? scene.title : "(" + scene.name + ")";
    queries.columns.push_back(name);
    changes.columns.push_back(name);
  }
  for (const IndexKind& kind : index_kinds()) {
    std::vector<std::string> query_row{std::string(kind.name)};
    std::vector<std::string> change_row = query_row;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      if (kind.is_slow && scenes[i].elements.size() > 10'000) {
        query_row.emplace_back("–");
        change_row.emplace_back("–");
        continue;
      }
      const IndexCost cost = measure(kind, scenes[i], paths[i], plan.rounds);
      query_row.push_back(text(cost.query_us, cost.candidates));
      change_row.push_back(text(cost.insert_us, cost.remove_us));
    }
    queries.rows.push_back(std::move(query_row));
    changes.rows.push_back(std::move(change_row));
  }
  return {std::move(queries), std::move(changes)};
}

}  // namespace dowel::bench
