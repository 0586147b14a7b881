// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/session.hpp"

#include <algorithm>
#include <utility>

#include "editing/contact_memory.hpp"
#include "editing/drag.hpp"
#include "editing/drag_trail.hpp"
#include "editing/edit_result.hpp"
#include "editing/feasible_state.hpp"
#include "editing/obstacle_session.hpp"
#include "editing/session_implementation.hpp"
#include "editing/sub_edit_loop.hpp"
#include "editing/sub_goals.hpp"
#include "editing/tightening.hpp"
#include "free_memory.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr double least_gain_of_edit = 1e-3;  // relative drop of the energy after a drag

/// Whether a goal counts as followed when the time budget ends its call.
enum class FollowedGoal {
  after_any_acceptance,
  as_the_work_recorded  ///< in DragProgress
};

class SurfaceSession final : public SessionImplementation {
 public:
  SurfaceSession(std::shared_ptr<const Surface> surface, Positions obstacles,
                 std::shared_ptr<const Deformation> deformation, const Controls& start, EditOptions options,
                 const Controls& accepted, const Controls& goal, Execution& execution)
      : context_(std::move(surface), std::move(obstacles), std::move(deformation), start, std::move(options),
                 execution),
        queries_(context_, start, execution) {
    execution.check();
    restore(accepted, goal, execution);
    if (context_.obstacles().rows() > 0) context_.region_areas(accepted_.surface, execution);  // keeps the obstacles'
  }

  void restore(const Controls& controls, const Controls& goal) override {
    Execution execution(context_.options().threads);
    restore(controls, goal, execution);
  }

  void restore_free(const Controls& controls, const Controls& goal) override {
    checked_ = controls;
    restore(controls, goal);
  }

  void restore(const Controls& controls, const Controls& goal, Execution& execution) {
    const FloatingPointScope floating_point;
    context_.check_controls(controls, "controls");
    context_.check_controls(goal, "goal");
    context_.limits().check(controls);
    const State state{controls, context_.surface_at(controls, execution)};
    const auto equals = [&](const Controls& known) { return controls.rows() == known.rows() && controls == known; };
    const bool is_known = equals(checked_) || equals(accepted_.controls);
    if (!context_.is_empty() && !is_known) queries_.check_start(state.surface, execution);
    checked_ = controls;
    progress_.reset();
    tightening_.reset();
    overshoot_ = {};
    contacts_ = {};
    queries_.clear_cache();
    trail_.begin(controls);
    const Controls aim = context_.limits().nearest(goal);
    const State followed = aim == controls ? state : last_feasible(context_, state, aim, execution);
    drag_.followed = followed;
    drag_ = {.followed = std::move(drag_.followed)};
    goal_ = goal;
    accepted_ = state;  // in place, as by a Transaction
    is_dragging_ = goal != controls;
  }

  void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) override {
    context_.set_weights(std::move(weights), std::move(weight_axes));
    restore_free(Controls(accepted_.controls), Controls(goal_));
  }

  EditResult edit(const Controls& goal, Execution& execution) override {
    limit_time(execution);
    const auto work = [&](EditCall& call, const Aim& aim) {
      is_dragging_ = false;
      tightening_.reset();
      contacts_ = {};
      drag_.missing_at_detour = drag_.missing_at_leap = 0;
      forget_leaps();
      const bool is_near = context_.longest_displacement(accepted_.surface, aim.surface) <= context_.pull_distance();
      if (is_near || context_.options().max_sub_edits == 1)
        run_sub_edits_by_steps(call, aim);
      else
        edit_toward(call, aim);
      if (context_.options().tight) tighten(call, aim, tightening_);
    };
    EditResult result = carry_out(goal, execution, FollowedGoal::after_any_acceptance, work);
    trail_.begin(accepted_.controls);
    return result;
  }

  EditResult drag(const Controls& goal, Execution& execution, std::optional<double> hand_over) override {
    limit_time(execution);
    const auto work = [&](EditCall& call, const Aim& aim) {
      is_dragging_ = true;
      if (hand_over) {
        call.hand_over.emplace(*hand_over);
        call.overshoot = &overshoot_;
        if (responds_linearly()) call.contacts = &contacts_;
      }
      tightening_.reset();
      const PullLimits limits = pull_limits_of_drag(context_, drag_, aim, execution);
      if (aim.controls != drag_.followed.controls) forget_leaps();
      if (drag_.is_leaping) leap(call, aim, drag_);
      follow_goal(call, aim, drag_);
      pull_and_leap(call, aim, drag_, limits);
      if (detour_of_drag(call, aim, drag_)) pull_until_settled(call, aim, limits);
    };
    EditResult result = carry_out(goal, execution, FollowedGoal::as_the_work_recorded, work);
    if (result.status != EditStatus::cancelled) trail_.add(goal, result.path);
    return result;
  }

  EditResult settle(Execution& execution) override {
    limit_time(execution);
    const Controls goal = goal_;
    const auto work = [&](EditCall& call, const Aim& aim) {
      if (!tightening_) settle_smoothly(call, aim);
      if (context_.options().tight) tighten(call, aim, tightening_);
    };
    EditResult result = carry_out(goal, execution, FollowedGoal::after_any_acceptance, work);
    if (result.status == EditStatus::cancelled) return result;
    if (execution.has_time_budget())
      trail_.add(goal, result.path);  // not yet compared with the edit from the start
    else
      trail_.begin(accepted_.controls);
    return result;
  }

  EditResult confirm(Execution& execution) override {
    const Controls goal = goal_;
    const auto work = [&](EditCall& call, const Aim& aim) {
      if (!is_dragging_) return;
      look_further(call, aim);
      if (context_.options().tight) tighten(call, aim, tightening_);
    };
    return carry_out(goal, execution, FollowedGoal::after_any_acceptance, work);
  }

  void end_drag() override { contacts_ = {}; }

  bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) override {
    const FloatingPointScope floating_point;
    context_.check_positions(start, execution);
    context_.check_positions(end, execution);
    if (start == end && end == accepted_.surface) return true;
    return queries_.is_step_free(start, end, execution);
  }

  std::shared_ptr<const DeviationTest> deviation_test() const override {
    return queries_.deviation_test(accepted_.surface);
  }

  std::optional<NearestTriangles> least_distance(DistancePairs pairs) override {
    if (!least_distance_) least_distance_.emplace(context_.shared_surface());
    SceneRows rows(context_.obstacles());
    return least_distance_->find(rows.with_rest(accepted_.surface), pairs);
  }

  const Controls& controls() const override { return accepted_.controls; }
  const Positions& surface() const override { return accepted_.surface; }
  double separation() const override { return context_.options().separation; }
  const IndexPairs& excluded() const override { return queries_.excluded(); }
  const Surface& topology() const override { return context_.surface(); }

 private:
  /// Restores the session when it ends, unless its call is to last. The session works on copies of its states: results
  /// are stored where the states were, because arrays that moved with each call would fragment the heap.
  class Transaction {
   public:
    explicit Transaction(SurfaceSession& session)
        : session_(session),
          accepted_(std::exchange(session.accepted_, State(session.accepted_))),
          followed_(std::exchange(session.drag_.followed, State(session.drag_.followed))),
          overshoot_(session.overshoot_) {}
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction() {
      session_.accepted_ = std::move(accepted_);
      session_.drag_.followed = std::move(followed_);
      if (lasts_) return;
      session_.overshoot_ = overshoot_;
      session_.contacts_ = {};
      session_.progress_.reset();
      session_.tightening_.reset();
      session_.queries_.clear_cache();
    }

    const Controls& controls_before() const { return accepted_.controls; }
    void commit(const State& followed) {
      accepted_ = session_.accepted_;
      followed_ = followed;
      lasts_ = true;
    }

   private:
    SurfaceSession& session_;
    State accepted_, followed_;  ///< before the call; those to keep, once it is to last
    OvershootMemory overshoot_;
    bool lasts_ = false;
  };

  /// Whether constraints of other controls keep their meaning: rotation vectors and scalars have another metric there.
  bool responds_linearly() const {
    return context_.deformation().rotation_rows().empty() && context_.deformation().scalar_rows().rows.empty();
  }

  void forget_leaps() {
    drag_.is_leaping = false;
    drag_.leapt_from.reset();
  }

  void settle_smoothly(EditCall& call, const Aim& aim) {
    PullLimits limits{.poor_pulls = poor_pulls_before_end(call.execution)};
    if (is_dragging_) limits.distance = context_.pull_distance();
    if (drag_.is_leaping) leap(call, aim, drag_);
    pull_until_settled(call, aim, limits);
    if (!is_dragging_) return;
    leap(call, aim, drag_);
    look_further(call, aim);
  }

  /// From the settled state of a drag. Changes nothing within a time budget.
  void look_further(EditCall& call, const Aim& aim) {
    if (detour_of_drag(call, aim, drag_)) {
      tightening_.reset();
      refine(call, aim);
    }
    edit_from_start(call, aim);
  }

  void edit_toward(EditCall& call, const Aim& aim) {
    const Controls start = accepted_.controls;
    approach_by_sub_goals(call, aim);
    refine(call, aim);
    if (detour(call, aim)) refine(call, aim);
    if (!moves_pinned_controls(context_.options(), start, aim.controls)) return_to_best(call, aim);
  }

  bool can_edit_from_start(const EditCall& call, const Aim& aim) const {
    const EditOptions& options = context_.options();
    const bool may_differ = options.max_sub_edits > 1 && accepted_.controls != context_.stored(aim.controls);
    const bool may_return = queries_.excluded().empty() && options.overlapping.empty() && trail_.is_known();
    return may_differ && may_return && context_.deformation().rotation_rows().empty() &&
           !call.execution.has_time_budget() && trail_.is_straight(aim.controls, context_.pull_distance()) &&
           !moves_pinned_controls(options, trail_.start(), aim.controls);
  }

  /// A drag straight to a far goal may end where an edit from its start would not. Makes that edit as well, as tight as
  /// the drag's state, and keeps the better result. Its path leads back to the start.
  void edit_from_start(EditCall& call, const Aim& aim) {
    if (!can_edit_from_start(call, aim)) return;
    State start{trail_.start(), context_.surface_at(trail_.start(), call.execution)};
    if (context_.longest_displacement(start.surface, aim.surface) <= context_.far_distance()) return;
    DragTrail trail = trail_;
    trail.add(aim.controls, call.report.path);
    if (!trail.is_known()) return;
    const State dragged = std::exchange(accepted_, std::move(start));
    EditReport report = std::exchange(call.report, {});
    std::optional<TighteningProgress> tightening = std::exchange(tightening_, std::nullopt);
    const double missing = context_.energy(dragged.surface, aim.surface);
    progress_.reset();
    queries_.clear_cache();
    edit_toward(call, aim);
    if (tightening) tighten(call, aim, tightening_);
    if (context_.energy(accepted_.surface, aim.surface) < (1 - least_gain_of_edit) * missing) {
      std::vector<Controls> way = trail.way_back();
      trail_.begin(trail.start());
      trail_.add(aim.controls, call.report.path);
      report.path.insert(report.path.end(), way.begin() + 1, way.end());
      call.report.path.insert(call.report.path.begin(), report.path.begin(), report.path.end());
    } else {
      call.report = std::move(report);
      accepted_ = dragged;
      tightening_ = std::move(tightening);
    }
    queries_.clear_cache();
  }

  /// The first solution is linearised where the surfaces met on the way to the goal, possibly far from the result.
  /// Solving again from there lowers the energy further. An edit whose response had settled stays unblocked.
  void refine(EditCall& call, const Aim& aim) {
    const bool was_blocked = call.report.blocked;
    pull_until_settled(
        call, aim,
        {.pulls = 2 * context_.options().max_sub_edits, .poor_pulls = poor_pulls_before_end(call.execution)});
    call.report.blocked = was_blocked && call.report.blocked;
  }

  void limit_time(Execution& execution) const {
    const double time_budget = context_.options().time_budget;
    if (time_budget > 0 && !execution.has_time_budget())
      execution.set_time_budget(time_budget, BudgetEnd::after_checkpoint);
  }

  /// Wraps every call: checks, interruption and the result. A call that is cancelled or throws changes nothing.
  template <class Work>
  EditResult carry_out(const Controls& goal, Execution& execution, FollowedGoal followed, const Work& work) {
    const FloatingPointScope floating_point;
    context_.check_controls(goal, "goal");
    if (context_.renew_metric()) {
      progress_.reset();
      tightening_.reset();
      contacts_ = {};
    }
    EditReport report;
    State target{goal, {}};
    EditStatus status = EditStatus::unchanged;
    {
      const ScopedTimer timer(execution.timings.total);
      EditCall call{context_, queries_, accepted_, progress_, report, execution};
      status = solve(call, goal, target, followed, work);
    }
    return make_result(context_, accepted_, target.surface, std::move(report), status, execution);
  }

  /// @param target the goal, or the point before it that has a surface
  template <class Work>
  EditStatus solve(EditCall& call, const Controls& goal, State& target, FollowedGoal followed, const Work& work) {
    Transaction transaction(*this);
    try {
      const Controls aim = context_.limits().nearest(goal);
      target = last_feasible(context_, accepted_, aim, call.execution);
      call.report.goal_is_infeasible = target.controls != aim;
      context_.check_positions(target.surface, call.execution);
      if (!context_.is_empty() && target.controls != accepted_.controls)
        work(call, {target.controls, target.surface, false});
      goal_ = goal;
      progress_.reset();
      const Controls& before = transaction.controls_before();
      const EditStatus status = status_of(context_, before, accepted_.controls, goal, call.report);
      transaction.commit(target);
      return status;
    } catch (const Interrupted&) {
      if (target.surface.rows() != accepted_.surface.rows()) target.surface = accepted_.surface;  // not yet known
      if (call.execution.cancel_requested()) {
        call.report.path.clear();
        return EditStatus::cancelled;
      }
      goal_ = goal;
      const bool accepted_some = !is_dragging_ || !call.report.path.empty();
      const bool follows_target = followed == FollowedGoal::after_any_acceptance && accepted_some;
      transaction.commit(follows_target ? target : drag_.followed);
      return EditStatus::budget;
    }
  }

  EditContext context_;
  CollisionQueries queries_;
  State accepted_;
  Controls goal_;  ///< of the last call, as given
  DragProgress drag_;
  DragTrail trail_;                               ///< of the drag since the last edit, settling or restoration
  std::optional<RoundProgress> progress_;         ///< of a call that the time budget ended
  std::optional<TighteningProgress> tightening_;  ///< toward the goal of the last call
  Controls checked_;                              ///< last restored; a drag that is cancelled goes back to them
  OvershootMemory overshoot_;                     ///< of the drags
  ContactMemory contacts_;                        ///< of the drags
  bool is_dragging_ = false;
  std::optional<LeastDistance> least_distance_;  ///< built at the first query
};

}  // namespace

std::unique_ptr<SessionImplementation> make_surface_session(std::shared_ptr<const Surface> surface, Positions obstacles,
                                                            std::shared_ptr<const Deformation> deformation,
                                                            const Controls& start, EditOptions options,
                                                            const Controls& accepted, const Controls& goal,
                                                            Execution& execution) {
  return std::make_unique<SurfaceSession>(std::move(surface), std::move(obstacles), std::move(deformation), start,
                                          std::move(options), accepted, goal, execution);
}

EditSession::EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                         const Controls& controls, EditOptions options) {
  Execution execution(std::max(0, options.threads));  // a negative number is reported with the other options
  implementation_ = make_surface_session(std::move(surface), Positions(0, 3), std::move(deformation), controls,
                                         std::move(options), controls, controls, execution);
}
EditSession::EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                         const Controls& controls, EditOptions options, Execution& execution)
    : implementation_(make_surface_session(std::move(surface), Positions(0, 3), std::move(deformation), controls,
                                           std::move(options), controls, controls, execution)) {}
EditSession::EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
                         const Controls& controls, EditOptions options, Obstacles obstacles, Execution& execution)
    : implementation_(make_obstacle_session(std::move(surface), std::move(deformation), controls, std::move(options),
                                            std::move(obstacles), execution)) {}
EditSession::~EditSession() = default;
EditSession::EditSession(EditSession&&) noexcept = default;
EditSession& EditSession::operator=(EditSession&&) noexcept = default;

EditResult EditSession::edit(const Controls& goal, Execution& execution) {
  return implementation_->edit(goal, execution);
}
EditResult EditSession::drag(const Controls& goal, Execution& execution, std::optional<double> hand_over) {
  return implementation_->drag(goal, execution, hand_over);
}
EditResult EditSession::settle(Execution& execution) { return implementation_->settle(execution); }
EditResult EditSession::confirm(Execution& execution) { return implementation_->confirm(execution); }
void EditSession::restore(const Controls& controls, const Controls& goal) {
  implementation_->restore(controls, goal);
  release_free_memory();
}
void EditSession::set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) {
  implementation_->set_weights(std::move(weights), std::move(weight_axes));
}

void EditSession::end_drag() {
  implementation_->end_drag();
  release_free_memory();
}

bool EditSession::is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) {
  return implementation_->is_step_free(start, end, execution);
}

const Controls& EditSession::controls() const { return implementation_->controls(); }
const Positions& EditSession::surface() const { return implementation_->surface(); }
std::shared_ptr<const DeviationTest> EditSession::deviation_test() const { return implementation_->deviation_test(); }
std::optional<NearestTriangles> EditSession::least_distance(DistancePairs pairs) {
  return implementation_->least_distance(pairs);
}
double EditSession::separation() const { return implementation_->separation(); }
const IndexPairs& EditSession::excluded() const { return implementation_->excluded(); }
const Surface& EditSession::topology() const { return implementation_->topology(); }

}  // namespace stiv
