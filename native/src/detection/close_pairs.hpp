// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "detection/broad_phase/candidate_source.hpp"

namespace stiv {

/// Appends the candidates that may come within the separation in a step, or in a step with a fraction of each vertex's
/// displacement. Responses push back along the step, so these pairs meet next. Displacements are relative to the
/// frame of the pair. The result is the same for the candidates of any broad phase. (mathematics.md, "The loop")
void append_close(const Surface& surface, EventKind kind, std::span<const Candidate> candidates,
                  const VertexSteps& vertices, const FrameMotions& motions, double separation,
                  std::vector<Candidate>& close);

}  // namespace stiv
