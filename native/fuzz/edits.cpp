// SPDX-License-Identifier: GPL-3.0-or-later
// Consecutive edits, drags and settling of a small scene: every accepted state passes the exact test of each pair,
// every step to it passes a detection without caches, and a call that fails or is cancelled changes nothing.
#include <algorithm>

#include "editing/small_scenes.hpp"
#include "small_mesh.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/step_check.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/editing/session.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using fuzz::Corners;
using fuzz::corners;

namespace {

/// May the two triangles interfere? Pairs of bodies that the surface excludes are not tested.
bool tested(const Surface& surface, const Corners& a, const Corners& b) {
  return surface.bodies_meet(surface.body_of(a[0]), surface.body_of(b[0]));
}

bool is_free(const Surface& surface, const Positions& q) {
  for (Index a = 0; a < surface.triangles().rows(); ++a)
    for (Index b = a + 1; b < surface.triangles().rows(); ++b) {
      const Corners one = corners(surface, a), other = corners(surface, b);
      if (tested(surface, one, other) && triangles_intersect(one, other, q)) return false;
    }
  return true;
}

/// Fewer controls than vertices: each vertex is a weighted mean of two of them.
std::shared_ptr<const Deformation> blended(fuzz::Input& input, const Positions& rest, Index controls) {
  std::vector<Index> starts{0}, columns;
  std::vector<double> values;
  for (Index vertex = 0; vertex < rest.rows(); ++vertex) {
    const double share = input.below(17) / 16.0;
    columns.insert(columns.end(), {input.below(controls), input.below(controls)});
    values.insert(values.end(), {share, 1 - share});
    starts.push_back(static_cast<Index>(columns.size()));
  }
  return make_linear(weights_from_rows(starts, columns, values, controls), rest);
}

tests::Scene scene_of(fuzz::Input& input) {
  switch (input.below(4)) {
    case 0:
      return tests::two_sheets(1 + input.below(3));
    case 1:
      return tests::plate_over_wall(1 + input.below(2));
    case 2: {  // a few controls with random weights drive both sheets
      tests::Scene scene = tests::two_sheets(1 + input.below(2));
      const Index count = 2 + input.below(4);
      scene.deformation = blended(input, scene.controls, count);
      scene.controls = Controls::Zero(count, 3);
      return scene;
    }
    default: {  // any mesh, degenerate faces and loose edges included
      tests::Scene scene;
      scene.surface = fuzz::small_surface(input);
      scene.deformation = make_identity(scene.surface->vertex_count());
      scene.controls = input.positions(scene.surface->vertex_count(), true);
      return scene;
    }
  }
}

EditOptions options_of(fuzz::Input& input, Index controls) {
  constexpr double separations[] = {0, 0x1p-12, 0.0625, 0.75};
  EditOptions options;
  options.separation = separations[input.below(4)];
  options.smoothness = input.below(2) == 0 ? 0.1 : 0.01;
  options.constraints = static_cast<ConstraintKind>(input.below(3));
  options.solver = static_cast<ConstraintSolver>(input.below(2));
  options.metric = static_cast<MetricKind>(input.below(2));
  options.volumes = static_cast<VolumeKind>(input.below(2));
  options.narrow_phase = static_cast<NarrowPhase>(input.below(2));
  options.single_precision = input.below(4) != 0;
  options.max_sub_edits = 1 + input.below(3);
  options.max_rounds = 12;
  options.accumulated_rounds = 6;
  if (input.below(2) == 0) {
    options.weights = Eigen::VectorXd::Ones(controls);
    for (Index control = 0; control < controls; ++control) options.weights[control] = input.below(4) / 2.0;
  }
  return options;
}

Controls goal_of(fuzz::Input& input, const Controls& from) {
  Controls goal = from;
  const Vector3 shift = 0.5 * input.point(true);
  const bool noise = input.below(2) == 0;
  for (Index row = 0; row < goal.rows(); ++row) {
    if (input.below(4) == 0) continue;
    goal.row(row) += shift.transpose();
    if (noise) goal.row(row) += 0.125 * input.point(false).transpose();
  }
  return goal;
}

EditResult call(fuzz::Input& input, EditSession& session, const Controls& goal, Execution& execution) {
  switch (input.below(4)) {
    case 0:
      return session.settle(execution);
    case 1:
      return session.drag(goal, execution);
    default:
      return session.edit(goal, execution);
  }
}

void require_accepted(const tests::Scene& scene, const Controls& before, const EditSession& session,
                      const EditResult& result) {
  fuzz::require(result.controls == session.controls(), "the session holds what it returned");
  fuzz::require(result.surface == session.surface(), "and its surface");
  fuzz::require(result.controls.allFinite() && result.surface.allFinite(), "accepted states are finite");
  fuzz::require(is_free(*scene.surface, result.surface), "accepted states are free of intersections");
  Positions from = scene.deformation->surface(before);
  for (const Controls& step : result.path) {
    const Positions to = scene.deformation->surface(step);
    Detector detector(scene.surface, {BroadPhase::brute_force, NarrowPhase::conservative});
    IntersectionTest intersections(scene.surface);
    Execution execution(1);
    fuzz::require(from == to || is_step_free(detector, intersections, from, to, {0, 0.5}, execution),
                  "steps are free of intersections");
    from = to;
  }
}

/// Invalid goals are rejected without any change.
void require_refused(fuzz::Input& input, EditSession& session, Controls goal) {
  const Controls before = session.controls();
  goal(input.below(static_cast<Index>(goal.rows())), input.below(3)) = std::numeric_limits<double>::quiet_NaN();
  Execution execution(1);
  try {
    session.edit(goal, execution);
  } catch (const InputError&) {
    fuzz::require(session.controls() == before, "a goal that is refused changes nothing");
    return;
  }
  fuzz::require(false, "a goal that is not finite is refused");
}

void require_no_trace_of_cancelled(fuzz::Input& input, EditSession& session, const Controls& goal) {
  const Controls before = session.controls();
  const Positions surface = session.surface();
  Execution execution(1);
  int left = input.byte();
  execution.cancel_when([&] { return --left < 0; });
  const EditResult result = call(input, session, goal, execution);
  if (result.status != EditStatus::cancelled) return;
  fuzz::require(session.controls() == before && session.surface() == surface, "a cancelled call leaves no trace");
}

std::optional<EditSession> begun(const tests::Scene& scene, const EditOptions& options) {
  const Positions start = scene.deformation->surface(scene.controls);
  try {
    return std::optional<EditSession>(std::in_place, scene.surface, scene.deformation, scene.controls, options);
  } catch (const StartIntersectsError& error) {
    for (const auto& [a, b] : error.pairs)
      fuzz::require(triangles_intersect(corners(*scene.surface, a), corners(*scene.surface, b), start),
                    "pairs for which a start is refused meet");
    Execution execution(1);
    fuzz::require(!IntersectionTest(scene.surface).is_free(start, {}, execution), "a start that is free is taken");
  } catch (const InputError&) {  // a separation that single precision cannot hold
  }
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const tests::Scene scene = scene_of(input);
  const auto count = static_cast<Index>(scene.controls.rows());
  std::optional<EditSession> session = begun(scene, options_of(input, count));
  if (!session) return 0;
  for (int step = 0; step < 4 && !input.empty(); ++step) {
    const Controls before = session->controls(), goal = goal_of(input, before);
    if (input.below(8) == 0) require_refused(input, *session, goal);
    if (input.below(4) == 0) require_no_trace_of_cancelled(input, *session, goal);
    const Controls start = session->controls();
    Execution execution(1 + input.below(2));
    require_accepted(scene, start, *session, call(input, *session, goal, execution));
    if (input.below(8) == 0) {
      session->restore(start);
      fuzz::require(session->controls() == start, "what was accepted is taken back");
    }
  }
  return 0;
}
