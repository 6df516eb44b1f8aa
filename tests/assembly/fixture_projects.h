#pragma once

// Small fixtures that the rules are tried on.

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "dowel/assembly/session.h"
#include "dowel/catalog/recognition.h"
#include "dowel/kernel/mass_properties.h"
#include "fixture_elements.h"

namespace dowel::testing {

/// A box with its bottom at z = 0 and faces "top" and "bottom".
inline ProjectElement box_element(const std::string& name, const Eigen::Vector3d& size,
                                  const std::string& role) {
  const double area_mm2 = size.x() * size.y();
  ProjectElement element =
      element_of(name, box(size, {0, 0, size.z() / 2.0}),
                 {face_feature("top", {0, 0, size.z()}, Eigen::Vector3d::UnitZ(), area_mm2),
                  face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), area_mm2)});
  element.element.role = role;
  element.element.licence = "Apache-2.0";
  element.element.density_kg_per_m3 = 7850.0;
  element.element.center_of_mass = {0, 0, size.z() / 2.0};
  return element;
}

/// A project under construction: instances at places, held to the plate by mates of kind fix.
class FixtureBuilder {
 public:
  FixtureBuilder() {
    ProjectElement plate = plate_element();
    plate.element.role = "base plate";
    add_element(std::move(plate));
    place("T/plate-5x3", "PLATE", {0, 0, 0});
    state.instances.at("PLATE").grounded = true;
  }

  void add_element(ProjectElement element) {
    element.element.licence = "Apache-2.0";
    element.element.sha256 = std::string(64, '0');
    element.element.density_kg_per_m3 = 7850.0;
    element.element.triangles =
        count_triangles(*element.solid, classify_faces(*element.solid, element.element.features));
    element.element.volume_mm3 = mass_properties(*element.solid).volume_mm3;
    for (const Face& face : element.solid->faces) {
      element.element.facet_error_mm =
          std::max(element.element.facet_error_mm, face.facet_error_mm);
    }
    elements.push_back(std::move(element));
  }

  void add_box(const std::string& name, const Eigen::Vector3d& size, const std::string& role) {
    add_element(box_element(name, size, role));
  }

  void place(const std::string& element, const std::string& name, const Eigen::Vector3d& at) {
    Instance instance;
    for (const auto& [known, other] : state.instances) {
      instance.number = std::max(instance.number, other.number);
    }
    ++instance.number;
    instance.name = name;
    instance.element = element;
    instance.X_WI = Pose(Eigen::Quaterniond::Identity(), at);
    state.instances[name] = instance;
  }

  void remove(const std::string& name) {
    state.instances.erase(name);
    std::erase_if(state.mates,
                  [&](const auto& entry) { return entry.second.moving.instance == name; });
  }

  /// Held to the plate where it is.
  void fix(const std::string& name) {
    Mate mate;
    mate.number = static_cast<std::uint32_t>(state.mates.size() + 1);
    mate.kind = MateKind::Fix;
    mate.moving = {name, ""};
    mate.fixed = {"PLATE", ""};
    mate.X_FM = state.instances.at(name).X_WI;
    state.mates[mate.number] = mate;
  }

  std::unique_ptr<Session> session() const {
    Project project;
    project.commit("build", state, elements);
    return std::make_unique<Session>(std::move(project));
  }

  ProjectState state;
  std::vector<ProjectElement> elements;
};

/// A block on three supports against three locators, pressed down by a clamp: nothing is wrong with
/// it. World = plate, whose top is at z = 40; the block is 120 x 80 x 30 with its bottom at z = 60.
inline FixtureBuilder sound_fixture() {
  FixtureBuilder builder;
  builder.add_box("T/rest-16x16x20", {16, 16, 20}, "support");
  builder.add_box("T/stop-16x16x40", {16, 16, 40}, "locator");
  builder.add_box("T/clamp-16x16x20", {16, 16, 20}, "clamp");
  builder.add_box("W/block-120x80x30", {120, 80, 30}, "workpiece");
  for (const auto& [name, x, y] :
       {std::tuple("REST1", -50.0, -30.0), std::tuple("REST2", 50.0, -30.0),
        std::tuple("REST3", 0.0, 30.0)}) {
    builder.place("T/rest-16x16x20", name, {x, y, 40});
    builder.fix(name);
  }
  for (const auto& [name, x, y] :
       {std::tuple("STOP1", -40.0, -48.0), std::tuple("STOP2", 40.0, -48.0),
        std::tuple("STOP3", -68.0, 0.0)}) {
    builder.place("T/stop-16x16x40", name, {x, y, 40});
    builder.fix(name);
  }
  builder.place("W/block-120x80x30", "WORK", {0, 0, 60});
  builder.place("T/clamp-16x16x20", "CLAMP", {0, -10, 90});
  builder.fix("CLAMP");
  FixtureDesign& design = builder.state.design;
  design.clamp_forces_N["CLAMP"] = 6000.0;
  design.loads["CUT"] = {{300, 0, 0}, {0, 0, 90}, {0, 0, 0}};
  design.points["BORE"] = {{30, 30, 90}, 0.2};
  return builder;
}

/// The block of the sound fixture on two pins instead of stops: a round one and a diamond, or two
/// round ones.
inline FixtureBuilder pinned_fixture(bool with_diamond) {
  FixtureBuilder builder = sound_fixture();
  for (const char* name : {"STOP1", "STOP2", "STOP3", "WORK"}) builder.remove(name);
  DrilledHole left;
  left.radius_mm = 6.0;
  left.x = -20.0;
  DrilledHole right = left;
  right.x = 20.0;
  ProjectElement work = element_of(
      "W/drilled-120x80x30", plate_with_holes({120, 80, 30}, {left, right}, 24),
      {hole_feature("h1", {-20, 0, 30}, -Eigen::Vector3d::UnitZ(), {{12.0, 30.0}}, true),
       hole_feature("h2", {20, 0, 30}, -Eigen::Vector3d::UnitZ(), {{12.0, 30.0}}, true)});
  work.element.role = "workpiece";
  builder.add_element(work);
  builder.place("W/drilled-120x80x30", "WORK", {0, 0, 60});
  builder.state.design.clamp_forces_N["CLAMP"] = 6000.0;
  const auto shank = shaft_feature("pin1", {0, 0, 30}, -Eigen::Vector3d::UnitZ(), 11.99, 30.0);
  const auto foot = face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), 112.0);
  ProjectElement round = element_of("T/pin-round", cylinder(5.995, 30.0, 24), {shank, foot});
  round.element.role = "locator";
  builder.add_element(round);
  builder.place("T/pin-round", "PIN1", {-20, 0, 40});
  if (with_diamond) {
    ProjectElement diamond =
        element_of("T/pin-diamond", box({0.6, 11.98, 30}, {0, 0, 15}), {shank});
    diamond.element.role = "locator";
    builder.add_element(diamond);
  }
  builder.place(with_diamond ? "T/pin-diamond" : "T/pin-round", "PIN2", {20, 0, 40});
  builder.fix("PIN1");
  builder.fix("PIN2");
  return builder;
}

}  // namespace dowel::testing
