#pragma once

#include <new>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>

#include "dowel/kernel/error.h"

namespace dowel {

inline Eigen::Vector3d to_eigen(const gp_XYZ& v) {
  return {v.X(), v.Y(), v.Z()};
}
inline Eigen::Vector3d to_eigen(const gp_Pnt& p) {
  return to_eigen(p.XYZ());
}
inline Eigen::Vector3d to_eigen(const gp_Vec& v) {
  return to_eigen(v.XYZ());
}
inline Eigen::Vector3d to_eigen(const gp_Dir& d) {
  return to_eigen(d.XYZ());
}

/// Runs `action`; what OpenCascade throws leaves as std::bad_alloc or as Error{FileMalformed} that
/// begins with `doing` ("the transfer failed").
template <class Action>
auto guarded(const std::string& doing, const Action& action) {
  try {
    return action();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const char* message = failure.GetMessageString();
    throw Error(ErrorCode::FileMalformed, doing + ": " + failure.DynamicType()->Name() +
                                              (message && *message ? ": " : "") +
                                              (message ? message : ""));
  }
}

}  // namespace dowel
