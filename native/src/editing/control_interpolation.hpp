// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Where between two sets of controls, and which of their rows (ascending) are rotation vectors: those are turned about
/// one axis instead of being added. `fraction` 1 gives `to` itself, bit by bit.
Controls interpolate(const Controls& from, const Controls& to, double fraction,
                     const std::vector<Index>& rotation_rows);

/// `base` moved as `to` is moved against `from`: points by the difference, rotation vectors by the rotation between.
Controls moved_alike(const Controls& base, const Controls& from, const Controls& to,
                     const std::vector<Index>& rotation_rows);

/// The largest angle in [0, pi] by which a rotation row turns from one to the other; 0 without any.
double largest_rotation(const Controls& from, const Controls& to, const std::vector<Index>& rotation_rows);

}  // namespace stiv
