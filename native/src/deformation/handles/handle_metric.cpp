// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/truncated_map.hpp"
#include "deformation/metric/axis_metric.hpp"
#include "deformation/metric/gram_metric.hpp"

namespace stiv {

Eigen::MatrixXd HandleMap::gram(const WeightMatrix* surface_gram) const {
  if (surface_gram != nullptr) return full_.transpose() * (*surface_gram * full_);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(control_count(), control_count());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(full_.transpose());
  return gram.selfadjointView<Eigen::Lower>();
}

std::unique_ptr<Metric> HandleMap::metric(const MetricOptions& options, const WeightMatrix* surface_gram) const {
  ResponseWeights weights = checked_weights(options, control_count());
  if (is_truncated()) {
    const Eigen::VectorXd diagonal = gram_diagonal(*truncated_, surface_gram);
    return make_axis_metric(std::move(weights), [&](const Eigen::VectorXd& some) {
      return make_diagonal_metric(diagonal, options.smoothness, active_controls(diagonal, some));
    });
  }
  const double products = static_cast<double>(vertex_count()) * control_count() * control_count();
  if (!is_full() || products > limits_.products) {
    const auto product = [&](const ColumnBlock& d) { return gram_product(d, surface_gram); };
    return make_axis_metric(std::move(weights), [&](const Eigen::VectorXd& some) {
      return make_low_rank_metric(product, limits_.probes, options.smoothness,
                                  active_controls(Eigen::VectorXd::Ones(control_count()), some));
    });
  }
  const Eigen::MatrixXd whole = gram(surface_gram);
  return make_axis_metric(std::move(weights), [&](const Eigen::VectorXd& some) {
    ActiveControls active = active_controls(whole.diagonal(), some);
    Eigen::MatrixXd selected = whole(active.control, active.control);
    return make_gram_metric(std::move(selected), options.smoothness, std::move(active));
  });
}

}  // namespace stiv
