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

  /// Makes the scene that of `state`, touching only what differs.
  void follow(const ProjectState& state);

  /// Pairs of `moving`, were it at `X_WI`. Its threads are taken as they are there.
  std::vector<Touch> check(const std::string& moving, const Pose& X_WI, double tolerance_mm);

  struct Path {
    double free_share = 1.0;
    Pose X_WI_free;              ///< last pose before the interference, or the end
    std::vector<Touch> touches;  ///< at the interference; empty where there is none
  };

  /// First interference on the way of `moving` from where it is: the frame U that it is fixed to
  /// goes through `X_WU` one after the other.
  Path sweep(const std::string& moving, const std::vector<Pose>& X_WU, double tolerance_mm);

  std::vector<Touch> check_all(double tolerance_mm);

  /// Forgets an element that no body uses, so that it is loaded anew.
  void forget(const std::string& element);

 private:
  struct Body {
    BodyId id;
    std::uint32_t number = 0;
    std::string element;
    Pose X_WI;
  };

  std::shared_ptr<const CollisionElement> shape(const std::string& element);
  /// Declares the threads between `name`, at any of `poses`, and all others.
  void relieve(const std::string& name, const std::vector<Pose>& poses);
  bool may_thread(const std::string& tapped, const std::string& screw);
  std::vector<Touch> named(std::span<const BodyVerdict> verdicts) const;

  FindElement find_element_;
  LoadSolid load_solid_;
  CollisionScene scene_;
  std::map<std::string, Body> bodies_;
  std::map<BodyId, std::string> names_;
  std::map<std::string, std::shared_ptr<const CollisionElement>> shapes_;
  std::map<std::pair<std::string, std::string>, bool> may_thread_;
  std::map<std::pair<BodyId, BodyId>, bool> relieved_;
};

}  // namespace dowel
