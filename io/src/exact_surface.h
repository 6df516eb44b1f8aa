#pragma once

#include <Eigen/Core>
#include <TopoDS_Face.hxx>

#include "dowel/kernel/surface.h"

namespace dowel {

/// The untrimmed surface of `face` in the frame of its shape, without regard to its orientation (a
/// plane's normal is the geometric one). Trimmed and offset wrappers, extrusions and revolutions of
/// lines and circles, and flat B-splines become what they are. `inside`: any point of the face; it
/// tells the nappe of a cone. OtherSurface for all else.
Surface exact_surface(const TopoDS_Face& face, const Eigen::Vector3d& inside);

}  // namespace dowel
