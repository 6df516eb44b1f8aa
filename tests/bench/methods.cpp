#include "methods.h"

#include <algorithm>
#include <iterator>

namespace dowel::bench {

std::vector<Method> all_methods() {
  std::vector<Method> methods{
      {"dowel", [] { return make_dowel({}); }},
      {"dowel first", [] { return make_dowel({.first_only = true}); }},
      {"dowel paper", [] { return make_dowel({.holes = HoleMode::Paper}); }},
      {"published", make_published, 5, 10'000}};
  std::ranges::move(peers(), std::back_inserter(methods));
  return methods;
}

std::vector<Method> peers() {
  return {
#ifdef DOWEL_BENCH_FCL
      {"FCL OBBRSS", make_fcl_obbrss},
      {"FCL OBB", make_fcl_obb},
      {"FCL OBBRSS float", make_fcl_obbrss_float},
      {"FCL OBB float", make_fcl_obb_float},
#endif
#ifdef DOWEL_BENCH_ODE
      {"ODE", make_ode, 1, 10'000},
#endif
      {"AABB tree", make_aabb_tree},
#ifdef DOWEL_BENCH_BULLET
      {"Bullet", make_bullet},
#endif
#ifdef DOWEL_BENCH_CGAL
      {"CGAL", make_cgal, 5, 10'000},
#endif
  };
}

}  // namespace dowel::bench
