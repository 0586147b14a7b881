// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/surface.hpp"
#include "stiv/volumes/region.hpp"

namespace stiv {

/// How regions are grouped into STIVs.
enum class ConstraintKind {
  per_patch,   ///< one STIV for each patch
  single,      ///< one STIV for all
  per_contact  ///< one STIV for each event: many constraints, few rounds
};

/// The patch of each region, 0, 1, ... Regions of neighboring vertices, and regions of the same event, are one patch.
/// Regions of rigid bodies are joined by event only: a rigid body that lies flat on another needs several constraints,
/// or it tips over. [P3.3; mathematics.md, "Rigid bodies"]
std::vector<Index> patch_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind);

/// The same with the paper's patches: only regions of neighboring vertices are joined. [P4.1]
std::vector<Index> ring_labels(const Surface& surface, const std::vector<Region>& regions, ConstraintKind kind);

}  // namespace stiv
