// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/linear_metric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <utility>

#include "deformation/checks.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Up to so many controls the inverse is kept in full: a few MB, and lattices fill it anyway.
constexpr Index dense_limit = 600;

/// The controls that the metric acts on, and the root of the weight of each.
struct ActiveControls {
  std::vector<Index> control;
  std::vector<double> root_weight;
  std::vector<Index> place;  ///< by control: its place among the active, or -1
};

ActiveControls active_controls(const WeightColumns& matrix, const Eigen::VectorXd& weights) {
  ActiveControls active;
  active.place.assign(static_cast<std::size_t>(matrix.cols()), -1);
  for (Index control = 0; control < matrix.cols(); ++control) {
    if (weights[control] == 0 || !(matrix.col(control).squaredNorm() > 0)) continue;
    active.place[static_cast<std::size_t>(control)] = static_cast<Index>(active.control.size());
    active.control.push_back(control);
    active.root_weight.push_back(std::sqrt(weights[control]));
  }
  return active;
}

WeightColumns selected_columns(const WeightColumns& matrix, const std::vector<Index>& columns) {
  WeightColumns selected(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    selected.startVec(static_cast<Index>(k));
    for (WeightColumns::InnerIterator entry(matrix, columns[k]); entry; ++entry)
      selected.insertBack(entry.row(), static_cast<Index>(k)) = entry.value();
  }
  selected.finalize();
  return selected;
}

/// M'M summed vertex by vertex into a dense matrix: a lattice's 64 weights a vertex fill it, whatever the order.
Eigen::MatrixXd dense_gram(const WeightColumns& matrix) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor, Index> rows = matrix;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(matrix.cols(), matrix.cols());
  using Entry = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>::InnerIterator;
  for (Index row = 0; row < rows.rows(); ++row)
    for (Entry a(rows, row); a; ++a)
      for (Entry b(rows, row); b && b.col() <= a.col(); ++b) gram(a.col(), b.col()) += a.value() * b.value();
  return gram.selfadjointView<Eigen::Lower>();
}

/// Values over the active controls, W^1/2 applied, from a covector over all; which of them are not zero.
struct ActiveVector {
  std::vector<Index> place;
  std::vector<Vector3> value;
};

ActiveVector restrict_to(const ActiveControls& active, const SparseField& g) {
  ActiveVector restricted;
  for (std::size_t k = 0; k < g.index.size(); ++k) {
    const Index place = active.place[static_cast<std::size_t>(g.index[k])];
    if (place < 0) continue;
    restricted.place.push_back(place);
    restricted.value.push_back(active.root_weight[static_cast<std::size_t>(place)] * g.value[k]);
  }
  return restricted;
}

SparseField extend_from(const ActiveControls& active, const Eigen::Matrix<double, Eigen::Dynamic, 3>& solution) {
  SparseField step;
  step.index = active.control;
  step.value.resize(active.control.size());
  for (std::size_t k = 0; k < step.value.size(); ++k)
    step.value[k] = active.root_weight[k] * solution.row(static_cast<Index>(k)).transpose();
  return step;
}

class DenseLinearMetric final : public Metric {
 public:
  DenseLinearMetric(const WeightColumns& matrix, double smoothness, ActiveControls active)
      : active_(std::move(active)) {
    if (matrix.cols() == 0) return;
    Eigen::MatrixXd damped = dense_gram(matrix);
    damped.diagonal().array() += smoothness * damped.diagonal().mean();
    inverse_ = damped.llt().solve(Eigen::MatrixXd::Identity(damped.rows(), damped.cols()));
  }

  SparseField apply_inverse(const Controls&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    Eigen::Matrix<double, Eigen::Dynamic, 3> solution(inverse_.rows(), 3);
    solution.setZero();
    for (std::size_t k = 0; k < right.place.size(); ++k)
      for (Index axis = 0; axis < 3; ++axis) solution.col(axis) += right.value[k][axis] * inverse_.col(right.place[k]);
    return extend_from(active_, solution);
  }

 private:
  ActiveControls active_;
  Eigen::MatrixXd inverse_;
};

class SparseLinearMetric final : public Metric {
 public:
  SparseLinearMetric(const WeightColumns& matrix, double smoothness, ActiveControls active)
      : active_(std::move(active)) {
    WeightColumns damped = WeightColumns(matrix.transpose()) * matrix;
    const double damping = smoothness * damped.diagonal().mean();
    for (Index k = 0; k < damped.cols(); ++k) damped.coeffRef(k, k) += damping;
    factor_.compute(damped);
    if (factor_.info() != Eigen::Success)
      throw InputError("the metric of the controls cannot be factored: weights are too large or too small");
  }

  SparseField apply_inverse(const Controls&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    Eigen::Matrix<double, Eigen::Dynamic, 3> dense(factor_.rows(), 3);
    dense.setZero();
    for (std::size_t k = 0; k < right.place.size(); ++k) dense.row(right.place[k]) = right.value[k].transpose();
    return extend_from(active_, factor_.solve(dense));
  }

 private:
  ActiveControls active_;
  Eigen::SimplicialLDLT<WeightColumns> factor_;
};

}  // namespace

std::unique_ptr<Metric> make_linear_metric(const WeightColumns& matrix, const MetricOptions& options) {
  ActiveControls active = active_controls(matrix, checked_weights(options, static_cast<Index>(matrix.cols())));
  const WeightColumns selected = selected_columns(matrix, active.control);
  if (selected.cols() <= dense_limit)
    return std::make_unique<DenseLinearMetric>(selected, options.smoothness, std::move(active));
  return std::make_unique<SparseLinearMetric>(selected, options.smoothness, std::move(active));
}

}  // namespace stiv
