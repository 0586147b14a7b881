// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/subdivision.hpp"

#include <optional>
#include <string>

#include "deformation/limit_stencils.hpp"
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

/// One grid's small quads, each from its corner of smallest x and y, in the grid's orientation.
void append_grid(const SubdividedVertices& vertices, Index face, Index grid, std::vector<std::array<Index, 4>>& quads) {
  const Index side = vertices.grid_segments(face);
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x)
      quads.push_back({vertices.grid_point(face, grid, x, y), vertices.grid_point(face, grid, x + 1, y),
                       vertices.grid_point(face, grid, x + 1, y + 1), vertices.grid_point(face, grid, x, y + 1)});
}

}  // namespace

WeightMatrix subdivision_weights(const Cage& cage, const SubdivisionOptions& options) {
  check_range("levels", options.levels, 0, 6);
  check_range("quality", options.quality, 1, 10);
  check_cage(cage);
  const CageEdges edges(cage);
  if (options.levels == 0) return unit_weights(cage.vertex_count);

  const SubdividedVertices vertices(cage, edges, options.levels);
  const Wires wires(cage, edges, !options.simple);
  const std::vector<SurfaceLocation> locations = surface_locations(cage, vertices);
  std::optional<LimitStencils> stencils;
  if (face_count(cage) > 0) stencils.emplace(cage, edges, wires, options);

  WeightRows rows(vertices.count(), cage.vertex_count);
  for (Index vertex = 0; vertex < vertices.count(); ++vertex) {
    const SurfaceLocation& location = locations[static_cast<std::size_t>(vertex)];
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
  check_range("levels", levels, 1, 6);
  check_cage(cage);
  const CageEdges edges(cage);
  const SubdividedVertices vertices(cage, edges, levels);
  std::vector<std::array<Index, 4>> found;
  for (Index face = 0; face < face_count(cage); ++face)
    for (Index grid = 0; grid < vertices.grid_count(face); ++grid) append_grid(vertices, face, grid, found);
  Quads quads(static_cast<Index>(found.size()), 4);
  for (std::size_t k = 0; k < found.size(); ++k)
    quads.row(static_cast<Index>(k)) = Eigen::Map<const Eigen::RowVector<Index, 4>>(found[k].data());
  return quads;
}

}  // namespace stiv
