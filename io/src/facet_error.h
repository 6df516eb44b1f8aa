#pragma once

#include <Poly_Triangulation.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Trsf.hxx>

#include "dowel/kernel/surface.h"

namespace dowel {

/// Largest distance found between the facets of a face and its surface, over the facets' corners,
/// edge midpoints and inner points. `placement` takes the nodes to the frame of `surface`. For
/// OtherSurface the distance is to the face's own surface, near each point's (u, v).
double facet_error_mm(const TopoDS_Face& face, const Poly_Triangulation& facets,
                      const gp_Trsf& placement, const Surface& surface);

/// The same over the facets' corners alone, for a surface that is not OtherSurface: how far the
/// face's boundary strays from the surface that the file claims for it.
double corner_error_mm(const Poly_Triangulation& facets, const gp_Trsf& placement,
                       const Surface& surface);

}  // namespace dowel
