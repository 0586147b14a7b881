// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/volumes/region.hpp"

using namespace stiv;

namespace {

/// A vertex 0 that meets face (1, 2, 3) nearest to corner 2, from above.
Event vertex_on_face(double time) {
  Event event;
  event.vertices = {0, 1, 2, 3};
  event.time = time;
  event.weights = {1, -0.2, -0.5, -0.3};
  event.normal = Vector3::UnitZ();
  return event;
}

Positions downward(Index falling) {
  Positions displacement = Positions::Zero(5, 3);
  displacement(falling, 2) = -1;
  return displacement;
}

}  // namespace

TEST_CASE("region: an event falls into the cells of the heaviest vertex of either side") {
  const auto regions = earliest_regions({vertex_on_face(0.5)}, downward(0));
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].vertex == 0);
  CHECK(regions[1].vertex == 2);

  Event edges = vertex_on_face(0.5);
  edges.kind = EventKind::edge_edge;
  edges.weights = {0.4, 0.6, -0.7, -0.3};
  const auto of_edges = earliest_regions({edges}, downward(0));
  REQUIRE(of_edges.size() == 2);
  CHECK(of_edges[0].vertex == 1);
  CHECK(of_edges[1].vertex == 2);
}

TEST_CASE("region: the earliest event is kept, of equal ones the first") {
  Events events{vertex_on_face(0.7), vertex_on_face(0.3), vertex_on_face(0.3)};
  for (const Region& region : earliest_regions(events, downward(0))) CHECK(region.event == 1);
}

TEST_CASE("region: an unusable normal gives way to a later usable one, and none is left when all are") {
  Event sliding = vertex_on_face(0.1);
  sliding.normal = Vector3::UnitX();
  Event unknown = vertex_on_face(0.2);
  unknown.normal = Vector3::Zero();
  const auto regions = earliest_regions({sliding, unknown, vertex_on_face(0.9)}, downward(0));
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].event == 2);
  CHECK(earliest_regions({sliding, unknown}, downward(0)).empty());
  CHECK(earliest_regions({vertex_on_face(0.5)}, Positions::Zero(5, 3)).empty());
}
