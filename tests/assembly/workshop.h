#pragma once

// A session over the elements of fixture_elements.h.

#include <memory>
#include <string>

#include "dowel/assembly/session.h"
#include "fixture_elements.h"
#include "program.h"

namespace dowel::testing {

/// A session in memory with the fixture catalogue and a grounded plate: 240 x 160 x 40, top at
/// z = 40, holes A1 to C5 with B3 in the middle.
struct Workshop {
  TemporaryFolder folder;
  Session session{Project()};

  Workshop() {
    write_fixture_catalog(folder / "catalog.db");
    session.use_catalog(
        std::make_shared<const Catalog>(folder / "catalog.db", Catalog::Access::ReadOnly));
    place("T/plate-5x3", "PLATE", {0, 0, 0});
    session.set_grounded("PLATE", true, "ground");
  }

  MoveReport place(const std::string& element, const std::string& name, const Eigen::Vector3d& at) {
    return session.place(element, name, Pose::from_translation(at), "place " + name);
  }

  MoveReport insert(const FeatureName& moving, const FeatureName& fixed, double offset_mm = 0.0) {
    return session.mate({.kind = {},
                         .moving = moving,
                         .fixed = fixed,
                         .seat = {},
                         .options = {.offset_mm = offset_mm}},
                        "mate insert");
  }

  MoveReport mate(MateKind kind, const FeatureName& moving, const FeatureName& fixed) {
    return session.mate({.kind = kind, .moving = moving, .fixed = fixed, .seat = {}, .options = {}},
                        "mate");
  }

  /// A block standing on the plate, its middle at x, y.
  void stand_block(const std::string& name, double x_mm, double y_mm) {
    place("T/block-40", name, {x_mm, y_mm, 60});
    mate(MateKind::FaceOnFace, {name, "bottom"}, {"PLATE", "top"});
  }

  DragReport drag(const std::string& name, const Eigen::Vector3d& by_mm_W,
                  std::optional<DragMode> mode = {}) {
    DragRequest request;
    request.instance = name;
    request.by_mm_W = by_mm_W;
    request.mode = mode;
    return session.drag(request, "drag " + name);
  }

  Eigen::Vector3d where(const std::string& name) {
    return session.instance(name).X_WI.translation();
  }
};

}  // namespace dowel::testing
