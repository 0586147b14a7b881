// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/control_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "editing/limit_constraint.hpp"

namespace stiv {

namespace {

constexpr double deviation_factor = 2;  // of the distance that vertices miss their goals by
constexpr double least_influence = 0.25;

Vector3 weights_of(const EditOptions& options, Index control, Index controls) {
  if (options.weights.size() == 0) return Vector3::Ones();
  if (options.weights.size() == controls) return Vector3::Constant(options.weights[control]);
  return options.weights.segment<3>(3 * control);
}

/// The distance by which a control's vertices miss their goals at most.
double largest_miss(const Deformation& deformation, Index control, const Eigen::VectorXd& missing) {
  double largest = 0;
  for (const Index vertex : deformation.support(control)) largest = std::max(largest, missing[vertex]);
  return largest;
}

/// The motion of the fastest vertex for a unit of a scalar.
double largest_speed(const Deformation& deformation, const Controls& p, Index row) {
  Controls unit = Controls::Zero(p.rows(), 3);
  unit(row, 0) = 1;
  return deformation.push_forward(p, unit).rowwise().norm().maxCoeff();
}

}  // namespace

ControlBox::ControlBox(const EditContext& context, const State& accepted, const State& goal, const Execution& execution)
    : goal_(goal.controls),
      reach_(goal.controls.rows(), 3),
      axes_(context.options().weight_axes),
      first_name_(2 * static_cast<Index>(context.limits().rows().size())) {
  const Deformation& deformation = context.deformation();
  const Eigen::VectorXd missing = (goal.surface - accepted.surface).rowwise().norm();
  const Influence controls = deformation.influence(accepted.controls, missing, execution);
  const auto count = static_cast<Index>(reach_.rows());
  for (Index k = 0; k < count; ++k) {
    const double distance = deviation_factor * controls.miss[k] / std::max(controls.largest[k], least_influence);
    reach_.row(k) = distance * weights_of(context.options(), k, count).cwiseMin(1).transpose();
  }
  for (const Index row : context.limits().rows()) {
    const double speed = largest_speed(deformation, accepted.controls, row);
    reach_.row(row).setConstant(speed > 0 ? deviation_factor * largest_miss(deformation, row, missing) / speed : 0);
  }
  for (const Index row : deformation.rotation_rows())
    reach_.row(row).setConstant(std::numeric_limits<double>::infinity());
  for (Index k = 0; k < count; ++k)
    for (int number = 0; number < 3; ++number) {
      const Vector3 deviation = (accepted.controls.row(k) - goal_.row(k)).transpose();
      reach_(k, number) = std::max(reach_(k, number), std::abs(axis(k, number).dot(deviation)));
    }
}

Vector3 ControlBox::axis(Index control, int number) const {
  return axes_.empty() ? Vector3(Vector3::Unit(number)) : Vector3(axes_[at(control)].col(number));
}

std::vector<ControlConstraint> ControlBox::exceeded(const Controls& p, const ConstraintSet& constraints,
                                                    const Metric& metric, const Controls& metric_at) const {
  std::vector<ControlConstraint> sides;
  for (Index k = 0; k < static_cast<Index>(reach_.rows()); ++k)
    for (int number = 0; number < 3; ++number) {
      const double deviation = axis(k, number).dot((p.row(k) - goal_.row(k)).transpose());
      if (!(std::abs(deviation) > reach_(k, number))) continue;
      const double sign = deviation > 0 ? -1 : 1;
      const Index name = first_name_ + 6 * k + 2 * number + (sign < 0);
      if (constraints.has_limit(name)) continue;
      const Vector3 direction = sign * axis(k, number);
      const double bound = direction.dot(goal_.row(k).transpose()) - reach_(k, number);
      if (std::optional<ControlConstraint> side = limit_constraint(k, direction, bound, name, metric, metric_at))
        sides.push_back(std::move(*side));
    }
  return sides;
}

}  // namespace stiv
