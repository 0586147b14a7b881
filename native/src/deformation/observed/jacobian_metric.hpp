// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "deformation/observed/jacobian.hpp"
#include "stiv/deformation/metric.hpp"

namespace stiv {

/// The metric of J'GJ, damped by eps times its mean diagonal over the active coordinates. (mathematics.md, "Metric")
/// @param surface_gram G, (n, n); null: the identity
std::unique_ptr<Metric> make_jacobian_metric(const JacobianProducts& jacobian, const MetricOptions& options,
                                             const WeightMatrix* surface_gram);

}  // namespace stiv
