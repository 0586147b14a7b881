// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/edit_result.hpp"

#include <algorithm>

namespace stiv {

std::vector<Index> bodies_in_contact(const Surface& surface, const Events& events) {
  std::vector<Index> bodies;
  for (const Event& event : events)
    for (const Index vertex : event.vertices) bodies.push_back(surface.body_of(vertex));
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

EditStatus status_of(const Problem& problem, const State& before, const State& accepted, const Controls& goal,
                     const SolveReport& report) {
  if (accepted.controls == goal || accepted.controls == problem.stored(goal))
    return accepted.controls == before.controls ? EditStatus::unchanged : EditStatus::reached;
  return report.blocked ? EditStatus::blocked : EditStatus::corrected;
}

EditResult make_result(const Problem& problem, const State& accepted, const Positions& goal_surface, SolveReport report,
                       EditStatus status) {
  EditResult result;
  result.status = status;
  result.controls = accepted.controls;
  result.surface = accepted.surface;
  result.energy = energy(accepted.surface, goal_surface);
  result.fraction = report.fraction;
  if (status == EditStatus::blocked) result.blocking = bodies_in_contact(problem.surface(), report.events);
  result.events = std::move(report.events);
  result.patches = report.patches;
  result.path = std::move(report.path);
  return result;
}

}  // namespace stiv
