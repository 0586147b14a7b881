// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "editing/control_box.hpp"
#include "editing/edit_call.hpp"

namespace stiv {

/// The tightening toward a goal, which the next call to the same goal resumes if the time budget ended this one.
struct TighteningProgress {
  Controls goal;
  ControlBox box;
  int level = 0;       ///< of the damping
  int pulls = 0;       ///< at all levels
  int poor_pulls = 0;  ///< consecutive ones
  double part = 1;     ///< of the step that the next pull takes
  double gain = 0;     ///< sum of the relative drops of the energy at this level
  bool ended = false;
};

/// Lowers the energy from a settled state further. The metric's damping keeps settled states smooth, so they end short
/// of the lowest energy. Each pull leads toward a damped Gauss-Newton step of the energy alone, whose fixed points are
/// its minima under the constraints. If rotations are controls, it leads to a linearised step. Less damped levels
/// follow while they lower the energy by more than 1e-4. Controls stay within their box. (mathematics.md, "Tight
/// edits")
void tighten(EditCall& call, const Aim& aim, std::optional<TighteningProgress>& progress);

}  // namespace stiv
