#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "dowel/io/scene_page.h"

namespace dowel {

/// Where a parallel projection is seen from. Isometric: from right, front and above. Top, front and
/// right are the views of a drawing: against z with y up, along y and against x with z up.
enum class View : std::uint8_t { Isometric, Top, Front, Right };

/// Largest width and height of a snapshot.
inline constexpr std::uint32_t kMaxSnapshot_px = 16384;

struct SnapshotOptions {
  std::uint32_t width_px = 1200;  ///< 1 to kMaxSnapshot_px
  std::uint32_t height_px = 900;  ///< 1 to kMaxSnapshot_px
  View view = View::Isometric;
};

/// PNG picture of a scene on white: shaded faces, edge lines and outlines, colours as in `to_glb`.
/// Drawn in software, without display or GPU: the same scene gives the same bytes. Cost: about
/// nine depth tests a pixel and surface. A scene without facets gives a white picture.
/// Expects: width and height in range; instances as for `to_glb`.
std::vector<std::byte> to_png(const DisplayScene& scene, const SnapshotOptions& options = {});

/// Writes `to_png`. The file appears whole or not at all. Throws Error{FileUnwritable}.
void write_png(const std::filesystem::path& file, const DisplayScene& scene,
               const SnapshotOptions& options = {});

}  // namespace dowel
