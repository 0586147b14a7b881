// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

WeightMatrix two_control_weights(Index n) {
  WeightMatrix matrix(n, 2);
  for (Index row = 0; row < n; ++row) {
    matrix.insert(row, 0) = 0.1 * row;
    matrix.insert(row, 1) = 1 - 0.1 * row;
  }
  return matrix;
}

/// Rigid, linear and identity components whose vertices are interleaved and out of order; 5 and 11 stay.
std::shared_ptr<const Deformation> mixed(const Positions& start) {
  const std::vector<Index> rigid{7, 1, 3, 9};
  return make_concatenation({{make_rigid(start(rigid, Eigen::all)), rigid},
                             {make_linear(two_control_weights(4)), {10, 0, 2, 8}},
                             {make_identity(2), {6, 4}}},
                            start);
}

}  // namespace

TEST_CASE("concatenation: vertices of components move and the others stay") {
  const Positions start = random_positions(12, 1);
  const auto whole = mixed(start);
  CHECK(whole->control_count() == 6);
  CHECK(whole->vertex_count() == 12);
  const Controls p = random_positions(6, 2);
  const Positions q = whole->surface(p);
  CHECK(q.row(5) == start.row(5));
  CHECK(q.row(11) == start.row(11));
  CHECK(q.row(6) == p.row(4));
  CHECK(q.row(4) == p.row(5));
  CHECK((q.row(2) - 0.2 * p.row(2) - 0.8 * p.row(3)).norm() < 1e-15);
  const std::vector<Index> some{11, 0, 6, 3};
  CHECK(whole->has_exact_rows());
  CHECK(whole->surface_rows(p, some, Execution(1)) == Positions(q(some, Eigen::all)));
  CHECK(whole->support(0) == std::vector<Index>{1, 3, 7, 9});
  CHECK(whole->support(4) == std::vector<Index>{6});
}

TEST_CASE("concatenation: derivatives") { check_derivatives(*mixed(random_positions(12, 1)), random_positions(6, 2)); }

TEST_CASE("concatenation: each component keeps its own metric") {
  const Positions start = random_positions(12, 1);
  const auto whole = mixed(start);
  const Controls p = random_positions(6, 2);
  MetricOptions options;
  options.weights = (Eigen::VectorXd(6) << 1, 2, 3, 0, 0.5, 1).finished();
  const SparseField g = random_field(6, 1, 3);
  const Positions found = dense(whole->metric(options)->apply_inverse(p, g), 6);

  const auto rigid = make_rigid(start(std::vector<Index>{7, 1, 3, 9}, Eigen::all));
  const auto rigid_metric = rigid->metric({0.1, options.weights.head(2)});
  const Positions rigid_step = dense(rigid_metric->apply_inverse(p.topRows(2), {{0, 1}, {g.value[0], g.value[1]}}), 2);
  CHECK(found.topRows(2) == rigid_step);
  const auto linear_metric = make_linear(two_control_weights(4))->metric({0.1, options.weights.segment(2, 2)});
  CHECK(found.middleRows(2, 2) ==
        dense(linear_metric->apply_inverse(p.middleRows(2, 2), {{0, 1}, {g.value[2], g.value[3]}}), 2));
  CHECK(found.row(4) == 0.5 * g.value[4].transpose());
  CHECK(found.row(5) == g.value[5].transpose());
}

TEST_CASE("concatenation: weights along axes apply to their component") {
  const auto whole = mixed(random_positions(12, 1));
  const Controls p = random_positions(6, 2);
  for (const bool turned : {false, true}) {
    const MetricOptions options = random_axis_weights(6, 8, turned);
    const SparseField g = random_field(6, 1, 3);
    const Positions found = dense(whole->metric(options)->apply_inverse(p, g), 6);
    MetricOptions of_linear{options.smoothness, options.weights.segment(6, 6)};
    if (turned) of_linear.weight_axes = {options.weight_axes[2], options.weight_axes[3]};
    const auto linear_metric = make_linear(two_control_weights(4))->metric(of_linear);
    CHECK(found.middleRows(2, 2) ==
          dense(linear_metric->apply_inverse(p.middleRows(2, 2), {{0, 1}, {g.value[2], g.value[3]}}), 2));
  }
}

TEST_CASE("concatenation: its metric is local if that of every component is") {
  const Positions start = random_positions(12, 1);
  const auto is_local = [&](std::vector<DeformationComponent> components) {
    return make_concatenation(std::move(components), start)->metric({0.1, {}})->is_local();
  };
  const DeformationComponent points{make_identity(2), {0, 1}};
  const DeformationComponent body{make_rigid(start.topRows(4)), {2, 3, 4, 5}};
  const DeformationComponent cage{make_linear(two_control_weights(4)), {6, 7, 8, 9}};
  CHECK(is_local({points, body}));
  CHECK_FALSE(is_local({points, cage}));
}

TEST_CASE("concatenation: invalid input is named") {
  const Positions start = random_positions(4, 1);
  CHECK_THROWS_WITH_AS(make_concatenation({{make_identity(2), {0, 1}}, {make_identity(2), {2, 1}}}, start),
                       doctest::Contains("component 1, vertex 1: already in component 0"), InputError);
  CHECK_THROWS_WITH_AS(make_concatenation({{make_identity(2), {0, 4}}}, start), doctest::Contains("vertex 4"),
                       InputError);
  CHECK_THROWS_WITH_AS(make_concatenation({{make_identity(2), {0, 1, 2}}}, start), doctest::Contains("3 vertices"),
                       InputError);
  CHECK_THROWS_AS(make_concatenation({{nullptr, {}}}, start), InputError);
  CHECK(make_concatenation({}, start)->surface(Controls(0, 3)) == start);
}

TEST_CASE("concatenation: rotation rows of rigid components are shifted to their rows among all controls") {
  const Positions rest = Positions::Random(3, 3);
  const auto whole = make_concatenation(
      {{make_identity(1), {0}}, {make_rigid(rest), {1, 2, 3}}, {make_rigid(rest), {4, 5, 6}}}, Positions::Zero(7, 3));
  CHECK(whole->rotation_rows() == std::vector<Index>{2, 4});
}
