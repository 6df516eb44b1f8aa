#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include "dowel/catalog/feature.h"

namespace dowel::library {

/// A feature as it was designed: geometry in the words of the catalogue, and what a solid cannot
/// tell: its thread and its tolerance class.
struct DesignedFeature {
  Feature geometry;
  std::string thread;  ///< "M12" where it is, or holds, a thread; else empty
  std::string fit;     ///< ISO 286 class of a locating diameter or width: "H7", "g6"; else empty
};

struct Dimension {
  std::string name;
  double value_mm = 0.0;
};

/// One element of the library: its solid and what the generator knows about it. Frame: z up,
/// origin in the centre of the face it is seated on; shanks and threads below it have z < 0.
struct Part {
  std::string name;  ///< product name: "H40-12/riser-80x80x40"
  std::string role;  ///< "base plate", "support", "locator", "clamp", "fastener", "workpiece"
  std::string description;  ///< one line for the librarian
  std::string source;       ///< where its numbers come from
  std::vector<Dimension> dimensions;
  std::vector<DesignedFeature> features;
  std::array<double, 3> colour{};  ///< sRGB 0..1
  TopoDS_Shape solid;
};

/// Along z of a part's frame.
inline const Eigen::Vector3d kUp(0.0, 0.0, 1.0);
inline const Eigen::Vector3d kDown(0.0, 0.0, -1.0);

/// Name of an element of the system: "H40-12/riser-80x80x40" for "riser-80x80x40".
std::string element_name(const std::string& name);

/// A number as it stands in a name: "12", "2.5".
std::string plain(double value);

/// Outside cylinder that grows from `origin` along `direction` for `length_mm`.
DesignedFeature shaft(std::string name, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction, double diameter_mm, double length_mm);

/// Planar face with its centre at `origin`.
DesignedFeature face(std::string name, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& normal);

/// `feature` with a thread, with a tolerance class.
DesignedFeature threaded(DesignedFeature feature, std::string thread);
DesignedFeature fitted(DesignedFeature feature, std::string fit);

}  // namespace dowel::library
