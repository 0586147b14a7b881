// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "position_rows.hpp"
#include "stiv/deformation/deformation.hpp"

namespace stiv::testing {

/// Points in [-1, 1]^3, the same for the same seed.
inline Positions random_positions(Index count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Positions positions(count, 3);
  for (Index row = 0; row < count; ++row)
    for (Index axis = 0; axis < 3; ++axis) positions(row, axis) = coordinate(generator);
  return positions;
}

/// Every `stride`-th row of a random field, as a sparse one.
inline SparseField random_field(Index count, Index stride, unsigned seed) {
  const Positions values = random_positions(count, seed);
  SparseField field;
  for (Index row = 0; row < count; row += stride) {
    field.index.push_back(row);
    field.value.push_back(values.row(row));
  }
  return field;
}

inline Positions dense(const SparseField& field, Index count) {
  Positions values = Positions::Zero(count, 3);
  for (std::size_t k = 0; k < field.index.size(); ++k) values.row(field.index[k]) += field.value[k].transpose();
  return values;
}

/// df/dp(c, axis) by central differences, (n, 3).
inline Positions difference(const Deformation& deformation, const Controls& p, Index control, int axis, double step) {
  Controls forward = p, backward = p;
  forward(control, axis) += step;
  backward(control, axis) -= step;
  return (deformation.surface(forward) - deformation.surface(backward)) / (2 * step);
}

/// surface_rows against surface, bit for bit: some rows in any order, none, and all.
inline void check_rows(const Deformation& deformation, const Controls& p) {
  const Positions q = deformation.surface(p);
  std::vector<Index> rows(static_cast<std::size_t>(q.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  std::shuffle(rows.begin(), rows.end(), std::mt19937(5));
  for (const std::size_t count : {rows.size(), rows.size() / 2, std::size_t{0}}) {
    rows.resize(count);
    for (const int threads : {1, 2}) CHECK(deformation.surface_rows(p, rows, Execution(threads)) == rows_of(q, rows));
  }
}

/// push_forward and pull_back against central differences of `surface` for each control and axis; the support of each
/// control against the vertices that move; and check_rows.
inline void check_derivatives(const Deformation& deformation, const Controls& p, double tolerance = 1e-7) {
  check_rows(deformation, p);
  const Index m = deformation.control_count(), n = deformation.vertex_count();
  REQUIRE(p.rows() == m);
  const SparseField g = random_field(n, 2, 7);
  const SparseField pulled_field = deformation.pull_back(p, g);
  CHECK(std::is_sorted(pulled_field.index.begin(), pulled_field.index.end()));
  const Positions covector = dense(g, n), pulled = dense(pulled_field, m);
  for (Index control = 0; control < m; ++control) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(n);
    for (int axis = 0; axis < 3; ++axis) {
      const Positions expected = difference(deformation, p, control, axis, 1e-5);
      Controls unit = Controls::Zero(m, 3);
      unit(control, axis) = 1;
      CHECK((deformation.push_forward(p, unit) - expected).cwiseAbs().sum() < tolerance * n);
      CHECK(pulled(control, axis) == doctest::Approx(covector.cwiseProduct(expected).sum()).epsilon(tolerance * n));
      moved += expected.rowwise().squaredNorm();
    }
    const std::vector<Index> support = deformation.support(control);
    CHECK(std::is_sorted(support.begin(), support.end()));
    for (Index vertex = 0; vertex < n; ++vertex)
      if (moved[vertex] > tolerance) CHECK(std::binary_search(support.begin(), support.end(), vertex));
  }
}

/// J, (3n, 3m), column by column from push_forward.
inline Eigen::MatrixXd dense_jacobian(const Deformation& deformation, const Controls& p) {
  const Index m = deformation.control_count(), n = deformation.vertex_count();
  Eigen::MatrixXd jacobian(3 * n, 3 * m);
  for (Index column = 0; column < 3 * m; ++column) {
    Controls unit = Controls::Zero(m, 3);
    unit(column / 3, column % 3) = 1;
    const Positions moved = deformation.push_forward(p, unit);
    jacobian.col(column) = Eigen::Map<const Eigen::VectorXd>(moved.data(), 3 * n);
  }
  return jacobian;
}

/// The weight of each degree of freedom, (3m).
inline Eigen::VectorXd weights_of_freedoms(const MetricOptions& options, Index m) {
  if (options.weights.size() == 0) return Eigen::VectorXd::Ones(3 * m);
  if (options.weights.size() == 3 * m) return options.weights;
  Eigen::VectorXd weights(3 * m);
  for (Index row = 0; row < 3 * m; ++row) weights[row] = options.weights[row / 3];
  return weights;
}

/// The axes of a metric's damping if the weights have other axes than x, y and z.
enum class DampingAxes { weights, world };

/// `metric` against W^1/2 (J'J + diag(damping))^-1 W^1/2 of the degrees of freedom whose weight is positive.
/// @param damping (3m) added to the diagonal of J'J
inline void check_metric(const Deformation& deformation, const Controls& p, const MetricOptions& options,
                         const Eigen::VectorXd& damping, DampingAxes damping_along = DampingAxes::weights) {
  constexpr double tolerance = 1e-9;
  const Index m = deformation.control_count();
  const Eigen::MatrixXd jacobian = dense_jacobian(deformation, p);
  Eigen::MatrixXd full = jacobian.transpose() * jacobian;
  const Eigen::VectorXd weights = weights_of_freedoms(options, m);
  Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(3 * m, 3 * m);
  for (std::size_t k = 0; k < options.weight_axes.size(); ++k)
    axes.block<3, 3>(3 * static_cast<Index>(k), 3 * static_cast<Index>(k)) = options.weight_axes[k];
  if (damping_along == DampingAxes::world) full.diagonal() += damping;
  full = (axes.transpose() * full * axes).eval();
  if (damping_along == DampingAxes::weights) full.diagonal() += damping;
  std::vector<Index> free;
  for (Index row = 0; row < 3 * m; ++row)
    if (weights[row] > 0) free.push_back(row);
  const SparseField g = random_field(m, 1, 11);
  const Positions covector = dense(g, m);
  const Eigen::VectorXd flat = axes.transpose() * Eigen::Map<const Eigen::VectorXd>(covector.data(), 3 * m);
  Eigen::VectorXd root(static_cast<Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) root[static_cast<Index>(k)] = std::sqrt(weights[free[k]]);
  const Eigen::VectorXd solution =
      root.cwiseProduct(Eigen::MatrixXd(full(free, free)).partialPivLu().solve(root.cwiseProduct(flat(free))));
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(3 * m);
  expected(free) = solution;
  expected = (axes * expected).eval();

  const SparseField step = deformation.metric(options)->apply_inverse(p, g);
  CHECK(std::is_sorted(step.index.begin(), step.index.end()));
  for (const Index control : step.index) CHECK(weights.segment<3>(3 * control).maxCoeff() > 0);
  const Positions found = dense(step, m);
  if (options.weight_axes.empty())
    for (Index row = 0; row < 3 * m; ++row)
      if (weights[row] == 0) CHECK(found(row / 3, row % 3) == 0);
  CHECK((Eigen::Map<const Eigen::VectorXd>(found.data(), 3 * m) - expected).norm() <= tolerance * expected.norm());
}

/// Damping of linear deformations: along each axis eps times the mean diagonal of J'J over the controls that may
/// respond along it.
inline Eigen::VectorXd mean_damping(const Deformation& deformation, const Controls& p, const MetricOptions& options) {
  const Eigen::VectorXd diagonal = dense_jacobian(deformation, p).colwise().squaredNorm();
  const Eigen::VectorXd weights = weights_of_freedoms(options, static_cast<Index>(diagonal.size()) / 3);
  Eigen::VectorXd damping(diagonal.size());
  for (Index axis = 0; axis < 3; ++axis) {
    double sum = 0, count = 0;
    for (Index row = axis; row < diagonal.size(); row += 3) {
      if (weights[row] == 0) continue;
      sum += diagonal[row];
      ++count;
    }
    for (Index row = axis; row < diagonal.size(); row += 3) damping[row] = options.smoothness * sum / count;
  }
  return damping;
}

/// Random weights for each coordinate of `count` controls, a third of them 0, and optional random axes.
inline MetricOptions random_axis_weights(Index count, unsigned seed, bool turned) {
  MetricOptions options;
  std::mt19937 random(seed);
  const double choices[] = {0, 0.3, 2};
  options.weights.resize(3 * count);
  for (double& weight : options.weights) weight = choices[random() % 3];
  if (turned) {
    const Eigen::Quaterniond rotation(0.8, 0.2, -0.4, 0.4);
    options.weight_axes.assign(static_cast<std::size_t>(count), rotation.normalized().toRotationMatrix());
  }
  return options;
}

}  // namespace stiv::testing
