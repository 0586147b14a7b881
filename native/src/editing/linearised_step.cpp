// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/linearised_step.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "editing/response_projection.hpp"
#include "editing/round_volumes.hpp"
#include "stiv/volumes/region.hpp"

namespace stiv {

namespace {

constexpr int max_rounds = 32;
constexpr double ease = 2e-3;  // of the threshold, beyond the tolerance of detection

double target_distance(const PairClearance& clearance) {
  return clearance.threshold + std::min(ease * clearance.threshold, clearance.margin);
}

/// The approach of a contact's plane at the accepted surface, with its gradient. Obstacles come last and have none.
Stiv linearised(const Event& event, const Positions& accepted, Index first_obstacle) {
  Stiv stiv;
  stiv.volume = event.normal.dot(weighted_sum(event, accepted)) - target_distance(event.clearance);
  std::array<int, 4> corners{0, 1, 2, 3};
  std::sort(corners.begin(), corners.end(), [&](int a, int b) { return event.vertices[a] < event.vertices[b]; });
  for (const int corner : corners) {
    if (event.vertices[corner] >= first_obstacle) continue;
    stiv.gradient.index.push_back(event.vertices[corner]);
    stiv.gradient.value.push_back(event.weights[corner] * event.normal);
  }
  return stiv;
}

/// Constraints of the contacts on the linearised way to the controls p; none if there are none.
std::vector<ControlConstraint> contacts_toward(EditCall& call, const Controls& p) {
  const EditContext& context = call.context;
  const Deformation& deformation = context.deformation();
  const State& accepted = call.accepted;
  const Positions ahead = accepted.surface + deformation.push_forward(accepted.controls, p - accepted.controls);
  const std::optional<Events> events = call.queries.find(accepted.surface, ahead, PairLimit::respected, call.execution);
  if (!events || events->empty()) return {};
  const auto [start, end] = call.queries.at_events(*events, accepted.surface, ahead);
  std::vector<Stiv> volumes;
  for (const Region& region : contact_regions(context.surface(), *events, start, end))
    volumes.push_back(linearised((*events)[at(region.event)], start, deformation.vertex_count()));
  return control_constraints(volumes, deformation, accepted.controls, ready_metric(call), accepted.controls,
                             &call.execution);
}

}  // namespace

Controls linearised_step(EditCall& call, const Controls& ahead) {
  ConstraintSet constraints;
  Controls p = project_within_limits(call, constraints, ahead);
  for (int round = 0; round < max_rounds; ++round) {
    call.execution.check();
    std::vector<ControlConstraint> contacts = contacts_toward(call, p);
    if (contacts.empty() || constraints.size() + contacts.size() > max_constraints(call.context)) break;
    constraints.add(std::move(contacts));
    p = project_within_limits(call, constraints, ahead);
  }
  return p;
}

}  // namespace stiv
