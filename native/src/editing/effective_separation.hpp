// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// What of the scene may move, and how large and how far from the origin it is.
struct MovingExtent {
  double diagonal = 0;  ///< of the bounding box of the vertices that some control moves; of all when there are none
  double largest_coordinate = 0;
};

MovingExtent moving_extent(const Surface& surface, const Deformation& deformation, const Positions& q);

/// The least separation that survives storing: four units in the last place of what is stored, in the world and in the
/// frames of the controls. (mathematics.md, Eq. 1)
/// @param frames empty: controls are stored in double precision
double least_separation(const MovingExtent& extent, const Controls& p, const std::vector<StorageFrame>& frames,
                        const std::vector<Index>& rotation_rows);

/// The separation in force: the one asked for, or 1e-4 of the diagonal raised to the least possible.
/// @throws InputError if the one asked for is negative, not finite or below the least possible, which it says
double effective_separation(double asked, const MovingExtent& extent, double least);

/// The separations of all pairs of bodies: `separation` but where others are asked for.
/// @throws InputError if there is no such body, or as effective_separation; 0 is not automatic here but too small
BodySeparations body_separations(const Surface& surface, const std::vector<BodyPairSeparation>& asked,
                                 double separation, const MovingExtent& extent, double least);

}  // namespace stiv
