// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stiv/acceptance/deviation_test.hpp"
#include "stiv/acceptance/least_distance.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/obstacle.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

enum class EditStatus {
  reached,    ///< the goal itself
  corrected,  ///< short of the goal: interference was resolved, or a limit of a scalar holds
  blocked,    ///< stopped at the last clear state before the response settled; `blocking` lists the bodies. Or stopped
              ///< before controls without a surface: `counters.infeasible` is positive
  budget,     ///< the time budget ended first; the last accepted state is returned
  cancelled,  ///< cancelled; the state before the edit is returned
  unchanged   ///< nothing to do: empty surface, no controls, or goal equal to the accepted controls
};

struct EditResult {
  EditStatus status = EditStatus::unchanged;
  Controls controls;            ///< accepted controls, as stored, (m, 3)
  std::vector<Controls> path;   ///< accepted controls in order, ending with `controls`; the linear steps between them
                                ///< are free of intersections
  Positions surface;            ///< f(controls), (N, 3), world
  double energy = 0;            ///< 1/2 |f(controls) - f(goal)|^2; without f(goal), of the last point before it
  double fraction = 1;          ///< least fraction of a step that acceptance allowed
  Events events;                ///< of the last round with a response
  Index patches = 0;            ///< number of patches of these events
  std::vector<Index> blocking;  ///< bodies in contact when blocked
  Counters counters;
  Timings timings;
};

class SessionImplementation;

/// An editing session: a surface, the deformation that moves it, and the last accepted controls. Every accepted state
/// is free of intersections, and so are the linear steps that lead to it. (mathematics.md, "Guarantee")
/// Not for use from two threads at once; different sessions are independent.
class EditSession {
 public:
  /// @throws InputError for shapes and values that do not fit; StartIntersectsError if f(controls) intersects itself
  ///         where bodies meet.
  EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
              const Controls& controls, EditOptions options = {});
  /// The same with the caller's threads and cancellation. @throws Interrupted as well
  EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
              const Controls& controls, EditOptions options, Execution& execution);
  /// The same beside obstacles, which are fixed bodies after those of the surface. Only their triangles near the motion
  /// are read, so time and memory of a call do not grow with the others. Positions of results are those of the surface
  /// alone; indices of vertices and triangles continue with the obstacles, in order. Pairs with obstacles cannot be
  /// excluded, and obstacles cannot overlap bodies.
  EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation,
              const Controls& controls, EditOptions options, Obstacles obstacles, Execution& execution);
  ~EditSession();
  EditSession(EditSession&&) noexcept;
  EditSession& operator=(EditSession&&) noexcept;

  /// One edit from the accepted controls toward `goal`, (m, 3). Passes sub-goals if the goal is far. Refines
  /// its solution while that lowers the energy. Ends at the best state of its path, unless pinned controls move.
  EditResult edit(const Controls& goal, Execution& execution);

  /// One mouse move of a drag: applies the increment since the last goal, then pulls toward the absolute goal.
  /// (mathematics.md, "Deep goals")
  /// @param hand_over seconds; the call ends at the first state that it accepts later than that, with the status
  ///        budget: the state can be shown while the next call continues from it. So that this state is near its goal,
  ///        the call begins with the contacts of the last one, and its increment includes a part of a pull
  EditResult drag(const Controls& goal, Execution& execution, std::optional<double> hand_over = std::nullopt);

  /// Solves again from the accepted state toward the last goal until the energy no longer falls. It never grows.
  /// Without a time budget, also confirms.
  EditResult settle(Execution& execution);

  /// After a straight drag to a far goal, makes the edit from its start as well, and keeps the better result. Heeds no
  /// time budget of the options: for a settled state, when the user waits or rests.
  EditResult confirm(Execution& execution);

  /// Makes an earlier accepted state (undo, Esc) the accepted one. The next drag's increment counts from `goal`. Clears
  /// the cached candidates, so later results do not depend on earlier calls, and returns free pages of the heap to the
  /// system. @throws StartIntersectsError
  void restore(const Controls& controls, const Controls& goal);
  void restore(const Controls& controls) { restore(controls, controls); }

  /// Changes the response weights and their axes, as in EditOptions. Continues from the accepted state as after
  /// `restore`. @throws InputError, with nothing changed
  void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes = {});

  /// Frees what is prepared for further calls of a drag, and returns free pages of the heap to the system. Further
  /// calls remain possible.
  void end_drag();

  /// Are the path and the end of a linear step between two surfaces free of intersections, given that its start is?
  /// Like stiv::is_step_free, but with the trees of the session. For sessions without excluded pairs.
  bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution);

  /// The exact test of surfaces that deviate from the accepted one by rounding. It remains valid, and may be used while
  /// the session solves on. Null for sessions with excluded pairs, bodies that may overlap or obstacles, and where the
  /// accepted state was not the last that was tested.
  std::shared_ptr<const DeviationTest> deviation_test() const;

  const Controls& controls() const;  ///< accepted, (m, 3)
  const Positions& surface() const;  ///< f(accepted), (N, 3)
  double separation() const;         ///< h in force
  /// The pairs of triangles that may intersect: those of the options, and other pairs of the same bodies that touch at
  /// the start. Two triangles touch if they are apart, but nearer than storing can keep them. Neighbors of the former
  /// may then intersect; the others, and parts of one body that only touch, no deeper than rounding. Sorted, smaller
  /// index first.
  const IndexPairs& excluded() const;
  /// Of the accepted surface; builds a tree at the first call.
  std::optional<NearestTriangles> least_distance(DistancePairs pairs = DistancePairs::between_bodies);
  const Surface& topology() const;

 private:
  std::unique_ptr<SessionImplementation> implementation_;
};

}  // namespace stiv
