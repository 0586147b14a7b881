// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "stiv/deformation/subdivision.hpp"

namespace stiv {

/// @throws InputError naming the element: faces with fewer than 3 corners or a corner twice, edges from a vertex to
///         itself, indices out of range, creases out of [0, 1] or of another number than edges or vertices.
void check_cage(const Cage& cage);

/// How the edges and faces of a cage hang together.
class CageEdges {
 public:
  /// @throws InputError naming a face, one of whose edges is missing from the cage's list.
  explicit CageEdges(const Cage& cage);

  /// The edge from a corner of a face to the next one; `corner` counts through the corners of all faces.
  Index of_corner(Index corner) const { return edge_of_corner_[at(corner)]; }

  bool is_loose(Index edge) const { return !in_face_[at(edge)]; }

 private:
  std::vector<Index> edge_of_corner_;
  std::vector<bool> in_face_;
};

/// Corners of face `face` as [first, last) in Cage::face_corners.
inline std::pair<Index, Index> corner_range(const Cage& cage, Index face) {
  return {cage.face_starts[at(face)], cage.face_starts[static_cast<std::size_t>(face) + 1]};
}

inline Index face_count(const Cage& cage) {
  return cage.face_starts.empty() ? 0 : static_cast<Index>(cage.face_starts.size()) - 1;
}

}  // namespace stiv
