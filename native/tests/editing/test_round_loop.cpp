// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "editing/sessions.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/deformation/lattice.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A sheet in a lattice pressed onto a bowl, which takes some rounds.
/// @param cells of the sheet along each side
/// @param height of the sheet; 0.1 touches the bowl
Scene sheet_over_bowl(Index cells = 12, double height = 0.3) {
  Positions q(0, 3);
  Triangles triangles(0, 3);
  append_sheet(q, triangles, cells, 1, Vector3(0.03, 0.02, height));
  const auto first = static_cast<Index>(q.rows());
  append_sheet(q, triangles, 17, 2, Vector3::Zero());
  for (Index vertex = first; vertex < q.rows(); ++vertex)
    q(vertex, 2) = 0.1 * std::sin(9 * q(vertex, 0)) * std::cos(7 * q(vertex, 1));
  std::vector<Index> vertices(static_cast<std::size_t>(first));
  for (Index vertex = 0; vertex < first; ++vertex) vertices[static_cast<std::size_t>(vertex)] = vertex;
  LatticeDefinition lattice;
  lattice.resolution = {4, 4, 2};
  lattice.rest.resize(32, 3);
  for (Index point = 0; point < 32; ++point)
    lattice.rest.row(point) << (point % 4) / 3.0 - 0.5, (point / 4 % 4) / 3.0 - 0.5, point / 16 - 0.5;
  const Positions sheet = q.topRows(first);
  Scene scene;
  scene.surface =
      surface_of(triangles, first, static_cast<Index>(q.rows()) - first, Mobility::deformable, Mobility::fixed);
  scene.controls = lattice.rest;
  scene.deformation =
      make_concatenation({{make_lattice(lattice, {sheet, Eigen::VectorXd(), sheet, scene.controls}), vertices}}, q);
  return scene;
}

struct Run {
  RoundOutcome outcome;
  std::int64_t rounds = 0, events = 0;
};

Run run(const Scene& scene, const StatePredicate& is_diverging, FirstSearch first = FirstSearch::whole_step,
        PairLimit limit = PairLimit::respected) {
  EditOptions options;
  options.max_rounds = 40;
  const EditContext context(scene.surface, Positions(0, 3), scene.deformation, scene.controls, options, Execution(1));
  Execution execution(1);
  CollisionQueries queries(context, scene.controls, execution);
  State accepted{scene.controls, context.surface_at(scene.controls, execution)};
  queries.check_start(accepted.surface, execution);
  std::optional<RoundProgress> progress;
  EditReport report;
  EditCall call{context, queries, accepted, progress, report, execution};
  const Controls goal = moved(scene.controls, static_cast<Index>(scene.controls.rows()), Vector3(0.05, 0, -0.45));
  return {RoundLoop(call, goal, Projection::from_goal, limit, first, is_diverging).run(), execution.counters.rounds,
          execution.counters.events};
}

}  // namespace

TEST_CASE("round loop: a candidate that is asked about is placed whole, and asking changes nothing") {
  const Scene scene = sheet_over_bowl();
  int asked = 0;
  const Run alone = run(scene, {}), watched = run(scene, [&](const State&candidate) {
                                      ++asked;
                                      CHECK(candidate.surface == scene.deformation->surface(candidate.controls));
                                      return false;
                                    });
  CHECK(asked > 0);
  CHECK(alone.rounds >= 6);
  CHECK(alone.outcome.clear);
  CHECK(alone.outcome.candidate.surface == scene.deformation->surface(alone.outcome.candidate.controls));
  CHECK(watched.outcome.clear);
  CHECK(!watched.outcome.given_up);
  CHECK(watched.rounds == alone.rounds);
  CHECK(watched.outcome.candidate.controls == alone.outcome.candidate.controls);
}

TEST_CASE("round loop: rounds are given up where that is wished") {
  const Run run_up = run(sheet_over_bowl(), [](const State&) { return true; });
  CHECK(run_up.outcome.given_up);
  CHECK(!run_up.outcome.clear);
  CHECK(run_up.rounds == 6);
}

TEST_CASE("round loop: a large body that goes deep finds fewer contacts if it searches near the start first") {
  const Scene scene = sheet_over_bowl(130, 0.103);
  const Run whole = run(scene, {}, FirstSearch::whole_step, PairLimit::ignored),
            near = run(scene, {}, FirstSearch::near_start, PairLimit::ignored);
  CHECK(whole.outcome.clear);
  CHECK(near.outcome.clear);
  CHECK(near.events > 0);
  CHECK(near.events < whole.events);
  IntersectionTest test(scene.surface);
  Execution execution(1);
  CHECK(test.find(near.outcome.candidate.surface, execution).empty());
}

TEST_CASE("round loop: for a small body, it does not matter where the search begins") {
  const Scene scene = sheet_over_bowl();
  const Run whole = run(scene, {}), near = run(scene, {}, FirstSearch::near_start);
  CHECK(near.events == whole.events);
  CHECK(near.outcome.candidate.controls == whole.outcome.candidate.controls);
}
