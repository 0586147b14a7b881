// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The extent of the vertices that may move.
struct MovingExtent {
  double diagonal = 0;  ///< of their bounding box; of all vertices if none may move
  double largest_coordinate = 0;
};

MovingExtent moving_extent(const Surface& surface, const Deformation& deformation, const Positions& q);

/// The least separation that survives storing: four units in the last place, in the world and in the frames of
/// the controls. (mathematics.md, Eq. 1)
/// @param frames empty: controls are stored in double precision
double least_separation(const MovingExtent& extent, const Controls& p, const std::vector<StorageFrame>& frames,
                        const std::vector<Index>& rows_without_length);

/// The requested separation, or 1e-4 of the diagonal for 0, raised to the least possible.
/// @throws InputError if the request is negative, not finite or below the least possible, which the message names
double effective_separation(double asked, const MovingExtent& extent, double least);

/// @throws InputError if a body of a requested pair does not exist
void check_body(Index body, std::size_t bodies);

/// The separations of all pairs of bodies: `separation`, except for the requested pairs.
/// @throws InputError if a body does not exist, or as effective_separation; 0 is too small here, not automatic
BodySeparations body_separations(const Surface& surface, const std::vector<BodyPairSeparation>& asked,
                                 double separation, const MovingExtent& extent, double least);

}  // namespace stiv
