#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include "dimensions.h"
#include "dowel/catalog/feature.h"

namespace dowel::library {

struct System;

struct Dimension {
  std::string name;
  double value_mm = 0.0;
};

/// One element of the library: its solid and what the generator knows about it. Its features hold
/// geometry, `use`, `thread` and `fit`, as they were designed; all holes, shafts and slots are
/// among them, and the faces that something is seated on or located by. Frame: z up, origin in the
/// centre of the face it is seated on; shanks and threads below it have z < 0.
struct Part {
  std::string name;  ///< product name: "H40-12/riser-80x80x40"
  std::string
      role;  ///< "base plate", "riser", "support", "locator", "clamp", "fastener", "workpiece"
  std::string description;  ///< one line for the librarian
  std::string source;       ///< where its numbers come from
  Material material = kSteel;
  std::vector<Dimension> dimensions;
  std::vector<Feature> features;
  std::array<double, 3> colour{};  ///< sRGB 0..1
  TopoDS_Shape solid;
};

/// Along z of a part's frame.
inline const Eigen::Vector3d kUp(0.0, 0.0, 1.0);
inline const Eigen::Vector3d kDown(0.0, 0.0, -1.0);

/// Name of an element of the system: "H40-12/riser-80x80x40" for "riser-80x80x40".
std::string element_name(const System& system, const std::string& name);

/// A number as it stands in a name: "12", "2.5".
std::string plain(double value);

/// Outside cylinder that grows from `origin` along `direction` for `length_mm`.
Feature shaft(std::string use, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
              double diameter_mm, double length_mm);

/// The same about the z axis, from `top_z_mm` down: the way of a shaft whose ends are alike.
Feature shaft_down(std::string use, double top_z_mm, double diameter_mm, double length_mm);

/// Planar face with its centre at `origin`.
Feature face(std::string use, const Eigen::Vector3d& origin, const Eigen::Vector3d& normal);

/// `feature` with a thread, with a tolerance class, under a name of a grid.
Feature threaded(Feature feature, std::string_view thread);
Feature fitted(Feature feature, std::string fit);
Feature named(Feature feature, std::string name);

/// Gives the features that have none the names that a catalogue gives them: "h1", "cb2", "pin1",
/// "slot1" in the order of catalog/README.md. Faces keep what they are used for as their name.
void name_features(Part& part);

}  // namespace dowel::library
