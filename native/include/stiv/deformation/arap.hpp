// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/handles.hpp"

namespace stiv {

/// As-rigid-as-possible editing [Sorkine and Alexa 2007]: q minimises
///   1/4 sum_i sum_j w_ij |(q_i - q_j) - R_i (rest_i - rest_j)|^2 + 1/2 sum_k pull_k |q_h(k) - p_k|^2
/// over positions and rotations R_i, one a vertex; hard handles and fixed vertices are held instead. Not linear in the
/// controls. The same controls always give the same surface: the minimum is sought from the rest positions, by local
/// and global steps in turn, until a step moves nothing by more than 1e-11 of the size, 300 steps at most. J is the
/// exact derivative of a minimum; the metric is that of rotations that do not answer. The last linearisation is kept.
/// @throws InputError: see make_laplacian
std::shared_ptr<const HandleDeformation> make_arap(const HandleDefinition& definition);

}  // namespace stiv
