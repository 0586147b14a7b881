// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/contraction.hpp"

#include <doctest/doctest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "repair/tangled_scenes.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

/// A dented sheet whose angles are all between 3 and 177 degrees: only the weights of obtuse angles are clamped.
Scene dented_sheet() {
  Scene scene = two_sheets(4);
  for (Index row = 0; row < scene.controls.rows(); ++row)
    scene.controls.row(row) += 0.05 * Eigen::RowVector3d(std::sin(3.1 * row), std::cos(2.3 * row), std::sin(1.7 * row));
  return scene;
}

/// The cotangent of the corner at a, computed from its angle.
double cotangent(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double angle = std::acos((b - a).normalized().dot((c - a).normalized()));
  return std::max(1e-3, 1 / std::tan(angle));
}

/// One step as a dense least-squares problem of stacked equations, solved by an orthogonal factorization. Areas are
/// those at the start, so the vertices' weights are 1.
Positions dense_step(const Scene& scene, double smoothing) {
  const Index count = scene.surface->vertex_count();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(2 * count, count);
  for (const auto& corners : scene.surface->triangles().rowwise())
    for (Index k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      const double weight =
          smoothing * 0.5 * cotangent(scene.controls.row(a), scene.controls.row(b), scene.controls.row(c));
      stacked(b, c) += weight;
      stacked(c, b) += weight;
      stacked(b, b) -= weight;
      stacked(c, c) -= weight;
    }
  stacked.bottomRows(count).setIdentity();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(2 * count, 3);
  right.bottomRows(count) = scene.controls;
  return stacked.colPivHouseholderQr().solve(right);
}

double largest_difference(const Positions& a, const Positions& b) { return (a - b).cwiseAbs().maxCoeff(); }

Positions stepped(const Scene& scene, const std::vector<unsigned char>& moves, double smoothing) {
  const ContractionSystem system = contraction_system(*scene.surface, scene.controls, moves);
  return contraction_step(*scene.surface, system, scene.controls, smoothing);
}

}  // namespace

TEST_CASE("a step of contraction solves the stacked least-squares problem") {
  const Scene scene = dented_sheet();
  for (const double smoothing : {0.1, 1.0, 8.0})
    CHECK(largest_difference(stepped(scene, {}, smoothing), dense_step(scene, smoothing)) < 1e-10);
}

TEST_CASE("a second step weights each vertex by its remaining area") {
  const Scene scene = dented_sheet();
  const ContractionSystem system = contraction_system(*scene.surface, scene.controls, {});
  const Positions once = contraction_step(*scene.surface, system, scene.controls, 2);
  const Positions twice = contraction_step(*scene.surface, system, once, 4);
  const Eigen::VectorXd ratio =
      scene.surface->vertex_areas(scene.controls).cwiseQuotient(scene.surface->vertex_areas(once));
  const Eigen::MatrixXd gradient = 16 * (system.laplacian.transpose() * (system.laplacian * Eigen::MatrixXd(twice))) +
                                   ratio.asDiagonal() * Eigen::MatrixXd(twice - once);
  CHECK(gradient.cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("contraction does not depend on the size of the shape") {
  const Scene scene = dented_sheet();
  const Positions step = stepped(scene, {}, 2);
  for (const double scale : {1e-7, 1e7}) {
    Scene scaled = scene;
    scaled.controls *= scale;
    CHECK(largest_difference(stepped(scaled, {}, 2) / scale, step) < 1e-12);
  }
}

TEST_CASE("fixed vertices stay exactly, and constrain the others") {
  const Scene scene = dented_sheet();
  std::vector<unsigned char> moves(static_cast<std::size_t>(scene.surface->vertex_count()), 0);
  for (std::size_t k = 5; k < 20; ++k) moves[k] = 1;
  const Positions step = stepped(scene, moves, 4);
  for (Index row = 0; row < step.rows(); ++row)
    CHECK((step.row(row) == scene.controls.row(row)) == (moves[static_cast<std::size_t>(row)] == 0));
}

TEST_CASE("triangles without area and coincident vertices give finite steps") {
  SurfaceDefinition definition;
  definition.vertex_count = 5;
  definition.triangles.resize(3, 3);
  definition.triangles << 0, 1, 2, 2, 1, 3, 1, 1, 4;
  Scene scene;
  scene.surface = std::make_shared<Surface>(definition);
  scene.controls.resize(5, 3);
  scene.controls << 0, 0, 0, 1, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1, 0;
  CHECK(stepped(scene, {}, 1).allFinite());
}

TEST_CASE("contraction ends at the first step without intersections") {
  const Scene scene = spike_through_sheet();
  Execution execution(1);
  const ContractionResult result = contract(scene.surface, scene.controls, {}, {}, execution);
  CHECK(result.free);
  CHECK(result.pairs.front() > 0);
  CHECK(result.pairs.back() == 0);
  IntersectionTest test(scene.surface);
  CHECK(test.is_free(result.positions, {}, execution));
}

TEST_CASE("contraction returns the best step if later steps are worse") {
  // Only the flat sheet shrinks, within its plane toward the spike in its middle: more and more of it meets the spike.
  Scene scene = spike_through_sheet();
  const Index first = scene.surface->vertex_count() / 2;
  std::vector<unsigned char> moves(2 * static_cast<std::size_t>(first), 0);
  for (std::size_t k = static_cast<std::size_t>(first); k < moves.size(); ++k) moves[k] = 1;
  ContractionOptions options;
  options.tolerance = 1;
  Execution execution(1);
  const ContractionResult result = contract(scene.surface, scene.controls, moves, options, execution);
  CHECK(result.pairs.back() > result.pairs.front());
  CHECK(result.positions == scene.controls);
  CHECK_FALSE(result.free);
}

TEST_CASE("contraction rejects invalid marks and options, and can be cancelled") {
  const Scene scene = spike_through_sheet();
  Execution execution(1);
  CHECK_THROWS_AS(contract(scene.surface, scene.controls, {1, 0}, {}, execution), InputError);
  ContractionOptions options;
  options.smoothing = 0;
  CHECK_THROWS_AS(contract(scene.surface, scene.controls, {}, options, execution), InputError);
  options = {};
  options.growth = 1;
  CHECK_THROWS_AS(contract(scene.surface, scene.controls, {}, options, execution), InputError);
  execution.request_cancel();
  CHECK_THROWS_AS(contract(scene.surface, scene.controls, {}, {}, execution), Interrupted);
}
