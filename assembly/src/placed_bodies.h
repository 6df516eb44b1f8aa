#pragma once

// The collision scene of a project: one body for each instance. Internal to Session.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dowel/assembly/project.h"
#include "dowel/assembly/session.h"
#include "dowel/collision/scene.h"

namespace dowel {

/// Keeps a CollisionScene in step with a project's instances and answers by instance name.
class PlacedBodies {
 public:
  using FindElement = std::function<const Element&(const std::string&)>;
  using LoadSolid = std::function<std::shared_ptr<const FacetedSolid>(const std::string&)>;

  PlacedBodies(FindElement find_element, LoadSolid load_solid);

  /// One without bodies that shares the elements' models.
  PlacedBodies empty_copy() const;

  /// Makes the scene that of `state`, touching only what differs.
  void follow(const ProjectState& state);

  /// One of the parts that move as one, and where it is: in the world, or in the frame that they
  /// are fixed to.
  struct Part {
    std::string name;
    Pose pose;
  };

  /// Pairs of the `moving` parts with all others, were they at these poses in the world. Their
  /// threads are taken as they are there.
  std::vector<Touch> check(const std::vector<Part>& moving, double tolerance_mm);
  std::vector<Touch> check(const std::string& moving, const Pose& X_WI, double tolerance_mm) {
    return check(std::vector<Part>{{moving, X_WI}}, tolerance_mm);
  }

  struct Path {
    double free_share = 1.0;
    Pose X_WU_free;              ///< last pose before the interference, or the end
    std::vector<Touch> touches;  ///< at the interference; empty where there is none
  };

  /// First interference on the way of the `moving` parts, posed in the frame U that they are fixed
  /// to, which goes through `X_WU` one after the other.
  Path sweep(const std::vector<Part>& moving, const std::vector<Pose>& X_WU, double tolerance_mm);

  std::vector<Touch> check_all(double tolerance_mm);

  /// The verdict of two bodies as they are placed, whatever was asked before: witnesses and bounds
  /// of the other checks may hang on that.
  PairVerdict pair(const std::string& a, const std::string& b, double tolerance_mm);

  /// An element's model, shared by all its bodies.
  std::shared_ptr<const CollisionElement> shape(const std::string& element);

  /// Forgets an element that no body uses, so that it is loaded anew.
  void forget(const std::string& element);

 private:
  struct Body {
    BodyId id;
    std::uint32_t number = 0;
    std::string element;
    std::size_t kind = 0;  ///< of the element, see `kinds_`
    Pose X_WI;
  };

  /// Declares the threads between `name`, at any of `poses`, and all others.
  void relieve(const std::string& name, const std::vector<Pose>& poses);
  /// Whether a body of one kind may be tapped for one of the other.
  bool may_thread(const Body& tapped, const Body& screw);
  void add(const Instance& instance);
  std::vector<Touch> named(std::span<const BodyVerdict> verdicts) const;

  FindElement find_element_;
  LoadSolid load_solid_;
  CollisionScene scene_;
  std::map<std::string, Body> bodies_;
  std::map<BodyId, std::string> names_;
  std::map<std::string, std::shared_ptr<const CollisionElement>> shapes_;
  std::map<std::string, std::size_t> kinds_;  ///< elements by the order in which they came
  std::map<std::pair<std::size_t, std::size_t>, bool> may_thread_;
  std::map<std::pair<BodyId, BodyId>, bool> relieved_;
};

}  // namespace dowel
