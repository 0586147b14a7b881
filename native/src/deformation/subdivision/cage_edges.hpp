// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "stiv/deformation/subdivision.hpp"

namespace stiv {

/// @throws InputError naming the element: a face with fewer than 3 corners or a repeated one, an edge from a vertex to
///         itself, an index out of range, a crease out of [0, 1], or the wrong number of creases
void check_cage(const Cage& cage);

/// The incidence of edges and faces of a cage.
class CageEdges {
 public:
  /// @throws InputError naming a face with an edge that the cage does not list
  explicit CageEdges(const Cage& cage);

  /// The edge from a corner of a face to the next one; `corner` is an index into Cage::face_corners.
  Index of_corner(Index corner) const { return edge_of_corner_[at(corner)]; }

  bool is_loose(Index edge) const { return !in_face_[at(edge)]; }

 private:
  std::vector<Index> edge_of_corner_;
  std::vector<bool> in_face_;
};

/// The range [first, last) of a face in Cage::face_corners.
inline std::pair<Index, Index> corner_range(const Cage& cage, Index face) {
  return {cage.face_starts[at(face)], cage.face_starts[static_cast<std::size_t>(face) + 1]};
}

inline Index face_count(const Cage& cage) {
  return cage.face_starts.empty() ? 0 : static_cast<Index>(cage.face_starts.size()) - 1;
}

}  // namespace stiv
