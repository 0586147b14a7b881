// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"
#include "stiv/volumes/patch.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

/// What the gradient of a published volume takes to change with the positions at the end of the step.
enum class PublishedGradient {
  whole,  ///< all of Appendix A: the time (with its scale), the weights and the normal; also by the other side's
          ///< vertices
  frozen  ///< none of these: dV_i / dq_k = A_i (1 - t) |w_k| n, for comparison
};

/// The STIVs of a step as the paper publishes them, for comparison: of each region i the volume that its own contact
/// point sweeps after the earliest event in it,
///
///     V_i = A_i (1 - t) n . Dr_i,
///
/// with n turned for each side so that V_i is negative. [P3.1 Eq. 1; P4 Eq. 3, "Interference prisms"; Appendix A]
/// Patches are regions joined by 1-ring connectivity alone [P4.1]; `kind` is per_patch or single. Regions whose contact
/// point rests, or slides along the plane, have no volume and are left out.
std::vector<Stiv> published_volumes(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end, const Eigen::VectorXd& areas, ConstraintKind kind,
                                    PublishedGradient gradient);

}  // namespace stiv
