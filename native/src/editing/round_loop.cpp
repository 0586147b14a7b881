// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/round_loop.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "editing/contact_memory.hpp"
#include "editing/control_interpolation.hpp"
#include "editing/feasible_state.hpp"
#include "editing/response_projection.hpp"
#include "editing/round_volumes.hpp"
#include "stiv/error.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/volumes/relative.hpp"

namespace stiv {

namespace {

/// If even this fraction of the way exceeds the pair limit, the start itself has too many close pairs.
constexpr double smallest_fraction = 0x1p-16;

/// `is_diverging` needs the whole surface of a candidate, so it is called only this often.
constexpr int rounds_before_giving_up = 6;

/// Halvings of a step to where there is a surface; after the last one, the accepted state is the candidate.
constexpr int max_halvings = 16;

/// Removes the vertices of obstacles, which come last.
void leave_out_obstacles(SparseField& field, Index first) {
  const auto end = std::lower_bound(field.index.begin(), field.index.end(), first);
  const auto count = static_cast<std::size_t>(end - field.index.begin());
  field.index.resize(count);
  field.value.resize(count);
}

/// Whether rounds begin with the contacts of the last ones, and leave theirs to the next ones.
bool shares_contacts(const EditCall& call, Projection projection) {
  return call.contacts != nullptr && projection == Projection::from_goal;
}

/// The rounds to resume, or new ones.
RoundProgress& progress_toward(EditCall& call, const Controls& goal, Projection projection) {
  std::optional<RoundProgress>& progress = call.progress;
  if (progress && progress->belongs_to(call.accepted.controls, goal, projection)) return *progress;
  progress = RoundProgress{call.accepted.controls, goal, projection, {}, goal, projection == Projection::from_goal};
  if (!shares_contacts(call, projection)) return *progress;
  progress->constraints = call.contacts->take();
  if (progress->constraints.size() == 0) return *progress;
  const ScopedTimer timer(call.execution.timings.response);
  progress->begins_with_contacts = true;
  progress->p = project_within_limits(call, progress->constraints, goal);
  return *progress;
}

/// The fraction whose rounds the time budget interrupted, if it is `fraction` or a later trial; else `fraction`.
double fraction_to_resume(const EditCall& call, Projection projection, double fraction,
                          const std::function<Controls(double)>& goal_at) {
  const std::optional<RoundProgress>& progress = call.progress;
  if (!progress || progress->projection != projection || progress->accepted != call.accepted.controls) return fraction;
  for (double begun = fraction; begun >= smallest_fraction; begun /= 2)
    if (progress->goal == goal_at(begun)) return begun;
  return fraction;
}

}  // namespace

RoundLoop::RoundLoop(EditCall& call, const Controls& goal, Projection projection, PairLimit pair_limit,
                     FirstSearch first, const StatePredicate& is_diverging)
    : call_(call),
      options_(call.context.options()),
      first_(first),
      is_diverging_(is_diverging),
      progress_(progress_toward(call, goal, projection)) {
  outcome_.pair_limit = pair_limit;
  if (progress_.cache_is_pruned) outcome_.candidate.surface = call.accepted.surface;  // else it is placed as a whole
}

RoundOutcome RoundLoop::run() {
  for (; candidate() && search() && constrain(); ++progress_.round) project();
  outcome_.is_cut = progress_.is_cut;
  if (outcome_.clear && progress_.accumulates && shares_contacts(call_, progress_.projection))
    call_.contacts->keep(std::exchange(progress_.constraints, {}));
  return std::move(outcome_);
}

/// The candidate of the next round; false if it is the last or the rounds diverge.
bool RoundLoop::candidate() {
  call_.execution.check();
  call_.execution.report("rounds", static_cast<double>(progress_.round) / options_.max_rounds);
  outcome_.candidate.controls = call_.context.stored(progress_.p);
  const bool is_last = progress_.round == options_.max_rounds;
  const bool asks =
      is_diverging_ && progress_.accumulates && progress_.round > 0 && progress_.round % rounds_before_giving_up == 0;
  if (is_last || asks || progress_.events) place_surface();
  outcome_.given_up = !is_last && asks && is_diverging_(outcome_.candidate);
  return !is_last && !outcome_.given_up;
}

/// Finds events on the step to the candidate; false if there are none or the step exceeds the pair limit.
bool RoundLoop::search() {
  if (!progress_.events) {
    std::optional<Events> events = find_events();
    outcome_.too_far = !events;
    if (outcome_.too_far) return false;
    progress_.events = std::move(events);
    call_.execution.checkpoint();
  }
  outcome_.clear = progress_.events->empty();
  return !outcome_.clear;
}

/// Adds the constraints of the events; false if no free control can change any of their volumes.
bool RoundLoop::constrain() {
  if (progress_.events_are_constrained) return true;
  ConstraintSet& constraints = progress_.constraints;
  ++call_.execution.counters.rounds;
  if (constraints.size() > max_constraints(call_.context) / 4) constraints.drop_inactive();
  if (areas_ == nullptr) areas_ = &call_.context.region_areas(call_.accepted.surface, call_.execution);
  const auto [start, end] =
      call_.queries.at_events(*progress_.events, call_.accepted.surface, outcome_.candidate.surface);
  RoundVolumes volumes = volumes_of_round(call_.context, {*progress_.events, start, end, *areas_}, progress_.round,
                                          constraints.size(), call_.execution);
  outcome_.patches = volumes.patches;
  std::vector<ControlConstraint> rows = linearised(std::move(volumes.stivs));
  if (rows.empty()) {
    outcome_.events = *progress_.events;  // a call that resumes these rounds needs them again
    place_surface();
    return false;
  }
  progress_.accumulates = progress_.accumulates && options_.solver == ConstraintSolver::lcp &&
                          (progress_.round < options_.accumulated_rounds || volumes.each_contact);
  if (!progress_.accumulates) constraints = ConstraintSet();
  constraints.add(std::move(rows));
  progress_.events_are_constrained = true;  // a projection that is interrupted must not add them twice
  return true;
}

std::vector<ControlConstraint> RoundLoop::linearised(std::vector<Stiv> stivs) const {
  const ScopedTimer timer(call_.execution.timings.response);
  for (Stiv& stiv : stivs) leave_out_obstacles(stiv.gradient, call_.context.deformation().vertex_count());
  return control_constraints(stivs, call_.context.deformation(), outcome_.candidate.controls, ready_metric(call_),
                             call_.accepted.controls, &call_.execution);
}

/// Projects to the next candidate.
void RoundLoop::project() {
  const ScopedTimer timer(call_.execution.timings.response);
  const Controls& from = progress_.accumulates ? progress_.goal : outcome_.candidate.controls;
  progress_.p = project_within_limits(call_, progress_.constraints, from);
  progress_.events_are_constrained = progress_.is_cut = false;
  outcome_.events = std::move(*progress_.events);
  progress_.events.reset();
  call_.execution.checkpoint();
}

/// Shortens the step to the candidate, at which there is no surface.
void RoundLoop::shorten_step(int cuts) {
  const Controls& from = call_.accepted.controls;
  ++call_.execution.counters.infeasible;
  progress_.p =
      cuts < max_halvings ? interpolate(from, outcome_.candidate.controls, 0.5, call_.context.rotation_rows()) : from;
  outcome_.candidate.controls = call_.context.stored(progress_.p);
  progress_.is_cut = true;
}

/// Evaluates the candidate, or the first one without InfeasibleError at half, a quarter and so on of the step to it.
template <class Evaluate>
auto RoundLoop::at_feasible_candidate(const Evaluate& evaluate) {
  for (int cuts = 1;; ++cuts) {
    try {
      return evaluate();
    } catch (const InfeasibleError&) {
      if (outcome_.candidate.controls == call_.accepted.controls) throw;
      shorten_step(cuts);
    }
  }
}

/// Events among the cached candidates or, if there are none, among all pairs. At the vertices of events, the
/// candidate's surface is that of `Deformation::surface_rows`; it is the whole one if there are none. Nothing if the
/// step exceeds the pair limit.
std::optional<Events> RoundLoop::find_events() {
  const Positions& start = call_.accepted.surface;
  const bool prunes = !progress_.cache_is_pruned, reads_rows = prunes && call_.context.deformation().has_exact_rows();
  std::optional<Positions> placed;
  if (prunes) {
    place_surface();
    prune_cache();
    progress_.cache_is_pruned = true;
    if (!reads_rows) placed = outcome_.candidate.surface;
  }
  const CandidateRows rows = reads_rows ? CandidateRows::placed : CandidateRows::to_be_placed;
  Events cached = at_feasible_candidate(
      [&] { return call_.queries.find_cached(start, outcome_.candidate, rows, call_.execution); });
  if (!cached.empty()) return cached;
  if (placed)
    outcome_.candidate.surface = std::move(*placed);
  else if (!reads_rows)
    place_surface();
  if (std::optional<Events> near = find_near_events()) return near;
  return call_.queries.find(start, outcome_.candidate.surface, outcome_.pair_limit, call_.execution);
}

/// Keeps the cached candidates of the step to the goal, even if the first candidate is closer: the next ones are not.
void RoundLoop::prune_cache() {
  std::optional<State> goal;
  if (progress_.begins_with_contacts)
    goal = feasible_state(call_.context, call_.context.stored(progress_.goal), call_.execution);
  call_.queries.prune_cache(call_.accepted.surface, goal ? goal->surface : outcome_.candidate.surface, call_.execution);
}

/// Events at the beginning of the step of a large body, which then is the candidate. Nothing if there are none, or if
/// the step is short or not the first.
std::optional<Events> RoundLoop::find_near_events() {
  const EditContext& context = call_.context;
  const bool projects_goal = options_.solver == ConstraintSolver::lcp && options_.accumulated_rounds > 0 &&
                             progress_.projection == Projection::from_goal;
  const bool is_first = progress_.round == 0 && !progress_.begins_with_contacts && first_ == FirstSearch::near_start;
  if (!is_first || !projects_goal || !context.has_large_body()) return std::nullopt;
  const double length = context.longest_displacement(call_.accepted.surface, outcome_.candidate.surface);
  if (length < 2 * context.first_reach()) return std::nullopt;
  const Controls begin = context.stored(interpolate(call_.accepted.controls, outcome_.candidate.controls,
                                                    context.first_reach() / length, context.rotation_rows()));
  std::optional<State> near = feasible_state(context, begin, call_.execution);
  if (!near) return std::nullopt;
  std::optional<Events> events =
      call_.queries.find(call_.accepted.surface, near->surface, outcome_.pair_limit, call_.execution);
  if (!events || events->empty()) return std::nullopt;
  progress_.p = begin;  // a call that resumes needs the candidate of the events
  outcome_.candidate = std::move(*near);
  return events;
}

void RoundLoop::place_surface() {
  outcome_.candidate.surface =
      at_feasible_candidate([&] { return call_.context.surface_at(outcome_.candidate.controls, call_.execution); });
}

RoundOutcome run_rounds_within_reach(EditCall& call, const Controls& goal, Projection projection, FirstSearch first,
                                     double& fraction, const StatePredicate& is_diverging) {
  const auto goal_at = [&](double part) {
    return interpolate(call.accepted.controls, goal, part, call.context.rotation_rows());
  };
  const auto run = [&](PairLimit limit) {
    return RoundLoop(call, goal_at(fraction), projection, limit, first, is_diverging).run();
  };
  for (fraction = fraction_to_resume(call, projection, std::min(1.0, 2 * fraction), goal_at);
       fraction >= smallest_fraction; fraction /= 2) {
    RoundOutcome outcome = run(PairLimit::respected);
    if (!outcome.too_far) return outcome;
    progress_toward(call, goal_at(fraction / 2), projection);
    call.execution.checkpoint();  // a call that ends here resumes with half the fraction
  }
  return run(PairLimit::ignored);
}

}  // namespace stiv
