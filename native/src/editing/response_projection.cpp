// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/response_projection.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "editing/control_box.hpp"

namespace stiv {

namespace {

/// Limits that p exceeds and `constraints` do not contain yet.
std::vector<ControlConstraint> exceeded_limits(const EditCall& call, const ConstraintSet& constraints,
                                               const Controls& p) {
  const Metric& metric = ready_metric(call);
  const Controls& metric_at = call.accepted.controls;
  std::vector<ControlConstraint> limits = call.context.limits().exceeded(p, constraints, metric, metric_at);
  if (call.box == nullptr) return limits;
  for (ControlConstraint& side : call.box->exceeded(p, constraints, metric, metric_at))
    limits.push_back(std::move(side));
  return limits;
}

}  // namespace

const Metric& ready_metric(const EditCall& call) {
  const Metric& metric = call.metric != nullptr ? *call.metric : call.context.metric();
  while (!metric.is_ready()) {
    call.execution.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return metric;
}

Controls project_within_limits(const EditCall& call, ConstraintSet& constraints, const Controls& from) {
  const bool solves_lcp = call.context.options().solver == ConstraintSolver::lcp;
  for (;;) {
    Controls p =
        solves_lcp ? constraints.project(from, call.execution) : constraints.project_as_equations(from, call.execution);
    std::vector<ControlConstraint> limits = exceeded_limits(call, constraints, p);
    if (limits.empty()) return p;
    constraints.add(std::move(limits));
  }
}

}  // namespace stiv
