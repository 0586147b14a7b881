// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/surface.hpp"
#include "stiv/volumes/region.hpp"

namespace stiv {

enum class ConstraintKind {
  per_patch,   ///< one STIV for each patch
  single,      ///< one for all
  per_contact  ///< one for each event, the finest there is: many constraints, few rounds
};

/// Label of each region, 0, 1, ...: regions of neighbouring vertices and regions of the same event are one patch.
/// Regions of rigid bodies are joined by event only: with six degrees of freedom, a body that lies flat on another
/// needs more than one constraint not to tip over. Joining by side alone gives collinear constraints. [P3.3;
/// mathematics.md, "Rigid bodies"]
std::vector<Index> patch_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind);

/// The same with patches as the paper has them, joined by neighbouring vertices alone. [P4.1]
std::vector<Index> ring_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind);

}  // namespace stiv
