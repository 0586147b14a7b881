// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/broad_phase/bvh.hpp"

namespace stiv {

/// The pairs of one task, as Bvh::overlaps has them: both subtrees are descended side by side, eight boxes at a time.
void traverse(const Bvh::Task& task, const Bvh& a, const Bvh& b, const GroupTable& groups, PairBuffer& found);

}  // namespace stiv
