// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// The triangles of a body in two parts, each ascending, by connected components: a figure with open eyes has a closed
/// part all the same.
struct BodyParts {
  std::vector<Index> closed;  ///< of components that bound a volume: every edge runs as often one way as the other
  std::vector<Index> open;
};

BodyParts body_parts(const Surface& surface, Index body);

}  // namespace stiv
