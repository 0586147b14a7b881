// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/subdivision/cage_edges.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "stiv/error.hpp"

namespace stiv {

namespace {

void check_vertex(const Cage& cage, Index vertex, const std::string& owner) {
  if (vertex < 0 || vertex >= cage.vertex_count)
    throw InputError("cage, " + owner + ": vertex " + std::to_string(vertex) + " does not exist; there are " +
                     std::to_string(cage.vertex_count));
}

void check_edges(const Cage& cage) {
  for (Index edge = 0; edge < cage.edges.rows(); ++edge) {
    const std::string name = "edge " + std::to_string(edge);
    for (Index end = 0; end < 2; ++end) check_vertex(cage, cage.edges(edge, end), name);
    if (cage.edges(edge, 0) == cage.edges(edge, 1))
      throw InputError("cage, " + name + ": both ends are the same vertex");
  }
}

void check_face_starts(const Cage& cage) {
  const std::vector<Index>& starts = cage.face_starts;
  const bool fits = starts.empty()
                        ? cage.face_corners.empty()
                        : starts.front() == 0 && starts.back() == static_cast<Index>(cage.face_corners.size());
  if (!fits) throw InputError("cage: the starts of the faces must begin with 0 and end with the number of corners");
  for (std::size_t face = 0; face + 1 < starts.size(); ++face)
    if (starts[face + 1] - starts[face] < 3)
      throw InputError("cage, face " + std::to_string(face) + ": a face needs at least 3 corners");
}

void check_faces(const Cage& cage) {
  check_face_starts(cage);
  for (Index face = 0; face < face_count(cage); ++face) {
    const std::string name = "face " + std::to_string(face);
    const auto [first, last] = corner_range(cage, face);
    std::vector<Index> corners(cage.face_corners.begin() + first, cage.face_corners.begin() + last);
    for (const Index vertex : corners) check_vertex(cage, vertex, name);
    std::sort(corners.begin(), corners.end());
    const auto twice = std::adjacent_find(corners.begin(), corners.end());
    if (twice != corners.end())
      throw InputError("cage, " + name + ": vertex " + std::to_string(*twice) + " is a corner twice; split the face");
  }
}

void check_creases(const std::vector<float>& creases, Index count, const std::string& element) {
  if (creases.empty()) return;
  if (static_cast<Index>(creases.size()) != count)
    throw InputError("cage: " + std::to_string(creases.size()) + " creases for " + std::to_string(count) + " " +
                     element + "s; give one for each, or none");
  for (std::size_t k = 0; k < creases.size(); ++k)
    if (!(creases[k] >= 0 && creases[k] <= 1))
      throw InputError("cage, " + element + " " + std::to_string(k) + ": crease must be in [0, 1]");
}

/// Ends in ascending order, then the edge: if several edges join two vertices, the first one sorts first.
using EdgeKey = std::tuple<Index, Index, Index>;

std::vector<EdgeKey> sorted_edges(const Cage& cage) {
  std::vector<EdgeKey> keys;
  for (Index edge = 0; edge < cage.edges.rows(); ++edge) {
    const auto [a, b] = std::minmax({cage.edges(edge, 0), cage.edges(edge, 1)});
    keys.emplace_back(a, b, edge);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

Index find_edge(const std::vector<EdgeKey>& keys, Index face, Index from, Index to) {
  const auto [a, b] = std::minmax({from, to});
  const auto found = std::lower_bound(keys.begin(), keys.end(), EdgeKey(a, b, 0));
  if (found == keys.end() || std::get<0>(*found) != a || std::get<1>(*found) != b)
    throw InputError("cage, face " + std::to_string(face) + ": its edge between vertices " + std::to_string(from) +
                     " and " + std::to_string(to) + " is missing from the list of edges");
  return std::get<2>(*found);
}

}  // namespace

void check_cage(const Cage& cage) {
  if (cage.vertex_count < 0) throw InputError("cage: the number of vertices is negative");
  check_edges(cage);
  check_faces(cage);
  check_creases(cage.edge_crease, static_cast<Index>(cage.edges.rows()), "edge");
  check_creases(cage.vertex_crease, cage.vertex_count, "vertex");
}

CageEdges::CageEdges(const Cage& cage)
    : edge_of_corner_(cage.face_corners.size()), in_face_(static_cast<std::size_t>(cage.edges.rows()), false) {
  const std::vector<EdgeKey> keys = sorted_edges(cage);
  for (Index face = 0; face < face_count(cage); ++face) {
    const auto [first, last] = corner_range(cage, face);
    for (Index corner = first; corner < last; ++corner) {
      const Index next = corner + 1 == last ? first : corner + 1;
      const Index edge = find_edge(keys, face, cage.face_corners[at(corner)], cage.face_corners[at(next)]);
      edge_of_corner_[at(corner)] = edge;
      in_face_[at(edge)] = true;
    }
  }
}

}  // namespace stiv
