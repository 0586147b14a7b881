// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/subdivision/subdivided_vertices.hpp"

#include <limits>

#include "stiv/error.hpp"

namespace stiv {

namespace {

std::int64_t inner_count(SubdivisionScheme scheme, Index corners, std::int64_t segments) {
  if (scheme == SubdivisionScheme::loop) return (segments - 1) * (segments - 2) / 2;
  const std::int64_t half = segments / 2;
  return corners == 4 ? (segments - 1) * (segments - 1) : 1 + corners * half * (half - 1);
}

}  // namespace

SubdividedVertices::SubdividedVertices(const Cage& cage, const CageEdges& edges, SubdivisionScheme scheme, int levels)
    : cage_(cage), edges_(edges), scheme_(scheme), segments_(Index{1} << levels) {
  std::int64_t next = cage.vertex_count + static_cast<std::int64_t>(cage.edges.rows()) * (segments_ - 1);
  const auto append = [&] {
    if (next > std::numeric_limits<Index>::max())
      throw InputError("subdivision: the result has too many vertices; use fewer levels than " +
                       std::to_string(levels));
    face_first_.push_back(static_cast<Index>(next));
  };
  append();
  for (Index face = 0; face < face_count(cage); ++face) {
    next += inner_count(scheme, corner_count(face), segments_);
    append();
  }
}

Index SubdividedVertices::corner_count(Index face) const {
  const auto [first, last] = corner_range(cage_, face);
  return last - first;
}

bool SubdividedVertices::has_sectors(Index face) const {
  return scheme_ == SubdivisionScheme::catmull_clark && corner_count(face) != 4;
}

Index SubdividedVertices::grid_count(Index face) const { return has_sectors(face) ? corner_count(face) : 1; }

Index SubdividedVertices::grid_segments(Index face) const { return has_sectors(face) ? segments_ / 2 : segments_; }

Index SubdividedVertices::last_in_row(Index face, Index y) const {
  return grid_segments(face) - (scheme_ == SubdivisionScheme::loop ? y : 0);
}

Index SubdividedVertices::grid_point(Index face, Index grid, Index x, Index y) const {
  if (scheme_ == SubdivisionScheme::loop) return triangle_point(face, x, y);
  return has_sectors(face) ? sector_point(face, grid, x, y) : quad_point(face, x, y);
}

/// The k-th point on a side of a face, counted from corner `side` of it, ends included.
Index SubdividedVertices::edge_point(Index face, Index side, Index k) const {
  const auto [first, last] = corner_range(cage_, face);
  const Index from = cage_.face_corners[at(first + side)];
  if (k == 0) return from;
  const Index edge = edges_.of_corner(first + side);
  const bool forward = cage_.edges(edge, 0) == from;
  if (k == segments_) return cage_.edges(edge, forward ? 1 : 0);
  return inner_edge_point(edge, forward ? k : segments_ - k);
}

Index SubdividedVertices::quad_point(Index face, Index x, Index y) const {
  if (y == 0) return edge_point(face, 0, x);
  if (x == segments_) return edge_point(face, 1, y);
  if (y == segments_) return edge_point(face, 2, segments_ - x);
  if (x == 0) return edge_point(face, 3, segments_ - y);
  return face_first_[at(face)] + (y - 1) * (segments_ - 1) + x - 1;
}

Index SubdividedVertices::triangle_point(Index face, Index x, Index y) const {
  if (y == 0) return edge_point(face, 0, x);
  if (x + y == segments_) return edge_point(face, 1, y);
  if (x == 0) return edge_point(face, 2, segments_ - y);
  const Index below = (y - 1) * (segments_ - 1) - y * (y - 1) / 2;  // inner points of the rows 1 to y - 1
  return face_first_[at(face)] + below + x - 1;
}

Index SubdividedVertices::sector_point(Index face, Index sector, Index x, Index y) const {
  const Index half = segments_ / 2, count = grid_count(face);
  const Index centre = face_first_[at(face)];
  const Index previous = sector == 0 ? count - 1 : sector - 1;
  if (y == 0) return edge_point(face, sector, x);
  if (x == 0) return edge_point(face, previous, segments_ - y);
  if (y == half) return x == half ? centre : sector_point(face, previous, half, x);
  return centre + 1 + sector * half * (half - 1) + (y - 1) * half + x - 1;
}

std::vector<SurfaceLocation> surface_locations(const Cage& cage, const SubdividedVertices& vertices) {
  std::vector<SurfaceLocation> locations(static_cast<std::size_t>(vertices.count()));
  Index ptex_face = 0;
  const auto place = [&](Index face, Index grid, Index x, Index y) {
    SurfaceLocation& location = locations[at(vertices.grid_point(face, grid, x, y))];
    const double step = 1.0 / vertices.grid_segments(face);
    if (location.ptex_face < 0) location = {ptex_face + grid, x * step, y * step};
  };
  for (Index face = 0; face < face_count(cage); ++face) {
    const Index side = vertices.grid_segments(face), grids = vertices.grid_count(face);
    // The far row of a sector is the far column of the previous sector, except for the center, which belongs to the
    // first one.
    const bool sectors = vertices.has_sectors(face);
    const Index rows = sectors ? side : side + 1;
    for (Index grid = 0; grid < grids; ++grid)
      for (Index y = 0; y < rows; ++y)
        for (Index x = 0; x <= vertices.last_in_row(face, y); ++x) place(face, grid, x, y);
    if (sectors) place(face, 0, side, side);
    ptex_face += grids;
  }
  return locations;
}

}  // namespace stiv
