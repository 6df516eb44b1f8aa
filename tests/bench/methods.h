#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "checker.h"

namespace dowel::bench {

/// A collision method. The slow ones get fewer poses.
struct Method {
  std::string_view name;
  std::function<std::unique_ptr<Checker>()> make;
  std::size_t stride = 1;  ///< checks every stride-th pose only
  std::size_t most_elements = std::numeric_limits<std::size_t>::max();  ///< of a scene that fits
};

/// "dowel", "dowel first" (stops at the first interference), "dowel paper" (hole triangles
/// dropped), "published" (the paper's method as it stands there), then the peers.
std::vector<Method> all_methods();

/// Those that were found at build time: "FCL OBBRSS" and "FCL OBB", the same in single precision
/// ("... float"), "ODE", "Bullet", "CGAL". After "ODE" our own "AABB tree", which is always there.
std::vector<Method> peers();

/// How dowel is asked.
struct DowelMode {
  double tolerance_mm = kDefaultTolerance_mm;
  HoleMode holes = HoleMode::Exact;
  bool first_only = false;
  bool knows_facets_alone = false;  ///< curved faces as their facets, as of a mesh file
  bool uses_brute_force = false;    ///< all facets of all elements
  SkipSet without = {};
};

std::unique_ptr<Checker> make_dowel(const DowelMode& mode);
std::unique_ptr<Checker> make_published();
std::unique_ptr<Checker> make_fcl_obbrss();
std::unique_ptr<Checker> make_fcl_obb();
std::unique_ptr<Checker> make_fcl_obbrss_float();
std::unique_ptr<Checker> make_fcl_obb_float();
std::unique_ptr<Checker> make_ode();
std::unique_ptr<Checker> make_aabb_tree();
std::unique_ptr<Checker> make_bullet();
std::unique_ptr<Checker> make_cgal();

}  // namespace dowel::bench
