// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "detection/broad_phase/candidate_source.hpp"

namespace stiv {

/// Appends the candidates that a step, or one that leads each vertex only a part of its way, may bring within the
/// separation: where responses push back, those are the pairs that meet next. Ways are those less `motion`, the step's
/// common one. Of what any broad phase hands out for the step, always the same.
void append_close(const Surface& surface, EventKind kind, std::span<const Candidate> candidates,
                  const VertexSteps& vertices, const Vector3& motion, double separation, std::vector<Candidate>& close);

}  // namespace stiv
