// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <mutex>

#include "deformation/metric/active_controls.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/deformation/metric.hpp"

namespace stiv {

/// Weights of controls at vertices, stored by controls.
using WeightColumns = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// The metric of q = M p + c: M'M of the active controls, damped by eps times its mean diagonal. For few controls it
/// stores the inverse, of which a sparse right-hand side reads few columns; for many, a sparse factor. M'M of few
/// controls is summed once: sessions near other obstacles and tight edits need other metrics of the same weights.
/// (mathematics.md, "Metric")
class LinearMetrics {
 public:
  explicit LinearMetrics(const WeightMatrix& matrix);

  const WeightColumns& matrix() const { return matrix_; }
  std::unique_ptr<Metric> make(const MetricOptions& options) const;

 private:
  std::unique_ptr<Metric> make_of_active(double smoothness, ActiveControls active) const;
  Eigen::MatrixXd gram_of(const std::vector<Index>& controls) const;

  WeightColumns matrix_;
  Eigen::VectorXd squared_lengths_;
  mutable std::once_flag summed_;
  mutable Eigen::MatrixXd gram_;  ///< M'M; empty for many controls
};

}  // namespace stiv
