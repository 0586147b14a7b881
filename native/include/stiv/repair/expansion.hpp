// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/editing/session.hpp"

namespace stiv {

/// Takes a surface free of intersections from controls `from` toward `target`, (m, 3) each: one edit with interference,
/// then settling. What a contraction is undone with; the target may be any shape with the same vertices. [P5.2,
/// "Self-intersecting meshes"]
/// @throws InputError for shapes and options that do not fit; StartIntersectsError
EditResult expand(const std::shared_ptr<const Surface>& surface, const std::shared_ptr<const Deformation>& deformation,
                  const Controls& from, const Controls& target, const EditOptions& options, Execution& execution);

/// The same with every vertex a control.
EditResult expand(const std::shared_ptr<const Surface>& surface, const Positions& from, const Positions& target,
                  const EditOptions& options, Execution& execution);

}  // namespace stiv
