// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/motions.hpp"
#include "detection/reference.hpp"
#include "stiv/detection/distance.hpp"

using namespace stiv;

namespace {

/// The weights describe a point of each primitive, and the separation matches them.
void check_consistent(EventKind kind, const std::array<Vector3, 4>& x, const Witness& found) {
  const auto first = static_cast<std::size_t>(first_side_size(kind));
  double sums[2] = {0, 0};
  Vector3 separation = Vector3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const double share = k < first ? found.weights[k] : -found.weights[k];
    CHECK(share >= -1e-15);
    sums[k < first ? 0 : 1] += share;
    separation += found.weights[k] * x[k];
  }
  CHECK(sums[0] == doctest::Approx(1));
  CHECK(sums[1] == doctest::Approx(1));
  CHECK((separation - found.separation).norm() <= 1e-12 * x[0].norm());
  CHECK(found.distance == doctest::Approx(found.separation.norm()));
}

}  // namespace

TEST_CASE("distance: equals another evaluation in extended precision, degenerate shapes included") {
  MotionMaker make(21);
  for (int sort = 0; sort < MotionMaker::far_away; ++sort)
    for (int trial = 0; trial < 500; ++trial)
      for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
        const PairMotion motion = make.make(sort);
        for (const auto& x : {motion.start, motion.end}) {
          const Witness found = witness(kind, x);
          const reference::Points points = reference::at({x, x}, 0);
          CHECK(found.distance ==
                doctest::Approx(static_cast<double>(reference::distance(kind, points))).epsilon(1e-7));
          check_consistent(kind, x, found);
        }
      }
}

TEST_CASE("distance: primitives without extent are points") {
  const Vector3 a(1, 2, 3), b(4, 6, 3);
  CHECK(point_triangle<double>({a, b, b, b}).distance == doctest::Approx(5));
  CHECK(segment_segment<double>({a, a, b, b}).distance == doctest::Approx(5));
  CHECK(point_triangle<double>({a, a, a, a}).distance == 0);
}

TEST_CASE("distance: parallel segments") {
  const Witness apart =
      segment_segment<double>({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(3, 4, 0), Vector3(5, 4, 0)});
  CHECK(apart.distance == doctest::Approx(std::sqrt(20.0)));
  const Witness beside =
      segment_segment<double>({Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(1, 2, 0), Vector3(3, 2, 0)});
  CHECK(beside.distance == doctest::Approx(2));
  const Witness along =
      segment_segment<double>({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(2, 0, 0), Vector3(3, 0, 0)});
  CHECK(along.distance == doctest::Approx(1));
}
