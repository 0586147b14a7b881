// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/edit_result.hpp"

#include <algorithm>

namespace stiv {

namespace {

/// Ascending, each once.
std::vector<Index> bodies_in_contact(const Surface& surface, const Events& events) {
  std::vector<Index> bodies;
  for (const Event& event : events)
    for (const Index vertex : event.vertices) bodies.push_back(surface.body_of(vertex));
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

}  // namespace

EditStatus status_of(const EditContext& context, const Controls& before, const Controls& accepted, const Controls& goal,
                     const EditReport& report) {
  if (report.goal_is_infeasible) return EditStatus::blocked;
  if (context.limits().contain(goal) && (accepted == goal || accepted == context.stored(goal)))
    return accepted == before ? EditStatus::unchanged : EditStatus::reached;
  return report.blocked ? EditStatus::blocked : EditStatus::corrected;
}

EditResult make_result(const EditContext& context, const State& accepted, const Positions& goal_surface,
                       EditReport report, EditStatus status, const Execution& execution) {
  EditResult result;
  result.status = status;
  result.controls = accepted.controls;
  result.surface = accepted.surface;
  result.energy = context.energy(accepted.surface, goal_surface);
  result.fraction = report.fraction;
  if (status == EditStatus::blocked) result.blocking = bodies_in_contact(context.surface(), report.events);
  result.events = std::move(report.events);
  result.patches = report.patches;
  result.path = std::move(report.path);
  result.counters = execution.counters;
  result.timings = execution.timings;
  return result;
}

}  // namespace stiv
