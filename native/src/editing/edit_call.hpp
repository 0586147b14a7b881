// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "editing/collision_queries.hpp"
#include "editing/edit_context.hpp"
#include "stiv/response/resolver.hpp"

namespace stiv {

class ContactMemory;
class ControlBox;

/// The controls from which a round projects. [P3.2; mathematics.md, "The loop"]
enum class Projection {
  from_goal,       ///< the goal, with accumulated constraints; after `accumulated_rounds` as below
  from_last_round  ///< the last candidate, with the constraints of the round alone: Algorithm 1
};

/// The rounds of a sub-edit, which the next call resumes if the time budget ended this one.
struct RoundProgress {
  Controls accepted, goal;  ///< of the sub-edit
  Projection projection = Projection::from_goal;
  ConstraintSet constraints;
  Controls p;  ///< next candidate, before it is rounded
  bool accumulates = true;
  int round = 0;
  bool cache_is_pruned = false;                 ///< for the step to this goal
  std::optional<Events> events = std::nullopt;  ///< of the step to the candidate, if a search has ended
  bool events_are_constrained = false;          ///< their rows are among `constraints`
  bool is_cut = false;                          ///< the step to the candidate was shortened to where there is a surface
  bool begins_with_contacts = false;            ///< its first constraints are those of a ContactMemory

  bool belongs_to(const Controls& from, const Controls& to, Projection kind) const {
    return accepted == from && goal == to && projection == kind;
  }
};

/// The outcome of a call so far, summed over its sub-edits.
struct EditReport {
  bool blocked = false;             ///< the last sub-edit ended before the response settled
  bool goal_is_infeasible = false;  ///< a point before the goal was the goal
  double fraction = 1;              ///< least fraction of a step that was accepted
  Events events;                    ///< of the last round that had any
  Index patches = 0;
  std::vector<Controls> path;  ///< accepted controls, in order
};

/// Which projection was better when accumulated constraints last overshot in a drag. The next call then need not solve
/// both ways before a state can be shown.
struct OvershootMemory {
  std::optional<Projection> better = std::nullopt;  ///< none: they do not overshoot
};

/// When a call ends at an acceptance, so that the state can be shown.
struct HandOver {
  using Clock = std::chrono::steady_clock;
  Clock::time_point begins, late;  ///< late: the state should have been accepted earlier

  explicit HandOver(double seconds) {
    const auto wait = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    begins = Clock::now() + wait;
    late = begins + wait;
  }
};

/// The inputs and outputs of one call of a session. `accepted` changes at each acceptance and only then, so it is valid
/// even when Interrupted is thrown.
struct EditCall {
  const EditContext& context;
  CollisionQueries& queries;
  State& accepted;
  std::optional<RoundProgress>& progress;
  EditReport& report;
  Execution& execution;
  std::optional<HandOver> hand_over = std::nullopt;
  OvershootMemory* overshoot = nullptr;  ///< of a drag that is to hand over
  ContactMemory* contacts = nullptr;     ///< the same
  const Metric* metric = nullptr;        ///< of the responses, instead of the context's
  const ControlBox* box = nullptr;       ///< that controls must not leave

  bool is_to_hand_over() const { return hand_over && HandOver::Clock::now() >= hand_over->begins; }
  bool is_late() const { return !hand_over || HandOver::Clock::now() >= hand_over->late; }
};

/// The goal of a sub-edit.
struct Aim {
  Controls controls;
  const Positions& surface;  ///< from which the energy is measured: the surface of the final goal, which outlives this
  bool must_improve;         ///< accept only states with lower energy
};

}  // namespace stiv
