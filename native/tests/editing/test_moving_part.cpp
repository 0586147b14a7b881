// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/scenes.hpp"
#include "editing/moving_part.hpp"
#include "stiv/volumes/relative.hpp"

using namespace stiv;

namespace {

/// Sheets of which one, or none, may move.
struct Scene {
  std::shared_ptr<const Surface> surface;
  Positions start, end;

  Scene(Index size, int sheets, int moving) {
    const MovingScene scene = stirred_sheets(size, sheets, 0.06, 1);
    SurfaceDefinition definition = scene.surface->definition();
    start = end = scene.start;
    for (int body = 0; body < sheets; ++body)
      if (body != moving) definition.bodies[at(body)].mobility = Mobility::fixed;
    if (moving >= 0)
      end.middleRows(moving * size * size, size * size) = scene.end.middleRows(moving * size * size, size * size);
    surface = std::make_shared<const Surface>(definition);
  }
};

const Positions no_obstacles = Positions(0, 3);

}  // namespace

TEST_CASE("moving part: distances and areas have the bits of whole surfaces") {
  for (const Index size : {3, 7, 11})
    for (const int moving : {0, 1, 2}) {
      const Scene scene(size, 3, moving);
      const MovingPart part(scene.surface, no_obstacles);
      CHECK(part.energy(scene.start, scene.end) == 0.5 * (scene.start - scene.end).squaredNorm());
      CHECK(part.energy(scene.start, scene.end) > 0);
      CHECK(part.longest_displacement(scene.start, scene.end) == (scene.end - scene.start).rowwise().norm().maxCoeff());
      for (const Positions* q : {&scene.start, &scene.end, &scene.start})
        CHECK(part.region_areas(*q, Execution(2)) == region_areas(*scene.surface, *q));
    }
}

TEST_CASE("moving part: vertices without an area get the mean of all others, while there are any") {
  for (const Index missing : {0, 13, 26}) {  // in each of three sheets, of which the middle one moves
    const Scene scene(3, 3, 1);
    SurfaceDefinition definition = scene.surface->definition();
    const Triangles all = definition.triangles;
    Index count = 0;
    for (Index row = 0; row < all.rows(); ++row)
      if ((all.row(row).array() != missing).all()) definition.triangles.row(count++) = all.row(row);
    definition.triangles.conservativeResize(count, 3);
    const auto surface = std::make_shared<const Surface>(definition);
    const MovingPart part(surface, no_obstacles);
    Positions flat = scene.end;
    flat.middleRows(9, 9).setZero();  // triangles without area
    for (const Positions& q : {scene.start, flat, scene.end, scene.start})
      CHECK(part.region_areas(q, Execution(2)) == region_areas(*surface, q));
  }
}

TEST_CASE("moving part: of fixed bodies alone, and of no vertices") {
  const Scene fixed(3, 2, -1);
  CHECK(MovingPart(fixed.surface, no_obstacles).energy(fixed.start, fixed.end) == 0);
  CHECK(MovingPart(fixed.surface, no_obstacles).longest_displacement(fixed.start, fixed.end) == 0);
  CHECK(MovingPart(fixed.surface, no_obstacles).region_areas(fixed.start, Execution(1)) ==
        region_areas(*fixed.surface, fixed.start));
  const MovingPart none(std::make_shared<const Surface>(SurfaceDefinition{}), no_obstacles);
  CHECK(none.longest_displacement(Positions(0, 3), Positions(0, 3)) == 0);
  CHECK(none.region_areas(Positions(0, 3), Execution(1)).size() == 0);
}
