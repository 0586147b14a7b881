// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/subdivision/surface_locations.hpp"

namespace stiv {

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
    // The far row of a sector is the far column of the one before it, except for the centre, which is the first's.
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
