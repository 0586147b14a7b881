// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "acceptance/shapes.hpp"
#include "stiv/acceptance/step_check.hpp"

using namespace stiv;

namespace {

bool step_is_free(const Assembly& start, const Positions& end, double separation = 0) {
  const auto surface = start.surface();
  Detector detector(surface);
  IntersectionTest intersections(surface);
  Execution execution(2);
  return is_step_free(detector, intersections, start.q, end, {separation}, execution);
}

}  // namespace

TEST_CASE("is_step_free: a ring pulled through a linked one and out again is not free") {
  const Assembly linked = linked_tori(16, 10, 0), beside = linked_tori(16, 10, 6);
  IntersectionTest test(beside.surface());
  Execution execution(1);
  CHECK(test.is_free(beside.q, {}, execution));
  CHECK_FALSE(step_is_free(linked, beside.q));
  CHECK_FALSE(step_is_free(beside, linked.q));
}

TEST_CASE("is_step_free: a step away from others, and one that ends in contact") {
  const Assembly linked = linked_tori(16, 10, 0);
  CHECK(step_is_free(linked, linked.q));
  CHECK(step_is_free(linked, linked_tori(16, 10, 0.2).q));
  CHECK_FALSE(step_is_free(linked, linked_tori(16, 10, 0.95).q, 0.2));
  CHECK_FALSE(step_is_free(linked, linked_tori(16, 10, 1.1).q));
}

TEST_CASE("is_step_free: neighbours folded flat at the end of the step") {
  Assembly wings;
  wings.begin_body(4, Mobility::deformable);
  wings.q << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, -1, 0;
  wings.add_triangle(0, 1, 2);
  wings.add_triangle(1, 0, 3);
  Positions folded = wings.q, bent = wings.q;
  folded.row(3) << 2.5, 1, 0;
  bent.row(3) << 0.5, 0, 1;
  CHECK(step_is_free(wings, bent));
  Assembly upright = wings;
  upright.q = bent;
  CHECK_FALSE(step_is_free(upright, folded));
}
