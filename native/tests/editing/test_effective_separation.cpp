// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "editing/effective_separation.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

double unit32(float x) { return std::nextafter(x, std::numeric_limits<float>::infinity()) - x; }

}  // namespace

TEST_CASE("separation: automatic is 1e-4 of the diagonal, but not below single precision") {
  CHECK(effective_separation(0, {10, 5}, 1e-6) == doctest::Approx(1e-3));
  CHECK(effective_separation(0, {10, 5}, 2e-3) == 2e-3);
}

TEST_CASE("separation: the least one is four units in the last place, in the world and in the controls' frames") {
  const Controls p = Controls::Constant(2, 3, 100);
  CHECK(least_separation({1, 1000}, p, {StorageFrame{0, 2}}, {}) == 4 * unit32(1000));
  StorageFrame scaled{0, 2};
  scaled.frame.diagonal() << 8, 8, 8, 1;
  scaled.frame(0, 3) = -8e6;  // the frame's origin is far away: local coordinates are large
  CHECK(least_separation({1, 1000}, p, {scaled}, {}) == doctest::Approx(4 * 8 * unit32(1000012.5F)));
  CHECK(least_separation({1, 1000}, p, {}, {}) < 1e-10);
  const Controls placement = (Controls(2, 3) << 1, 1, 1, 300, 0, 0).finished();
  CHECK(least_separation({1, 1}, placement, {StorageFrame{0, 2}}, {1}) == 4 * unit32(1));
}

TEST_CASE("separation: one that cannot be kept is refused with the least possible") {
  CHECK(effective_separation(1e-3, {10, 5}, 1e-6) == 1e-3);
  CHECK_THROWS_WITH_AS(effective_separation(1e-7, {10, 5}, 2.5e-6), doctest::Contains("2.5e-06"), InputError);
  CHECK_THROWS_AS(effective_separation(-1, {10, 5}, 1e-6), InputError);
  CHECK_THROWS_AS(effective_separation(std::nan(""), {10, 5}, 1e-6), InputError);
}

TEST_CASE("separation: only movable vertices count for the extent") {
  SurfaceDefinition definition;
  definition.vertex_count = 4;
  definition.vertex_body = {0, 0, 1, 1};
  definition.bodies = {{"part", Mobility::deformable}, {"ground", Mobility::fixed}};
  Positions q = Positions::Zero(4, 3);
  q(1, 0) = 3;
  q(1, 1) = 4;
  q(3, 0) = 1e6;
  const MovingExtent extent = moving_extent(Surface(definition), *make_identity(4), q);
  CHECK(extent.diagonal == 5);
  CHECK(extent.largest_coordinate == 4);
  definition.bodies[0].mobility = Mobility::fixed;
  CHECK(moving_extent(Surface(definition), *make_identity(4), q).diagonal == doctest::Approx(1e6));
}
