// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

/// Each vertex depends on the control with the same index (modulo m) and the next three.
WeightMatrix banded_weights(Index n, Index m) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  const Positions values = random_positions(4 * n, 5);
  for (Index row = 0; row < n; ++row)
    for (Index k = 0; k < 4; ++k) entries.emplace_back(row, (row + k) % m, values(4 * row + k, 0));
  WeightMatrix matrix(n, m);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void check_linear_metric(const Deformation& linear, Index m) {
  const Controls p = Controls::Zero(m, 3);
  MetricOptions options;
  check_metric(linear, p, options, mean_damping(linear, p, options));
  options.smoothness = 0.01;
  options.weights = Eigen::VectorXd::LinSpaced(m, 0.5, 2);
  for (Index control = 0; control < m; control += 3) options.weights[control] = 0;
  check_metric(linear, p, options, mean_damping(linear, p, options));
  for (const bool turned : {false, true}) {
    options = random_axis_weights(m, 4, turned);
    check_metric(linear, p, options, mean_damping(linear, p, options));
  }
}

}  // namespace

TEST_CASE("linear: derivatives") {
  const Positions offset = random_positions(12, 3);
  const auto linear = make_linear(banded_weights(12, 5), offset);
  check_derivatives(*linear, random_positions(5, 1));
  CHECK(linear->surface(Controls::Zero(5, 3)) == offset);
}

TEST_CASE("linear: the surface has the same bits for any number of threads") {
  const auto linear = make_linear(banded_weights(5000, 300), random_positions(5000, 3));
  const Controls p = random_positions(300, 1);
  for (const int threads : {2, 5}) CHECK(linear->surface(p, Execution(threads)) == linear->surface(p));
  check_rows(*linear, p);
}

TEST_CASE("linear: metric of few controls") { check_linear_metric(*make_linear(banded_weights(60, 25)), 25); }

TEST_CASE("linear: metric of many controls") { check_linear_metric(*make_linear(banded_weights(610, 610)), 610); }

TEST_CASE("linear: equal weights along all axes give the bits of one weight for each control") {
  constexpr Index m = 30;
  const auto linear = make_linear(banded_weights(60, m));
  const Controls p = Controls::Zero(m, 3);
  const SparseField g = random_field(m, 1, 2);
  MetricOptions one, three = random_axis_weights(m, 1, true);
  one.weights = Eigen::VectorXd::LinSpaced(m, 0, 2);
  for (Index row = 0; row < 3 * m; ++row) three.weights[row] = one.weights[row / 3];
  CHECK(dense(linear->metric(one)->apply_inverse(p, g), m) == dense(linear->metric(three)->apply_inverse(p, g), m));
}

TEST_CASE("linear: a metric has the same bits, whichever was made before of the same weights") {
  const WeightMatrix weights = banded_weights(60, 25);
  const auto linear = make_linear(weights);
  linear->metric({});
  MetricOptions options;
  options.smoothness = 0.01;
  options.weights = Eigen::VectorXd::Ones(25);
  options.weights.segment(3, 9).setZero();
  const SparseField field = random_field(25, 6, 1);
  const SparseField again = linear->metric(options)->apply_inverse(Controls::Zero(25, 3), field);
  const SparseField fresh = make_linear(weights)->metric(options)->apply_inverse(Controls::Zero(25, 3), field);
  CHECK(again.index == fresh.index);
  CHECK(again.value == fresh.value);
  CHECK(again.index.size() == 16);
}

TEST_CASE("linear: a sparse covector over many controls") {
  const auto linear = make_linear(banded_weights(40, 20));
  const auto metric = linear->metric({});
  const Controls p = Controls::Zero(20, 3);
  const SparseField whole = random_field(20, 1, 2), part{{4, 9}, {whole.value[4], whole.value[9]}};
  Positions sum = Positions::Zero(20, 3);
  for (Index k = 0; k < 20; ++k)
    sum += dense(metric->apply_inverse(p, {{k}, {whole.value[static_cast<std::size_t>(k)]}}), 20);
  CHECK((sum - dense(metric->apply_inverse(p, whole), 20)).norm() < 1e-12 * sum.norm());
  CHECK(metric->apply_inverse(p, {}).index.empty());
  CHECK(metric->apply_inverse(p, part).index.size() == 20);
}

TEST_CASE("linear: controls without vertices do not move") {
  WeightMatrix matrix(2, 3);
  matrix.insert(0, 0) = 1;
  matrix.insert(1, 2) = 0.5;
  matrix.insert(1, 1) = 0;
  const auto linear = make_linear(matrix);
  CHECK(linear->support(1).empty());
  const SparseField step = linear->metric({})->apply_inverse(Controls::Zero(3, 3), random_field(3, 1, 1));
  CHECK(step.index == std::vector<Index>{0, 2});
}

TEST_CASE("linear: the inverse of a large metric is factored aside and waited for") {
  constexpr Index m = 4000;  // sparse
  const auto linear = make_linear(banded_weights(2 * m, m));
  const auto metric = linear->metric({});
  const Controls p = Controls::Zero(m, 3);
  const SparseField g = random_field(m, 1, 3);
  const Positions step = dense(metric->apply_inverse(p, g), m);
  CHECK(metric->is_ready());
  CHECK(dense(linear->metric({})->apply_inverse(p, g), m) == step);
  linear->metric({});  // no one waits for its end
  const auto huge = make_linear(WeightMatrix(banded_weights(2 * m, m) * 1e200));
  CHECK_THROWS_WITH_AS(huge->metric({}), doctest::Contains("cannot be factored"), InputError);
}

TEST_CASE("linear: everything pinned") {
  MetricOptions options;
  options.weights = Eigen::VectorXd::Zero(5);
  const auto metric = make_linear(banded_weights(6, 5))->metric(options);
  CHECK(metric->apply_inverse(Controls::Zero(5, 3), random_field(5, 1, 1)).index.empty());
}

TEST_CASE("linear: invalid input is named") {
  WeightMatrix matrix = banded_weights(6, 4);
  CHECK_THROWS_WITH_AS(make_linear(matrix, Positions::Zero(5, 3)), doctest::Contains("5 rows"), InputError);
  Positions offset = Positions::Zero(6, 3);
  offset(2, 0) = INFINITY;
  CHECK_THROWS_WITH_AS(make_linear(matrix, offset), doctest::Contains("row 2"), InputError);
  matrix.coeffRef(3, 1) = NAN;
  CHECK_THROWS_WITH_AS(make_linear(matrix), doctest::Contains("row 3: weight of control 1"), InputError);
}
