// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Interpolates between two sets of controls; `rotation_rows` (ascending) are rotation vectors, and rotate about one
/// axis. `fraction` 1 gives exactly `to`.
Controls interpolate(const Controls& from, const Controls& to, double fraction,
                     const std::vector<Index>& rotation_rows);

/// `base` moved by the motion from `from` to `to`: points are translated, rotation vectors are composed.
Controls moved_alike(const Controls& base, const Controls& from, const Controls& to,
                     const std::vector<Index>& rotation_rows);

/// The largest angle in [0, pi] between two rotation rows; 0 without any.
double largest_rotation(const Controls& from, const Controls& to, const std::vector<Index>& rotation_rows);

}  // namespace stiv
