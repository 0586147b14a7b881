// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two sheets, one above the other. The upper one is pushed into the lower one; it stops there, and both deform.
//
//     cmake -S native/examples/two_sheets -B build/two_sheets -DCMAKE_PREFIX_PATH=/where/stiv/is/installed
//     cmake --build build/two_sheets && build/two_sheets/two_sheets

#include <iostream>
#include <memory>
#include <stiv/acceptance/intersections.hpp>
#include <stiv/deformation/linear.hpp>
#include <stiv/editing/session.hpp>
#include <stiv/error.hpp>
#include <stiv/surface.hpp>

namespace {

constexpr stiv::Index side = 21;  // vertices along each side of a sheet
constexpr stiv::Index count = side * side;

/// A square sheet of half width 1 at a height.
stiv::Positions sheet(double height) {
  stiv::Positions q(count, 3);
  for (stiv::Index i = 0; i < count; ++i) {
    q.row(i) << 2.0 * (i / side) / (side - 1) - 1.0, 2.0 * (i % side) / (side - 1) - 1.0, height;
  }
  return q;
}

/// The triangles of both sheets: those of the second have vertices count, count + 1, ...
stiv::Triangles triangles() {
  const stiv::Index quads = (side - 1) * (side - 1);
  stiv::Triangles result(4 * quads, 3);
  stiv::Index row = 0;
  for (stiv::Index first : {0, count}) {
    for (stiv::Index quad = 0; quad < quads; ++quad) {
      const stiv::Index a = first + quad / (side - 1) * side + quad % (side - 1);
      result.row(row++) << a, a + side, a + side + 1;
      result.row(row++) << a, a + side + 1, a + 1;
    }
  }
  return result;
}

}  // namespace

int main() try {
  stiv::SurfaceDefinition definition;
  definition.vertex_count = 2 * count;
  definition.triangles = triangles();
  const auto surface = std::make_shared<const stiv::Surface>(std::move(definition));

  stiv::Positions start(2 * count, 3);
  start << sheet(0.0), sheet(0.3);
  stiv::Controls goal = start;  // every vertex is a control
  goal.bottomRows(count).col(2).array() -= 0.5;

  stiv::Execution execution;  // all processors; progress and cancellation are set here
  stiv::EditSession session(surface, stiv::make_identity(2 * count), start);
  const stiv::EditResult result = session.edit(goal, execution);

  const auto intersections = stiv::IntersectionTest(surface).find(result.surface, execution);
  std::cout << (result.status == stiv::EditStatus::corrected ? "corrected" : "not corrected") << " in "
            << result.counters.rounds << " rounds, " << intersections.size() << " intersections\n";
  return intersections.empty() ? 0 : 1;
} catch (const stiv::InputError& error) {  // names the object and the element, and says what to do
  std::cerr << error.what() << '\n';
  return 2;
}
