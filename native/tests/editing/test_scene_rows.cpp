// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/scene_rows.hpp"

#include <doctest/doctest.h>

using namespace stiv;

TEST_CASE("scene rows: those of events are right, whichever rows were asked for before") {
  const Positions rest = Positions::Random(40, 3), q = Positions::Random(20, 3), later = Positions::Random(20, 3);
  Positions whole(60, 3), whole_later(60, 3);
  whole << q, rest;
  whole_later << later, rest;
  Event event;
  event.vertices = {3, 17, 20, 59};
  const auto are_placed = [&](const Positions& rows, const Positions& expected) {
    for (const Index vertex : event.vertices)
      if (rows.row(vertex) != expected.row(vertex)) return false;
    return rows.rows() == 60;
  };
  for (const bool all_first : {false, true}) {
    SceneRows rows(rest);
    if (all_first) CHECK(rows.with_rest(q) == whole);
    CHECK(are_placed(rows.with_rest_at({event}, q), whole));
    CHECK(are_placed(rows.with_rest_at({event}, later), whole_later));
    CHECK(rows.with_rest(later) == whole_later);
    CHECK(are_placed(rows.with_rest_at({event}, q), whole));
    CHECK(are_placed(rows.with_rest_at(Events(30, event), later), whole_later));
  }
}
