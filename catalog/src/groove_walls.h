#pragma once

#include <array>
#include <vector>

#include "slot_geometry.h"

namespace dowel {

/// A wall that stands on a floor, and what hangs over the floor above it.
struct GrooveSide {
  std::size_t wall = 0;
  std::vector<std::size_t> floors;     ///< patches that it stands on, all in one plane; sorted
  std::vector<std::uint32_t> fillets;  ///< between wall and floor
  Extent run;                          ///< along its own run, see run_of()
  std::vector<std::size_t> ledges;     ///< T-slot: patches that face the floor
  std::vector<std::size_t> throats;    ///< T-slot: walls above them
  bool is_open = true;                 ///< nothing else hangs over the floor
};

/// Two sides that face each other over one floor.
struct GroovePiece {
  std::array<GrooveSide, 2> sides;
  Extent run;  ///< where both walls stand

  bool is_tee() const { return !sides[0].ledges.empty(); }
};

/// Where a wall with that outward normal runs, on a floor that faces `up`.
Eigen::Vector3d run_of(const Eigen::Vector3d& up, const Eigen::Vector3d& normal);

/// Floors in one plane, the largest first, and the pieces of grooves over them. Pieces are in no
/// order, nor are the sides of one.
struct GrooveFloor {
  Eigen::Vector3d up;
  double height_mm = 0.0;  ///< along `up`
  std::vector<GroovePiece> pieces;
};

std::vector<GrooveFloor> groove_floors(const SolidView& view);

}  // namespace dowel
