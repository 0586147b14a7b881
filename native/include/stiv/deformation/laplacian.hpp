// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/deformation/handles.hpp"

namespace stiv {

/// Laplacian editing [Sorkine et al. 2004; App. B, Eq. 4]: q minimises |L (q - rest)|^2 + sum pull_k |q_h(k) - p_k|^2,
/// with L the Laplacian whose rows are divided by their diagonal; hard handles and fixed vertices are held instead.
/// Linear in the controls. The factor is made once; up to 256 MB the weights of all handles are kept in full too, which
/// makes constraints cheap, beyond that each product with J is a solve. At the rest positions of the handles nothing is
/// moved, to the last bit.
/// @throws InputError naming the element: a triangle, handle or fixed vertex out of range, a handle twice or fixed too,
///         a position or pull not finite, a pull not positive.
std::shared_ptr<const HandleDeformation> make_laplacian(const HandleDefinition& definition);

}  // namespace stiv
