// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stiv/acceptance/least_distance.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

enum class EditStatus {
  reached,    ///< the goal itself
  corrected,  ///< interference was resolved; the controls are as near to the goal as the response brought them
  blocked,    ///< stopped at the last clear state before the response could settle; `blocking` names the bodies
  budget,     ///< the time budget ended first; the last accepted state is returned
  cancelled,  ///< cancelled; the state before the edit is returned
  unchanged   ///< nothing to do: empty surface, no controls, or goal equal to the accepted controls
};

struct EditResult {
  EditStatus status = EditStatus::unchanged;
  Controls controls;            ///< accepted controls, as stored, (m, 3)
  std::vector<Controls> path;   ///< controls accepted on the way, the last of them `controls`; between two of them the
                                ///< surface moves on straight lines and meets nothing
  Positions surface;            ///< f(controls), (N, 3), world
  double energy = 0;            ///< 1/2 |f(controls) - f(goal)|^2
  double fraction = 1;          ///< least fraction of a step that acceptance allowed
  Events events;                ///< contacts that the last responding round found
  Index patches = 0;            ///< their number of patches
  std::vector<Index> blocking;  ///< bodies in contact when blocked
  Counters counters;
  Timings timings;
};

/// An editing session: a surface, the deformation that moves it, and the last accepted controls. Every accepted state
/// is free of intersections, and reachable from the one before without passing through. (mathematics.md, "Guarantee")
/// Not for use from two threads at once; different sessions are independent.
class EditSession {
 public:
  /// @throws InputError for shapes and values that do not fit; StartIntersectsError if f(controls) intersects itself
  ///         where bodies meet.
  EditSession(std::shared_ptr<const Surface> surface, std::shared_ptr<const Deformation> deformation, Controls controls,
              EditOptions options = {});
  ~EditSession();
  EditSession(EditSession&&) noexcept;
  EditSession& operator=(EditSession&&) noexcept;

  /// One edit from the accepted controls toward `goal`, (m, 3). Goes on from its first answer while that is cheap.
  EditResult edit(const Controls& goal, Execution& execution);

  /// One mouse move of a drag: the increment since the last move's goal, then a pull toward the absolute goal, so that
  /// deep goals neither drag sideways nor lose travel, and the shape comes back with the mouse. (mathematics.md,
  /// "Deep goals")
  EditResult drag(const Controls& goal, Execution& execution);

  /// Solve again from the accepted state toward the last goal until E no longer falls: never a larger E.
  EditResult settle(Execution& execution);

  /// Take a state that was accepted before (undo, Esc) as the accepted one, and `goal` as the goal of the last drag,
  /// from which the next increment counts. Pairs that edits brought close, and that rounds ask first, are forgotten:
  /// what comes next does not depend on what came before. @throws StartIntersectsError
  void restore(const Controls& controls, const Controls& goal);
  void restore(const Controls& controls) { restore(controls, controls); }

  /// Is the linear step between two surfaces free, its path and its end, given that its start is? (stiv::is_step_free)
  /// With the trees that edits use; the accepted surface itself is known to be free. For sessions without excluded
  /// pairs.
  bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution);

  const Controls& controls() const;                                           ///< accepted, (m, 3)
  const Positions& surface() const;                                           ///< f(accepted), (N, 3)
  double separation() const;                                                  ///< h in force
  std::optional<NearestTriangles> least_distance(bool within = false) const;  ///< of the accepted surface
  const Surface& topology() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiv
