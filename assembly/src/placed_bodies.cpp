#include "placed_bodies.h"

#include <algorithm>
#include <array>
#include <utility>

#include "dowel/assembly/thread.h"
#include "dowel/kernel/check.h"

namespace dowel {
namespace {

std::vector<std::uint32_t> hole_faces(const Element& element) {
  std::vector<std::uint32_t> faces;
  for (const Feature& feature : element.features) {
    if (feature.kind == FeatureKind::Hole) {
      faces.insert(faces.end(), feature.faces.begin(), feature.faces.end());
    }
  }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

/// Adds the reliefs that are not there yet: two poses on one axis give the same ones.
void add_new(std::vector<ThreadRelief>& all, const std::vector<ThreadRelief>& more) {
  for (const ThreadRelief& relief : more) {
    const bool known = std::ranges::any_of(all, [&](const ThreadRelief& other) {
      return other.start == relief.start && other.direction == relief.direction &&
             other.length_mm == relief.length_mm && other.radius_mm == relief.radius_mm;
    });
    if (!known) all.push_back(relief);
  }
}

ThreadRelief seen_from(const Pose& X_AB, ThreadRelief relief_B) {
  relief_B.start = X_AB * relief_B.start;
  relief_B.direction = X_AB.rotation() * relief_B.direction;
  return relief_B;
}

}  // namespace

PlacedBodies::PlacedBodies(FindElement find_element, LoadSolid load_solid)
    : find_element_(std::move(find_element)), load_solid_(std::move(load_solid)) {}

std::shared_ptr<const CollisionElement> PlacedBodies::shape(const std::string& element) {
  auto& found = shapes_[element];
  if (found == nullptr) {
    const Element& description = find_element_(element);
    found = std::make_shared<const CollisionElement>(
        description.obb, [load = load_solid_, element] { return load(element); },
        hole_faces(description));
  }
  return found;
}

void PlacedBodies::forget(const std::string& element) {
  const bool used = std::ranges::any_of(
      bodies_, [&](const auto& entry) { return entry.second.element == element; });
  DOWEL_EXPECTS(!used);
  shapes_.erase(element);
  const auto kind = kinds_.find(element);
  if (kind == kinds_.end()) return;
  std::erase_if(may_thread_, [&](const auto& entry) {
    return entry.first.first == kind->second || entry.first.second == kind->second;
  });
}

void PlacedBodies::add(const Instance& instance) {
  const BodyId id = scene_.add(shape(instance.element), instance.X_WI);
  const std::size_t kind = kinds_.try_emplace(instance.element, kinds_.size()).first->second;
  bodies_.emplace(instance.name, Body{id, instance.number, instance.element, kind, instance.X_WI});
  names_.emplace(id, instance.name);
}

void PlacedBodies::follow(const ProjectState& state) {
  // Both are sorted by name: most commands leave nearly all as it was, and going through them side
  // by side costs no search.
  std::vector<const Instance*> added;
  std::vector<const Instance*> moved;
  auto body = bodies_.begin();
  const auto drop = [&] {
    const BodyId id = body->second.id;
    scene_.remove(id);
    names_.erase(id);
    std::erase_if(relieved_, [&](const auto& pair) {
      return pair.first.first == id || pair.first.second == id;
    });
    body = bodies_.erase(body);
  };
  for (const auto& [name, instance] : state.instances) {
    while (body != bodies_.end() && body->first < name) drop();
    const bool is_there = body != bodies_.end() && body->first == name;
    // A name can come back as another element.
    if (is_there && body->second.element != instance.element) drop();
    if (body == bodies_.end() || body->first != name) {
      added.push_back(&instance);
      continue;
    }
    body->second.number = instance.number;
    if (!(body->second.X_WI == instance.X_WI)) moved.push_back(&instance);
    ++body;
  }
  while (body != bodies_.end()) drop();
  std::vector<const Instance*> changed = added;
  changed.insert(changed.end(), moved.begin(), moved.end());
  std::ranges::sort(added, {}, &Instance::number);
  for (const Instance* instance : added) add(*instance);
  for (const Instance* instance : moved) {
    Body& there = bodies_.at(instance->name);
    scene_.move(there.id, instance->X_WI);
    there.X_WI = instance->X_WI;
  }
  std::ranges::sort(changed, {}, &Instance::number);
  for (const Instance* instance : changed) relieve(instance->name, {instance->X_WI});
}

bool PlacedBodies::may_thread(const Body& tapped, const Body& screw) {
  const auto [entry, is_new] = may_thread_.try_emplace({tapped.kind, screw.kind}, false);
  if (is_new) {
    entry->second = may_form_thread(find_element_(tapped.element), find_element_(screw.element));
  }
  return entry->second;
}

namespace {

/// How bodies of one kind go with those of another: asked once for each kind.
struct Threading {
  bool is_known = false;
  bool taps = false;
  bool screws = false;
};

}  // namespace

void PlacedBodies::relieve(const std::string& name, const std::vector<Pose>& poses) {
  const Body& body = bodies_.at(name);
  // Most bodies are of a kind that is known to form no thread with any other: no need to go through
  // them all.
  const auto is_known_apart = [&](std::size_t tapped, std::size_t screw) {
    const auto known = may_thread_.find({tapped, screw});
    return known != may_thread_.end() && !known->second;
  };
  if (std::ranges::all_of(kinds_, [&](const auto& entry) {
        return is_known_apart(body.kind, entry.second) && is_known_apart(entry.second, body.kind);
      })) {
    return;
  }
  std::vector<Threading> threadings(kinds_.size());
  for (const auto& [other_name, other] : bodies_) {
    if (other.id == body.id) continue;
    Threading& with = threadings[other.kind];
    if (!with.is_known) with = {true, may_thread(body, other), may_thread(other, body)};
    const auto [is_known, taps, screws] = with;
    if (!taps && !screws) continue;
    const Element& mine = find_element_(body.element);
    const Element& theirs = find_element_(other.element);
    // In the frame of the part that has the core hole, where they hold while the screw turns in.
    std::vector<ThreadRelief> reliefs;
    for (const Pose& X_WI : poses) {
      if (taps) add_new(reliefs, thread_reliefs(mine, X_WI, theirs, other.X_WI));
    }
    const bool mine_first = !reliefs.empty();
    for (const Pose& X_WI : poses) {
      if (!screws) continue;
      std::vector<ThreadRelief> more = thread_reliefs(theirs, other.X_WI, mine, X_WI);
      if (mine_first) {
        for (ThreadRelief& relief : more) relief = seen_from(X_WI.inverse() * other.X_WI, relief);
      }
      add_new(reliefs, more);
    }
    bool& relieved = relieved_[std::minmax(body.id, other.id)];
    if (reliefs.empty() && !relieved) continue;
    relieved = !reliefs.empty();
    if (mine_first) {
      scene_.set_reliefs(body.id, other.id, std::move(reliefs));
    } else {
      scene_.set_reliefs(other.id, body.id, std::move(reliefs));
    }
  }
}

std::vector<Touch> PlacedBodies::named(std::span<const BodyVerdict> verdicts) const {
  const auto number = [&](const std::string& name) { return bodies_.at(name).number; };
  std::vector<Touch> touches;
  for (const BodyVerdict& verdict : verdicts) {
    if (verdict.pair.verdict == Verdict::Clear) continue;
    touches.push_back({names_.at(verdict.moving), names_.at(verdict.with), verdict.pair});
  }
  std::ranges::sort(touches, {}, [&](const Touch& touch) {
    return std::pair(number(touch.instance), number(touch.with));
  });
  return touches;
}

std::vector<Touch> PlacedBodies::check(const std::vector<Part>& moving, double tolerance_mm) {
  std::vector<BodyId> ids;
  std::vector<Pose> poses;
  for (const Part& part : moving) {
    ids.push_back(bodies_.at(part.name).id);
    poses.push_back(part.pose);
    relieve(part.name, {part.pose});
  }
  std::vector<Touch> touches = named(scene_.check(ids, poses, {.tolerance_mm = tolerance_mm}));
  for (const Part& part : moving) relieve(part.name, {bodies_.at(part.name).X_WI});
  return touches;
}

PlacedBodies::Path PlacedBodies::sweep(const std::vector<Part>& moving,
                                       const std::vector<Pose>& X_WU, double tolerance_mm) {
  DOWEL_EXPECTS(X_WU.size() >= 2);
  std::vector<BodyId> ids;
  std::vector<Pose> X_UB;
  for (const Part& part : moving) {
    ids.push_back(bodies_.at(part.name).id);
    X_UB.push_back(part.pose);
    relieve(part.name, {X_WU.front() * part.pose, X_WU.back() * part.pose});
  }
  Path path;
  path.X_WU_free = X_WU.back();
  const auto legs = static_cast<double>(X_WU.size() - 1);
  for (std::size_t leg = 0; leg + 1 < X_WU.size(); ++leg) {
    const SweepResult result =
        scene_.sweep(ids, X_UB, X_WU[leg], X_WU[leg + 1], {.tolerance_mm = tolerance_mm});
    if (result.verdict != Verdict::Interference) continue;
    path.free_share = (static_cast<double>(leg) + result.time_of_impact) / legs;
    path.X_WU_free = result.free_pose;
    path.touches = named(result.pairs);
    break;
  }
  for (const Part& part : moving) relieve(part.name, {bodies_.at(part.name).X_WI});
  return path;
}

std::vector<Touch> PlacedBodies::check_all(double tolerance_mm) {
  std::vector<Touch> touches = named(scene_.check_all({.tolerance_mm = tolerance_mm}));
  for (Touch& touch : touches) {
    if (bodies_.at(touch.with).number < bodies_.at(touch.instance).number) {
      std::swap(touch.instance, touch.with);
    }
  }
  std::ranges::sort(touches, {}, [&](const Touch& touch) {
    return std::pair(bodies_.at(touch.instance).number, bodies_.at(touch.with).number);
  });
  return touches;
}

}  // namespace dowel
