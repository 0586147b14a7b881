// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/deformation.hpp"

namespace stiv {

/// One part of a concatenation: a deformation and the vertices of the whole surface that it moves, in its own order.
struct DeformationPart {
  std::shared_ptr<const Deformation> deformation;
  std::vector<Index> vertices;
};

/// Several deformations side by side on one surface; controls are stacked in the order of the parts. Vertices that no
/// part moves stay at `start`, (N, 3). Each part keeps its own metric block.
/// @throws InputError: a vertex out of range or moved by two parts, a part whose vertex count does not fit.
std::shared_ptr<const Deformation> make_concatenation(std::vector<DeformationPart> parts, Positions start);

}  // namespace stiv
