// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/subdivision.hpp"

#include <optional>
#include <string>

#include "deformation/subdivision/limit_stencils.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

void check_range(const char* what, int value, int lowest, int highest) {
  if (value < lowest || value > highest)
    throw InputError(std::string("subdivision: ") + what + " is " + std::to_string(value) + ", must be " +
                     std::to_string(lowest) + " to " + std::to_string(highest));
}

/// No level: the modifier passes the cage on.
WeightMatrix unit_weights(Index count) {
  WeightMatrix unit(count, count);
  unit.setIdentity();
  return unit;
}

void check_triangles(const Cage& cage) {
  for (Index face = 0; face < face_count(cage); ++face) {
    const auto [first, last] = corner_range(cage, face);
    if (last - first != 3)
      throw InputError("cage, face " + std::to_string(face) + ": it has " + std::to_string(last - first) +
                       " corners; Loop's scheme subdivides triangles alone: triangulate the cage");
  }
}

/// One grid's small quads, each from its corner of smallest x and y, in the grid's orientation.
void append_grid(const SubdividedVertices& vertices, Index face, Index grid, std::vector<std::array<Index, 4>>& quads) {
  const Index side = vertices.grid_segments(face);
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x)
      quads.push_back({vertices.grid_point(face, grid, x, y), vertices.grid_point(face, grid, x + 1, y),
                       vertices.grid_point(face, grid, x + 1, y + 1), vertices.grid_point(face, grid, x, y + 1)});
}

/// A triangle's small triangles, row by row: those with an edge in this row, and between them those with an edge in the
/// next row.
void append_triangles(const SubdividedVertices& vertices, Index face, std::vector<std::array<Index, 3>>& triangles) {
  const auto point = [&](Index x, Index y) { return vertices.grid_point(face, 0, x, y); };
  for (Index y = 0; y < vertices.segments(); ++y)
    for (Index x = 0; x < vertices.last_in_row(face, y); ++x) {
      triangles.push_back({point(x, y), point(x + 1, y), point(x, y + 1)});
      if (x + 1 < vertices.last_in_row(face, y))
        triangles.push_back({point(x + 1, y), point(x + 1, y + 1), point(x, y + 1)});
    }
}

template <int corners>
Eigen::Matrix<Index, Eigen::Dynamic, corners, Eigen::RowMajor> as_matrix(
    const std::vector<std::array<Index, corners>>& faces) {
  Eigen::Matrix<Index, Eigen::Dynamic, corners, Eigen::RowMajor> matrix(static_cast<Index>(faces.size()), corners);
  for (std::size_t k = 0; k < faces.size(); ++k)
    matrix.row(static_cast<Index>(k)) = Eigen::Map<const Eigen::RowVector<Index, corners>>(faces[k].data());
  return matrix;
}

constexpr int max_levels = 11;  // of Blender's modifier

}  // namespace

WeightMatrix subdivision_weights(const Cage& cage, const SubdivisionOptions& options) {
  check_range("levels", options.levels, 0, max_levels);
  check_range("quality", options.quality, 1, 10);
  check_cage(cage);
  if (options.scheme == SubdivisionScheme::loop) check_triangles(cage);
  const CageEdges edges(cage);
  if (options.levels == 0) return unit_weights(cage.vertex_count);

  const SubdividedVertices vertices(cage, edges, options.scheme, options.levels);
  const Wires wires(cage, edges, !options.simple);
  const std::vector<SurfaceLocation> locations = surface_locations(cage, vertices);
  std::optional<LimitStencils> stencils;
  if (face_count(cage) > 0) stencils.emplace(cage, edges, wires, options);

  WeightRows rows(vertices.count(), cage.vertex_count);
  for (Index vertex = 0; vertex < vertices.count(); ++vertex) {
    const SurfaceLocation& location = locations[at(vertex)];
    if (location.ptex_face >= 0) {
      stencils->add_point(location, rows);
    } else if (vertex < cage.vertex_count) {
      wires.add_vertex(vertex, rows);
    } else {
      const Index inner = vertex - cage.vertex_count, per_edge = vertices.segments() - 1;
      wires.add_edge_point(inner / per_edge, (inner % per_edge + 1.0) / vertices.segments(), rows);
    }
    rows.end_row();
  }
  return rows.matrix();
}

Quads subdivided_faces(const Cage& cage, int levels) {
  check_range("levels", levels, 1, max_levels);
  check_cage(cage);
  const CageEdges edges(cage);
  const SubdividedVertices vertices(cage, edges, SubdivisionScheme::catmull_clark, levels);
  std::vector<std::array<Index, 4>> found;
  for (Index face = 0; face < face_count(cage); ++face)
    for (Index grid = 0; grid < vertices.grid_count(face); ++grid) append_grid(vertices, face, grid, found);
  return as_matrix<4>(found);
}

Triangles subdivided_triangles(const Cage& cage, int levels) {
  check_range("levels", levels, 1, max_levels);
  check_cage(cage);
  check_triangles(cage);
  const CageEdges edges(cage);
  const SubdividedVertices vertices(cage, edges, SubdivisionScheme::loop, levels);
  std::vector<std::array<Index, 3>> found;
  for (Index face = 0; face < face_count(cage); ++face) append_triangles(vertices, face, found);
  return as_matrix<3>(found);
}

}  // namespace stiv
