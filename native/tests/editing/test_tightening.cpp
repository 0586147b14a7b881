// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/tightening.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "editing/sessions.hpp"
#include "stiv/deformation/linear.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

constexpr Index cells = 8;

double bernstein(Index degree, Index k, double t) {
  double value = std::pow(t, double(k)) * std::pow(1 - t, double(degree - k));
  for (Index i = 1; i <= k; ++i) value *= double(degree - k + i) / double(i);
  return value;
}

/// A Bezier sheet of side 1 at height 0.5, moved by its control points, above a fixed plate at height 0. Its metric is
/// the worse conditioned the higher the degree.
struct BezierOverPlate {
  Scene scene;
  Eigen::MatrixXd weights;  ///< (sheet's vertices, controls)
  Index degree;

  explicit BezierOverPlate(Index bezier_degree) : degree(bezier_degree) {
    Positions q(0, 3);
    Triangles triangles(0, 3);
    append_sheet(q, triangles, cells, 1, Vector3(0.03, 0.02, 0.5));
    const Index moving = static_cast<Index>(q.rows()), side = degree + 1;
    append_sheet(q, triangles, 4, 6, Vector3::Zero());
    weights.resize(moving, side * side);
    WeightMatrix matrix(moving, side * side);
    scene.controls.resize(side * side, 3);
    for (Index i = 0; i < side; ++i)
      for (Index j = 0; j < side; ++j) {
        scene.controls.row(i * side + j) << double(i) / degree - 0.47, double(j) / degree - 0.48, 0.5;
        for (Index u = 0; u <= cells; ++u)
          for (Index v = 0; v <= cells; ++v)
            weights(u * (cells + 1) + v, i * side + j) =
                bernstein(degree, i, double(u) / cells) * bernstein(degree, j, double(v) / cells);
      }
    for (Index vertex = 0; vertex < moving; ++vertex)
      for (Index k = 0; k < side * side; ++k) matrix.insert(vertex, k) = weights(vertex, k);
    std::vector<Index> vertices;
    for (Index vertex = 0; vertex < moving; ++vertex) vertices.push_back(vertex);
    scene.deformation = make_concatenation({{make_linear(std::move(matrix)), vertices}}, q);
    scene.surface =
        surface_of(triangles, moving, static_cast<Index>(q.rows()) - moving, Mobility::deformable, Mobility::fixed);
  }

  /// The start, pressed down most at one side of the middle.
  Controls pressed(double depth) const {
    Controls goal = scene.controls;
    for (Index k = 0; k < static_cast<Index>(goal.rows()); ++k) {
      const double x = goal(k, 0) - 0.1, y = goal(k, 1) + 0.05;
      goal(k, 2) -= depth * std::exp(-12 * (x * x + y * y));
    }
    return goal;
  }

  double energy_at(const Controls& p, const Controls& goal) const { return 0.5 * (weights * (p - goal)).squaredNorm(); }

  /// The least energy above a height: the dual of a dense quadratic program by Gauss-Seidel sweeps [Hildreth 1957].
  /// Only the heights matter, since the plate is level.
  Controls optimum(const Controls& goal, double height) const {
    const Eigen::MatrixXd gram = weights.transpose() * weights;
    const Eigen::MatrixXd steps = gram.ldlt().solve(weights.transpose());
    const Eigen::MatrixXd pushes = weights * steps;
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(weights.rows());
    Eigen::VectorXd excess = (weights * goal.col(2)).array() - height;
    for (int sweep = 0; sweep < 20000; ++sweep)
      for (Eigen::Index r = 0; r < multipliers.size(); ++r) {
        const double change = std::max(-multipliers[r], -excess[r] / pushes(r, r));
        multipliers[r] += change;
        excess += change * pushes.col(r);
      }
    CHECK(excess.minCoeff() > -1e-6);
    Controls p = goal;
    p.col(2) += steps * multipliers;
    return p;
  }
};

EditOptions precise(bool tight) {
  EditOptions options;
  options.tight = tight;
  options.single_precision = false;
  options.separation = 1e-7;
  return options;
}

double largest_deviation(const Controls& p, const Controls& goal) { return (p - goal).cwiseAbs().maxCoeff(); }

EditResult edited(EditSession& session, const Controls& goal, int threads = 1) {
  Execution execution(threads);
  return session.edit(goal, execution);
}

/// An edit and settling in calls whose time is used up at once.
EditResult edited_in_short_calls(const Scene& scene, EditSession& session, const Controls& goal) {
  EditResult result;
  int calls = 0;
  for (; calls < 2000 && (calls == 0 || result.status == EditStatus::budget); ++calls) {
    Execution execution(1);
    execution.set_time_budget(1e-9, BudgetEnd::after_checkpoint);
    result = calls == 0 ? session.edit(goal, execution) : session.settle(execution);
    CHECK(is_free(scene, session.surface()));
  }
  CHECK(calls > 5);
  CHECK(result.status != EditStatus::budget);
  return result;
}

Controls pressed_and_turned(const Scene& plate) {
  Controls goal = plate.controls;
  goal.row(0) += Eigen::RowVector3d(0.1, 0, -0.8);
  goal.row(1) << 0, 0.6, 0;
  return goal;
}

}  // namespace

TEST_CASE("tight: an edit ends at the optimum of a dense quadratic program") {
  const BezierOverPlate bezier(2);
  for (const double depth : {4.0, 8.0}) {
    CAPTURE(depth);
    const Controls goal = bezier.pressed(depth);
    EditSession smooth = session_of(bezier.scene, precise(false)), tight = session_of(bezier.scene, precise(true));
    edited(smooth, goal);
    const EditResult result = edited(tight, goal);
    const double least = bezier.energy_at(bezier.optimum(goal, 1e-7), goal);
    CHECK(result.energy == doctest::Approx(bezier.energy_at(tight.controls(), goal)));
    CHECK(result.energy < (1 + 1e-4) * least);
    CHECK(result.energy > (1 - 1e-4) * least);
    CHECK(bezier.energy_at(smooth.controls(), goal) > (1 + 1e-3) * least);
    CHECK(is_free(bezier.scene, tight.surface()));
  }
}

TEST_CASE("tight: settling ends there too, and settling again changes nothing") {
  const BezierOverPlate bezier(2);
  const Controls goal = bezier.pressed(6);
  EditSession session = session_of(bezier.scene, precise(true));
  Execution execution(1);
  for (int step = 1; step <= 4; ++step)
    session.drag(bezier.scene.controls + step / 4.0 * (goal - bezier.scene.controls), execution);
  const double least = bezier.energy_at(bezier.optimum(goal, 1e-7), goal);
  CHECK(bezier.energy_at(session.controls(), goal) > (1 + 1e-3) * least);
  session.settle(execution);
  CHECK(bezier.energy_at(session.controls(), goal) < (1 + 1e-4) * least);
  const Controls settled = session.controls();
  CHECK(session.settle(execution).path.empty());
  CHECK(session.controls() == settled);
}

TEST_CASE("tight: controls of an ill-conditioned cage do not run off as those of plain Gauss-Newton steps do") {
  const BezierOverPlate bezier(7);
  const Controls goal = bezier.pressed(1.6);
  EditSession smooth = session_of(bezier.scene, precise(false)), tight = session_of(bezier.scene, precise(true));
  edited(smooth, goal);
  edited(tight, goal);
  const double miss = (bezier.weights * (smooth.controls() - goal)).rowwise().norm().maxCoeff();
  const double bound = std::max(2 * miss / 0.25, largest_deviation(smooth.controls(), goal));
  const double least = bezier.energy_at(bezier.optimum(goal, 1e-7), goal);
  const double before = bezier.energy_at(smooth.controls(), goal), after = bezier.energy_at(tight.controls(), goal);
  CHECK(largest_deviation(bezier.optimum(goal, 1e-7), goal) > 3 * bound);
  CHECK(largest_deviation(tight.controls(), goal) < (1 + 1e-6) * bound);
  CHECK(after - least < 0.2 * (before - least));
  CHECK(is_free(bezier.scene, tight.surface()));
}

TEST_CASE("tight: pinned controls rest, and controls of little weight deviate less") {
  const BezierOverPlate bezier(2);
  Controls goal = bezier.pressed(6);
  goal.row(1) = bezier.scene.controls.row(1);
  EditOptions options = precise(true);
  options.weights = Eigen::VectorXd::Ones(9);
  options.weights[1] = 0;
  options.weights[4] = 0.5;
  EditSession tight = session_of(bezier.scene, options);
  options.tight = false;
  EditSession smooth = session_of(bezier.scene, options);
  edited(tight, goal);
  edited(smooth, goal);
  CHECK(tight.controls().row(1) == bezier.scene.controls.row(1));
  CHECK(bezier.energy_at(tight.controls(), goal) < bezier.energy_at(smooth.controls(), goal));
  const double miss = (bezier.weights * (smooth.controls() - goal)).rowwise().norm().maxCoeff();
  const auto deviation = [&](const EditSession& session) {
    return (session.controls().row(4) - goal.row(4)).cwiseAbs().maxCoeff();
  };
  CHECK(deviation(tight) < (1 + 1e-6) * std::max(0.5 * 2 * miss / 0.25, deviation(smooth)));
}

TEST_CASE("tight: pinned axes rest to the last bit") {
  const BezierOverPlate bezier(2);
  const Controls goal = bezier.pressed(6);
  EditOptions options = precise(true);
  options.weights = Eigen::VectorXd::Ones(27);
  for (Index k = 0; k < 9; ++k) options.weights[3 * k] = 0;
  EditSession session = session_of(bezier.scene, options);
  edited(session, goal);
  CHECK(session.controls().col(0) == bezier.scene.controls.col(0));
}

TEST_CASE("tight: the same bits for any number of threads") {
  for (const Index degree : {2, 7}) {
    const BezierOverPlate bezier(degree);
    const Controls goal = bezier.pressed(6);
    EditSession one = session_of(bezier.scene, precise(true)), three = session_of(bezier.scene, precise(true));
    edited(one, goal, 1);
    edited(three, goal, 3);
    CHECK(one.controls() == three.controls());
  }
}

TEST_CASE("tight: a rigid motion is tightened too, and stays free of intersections") {
  const Scene scene = plate_over_wall();
  EditOptions options;
  const Controls goal = pressed_and_turned(scene);
  EditSession smooth = session_of(scene, options);
  options.tight = true;
  EditSession tight = session_of(scene, options);
  CHECK(edited(tight, goal).energy <= edited(smooth, goal).energy);
  CHECK(is_free(scene, tight.surface()));
}

TEST_CASE("tight: a rigid motion has the same bits for any number of threads, and the same energy in short calls") {
  const Scene scene = plate_over_wall();
  const Controls goal = pressed_and_turned(scene);
  EditSession one = session_of(scene, precise(true)), three = session_of(scene, precise(true));
  const double energy = edited(one, goal, 1).energy;
  edited(three, goal, 3);
  CHECK(one.controls() == three.controls());
  EditSession session = session_of(scene, precise(true));
  CHECK(edited_in_short_calls(scene, session, goal).energy < (1 + 1e-4) * energy);
}

TEST_CASE("tight: a call that is cancelled changes nothing") {
  const BezierOverPlate bezier(2);
  const Controls goal = bezier.pressed(6);
  EditSession session = session_of(bezier.scene, precise(true)), other = session_of(bezier.scene, precise(true));
  int asked = 0;
  Execution counting(1);
  counting.cancel_when([&] { return ++asked < 0; });
  other.edit(goal, counting);
  Execution cancelled(1);
  int left = asked - 3;  // while it tightens
  cancelled.cancel_when([&] { return --left < 0; });
  CHECK(session.edit(goal, cancelled).status == EditStatus::cancelled);
  CHECK(session.controls() == bezier.scene.controls);
  edited(session, goal);
  CHECK(session.controls() == other.controls());
}

TEST_CASE("tight: settling in calls without time ends at the same energy") {
  const BezierOverPlate bezier(2);
  const Controls goal = bezier.pressed(6);
  EditSession session = session_of(bezier.scene, precise(true));
  const EditResult result = edited_in_short_calls(bezier.scene, session, goal);
  CHECK(result.energy < (1 + 1e-4) * bezier.energy_at(bezier.optimum(goal, 1e-7), goal));
}
