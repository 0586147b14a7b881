// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/checks.hpp"

#include <cmath>
#include <string>

#include "stiv/error.hpp"

namespace stiv {

void check_control_rows(const Controls& p, Index count) {
  if (p.rows() == count) return;
  throw InputError("controls have " + std::to_string(p.rows()) + " rows, the deformation has " + std::to_string(count) +
                   " controls: give one row for each");
}

void check_finite(const Positions& positions, const char* what) {
  for (Index row = 0; row < positions.rows(); ++row)
    if (!positions.row(row).allFinite())
      throw InputError(std::string(what) + " " + std::to_string(row) + ": coordinate is not finite");
}

Eigen::VectorXd checked_weights(const MetricOptions& options, Index count) {
  if (!(options.smoothness > 0) || !std::isfinite(options.smoothness))
    throw InputError("smoothness " + std::to_string(options.smoothness) + " must be positive and finite; usual is 0.1");
  if (options.weights.size() == 0) return Eigen::VectorXd::Ones(count);
  if (options.weights.size() != count)
    throw InputError("there are " + std::to_string(options.weights.size()) + " control weights for " +
                     std::to_string(count) + " controls: give one for each, or none");
  for (Index control = 0; control < count; ++control)
    if (!(options.weights[control] >= 0) || !std::isfinite(options.weights[control]))
      throw InputError("control " + std::to_string(control) + ": weight must be finite and not negative");
  return options.weights;
}

}  // namespace stiv
