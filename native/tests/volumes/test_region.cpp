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

Surface points(Index count, Mobility mobility = Mobility::deformable) {
  SurfaceDefinition definition;
  definition.vertex_count = count;
  definition.bodies = {{"falling", mobility}, {"standing", Mobility::fixed}};
  definition.vertex_body.assign(count, 1);
  definition.vertex_body[0] = 0;
  return Surface(definition);
}

/// Regions of events in which vertex 0 falls on a face whose corners are at rest.
std::vector<Region> regions_of(const Events& events, double fall = 1) {
  Positions start(4, 3);
  start << 0.4, 0.3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  Positions end = start;
  end(0, 2) -= fall;
  return earliest_regions(points(4), events, start, end);
}

}  // namespace

TEST_CASE("region: an event belongs to the vertices of largest weight on both sides") {
  const auto regions = regions_of({vertex_on_face(0.5)});
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].vertex == 0);
  CHECK(regions[1].vertex == 2);

  Event edges = vertex_on_face(0.5);
  edges.kind = EventKind::edge_edge;
  edges.weights = {0.4, 0.6, -0.7, -0.3};
  const auto of_edges = regions_of({edges});
  REQUIRE(of_edges.size() == 2);
  CHECK(of_edges[0].vertex == 1);
  CHECK(of_edges[1].vertex == 2);
}

TEST_CASE("region: the earliest event, the first of equals") {
  Events events{vertex_on_face(0.7), vertex_on_face(0.3), vertex_on_face(0.3)};
  for (const Region& region : regions_of(events)) CHECK(region.event == 1);
}

TEST_CASE("region: later usable normals replace unusable ones, and there is no region if all are unusable") {
  Event sliding = vertex_on_face(0.1);
  sliding.normal = Vector3::UnitX();
  Event unknown = vertex_on_face(0.2);
  unknown.normal = Vector3::Zero();
  const auto regions = regions_of({sliding, unknown, vertex_on_face(0.9)});
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].event == 2);
  CHECK(regions_of({sliding, unknown}).empty());
  CHECK(regions_of({vertex_on_face(0.5)}, 0).empty());
}

TEST_CASE("region: nearly parallel edges and contacts at ends count only without others") {
  Positions start(8, 3);
  start << 0, 0, 1, 1, 1e-5, 1, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  Positions end = start;
  for (const Index falling : {0, 1, 4}) end(falling, 2) = -1;
  Event parallel;
  parallel.kind = EventKind::edge_edge;
  parallel.vertices = {0, 1, 2, 3};
  parallel.time = 0.2;
  parallel.weights = {0.6, 0.4, -0.6, -0.4};
  parallel.normal = Vector3::UnitZ();
  Event face = vertex_on_face(0.5);
  face.vertices = {4, 5, 6, 7};
  CHECK(earliest_regions(points(8), {parallel}, start, end).size() == 2);
  CHECK(earliest_regions(points(8), {parallel, face}, start, end).front().vertex == 4);
  end(1, 1) = start(1, 1) = 1;
  CHECK(earliest_regions(points(8), {parallel, face}, start, end).front().vertex == 0);
  parallel.weights = {1, 0, -0.6, -0.4};
  CHECK(earliest_regions(points(8), {parallel, face}, start, end).front().vertex == 4);
}

TEST_CASE("region: per contact, every usable event is a region of its first side") {
  Positions start(4, 3);
  start << 0.4, 0.3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  Positions end = start;
  end(0, 2) = 0;
  Event sliding = vertex_on_face(0.1);
  sliding.normal = Vector3::UnitX();
  const Events events{vertex_on_face(0.7), sliding, vertex_on_face(0.3)};
  const auto regions = contact_regions(points(4), events, start, end);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].event == 0);
  CHECK(regions[1].event == 2);
  for (const Region& region : regions) CHECK(region.vertex == 0);
  const auto rigid = contact_regions(points(4, Mobility::rigid), events, start, end);
  const auto earliest = earliest_regions(points(4, Mobility::rigid), events, start, end);
  REQUIRE(rigid.size() == earliest.size());
  for (std::size_t k = 0; k < rigid.size(); ++k) CHECK(rigid[k].event == earliest[k].event);
}

TEST_CASE("region: later contacts of a rigid body are left out, and many contacts are thinned") {
  Positions start(4, 3);
  start << 0.4, 0.3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  Positions end = start;
  end(0, 2) = 0;
  Event late = vertex_on_face(0.4);
  late.weights = {1, -0.5, -0.2, -0.3};
  const Events events{vertex_on_face(0.3), late};
  CHECK(earliest_regions(points(4), events, start, end).size() == 3);
  const auto regions = earliest_regions(points(4, Mobility::rigid), events, start, end);
  REQUIRE(regions.size() == 2);
  CHECK(regions[1].vertex == 2);
  CHECK(regions[1].rigid);

  const Index many = 300;
  Events spread;
  Positions sheet = Positions::Zero(many, 3);
  for (Index k = 0; k + 3 < many; ++k) {
    spread.push_back(vertex_on_face(0.3));
    spread.back().vertices = {0, k + 1, k + 2, k + 3};
  }
  Positions lifted = sheet;
  lifted(0, 2) = -1;
  CHECK(earliest_regions(points(many), spread, sheet, lifted).size() > 200);
  const std::size_t kept = earliest_regions(points(many, Mobility::rigid), spread, sheet, lifted).size();
  CHECK(kept > 16);
  CHECK(kept <= 32);
}
