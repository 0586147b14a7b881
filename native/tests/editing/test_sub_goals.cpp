// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/sub_goals.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "editing/sessions.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A path of heights of the upper sheet, cut at the state closest to a goal at `goal_height`.
std::vector<Controls> best_path(const Scene& scene, const std::vector<double>& heights, double goal_height) {
  const EditContext context(scene.surface, Positions(0, 3), scene.deformation, scene.controls, {}, Execution(1));
  Execution execution(1);
  CollisionQueries queries(context, scene.controls, execution);
  const auto at = [&](double height) { return moved(scene.controls, upper_sheet, Vector3(0, 0, height)); };
  EditReport report;
  for (const double height : heights) report.path.push_back(at(height));
  State accepted{at(heights.back()), scene.deformation->surface(at(heights.back()))};
  std::optional<RoundProgress> progress;
  EditCall call{context, queries, accepted, progress, report, execution};
  return_to_best(call, {at(goal_height), scene.deformation->surface(at(goal_height)), false});
  CHECK(accepted.controls == report.path.back());
  CHECK(accepted.surface == scene.deformation->surface(accepted.controls));
  return report.path;
}

}  // namespace

TEST_CASE("sub-goals: an edit ends at the best state of its path, and the path ends there too") {
  const Scene scene = two_sheets();
  CHECK(best_path(scene, {0.5, 0.9, 0.2, 0.6}, 1).size() == 2);
  CHECK(best_path(scene, {0.5, 0.9, 0.95}, 1).size() == 3);
  CHECK(best_path(scene, {0.9, 0.5, 0.9}, 1).size() == 3);  // equally good: nothing is taken back
  CHECK(best_path(scene, {0.5}, 1).size() == 1);
}
