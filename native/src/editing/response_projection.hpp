// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "editing/edit_call.hpp"

namespace stiv {

/// The metric of a call's responses. Waits until it is prepared: large metrics are factored while the first motions are
/// free.
/// @throws Interrupted
const Metric& ready_metric(const EditCall& call);

/// The point closest to `from` that satisfies the constraints and the call's limits on controls. Adds the limits that
/// it exceeds until it exceeds none: most limits are far away.
/// @throws Interrupted
Controls project_within_limits(const EditCall& call, ConstraintSet& constraints, const Controls& from);

}  // namespace stiv
