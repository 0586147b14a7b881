// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/large_body.hpp"

#include <doctest/doctest.h>

#include "editing/sessions.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// Mean edge of a sheet of this many cells a side, beside another one.
double mean_edge(Index cells, Mobility mobility) {
  Positions q(0, 3);
  Triangles triangles(0, 3);
  append_sheet(q, triangles, cells, 2, Vector3::Zero());
  const auto first = static_cast<Index>(q.rows());
  append_sheet(q, triangles, 3, 1, Vector3(0, 0, 1));
  return mean_edge_of_large_bodies(
      *surface_of(triangles, first, static_cast<Index>(q.rows()) - first, mobility, Mobility::fixed), q);
}

}  // namespace

TEST_CASE("large body: the mean edge of bodies with many vertices that may move") {
  const double edge = 2.0 / 127;  // two thirds of the edges have this length, the others are diagonals
  const double mean = mean_edge(127, Mobility::deformable);
  CHECK(mean > edge);
  CHECK(mean < 1.42 * edge);
  CHECK(mean_edge(127, Mobility::fixed) == 0);
  CHECK(mean_edge(126, Mobility::deformable) == 0);
}
