// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"
#include "stiv/volumes/patch.hpp"
#include "stiv/volumes/relative.hpp"

namespace stiv {

/// The quantities that the gradient of a published volume differentiates.
enum class PublishedGradient {
  whole,  ///< time (with its scale), weights and normal, by the vertices of both sides [Appendix A]
  frozen  ///< none of these: dV_i / dq_k = A_i (1 - t) |w_k| n, for comparison
};

/// The STIVs of a step as published, for comparison. The volume of region i is swept by its own contact point after its
/// earliest event,
///
///     V_i = A_i (1 - t) n . Dr_i,
///
/// with n oriented for each side so that V_i is negative. [P3.1 Eq. 1; P4 Eq. 3, "Interference prisms"; Appendix A]
/// Patches are those of ring_labels. Regions whose contact point rests, or slides along the plane, have no volume and
/// are left out.
/// @param start, end the step, (N, 3) each
/// @param areas (N) of region_areas
/// @param kind per_patch or single
std::vector<Stiv> published_volumes(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end, const Eigen::VectorXd& areas, ConstraintKind kind,
                                    PublishedGradient gradient);

}  // namespace stiv
