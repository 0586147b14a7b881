// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "editing/control_interpolation.hpp"
#include "editing/edit_result.hpp"
#include "editing/pull.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr int most_pulls_of_drag = 12;
constexpr double least_stride = 0.25;  // pulls

/// An answer is linearised where the goal's surface met, which may be far from where it ends; solving again from there
/// lowers E further. While an edit has taken fewer rounds than this, it does so without being asked: unless the goal is
/// no farther than a pull goes (a mouse move), where all is near, and there is little to gain before the next one.
constexpr int rounds_of_cheap_edit = 24;

/// How far a goal counts as followed when the time of a call ends.
enum class Following {
  whole,  ///< if anything was accepted
  own     ///< as far as the work itself says
};

double farthest_way(const Positions& from, const Positions& to) { return (to - from).rowwise().norm().maxCoeff(); }

}  // namespace

class EditSession::Implementation {
 public:
  Implementation(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                 Controls controls, EditOptions options)
      : problem_(std::move(surface), std::move(deformation), controls, std::move(options)) {
    restore(controls, controls);
  }

  void restore(const Controls& controls, const Controls& goal) {
    const FloatingPointScope floating_point;
    problem_.check_controls(controls, "controls");
    problem_.check_controls(goal, "goal");
    Execution execution(problem_.options().threads);
    State state{controls, problem_.surface_at(controls, execution)};
    const bool known = controls.rows() == checked_.rows() && controls == checked_;
    if (!problem_.is_empty() && !known) problem_.check_start(state.surface, execution);
    checked_ = controls;
    problem_.unfinished_rounds().reset();
    problem_.clear_cached_candidates();
    goal_ = {goal, problem_.surface_at(goal, execution)};
    followed_ = goal_;
    stride_ = std::numeric_limits<double>::infinity();
    accepted_ = std::move(state);
    dragging_ = goal != controls;
  }

  EditResult edit(const Controls& goal, Execution& execution) {
    return carry_out(goal, execution, Following::whole, [&](const Aim& aim, SolveReport& report) {
      dragging_ = false;
      const bool is_short = farthest_way(accepted_.surface, aim.surface) <= pull_limit();
      solve_in_turns(problem_, accepted_, aim, report, execution);
      if (!report.blocked && !is_short) refine(aim, report, execution);
    });
  }

  EditResult drag(const Controls& goal, Execution& execution) {
    return carry_out(goal, execution, Following::own, [&](const Aim& aim, SolveReport& report) {
      dragging_ = true;
      const PullLimits limits{.distance = pull_limit(), .pulls = pulls_after(aim)};
      follow(aim, report, execution);
      pull_until_settled(problem_, accepted_, aim, limits, report, execution);
    });
  }

  EditResult settle(Execution& execution) {
    const Controls goal = goal_.controls;
    return carry_out(goal, execution, Following::whole, [&](const Aim& aim, SolveReport& report) {
      PullLimits limits;
      if (dragging_) limits.distance = pull_limit();
      pull_until_settled(problem_, accepted_, aim, limits, report, execution);
    });
  }

  bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) {
    const FloatingPointScope floating_point;
    problem_.surface().check_positions(start);
    problem_.surface().check_positions(end);
    if (start == end && end == accepted_.surface) return true;
    return problem_.is_step_free(start, end, execution);
  }

  std::optional<NearestTriangles> least_distance(bool within) {
    if (!least_distance_) least_distance_.emplace(problem_.shared_surface());
    return least_distance_->find(accepted_.surface, within);
  }

  const Problem& problem() const { return problem_; }
  const State& accepted() const { return accepted_; }

 private:
  /// Further sub-edits while they are cheap. The answer has settled; that these may not does not make it blocked.
  void refine(const Aim& aim, SolveReport& report, Execution& execution) {
    const PullLimits limits{.pulls = problem_.options().max_sub_edits - 1, .rounds = rounds_of_cheap_edit};
    pull_until_settled(problem_, accepted_, aim, limits, report, execution);
    report.blocked = false;
  }

  /// The increment since the goal that was followed last. Where the time of calls is limited, in strides: half as long
  /// after one that took several calls, so that they come to accept something in each, and twice as long after others.
  void follow(const Aim& aim, SolveReport& report, Execution& execution) {
    for (bool arrives = false; !arrives;) {
      const double way = farthest_way(followed_.surface, aim.surface);
      arrives = way <= stride_ || !execution.has_time_budget();
      State next{aim.controls, aim.surface};
      if (!arrives) {
        next.controls = interpolate(followed_.controls, aim.controls, stride_ / way, problem_.rotation_rows());
        next.surface = problem_.surface_at(next.controls, execution);
      }
      const std::size_t accepted_before = report.path.size();
      try {
        const Controls increment = incremented(next.controls);
        if (problem_.stored(increment) != accepted_.controls)
          solve_in_turns(problem_, accepted_, {increment, aim.surface, false}, report, execution);
      } catch (const Interrupted&) {
        if (report.path.size() > accepted_before) followed_ = next;  // else what is left of it comes first
        stride_is_long_ = true;
        throw;
      }
      followed_ = next;
      stride_ = stride_is_long_ ? std::max(std::min(stride_, way) / 2, least_stride * pull_limit()) : 2 * stride_;
      stride_is_long_ = false;
    }
  }

  double pull_limit() const { return problem_.options().pull_limit * problem_.diagonal(); }

  /// Enough pulls to go back all the way that the increment came, and one more: a mouse that returns from deep inside
  /// a wall takes the shape off it, and the pull has to put it back.
  int pulls_after(const Aim& aim) const {
    const double increment = farthest_way(followed_.surface, aim.surface);
    return static_cast<int>(std::min<double>(most_pulls_of_drag, 1 + std::ceil(increment / pull_limit())));
  }

  /// The accepted controls moved as the goal did since they followed it; the goal itself if nothing is missing so far.
  Controls incremented(const Controls& goal) const {
    if (accepted_.controls == problem_.stored(followed_.controls)) return goal;
    return moved_alike(accepted_.controls, followed_.controls, goal, problem_.rotation_rows());
  }

  /// Frame of every call: checks, the goal's surface, interruption, and the result. On anything but an end by itself or
  /// by the time budget, session and goal are as they were before.
  template <class Work>
  EditResult carry_out(const Controls& goal, Execution& execution, Following following, const Work& work) {
    const FloatingPointScope floating_point;
    problem_.check_controls(goal, "goal");
    const State before = accepted_, followed_before = followed_;
    SolveReport report;
    bool resumable = false;
    EditStatus status = EditStatus::unchanged;
    State target{goal, before.surface};
    {
      const ScopedTimer timer(execution.timings.total);
      if (problem_.options().time_budget > 0 && !execution.has_time_budget())
        execution.set_time_budget(problem_.options().time_budget, true);
      try {
        target.surface = problem_.surface_at(goal, execution);
        problem_.surface().check_positions(target.surface);
        if (!problem_.is_empty() && goal != accepted_.controls) work({goal, target.surface, false}, report);
        status = status_of(problem_, before, accepted_, goal, report);
        goal_ = followed_ = target;
      } catch (const Interrupted&) {
        status = execution.cancel_requested() ? EditStatus::cancelled : EditStatus::budget;
        if (status == EditStatus::cancelled) {
          accepted_ = before;
          followed_ = followed_before;
          problem_.clear_cached_candidates();
          report.path.clear();
        } else {
          goal_ = target;
          const bool accepted_some = !dragging_ || !report.path.empty();
          if (following == Following::whole && accepted_some) followed_ = target;
          resumable = true;
        }
      } catch (...) {
        accepted_ = before;
        followed_ = followed_before;
        problem_.unfinished_rounds().reset();
        problem_.clear_cached_candidates();
        throw;
      }
      if (!resumable) problem_.unfinished_rounds().reset();
    }
    EditResult result = make_result(problem_, accepted_, target.surface, std::move(report), status);
    result.counters = execution.counters;
    result.timings = execution.timings;
    return result;
  }

  Problem problem_;
  State accepted_;
  State goal_;      ///< of the last call, as given
  State followed_;  ///< the last one whose increment was made: before `goal_` where the time budget ended a drag early
  Controls checked_;  ///< that were last restored: a drag that is cancelled goes back to them
  double stride_ = std::numeric_limits<double>::infinity();  ///< of the surface, see `follow`
  bool stride_is_long_ = false;                              ///< it took several calls so far
  bool dragging_ = false;
  std::optional<LeastDistance> least_distance_;  ///< made when first asked for
};

EditSession::EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                         Controls controls, EditOptions options)
    : implementation_(std::make_unique<Implementation>(std::move(surface), std::move(deformation), std::move(controls),
                                                       std::move(options))) {}
EditSession::~EditSession() = default;
EditSession::EditSession(EditSession&&) noexcept = default;
EditSession& EditSession::operator=(EditSession&&) noexcept = default;

EditResult EditSession::edit(const Controls& goal, Execution& execution) {
  return implementation_->edit(goal, execution);
}
EditResult EditSession::drag(const Controls& goal, Execution& execution) {
  return implementation_->drag(goal, execution);
}
EditResult EditSession::settle(Execution& execution) { return implementation_->settle(execution); }
void EditSession::restore(const Controls& controls, const Controls& goal) { implementation_->restore(controls, goal); }

bool EditSession::is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) {
  return implementation_->is_step_free(start, end, execution);
}

const Controls& EditSession::controls() const { return implementation_->accepted().controls; }
const Positions& EditSession::surface() const { return implementation_->accepted().surface; }
std::optional<NearestTriangles> EditSession::least_distance(bool within) const {
  return implementation_->least_distance(within);
}
double EditSession::separation() const { return implementation_->problem().options().separation; }
const Surface& EditSession::topology() const { return implementation_->problem().surface(); }

}  // namespace stiv
