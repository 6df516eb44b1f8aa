#pragma once

#include "dowel/collision/model.h"
#include "exact_face.h"

// Tori whose facets are far off them. Private to collision.

namespace dowel {

/// Whether facets are so far off the tube of a torus that its normals miss them, as at fillets that
/// are smaller than the chords of their rims are off. Then angles tell which facet a place belongs
/// to.
bool is_coarse(const Face& face);

/// How far the part of a coarse face for which a facet stands may be from the facet.
double coarse_reach_mm(const Face& face, const ModelTriangle& t);

/// Nearest place to `c`, a place of a coarse face, of the part of it for which a facet stands.
TrianglePoint closest_on_coarse(const Face& face, const ModelTriangle& t, const Eigen::Vector3d& c);

}  // namespace dowel
