// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/editing/session.hpp"

namespace stiv {

/// Takes a surface free of intersections from `from` toward `target`, (N, 3) each, every vertex a control: one edit
/// with interference, then settling. What a contraction is undone with; the target may be any shape with the same
/// vertices. [P5.2, "Self-intersecting meshes"]
/// @throws InputError for shapes and options that do not fit; StartIntersectsError
EditResult expand(const std::shared_ptr<const Surface>& surface, const Positions& from, const Positions& target,
                  const EditOptions& options, Execution& execution);

}  // namespace stiv
