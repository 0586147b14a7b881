// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/checks.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "stiv/error.hpp"

namespace stiv {

namespace {

void check_axes(const std::vector<Eigen::Matrix3d>& axes, Index count) {
  if (axes.empty()) return;
  if (static_cast<Index>(axes.size()) != count)
    throw InputError(std::to_string(axes.size()) + " weight axes for " + std::to_string(count) +
                     " controls; give a rotation for each, or none");
  for (std::size_t control = 0; control < axes.size(); ++control) {
    const Eigen::Matrix3d error = axes[control].transpose() * axes[control] - Eigen::Matrix3d::Identity();
    if (!(error.cwiseAbs().maxCoeff() < 1e-9))
      throw InputError("control " + std::to_string(control) + ": weight axes must be orthonormal columns");
  }
}

}  // namespace

void check_control_rows(const Controls& p, Index count) {
  if (p.rows() == count) return;
  throw InputError("controls have " + std::to_string(p.rows()) + " rows, the deformation has " + std::to_string(count) +
                   " controls; give one row for each");
}

void check_finite(const Positions& positions, const char* what) {
  for (Index row = 0; row < positions.rows(); ++row)
    if (!positions.row(row).allFinite())
      throw InputError(std::string(what) + " " + std::to_string(row) + ": coordinate is not finite");
}

ResponseWeights checked_weights(const MetricOptions& options, Index count) {
  if (!(options.smoothness > 0) || !std::isfinite(options.smoothness))
    throw InputError("smoothness " + std::to_string(options.smoothness) +
                     " must be positive and finite; the default is 0.1");
  check_axes(options.weight_axes, count);
  const Eigen::VectorXd& weights = options.weights;
  if (weights.size() == 0) return {Eigen::VectorXd::Ones(count), {}};
  const bool by_axis = weights.size() != count;
  if (by_axis && weights.size() != 3 * count)
    throw InputError(std::to_string(weights.size()) + " control weights for " + std::to_string(count) +
                     " controls; give one for each, three for each, or none");
  for (Index k = 0; k < weights.size(); ++k)
    if (!(weights[k] >= 0) || !std::isfinite(weights[k]))
      throw InputError("control " + std::to_string(by_axis ? k / 3 : k) + ": weight must be finite and not negative");
  if (!by_axis) return {weights, {}};
  Eigen::MatrixXd values = Eigen::Map<const Positions>(weights.data(), count, 3);
  const bool alike = values.col(0) == values.col(1) && values.col(0) == values.col(2);
  if (alike) return {values.col(0), {}};
  return {std::move(values), options.weight_axes};
}

}  // namespace stiv
