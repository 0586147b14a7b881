// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/displaced_bodies.hpp"

namespace stiv {

std::vector<unsigned char> displaced_bodies(const Surface& surface, const Positions& from, const Positions& to) {
  std::vector<unsigned char> displaced(surface.bodies().size(), 0);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (from.row(vertex) != to.row(vertex)) displaced[at(surface.body_of(vertex))] = 1;
  return displaced;
}

}  // namespace stiv
