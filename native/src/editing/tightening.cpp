// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/tightening.hpp"

#include <algorithm>

#include "editing/drag.hpp"
#include "editing/linearised_step.hpp"
#include "editing/response_projection.hpp"
#include "editing/sub_edit_loop.hpp"
#include "response/sparse_fields.hpp"

namespace stiv {

namespace {

constexpr int max_settlings = 12;
constexpr int max_pulls = 100;
constexpr int poor_pulls_before_next_level = 2;  // in a row
constexpr double least_gain = 1e-4;  // relative drop of the energy; below it a settling, pull or level is poor
constexpr double smallest_part = 1.0 / 64;

class Tightening {
 public:
  Tightening(EditCall& call, const Aim& aim, TighteningProgress& progress)
      : call_(call), aim_(aim), progress_(progress) {}

  void run();

 private:
  double energy_now() const { return call_.context.energy(call_.accepted.surface, aim_.surface); }
  Controls step() const;
  double fraction_nearest_to_goal(const Controls& motion) const;
  Controls projected(const Controls& ahead) const;
  bool is_balanced(const Controls& goal) const;
  std::optional<double> pull();
  bool run_level();

  EditCall& call_;
  const Aim& aim_;
  TighteningProgress& progress_;
  const bool turns_ = !call_.context.deformation().rotation_rows().empty();
};

/// The motion M^-1 J' (q~ - f(p)) of the controls, in which pinned controls rest.
Controls Tightening::step() const {
  const Controls& p = call_.accepted.controls;
  SparseField missing;
  for (Index vertex = 0; vertex < static_cast<Index>(aim_.surface.rows()); ++vertex) {
    const Vector3 way = (aim_.surface.row(vertex) - call_.accepted.surface.row(vertex)).transpose();
    if (way.isZero(0)) continue;
    missing.index.push_back(vertex);
    missing.value.push_back(way);
  }
  Controls motion = Controls::Zero(p.rows(), 3);
  add_scaled(motion, 1, ready_metric(call_).apply_inverse(p, call_.context.deformation().pull_back(p, missing)));
  return motion;
}

/// Where along a motion the linearised surface is nearest to the goal: damping makes the motion too short, and response
/// weights scale it.
double Tightening::fraction_nearest_to_goal(const Controls& motion) const {
  const Positions moved = call_.context.deformation().push_forward(call_.accepted.controls, motion);
  const double squared_length = moved.squaredNorm();
  return squared_length > 0 ? (aim_.surface - call_.accepted.surface).cwiseProduct(moved).sum() / squared_length : 0;
}

/// Contacts of turning bodies are linear only near the state at which they are linearised.
Controls Tightening::projected(const Controls& ahead) const {
  if (turns_) return linearised_step(call_, ahead);
  ConstraintSet limits;
  return project_within_limits(call_, limits, ahead);
}

/// Is the motion to these controls as short as rounding? Then contacts balance the step, and shorter ones too.
bool Tightening::is_balanced(const Controls& goal) const {
  const Controls& p = call_.accepted.controls;
  const Positions motion = call_.context.deformation().push_forward(p, goal - p);
  const double longest = motion.rowwise().squaredNorm().maxCoeff(), rounding = call_.context.least_separation();
  return longest <= rounding * rounding;
}

/// Pulls along a part of the step. Returns the relative drop of the energy, or nothing if the whole step is balanced.
std::optional<double> Tightening::pull() {
  const double before = energy_now();
  const Controls motion = step();
  const Controls ahead = call_.accepted.controls + progress_.part * fraction_nearest_to_goal(motion) * motion;
  const Controls goal = call_.context.limits().nearest(projected(ahead));
  if (turns_ && progress_.part == 1 && is_balanced(goal)) return std::nullopt;
  if (call_.context.stored(goal) == call_.accepted.controls) return 0;
  run_sub_edits_by_steps(call_, {goal, aim_.surface, true});
  return 1 - energy_now() / before;
}

/// Pulls until two are poor without a good one between them. The part of the step is halved where the surface or the
/// contacts are not linear enough for all of it; a pull that gains nothing is poor only if its part is the smallest.
/// Returns whether the level lowered the energy enough for another one.
bool Tightening::run_level() {
  call_.metric = &call_.context.tight_metric(progress_.level);
  while (progress_.poor_pulls < poor_pulls_before_next_level && progress_.pulls < max_pulls) {
    if (call_.context.longest_displacement(call_.accepted.surface, aim_.surface) <= call_.context.least_separation())
      return false;
    const std::optional<double> gain = pull();
    if (!gain) break;
    ++progress_.pulls;
    progress_.gain += *gain;
    if (*gain >= least_gain)
      progress_.poor_pulls = 0;
    else if (*gain > 0 || progress_.part == smallest_part)
      ++progress_.poor_pulls;
    progress_.part = *gain > 0 ? std::min(1.0, 2 * progress_.part) : std::max(smallest_part, progress_.part / 2);
  }
  return progress_.gain >= least_gain && progress_.pulls < max_pulls;
}

void Tightening::run() {
  while (!progress_.ended) {
    progress_.ended = !run_level() || progress_.level + 1 == EditContext::tight_levels;
    ++progress_.level;
    progress_.poor_pulls = 0;
    progress_.part = 1;
    progress_.gain = 0;
  }
}

/// Settling ends after poor pulls, but the way between obstacles may be long. Tightening has bounds around the state
/// from which it begins, so it begins where settling gains nothing more.
void settle_to_the_end(EditCall& call, const Aim& aim) {
  const PullLimits limits{.pulls = 2 * call.context.options().max_sub_edits,
                          .poor_pulls = poor_pulls_before_end(call.execution)};
  const auto energy_now = [&] { return call.context.energy(call.accepted.surface, aim.surface); };
  for (int k = 0; k < max_settlings; ++k) {
    const double before = energy_now();
    pull_until_settled(call, aim, limits);
    if (!(energy_now() < (1 - least_gain) * before)) return;
  }
}

}  // namespace

void tighten(EditCall& call, const Aim& aim, std::optional<TighteningProgress>& progress) {
  const bool was_blocked = call.report.blocked;
  if (!progress || progress->goal != aim.controls) {
    settle_to_the_end(call, aim);
    progress = TighteningProgress{aim.controls,
                                  ControlBox(call.context, call.accepted, {aim.controls, aim.surface}, call.execution)};
  }
  EditCall tight = call;
  tight.box = &progress->box;
  Tightening(tight, aim, *progress).run();
  call.report.blocked = was_blocked;
}

}  // namespace stiv
